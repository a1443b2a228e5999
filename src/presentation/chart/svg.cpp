// SPDX-License-Identifier: Apache-2.0
#include "chart/svg.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace takt::chart {
namespace {

constexpr std::array<std::string_view, 3> anchors = {"start", "middle", "end"};

std::string ends(Point from, Point to) {
  return fmt::format(R"(x1="{}" y1="{}" x2="{}" y2="{}")", coordinate(from.x), coordinate(from.y), coordinate(to.x),
                     coordinate(to.y));
}

std::string turned(double degrees, Point at) {
  return degrees == 0 ? ""
                      : fmt::format(R"x( transform="rotate({} {} {})")x", coordinate(degrees), coordinate(at.x),
                                    coordinate(at.y));
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string coordinate(double value) {
  if (!std::isfinite(value)) return "0";
  std::string text = fmt::format("{:.2f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

void Svg::line(Point from, Point to, Class look) {
  body_ += fmt::format("<line {} class=\"{}\"/>\n", ends(from, to), look.name);
}

void Svg::polyline(const std::vector<Point>& points, std::string_view colour, Class look) {
  body_ += "<polyline points=\"";
  for (const Point& point : points) body_ += coordinate(point.x) + "," + coordinate(point.y) + " ";
  body_ += fmt::format("\" stroke=\"{}\" class=\"{}\"/>\n", colour, look.name);
}

void Svg::path(std::string_view commands, std::string_view colour, Class look) {
  body_ += fmt::format(R"(<path d="{}"{} class="{}"/>)"
                       "\n",
                       commands, colour.empty() ? "" : fmt::format(R"( stroke="{}")", colour), look.name);
}

void Svg::rectangle(Point corner, double width, double height, Class look, double round) {
  body_ += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" rx="{}" class="{}"/>)"
                       "\n",
                       coordinate(corner.x), coordinate(corner.y), coordinate(width), coordinate(height),
                       coordinate(round), look.name);
}

void Svg::swatch(Point corner, double width, double height, std::string_view colour) {
  body_ += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="{}"/>)"
                       "\n",
                       coordinate(corner.x), coordinate(corner.y), coordinate(width), coordinate(height), colour);
}

void Svg::text(Point at, std::string_view text, Anchor anchor, Class look, double turn) {
  body_ += fmt::format(R"(<text x="{}" y="{}" text-anchor="{}" class="{}"{}>{}</text>)"
                       "\n",
                       coordinate(at.x), coordinate(at.y), anchors[static_cast<std::size_t>(anchor)], look.name,
                       turned(turn, at), escaped(text));
}

void Svg::mark_circle(Point centre, double radius, std::string_view colour, std::string_view title) {
  body_ += fmt::format(R"(<circle cx="{}" cy="{}" r="{}" fill="{}" class="mark"><title>{}</title></circle>)"
                       "\n",
                       coordinate(centre.x), coordinate(centre.y), coordinate(radius), colour, escaped(title));
}

void Svg::mark_rectangle(Point corner, double width, double height, std::string_view colour, std::string_view title) {
  body_ += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="{}" class="mark"><title>{}</title></rect>)"
                       "\n",
                       coordinate(corner.x), coordinate(corner.y), coordinate(width), coordinate(height), colour,
                       escaped(title));
}

void Svg::titled_path(std::string_view commands, std::string_view colour, double stroke_width, std::string_view title) {
  body_ += fmt::format(R"(<path d="{}" stroke="{}" stroke-width="{}" fill="none" class="mark"><title>{}</title></path>)"
                       "\n",
                       commands, colour, coordinate(stroke_width), escaped(title));
}

std::string Svg::element(std::string_view label) const {
  return fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="{2}">)"
      "\n{3}</svg>\n",
      coordinate(width_), coordinate(height_), escaped(label), body_);
}

std::string_view style_sheet() {
  return "svg text{font:11px system-ui,sans-serif;fill:#333}svg .title{font-weight:600;font-size:12px}svg "
         ".strong{font-weight:600;font-size:12px}svg .axis{stroke:#666;stroke-width:1}"
         "svg .grid{stroke:#e4e4e4;stroke-width:1}svg "
         ".limit{fill:none;stroke:#c0392b;stroke-width:1.5;stroke-dasharray:5 4}svg .whisker{fill:none;stroke-width:1}"
         "svg .curve{fill:none;stroke-width:1.8}svg .chosen{fill:none;stroke:#c0392b;stroke-width:1.8}svg "
         ".area{stroke:none;opacity:.15}svg .arrow{fill:none;stroke:#333;stroke-width:1.3}"
         "svg .dashed{stroke-dasharray:6 4}svg .box{fill:#eef3f8;stroke:#0072b2}svg .paper{fill:#fff}svg "
         ".screen{fill:#12242e}svg .screen-grid{stroke:#34505d}"
         "svg .note{fill:#555;paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}svg "
         ".mark{cursor:default}svg .on-dark{fill:#fff}\n";
}

std::string_view arrow_heads() {
  return "<style>svg .arrow{marker-end:url(#arrow)}svg .arrowhead{fill:#333}</style><defs><marker id=\"arrow\" "
         "viewBox=\"0 0 10 10\" refX=\"9\" refY=\"5\" markerWidth=\"8\" markerHeight=\"8\" "
         "markerUnits=\"userSpaceOnUse\" orient=\"auto\"><path d=\"M0 0 L10 5 L0 10 z\" "
         "class=\"arrowhead\"/></marker></defs>";
}

std::string picture(std::string element) {
  return element.insert(element.find('>') + 1, "<style>" + std::string(style_sheet()) + "</style>" +
                                                   std::string(arrow_heads()) +
                                                   "<rect width=\"100%\" height=\"100%\" class=\"paper\"/>");
}

std::string_view palette(std::size_t number) {
  static constexpr std::array<std::string_view, 8> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                              "#56b4e9", "#e69f00", "#000000", "#999933"};
  return colours[number % colours.size()];
}

std::string_view screen_palette(std::size_t number) {
  static constexpr std::array<std::string_view, 4> colours = {"#f4d35e", "#7fd1c7", "#e58fb1", "#a8c686"};
  return colours[number % colours.size()];
}

}  // namespace takt::chart
