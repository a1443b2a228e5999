// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/charts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chart/bar_chart.hpp"
#include "chart/square_wave.hpp"

namespace takt::papers::coexistence {
namespace {

std::vector<std::string> columns() {
  std::vector<std::string> names;
  for (const int interval : intervals) names.push_back(fmt::format("{} ms", interval));
  return names;
}

/// Names of groups are broken at spaces; that of the protocol is not.
std::string unbroken(std::string name) {
  if (const std::size_t at = name.find("OPC UA"); at != std::string::npos) name.replace(at, 6, "OPC\u00a0UA");
  return name;
}

}  // namespace

std::string success_chart(const Reproduction& made) {
  std::vector<chart::BarGroup> groups;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    chart::BarGroup group;
    group.name = unbroken(fmt::format("{} {} {}", tables[t].protocol, tables[t].node, tables[t].operation));
    for (std::size_t column = 0; column < intervals.size(); ++column)
      group.bars.push_back({made.success[t][column], tables[t].success[column]});
    groups.push_back(std::move(group));
  }
  return chart::bar_chart("Tables 1 to 8: calls in time (criterion 1)", "per cent: bar simulated, line published",
                          columns(), groups);
}

std::string buffering_chart(const Reproduction& made) {
  std::vector<chart::BarGroup> groups;
  for (const BufferingRow& row : made.buffering) {
    chart::BarGroup group;
    group.name = unbroken(row.node);
    for (std::size_t column = 0; column < intervals.size(); ++column)
      group.bars.push_back({row.buffered[column], row.success[column]});
    groups.push_back(std::move(group));
  }
  return chart::bar_chart("Fig. 4: values buffered (criterion 2), simulated",
                          "per cent: bar criterion 2, line criterion 1", columns(), groups);
}

std::string signal_chart(const RunFigures& run, const SignalRow& row, int figure) {
  const double interval = row.interval;
  // The first edges after what is looked at has begun; every screen begins a tenth of a division before a rise.
  const auto milliseconds = [](sim::TrueTime t) { return static_cast<double>(t.ps()) * 1e-9; };
  chart::SquareWaves waves;
  waves.title =
      fmt::format("Fig. {}: digital signal at the DDS control node, messages every {} ms", figure, row.interval);
  waves.unit = "ms";
  waves.division = 4 * interval;
  const auto first = std::find_if(run.edges.begin(), run.edges.end(),
                                  [&](const SignalEdge& edge) { return edge.is_high && edge.time >= run.begin; });
  const double zero = first == run.edges.end() ? milliseconds(run.begin) : milliseconds(first->time);
  waves.from = -0.4 * interval;
  chart::Trace output{"output", {}};
  for (const SignalEdge& edge : run.edges) output.edges.push_back({milliseconds(edge.time) - zero, edge.is_high});
  chart::Trace ideal{"ideal", {}};
  for (int k = 0; k < 40; ++k) ideal.edges.push_back({k * interval, k % 2 == 0});
  waves.traces = {std::move(output), std::move(ideal)};
  const SignalStatistics& s = row.statistics;
  waves.note = fmt::format(
      "{} pulses of {:.0f} expected; length {:.2f} +- {:.2f} ms; {:.1f} % off by more than half an interval", s.pulses,
      s.expected, s.pulse_mean * interval, s.pulse_deviation * interval, 100 * s.irregular);
  return chart::draw(waves);
}

}  // namespace takt::papers::coexistence
