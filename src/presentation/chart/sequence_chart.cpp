// SPDX-License-Identifier: Apache-2.0
#include "chart/sequence_chart.hpp"

#include <algorithm>
#include <cmath>

#include "chart/svg.hpp"

namespace takt::chart {

std::string sequence_chart_element(const SequenceChart& chart) {
  constexpr double margin = 210;
  // Many participants and many rows stand closer.
  const double gap = chart.participants.size() <= 4 ? 320 : chart.participants.size() <= 8 ? 190 : 125;
  const double half_box = std::min(65.0, gap / 2 - 5);
  constexpr double first_row = 130;
  std::vector<std::int64_t> rows;
  for (const SequenceStep& step : chart.steps) rows.push_back(step.time);
  for (const SequenceMessage& message : chart.messages) {
    rows.push_back(message.sent);
    rows.push_back(message.received);
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  constexpr std::size_t many_rows = 24;
  const double row_height = rows.size() <= many_rows ? 34 : 24;
  const auto y_of = [&](std::int64_t time) {
    return first_row +
           row_height * static_cast<double>(std::lower_bound(rows.begin(), rows.end(), time) - rows.begin());
  };
  const auto x_of = [&](std::size_t participant) { return margin + 110 + gap * static_cast<double>(participant); };
  const double end = first_row + row_height * static_cast<double>(rows.size());
  const double width = x_of(chart.participants.size() - 1) + 190;
  Svg svg(width, end + 20);
  svg.text({20, 26}, chart.title, Anchor::start, Class{"title"});
  for (std::size_t p = 0; p < chart.participants.size(); ++p) {
    svg.line({x_of(p), 80}, {x_of(p), end}, Class{"axis"});
    svg.rectangle({x_of(p) - half_box, 45}, 2 * half_box, 36, Class{"box"}, 4);
    svg.text({x_of(p), 60}, chart.participants[p], Anchor::middle, Class{"strong"});
    svg.text({x_of(p), 75}, chart.states[p], Anchor::middle, Class{"label"});
  }
  for (const std::int64_t row : rows)
    if (chart.label) svg.text({20, y_of(row) + 4}, chart.label(row), Anchor::start, Class{"note"});
  for (const SequenceMessage& message : chart.messages) {
    const Point from{x_of(message.from), y_of(message.sent)};
    const Point to{x_of(message.to), y_of(message.received)};
    svg.line(from, to, Class{"arrow dashed"});
    svg.text({(from.x + to.x) / 2, (from.y + to.y) / 2 - 9}, message.text, Anchor::middle, Class{"label"});
  }
  for (const SequenceStep& step : chart.steps) {
    const bool leftmost = step.participant == 0;
    svg.mark_rectangle({x_of(step.participant) - 5, y_of(step.time) - 9}, 10, 18, palette(0), step.text);
    svg.text({x_of(step.participant) + (leftmost ? -12 : 12), y_of(step.time) + 4}, step.text,
             leftmost ? Anchor::end : Anchor::start, Class{"strong"});
  }
  return svg.element(chart.title);
}

std::string sequence_chart(const SequenceChart& chart) { return picture(sequence_chart_element(chart)); }

}  // namespace takt::chart
