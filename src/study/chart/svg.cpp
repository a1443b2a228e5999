#include "study/chart/svg.hpp"

#include <fmt/format.h>

#include <cmath>

namespace takt::study::chart {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      case '\'': safe += "&#39;"; break;
      default: safe += c;
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

void Svg::line(double x1, double y1, double x2, double y2, std::string_view css_class) {
  elements_ += fmt::format(R"(<line x1="{}" y1="{}" x2="{}" y2="{}" class="{}"/>)" "\n", coordinate(x1), coordinate(y1), coordinate(x2), coordinate(y2), css_class);
}

void Svg::text(double x, double y, std::string_view text, std::string_view anchor, std::string_view css_class, double turn) {
  const std::string turned = turn == 0 ? "" : fmt::format(R"x( transform="rotate({} {} {})")x", coordinate(turn), coordinate(x), coordinate(y));
  elements_ += fmt::format(R"(<text x="{}" y="{}" text-anchor="{}" class="{}"{}>{}</text>)" "\n", coordinate(x), coordinate(y), anchor, css_class, turned, escaped(text));
}

void Svg::circle(double x, double y, double radius, std::string_view colour, std::string_view title) {
  elements_ += fmt::format(R"(<circle cx="{}" cy="{}" r="{}" fill="{}" class="mark"><title>{}</title></circle>)" "\n", coordinate(x), coordinate(y), coordinate(radius), colour, escaped(title));
}

void Svg::bar(double x, double y, double width, double height, std::string_view colour, std::string_view title) {
  elements_ += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="{}" class="mark"><title>{}</title></rect>)" "\n", coordinate(x), coordinate(y), coordinate(width), coordinate(height),
                           colour, escaped(title));
}

void Svg::box(double x, double y, double width, double height, std::string_view colour) {
  elements_ += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="{}"/>)" "\n", coordinate(x), coordinate(y), coordinate(width), coordinate(height), colour);
}

void Svg::path(std::string_view commands, std::string_view colour, std::string_view css_class) {
  elements_ += fmt::format(R"(<path d="{}" stroke="{}" class="{}"/>)" "\n", commands, colour, css_class);
}

std::string Svg::take(std::string_view label) const {
  return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="{2}">)" "\n{3}</svg>\n", coordinate(width_),
                     coordinate(height_), escaped(label), elements_);
}

std::string_view style_sheet() {
  return "svg text{font:11px system-ui,sans-serif;fill:#333}svg .title{font-weight:600;font-size:12px}svg .axis{stroke:#666;stroke-width:1}"
         "svg .grid{stroke:#e4e4e4;stroke-width:1}svg .limit{stroke:#c0392b;stroke-width:1.5;stroke-dasharray:5 4}svg .whisker{stroke:#555;stroke-width:1}"
         "svg .curve{fill:none;stroke-width:1.8}svg .area{stroke:none;opacity:.15}svg .note{fill:#777}svg .mark{cursor:default}svg .on-dark{fill:#fff}\n";
}

}  // namespace takt::study::chart
