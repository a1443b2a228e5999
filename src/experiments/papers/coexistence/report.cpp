// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/report.hpp"

#include <fmt/format.h>

#include "papers/folder.hpp"

namespace takt::papers::coexistence {
namespace {

using json::Node;

double microseconds(sim::Duration d) { return static_cast<double>(d.ps()) * 1e-6; }

std::string laws_text(const Reproduction& made) {
  std::string out =
      "\nLaws of response times, fitted to the 1 ms and 5 ms cells\n\n  law            2 ms: worst | root mean square, "
      "points     10 ms: least, %     within both limits\n";
  for (const LawErrors& law : made.laws)
    out += fmt::format("  {:<14}{:>12.2f} | {:.2f}{:>43.2f}{:>23}\n", name_of(law.law), law.worst_at_2_ms,
                       law.rms_at_2_ms, law.least(), law.fits() ? "yes" : "no");
  return out;
}

std::string cells(const std::array<double, 4>& values) {
  std::string out;
  for (const double value : values) out += fmt::format("{:>8.1f}", value);
  return out;
}

std::string buffering_text(const Reproduction& made) {
  std::string out = "\nFig. 4: values buffered, % (the paper's numbers are not in its text)\n\n" +
                    fmt::format("  {:<18}{:>32}{:>32}{:>32}\n  {:<18}", "", "criterion 2", "criterion 1",
                                "criterion 2, nothing else sent", "node");
  for (int k = 0; k < 3; ++k)
    for (const int interval : intervals) out += fmt::format("{:>8}", fmt::format("{} ms", interval));
  out += "\n";
  for (const BufferingRow& row : made.buffering) {
    out += fmt::format("  {:<18}{}{}{}\n", row.node, cells(row.buffered), cells(row.success), cells(row.without_load));
    std::string measured;
    for (const auto& value : row.measured)
      measured += fmt::format("{:>8}", value ? fmt::format("{:.1f}", *value) : "-");
    if (!made.machine.empty()) out += fmt::format("  {:<18}{}\n", "    measured", measured);
  }
  return out;
}

std::string signals_text(const Reproduction& made) {
  std::string out =
      "\nFig. 5 to 9: the digital signal, in intervals\n\n  interval    pulses of expected     pulse mean +- dev     "
      "median    least | greatest     period mean +- dev     off by > 1/2    > 1/10\n";
  for (const SignalRow& row : made.signals) {
    const SignalStatistics& s = row.statistics;
    out += fmt::format("  {:>5} ms{:>22}{:>22}{:>11.2f}{:>20}{:>23}{:>15.1f} %{:>8.1f} %\n", row.interval,
                       fmt::format("{} of {:.0f}", s.pulses, s.expected),
                       fmt::format("{:.2f} +- {:.2f}", s.pulse_mean, s.pulse_deviation), s.pulse_median,
                       fmt::format("{:.2f} | {:.2f}", s.pulse_least, s.pulse_greatest),
                       fmt::format("{:.2f} +- {:.2f}", s.period_mean, s.period_deviation), 100 * s.irregular,
                       100 * s.off_by_a_tenth);
  }
  return out;
}

std::string improvements_text(const Reproduction& made) {
  std::string out = "\nWhat real-time Linux and TSN change\n\n" +
                    fmt::format("  {:>8}  {:<38}{:>22}{:>22}{:>14}{:>34}\n  {:>8}  {:<38}{:>22}{:>22}{:>14}{:>34}\n",
                                "", "", "criterion 1, %", "criterion 2, %", "irregular", "reaction, us", "interval", "",
                                "mean | worst", "mean | worst", "pulses, %", "mean | 99 % within | longest");
  for (const ImprovementRow& row : made.improvements)
    out += fmt::format("  {:>5} ms  {:<38}{:>22}{:>22}{:>14.1f}{:>34}\n", row.interval, row.variant,
                       fmt::format("{:.1f} | {:.1f}", row.success, row.least_success),
                       fmt::format("{:.1f} | {:.1f}", row.buffered, row.least_buffered), 100 * row.signal.irregular,
                       fmt::format("{:.0f} | {:.0f} | {:.0f}", microseconds(row.reaction.mean),
                                   microseconds(row.reaction.p99), microseconds(row.reaction.greatest)));
  return out;
}

Node laws_node(const Reproduction& made) {
  Node all = Node::object();
  for (const LawErrors& law : made.laws) {
    Node node = Node::object();
    node.add("worst_at_2_ms_points", Node::of_double(law.worst_at_2_ms));
    node.add("rms_at_2_ms_points", Node::of_double(law.rms_at_2_ms));
    node.add("rms_at_10_ms_points", Node::of_double(law.rms_at_10_ms));
    node.add("least_at_10_ms", Node::of_double(law.least()));
    node.add("fits", Node::of_bool(law.fits()));
    Node rows = Node::array();
    for (const FittedLaw& fitted : law.fitted) {
      Node row = Node::object();
      row.add("shape", Node::of_double(fitted.shape));
      row.add("scale_ms", Node::of_double(fitted.scale));
      rows.items.push_back(std::move(row));
    }
    node.add("tables", std::move(rows));
    all.add(std::string(name_of(law.law)), std::move(node));
  }
  return all;
}

template <typename Values>
Node columns_node(const Values& values) {
  Node node = Node::object();
  for (std::size_t column = 0; column < intervals.size(); ++column)
    node.add(fmt::format("{}ms", intervals[column]), Node::of_double(values[column]));
  return node;
}

Node signal_node(const SignalStatistics& s) {
  Node node = Node::object();
  node.add("pulses", Node::of_integer(static_cast<sim::int128>(s.pulses)));
  node.add("expected", Node::of_double(s.expected));
  node.add("pulse_mean", Node::of_double(s.pulse_mean));
  node.add("pulse_deviation", Node::of_double(s.pulse_deviation));
  node.add("pulse_median", Node::of_double(s.pulse_median));
  node.add("pulse_least", Node::of_double(s.pulse_least));
  node.add("pulse_greatest", Node::of_double(s.pulse_greatest));
  node.add("period_mean", Node::of_double(s.period_mean));
  node.add("period_deviation", Node::of_double(s.period_deviation));
  node.add("irregular", Node::of_double(s.irregular));
  node.add("off_by_a_tenth", Node::of_double(s.off_by_a_tenth));
  return node;
}

Node buffering_node(const Reproduction& made) {
  Node all = Node::object();
  for (const BufferingRow& row : made.buffering) {
    Node node = Node::object();
    node.add("criterion_1", columns_node(row.success));
    node.add("criterion_2", columns_node(row.buffered));
    node.add("criterion_2_without_load", columns_node(row.without_load));
    all.add(row.node, std::move(node));
  }
  return all;
}

Node improvements_node(const Reproduction& made) {
  Node all = Node::array();
  for (const ImprovementRow& row : made.improvements) {
    Node node = Node::object();
    node.add("interval_ms", Node::of_integer(row.interval));
    node.add("variant", Node::of_string(row.variant));
    node.add("criterion_1", Node::of_double(row.success));
    node.add("criterion_1_worst", Node::of_double(row.least_success));
    node.add("criterion_2", Node::of_double(row.buffered));
    node.add("criterion_2_worst", Node::of_double(row.least_buffered));
    node.add("signal", signal_node(row.signal));
    node.add("commands", Node::of_integer(static_cast<sim::int128>(row.reaction.commands)));
    node.add("answered", Node::of_integer(static_cast<sim::int128>(row.reaction.answered)));
    node.add("reaction_mean_ps", Node::of_integer(row.reaction.mean.ps()));
    node.add("reaction_p99_ps", Node::of_integer(row.reaction.p99.ps()));
    node.add("reaction_max_ps", Node::of_integer(row.reaction.greatest.ps()));
    all.items.push_back(std::move(node));
  }
  return all;
}

}  // namespace

std::string text_report(const Reproduction& made) {
  std::string out =
      fmt::format("DDS and OPC UA side by side, reproduced{}\n",
                  made.is_short ? " (short: fewer repetitions, what TSN changes at 10 and 1 ms only)" : "") +
      laws_text(made);
  if (!made.machine.empty()) out += fmt::format("\nMeasured on {}\n", made.machine);
  out += fmt::format("\nCells: mean of {} repetitions (least-greatest), each with the tests of its table\n\n",
                     made.repetitions) +
         papers::text_of(made.comparisons) + buffering_text(made) + signals_text(made) + improvements_text(made) +
         "\nRuns\n";
  for (const Speed& speed : made.speed)
    out += fmt::format("  {:<16}{:.0f} s simulated, {} events, digest {:016x}\n", speed.scenario,
                       speed.simulated_seconds, speed.events, speed.digest);
  return out + fmt::format("\n{}\n", made.holds() ? "REPRODUCED" : "NOT REPRODUCED");
}

std::string json_report(const Reproduction& made) {
  Node node = Node::object();
  node.add("paper", Node::of_string("coexistence"));
  node.add("short", Node::of_bool(made.is_short));
  node.add("repetitions", Node::of_integer(made.repetitions));
  node.add("holds", Node::of_bool(made.holds()));
  if (!made.machine.empty()) node.add("machine", Node::of_string(made.machine));
  node.add("laws", laws_node(made));
  node.add("comparisons", papers::json_of(made.comparisons));
  node.add("buffering", buffering_node(made));
  Node signals = Node::object();
  for (const SignalRow& row : made.signals) signals.add(fmt::format("{}ms", row.interval), signal_node(row.statistics));
  node.add("signals", std::move(signals));
  node.add("improvements", improvements_node(made));
  Node runs = Node::object();
  for (const Speed& speed : made.speed) {
    Node run = Node::object();
    run.add("simulated_s", Node::of_double(speed.simulated_seconds));
    run.add("events", Node::of_integer(static_cast<sim::int128>(speed.events)));
    run.add("digest", Node::of_string(fmt::format("{:016x}", speed.digest)));
    runs.add(speed.scenario, std::move(run));
  }
  node.add("runs", std::move(runs));
  return json::pretty(node);
}

std::string write_folder(const std::string& folder, const Reproduction& made) {
  return papers::write_folder(folder,
                              Folder{text_report(made), json_report(made), made.figures, made.scenarios, made.waves});
}

}  // namespace takt::papers::coexistence
