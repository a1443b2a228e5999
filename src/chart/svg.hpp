// A drawing as SVG text: lines, rectangles, texts in a given order.
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

class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  void line(Point from, Point to, const Stroke& stroke);
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  /// A quadratic curve.
  void curve(Point from, Point control, Point to, const Stroke& stroke);
  void rectangle(Point corner, double width, double height, std::string_view fill, std::string_view edge = "none", double round = 0);
  void circle(Point centre, double radius, std::string_view fill, std::string_view edge = "none");
  void text(Point at, std::string_view text, const TextStyle& style = {});

  /// The whole document, with a line end after each line.
  std::string document() const;

 private:
  double width_;
  double height_;
  std::string body_;
};

/// Colours that can be told apart, again from the first on when they are used up.
std::string_view palette(std::size_t number);

}  // namespace takt::chart
