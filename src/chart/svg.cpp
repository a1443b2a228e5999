#include "chart/svg.hpp"

#include <fmt/format.h>

#include <array>

namespace takt::chart {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string attributes(const Stroke& stroke) {
  return fmt::format(R"(fill="none" stroke="{}" stroke-width="{:.1f}"{}{})", stroke.colour, stroke.width, stroke.dashed ? R"( stroke-dasharray="6 4")" : "",
                     stroke.arrow ? R"-( marker-end="url(#arrow)")-" : "");
}

}  // namespace

void Svg::line(Point from, Point to, const Stroke& stroke) {
  body_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", from.x, from.y, to.x, to.y, attributes(stroke));
}

void Svg::polyline(const std::vector<Point>& points, const Stroke& stroke) {
  body_ += "<polyline points=\"";
  for (const Point& point : points) body_ += fmt::format("{:.1f},{:.1f} ", point.x, point.y);
  body_ += fmt::format("\" {}/>\n", attributes(stroke));
}

void Svg::curve(Point from, Point control, Point to, const Stroke& stroke) {
  body_ += fmt::format("<path d=\"M{:.1f} {:.1f} Q{:.1f} {:.1f} {:.1f} {:.1f}\" {}/>\n", from.x, from.y, control.x, control.y, to.x, to.y, attributes(stroke));
}

void Svg::rectangle(Point corner, double width, double height, std::string_view fill, std::string_view edge, double round) {
  body_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" rx=\"{:.1f}\" fill=\"{}\" stroke=\"{}\"/>\n", corner.x, corner.y, width,
                       height, round, fill, edge);
}

void Svg::circle(Point centre, double radius, std::string_view fill, std::string_view edge) {
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\" stroke=\"{}\"/>\n", centre.x, centre.y, radius, fill, edge);
}

void Svg::text(Point at, std::string_view text, const TextStyle& style) {
  constexpr std::array<std::string_view, 3> anchors = {"start", "middle", "end"};
  const std::string turn = style.upright ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", at.x, at.y) : "";
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.0f}\" text-anchor=\"{}\" fill=\"{}\"{}{}>{}</text>\n", at.x, at.y, style.size,
                       anchors[static_cast<std::size_t>(style.anchor)], style.colour, style.bold ? " font-weight=\"bold\"" : "", turn, escaped(text));
}

std::string Svg::document() const {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\">\n"
             "<defs><marker id=\"arrow\" viewBox=\"0 0 10 10\" refX=\"9\" refY=\"5\" markerWidth=\"8\" markerHeight=\"8\" markerUnits=\"userSpaceOnUse\" orient=\"auto\">"
             "<path d=\"M0 0 L10 5 L0 10 z\" fill=\"#333\"/></marker></defs>\n"
             "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#fff\"/>\n",
             width_, height_) +
         body_ + "</svg>\n";
}

std::string_view palette(std::size_t number) {
  constexpr std::array<std::string_view, 8> colours = {"#1b6ca8", "#d1495b", "#2e8b57", "#e09f3e", "#6a4c93", "#3d405b", "#00798c", "#9c6644"};
  return colours[number % colours.size()];
}

}  // namespace takt::chart
