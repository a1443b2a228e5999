// SVG elements as text.
#pragma once

#include <string>
#include <string_view>

namespace takt::study::chart {

/// & < > " and ' as entities, for text and attributes of HTML and SVG.
std::string escaped(std::string_view text);
/// A coordinate: two decimals, without trailing zeros.
std::string coordinate(double value);

/// Collects elements of one picture. Colours are CSS classes where a style sheet says what they are, or CSS colours.
class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  void line(double x1, double y1, double x2, double y2, std::string_view css_class);
  /// Text at a place; anchor is start, middle or end; turned by so many degrees.
  void text(double x, double y, std::string_view text, std::string_view anchor, std::string_view css_class, double turn = 0);
  /// Marks stand for figures: `title` is shown when the mouse rests on them.
  void circle(double x, double y, double radius, std::string_view colour, std::string_view title);
  void bar(double x, double y, double width, double height, std::string_view colour, std::string_view title);
  /// Decoration: a rectangle that is no mark, a path.
  void box(double x, double y, double width, double height, std::string_view colour);
  void path(std::string_view commands, std::string_view colour, std::string_view css_class);

  /// The whole <svg> element; `label` is what a screen reader reads.
  std::string take(std::string_view label) const;

 private:
  double width_;
  double height_;
  std::string elements_;
};

/// The style sheet that the elements need, once for a page (or for a file of one picture).
std::string_view style_sheet();

}  // namespace takt::study::chart
