// SPDX-License-Identifier: Apache-2.0
// A drawing as SVG text: elements in a given order. How they look is left to the classes of one style sheet, which a
// page has once and a picture that is a file brings along.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace takt::chart {

/// In pixels, y downwards.
struct Point {
  double x = 0;
  double y = 0;
};

enum class Anchor { start, middle, end };

/// The look is what the style sheet says of this class.
struct Class {
  std::string_view name;
};

/// & < > " and ' as entities, for text and attributes of HTML and SVG.
std::string escaped(std::string_view text);
/// A coordinate: two decimals, without trailing zeros.
std::string coordinate(double value);

class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  void line(Point from, Point to, Class look);
  void polyline(const std::vector<Point>& points, std::string_view colour, Class look);
  /// A path of SVG commands; without a colour in that of its class.
  void path(std::string_view commands, std::string_view colour, Class look);
  void rectangle(Point corner, double width, double height, Class look, double round = 0);
  /// A piece of a legend.
  void swatch(Point corner, double width, double height, std::string_view colour);
  /// Turned by so many degrees.
  void text(Point at, std::string_view text, Anchor anchor, Class look, double turn = 0);
  /// Marks stand for figures: they have the class `mark`, and `title` is shown when the mouse rests on them.
  void mark_circle(Point centre, double radius, std::string_view colour, std::string_view title);
  void mark_rectangle(Point corner, double width, double height, std::string_view colour, std::string_view title);
  /// A stroke that stands for a figure.
  void titled_path(std::string_view commands, std::string_view colour, double stroke_width, std::string_view title);

  /// One <svg> element for a page; `label` is what a screen reader reads.
  std::string element(std::string_view label) const;

 private:
  double width_;
  double height_;
  std::string body_;
};

/// What classes look like, once for a page.
std::string_view style_sheet();
/// What arrows want besides, within the first <svg> element of a page that has some.
std::string_view arrow_heads();
/// An element as a file of its own: with the style sheet, and white behind it.
std::string picture(std::string element);

/// Colours of series, again from the first on when they are used up; told apart by people who see few colours too
/// (Okabe and Ito).
std::string_view palette(std::size_t number);
/// The same on the dark of a screen.
std::string_view screen_palette(std::size_t number);
/// What stands behind or before series.
inline constexpr std::string_view faint = "#b8c4cc";
inline constexpr std::string_view strong = "#222";

}  // namespace takt::chart
