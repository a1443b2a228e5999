// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/axis.hpp"
#include "chart/chart.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

struct Colour {
  double red, green, blue;
};

/// From light to dark over few hues, so that it reads in grey too (the ends and middle of viridis, turned round).
Colour colour_at(double share) {
  static constexpr Colour stops[] = {{247, 244, 190}, {122, 209, 145}, {43, 140, 140}, {55, 85, 140}, {62, 25, 90}};
  const double position = std::clamp(share, 0.0, 1.0) * 4;
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(position), 3);
  const double rest = position - static_cast<double>(i);
  const auto between = [&](double a, double b) { return a + (b - a) * rest; };
  return {between(stops[i].red, stops[i + 1].red), between(stops[i].green, stops[i + 1].green),
          between(stops[i].blue, stops[i + 1].blue)};
}

std::string css(const Colour& c) { return fmt::format("rgb({:.0f},{:.0f},{:.0f})", c.red, c.green, c.blue); }

std::size_t longest_of(const std::vector<std::string>& texts) {
  std::size_t longest = 0;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  return std::min<std::size_t>(longest, 30);
}

}  // namespace

std::string draw(const HeatMap& chart) {
  double low = INFINITY;
  double high = -INFINITY;
  for (const auto& row : chart.cells)
    for (const auto& cell : row)
      if (cell && (!chart.is_logarithmic || *cell > 0)) {
        low = std::min(low, *cell);
        high = std::max(high, *cell);
      }
  const bool is_logarithmic = chart.is_logarithmic && low > 0 && low < high;
  const auto share = [&](double value) {
    if (!(low < high)) return 0.5;
    return is_logarithmic ? std::log(std::max(value, low) / low) / std::log(high / low) : (value - low) / (high - low);
  };
  const double label_width = 30 + 6.2 * static_cast<double>(longest_of(chart.rows));
  const double width = std::clamp(6.2 * static_cast<double>(longest_of(chart.columns)) + 10, 52.0, 200.0);
  const double height = 26;
  const double x0 = label_width;
  const double y0 = 26;
  const double x1 = x0 + width * static_cast<double>(chart.columns.size());
  const double y1 = y0 + height * static_cast<double>(chart.rows.size());
  const std::string scale = low < high ? fmt::format("{} to {} {}{}", number_text(low), number_text(high), chart.unit,
                                                     is_logarithmic ? ", logarithmic" : "")
                                       : "";
  Svg svg(std::max({x1 + 14, x0 + 7.0 * static_cast<double>(chart.title.size()),
                    x0 + 130 + 6.2 * static_cast<double>(scale.size())}),
          y1 + 62);
  svg.text({x0, 15}, chart.title, Anchor::start, Class{"title"});
  for (std::size_t r = 0; r < chart.rows.size(); ++r) {
    const double y = y0 + height * static_cast<double>(r);
    svg.text({x0 - 6, y + height / 2 + 4}, chart.rows[r].substr(0, 30), Anchor::end, Class{"tick"});
    for (std::size_t c = 0; c < chart.columns.size(); ++c) {
      const double x = x0 + width * static_cast<double>(c);
      const auto& cell = chart.cells[r][c];
      const bool has_note = r < chart.notes.size() && c < chart.notes[r].size() && !chart.notes[r][c].empty();
      const std::string title = chart.columns[c] + ", " + chart.rows[r] + ": " +
                                (cell ? number_text(*cell) + " " + chart.unit : "no result") +
                                (has_note ? "; " + chart.notes[r][c] : "");
      svg.mark_rectangle({x + 0.5, y + 0.5}, width - 1, height - 1,
                         cell ? css(colour_at(share(*cell))) : std::string(faint), title);
      const std::string_view look = cell && share(*cell) > 0.45 ? "cell on-dark" : "cell";
      svg.text({x + width / 2, y + height / 2 + 4}, cell ? fmt::format("{:.4g}", *cell) : "-", Anchor::middle,
               Class{look});
      if (r < chart.marked.size() && c < chart.marked[r].size() && chart.marked[r][c])
        svg.path(fmt::format("M{} {}h{}v{}h-{}z", coordinate(x + 1.5), coordinate(y + 1.5), coordinate(width - 3),
                             coordinate(height - 3), coordinate(width - 3)),
                 {}, Class{"chosen"});
    }
  }
  for (std::size_t c = 0; c < chart.columns.size(); ++c)
    svg.text({x0 + width * (static_cast<double>(c) + 0.5), y1 + 15}, chart.columns[c].substr(0, 30), Anchor::middle,
             Class{"tick"});
  svg.text({(x0 + x1) / 2, y1 + 32}, chart.x_label, Anchor::middle, Class{"label"});
  svg.text({12, (y0 + y1) / 2}, chart.y_label, Anchor::middle, Class{"label"}, -90);
  if (low < high) {
    for (int i = 0; i < 20; ++i) svg.swatch({x0 + 6 * i, y1 + 42}, 6.2, 8, css(colour_at(i / 19.0)));
    svg.text({x0 + 126, y1 + 50}, scale, Anchor::start, Class{"note"});
  }
  return svg.element(chart.title);
}

}  // namespace takt::chart
