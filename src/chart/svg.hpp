// A drawing as SVG text: elements in a given order. How they look stands in attributes (pictures that are files) or is left to a style sheet's class
// (pictures in a page).
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

struct Stroke {
  std::string_view colour = "#333";
  double width = 1;
  bool dashed = false;
  bool arrow = false;   ///< at its end
};

struct TextStyle {
  double size = 12;
  Anchor anchor = Anchor::start;
  std::string_view colour = "#222";
  bool bold = false;
  bool upright = false;  ///< reads from bottom to top
};

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

  void line(Point from, Point to, const Stroke& stroke = {});
  void line(Point from, Point to, Class look);
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  /// A quadratic curve.
  void curve(Point from, Point control, Point to, const Stroke& stroke);
  /// A path of SVG commands.
  void path(std::string_view commands, std::string_view colour, Class look);
  void rectangle(Point corner, double width, double height, std::string_view fill, std::string_view edge = "none", double round = 0);
  void circle(Point centre, double radius, std::string_view fill, std::string_view edge = "none");
  void text(Point at, std::string_view text, const TextStyle& style = {});
  /// Turned by so many degrees.
  void text(Point at, std::string_view text, Anchor anchor, Class look, double turn = 0);
  /// Marks stand for figures: they have the class `mark`, and `title` is shown when the mouse rests on them.
  void mark_circle(Point centre, double radius, std::string_view colour, std::string_view title);
  void mark_rectangle(Point corner, double width, double height, std::string_view colour, std::string_view title);

  /// A document of its own, on white, with a line end after each line.
  std::string document() const;
  /// One <svg> element for a page; `label` is what a screen reader reads.
  std::string element(std::string_view label) const;

 private:
  double width_;
  double height_;
  std::string body_;
};

/// What classes look like, once for a page (or for a file of one picture).
std::string_view style_sheet();

/// Colours of pictures that are files, again from the first on when they are used up.
std::string_view ink(std::size_t number);
/// Colours of series in a page; told apart by people who see few colours too (Okabe and Ito).
std::string_view palette(std::size_t number);

}  // namespace takt::chart
