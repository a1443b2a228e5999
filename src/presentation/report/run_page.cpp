// SPDX-License-Identifier: Apache-2.0
#include "report/run_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "chart/chart.hpp"
#include "chart/histogram.hpp"
#include "chart/page.hpp"
#include "chart/svg.hpp"
#include "output/text_report.hpp"
#include "report/network_figure.hpp"
#include "report/page_parts.hpp"
#include "results/behaviour.hpp"

namespace takt::report {
namespace {

using output::readable;
using results::RunResult;
using results::StreamResult;

constexpr std::size_t most_histograms = 12;

std::string sentence(const RunResult& result) {
  const auto failed = std::count_if(result.requirements.begin(), result.requirements.end(),
                                    [](const auto& each) { return each.verdict == results::Verdict::fail; });
  std::string text = fmt::format("{}: {}", result.scenario, results::name_of(result.verdict));
  if (result.nothing_required)
    text += std::string(", since ") + results::nothing_was_required;
  else if (failed > 0)
    text += fmt::format(", {} of {} requirements failed in this run", failed, result.requirements.size());
  else if (result.verdict == results::Verdict::pass)
    text += fmt::format(", all {} requirements hold in this run (takt verify asks whether they hold in every run)",
                        result.requirements.size());
  return text;
}

std::string head(const RunResult& result) {
  chart::Table table({});
  table.row(
      {{"simulated"},
       {result.partial ? readable(result.simulated) + " of " + readable(result.wanted) + ", then it was interrupted"
                       : readable(result.simulated)}});
  table.row({{"seed"}, {std::to_string(result.seed)}});
  table.row({{"digest"}, {fmt::format("{:016x}", result.digest)}});
  table.row({{"events"}, {std::to_string(result.events)}});
  table.row({{"takt"}, {result.version + ", behaviour " + std::to_string(results::behaviour())}});
  return table.take();
}

std::string requirements(const RunResult& result) {
  if (result.requirements.empty()) return {};
  chart::LimitBars bars{"Requirements, as parts of their limits", {}};
  chart::Table table({"verdict", "requirement", "in this run", ""});
  for (const results::RequirementResult& each : result.requirements) {
    const char* const verdict = results::name_of(each.verdict);
    const chart::LimitBar bar = limit_bar(each, verdict);
    if (bar.simulated) bars.bars.push_back(bar);
    const std::string figures = figures_of(each);
    table.row({{verdict, false, look_of(verdict)},
               {results::titled(each)},
               {figures},
               {figures == each.remark ? std::string() : each.remark, false, "note"}});
  }
  std::string text = chart::section("Requirements");
  if (!bars.bars.empty()) text += chart::charts({draw(bars)});
  return text + table.take();
}

/// In microseconds, in bars of the histogram's own buckets.
std::string histogram_of(const StreamResult& stream) {
  std::vector<chart::Bar> bars;
  for (const results::HistogramBucket& bucket : stream.histogram)
    bars.push_back({static_cast<double>(bucket.from.ps()) * 1e-6, static_cast<double>(bucket.to.ps() + 1) * 1e-6,
                    static_cast<double>(bucket.count)});
  const double least = bars.front().from;
  const double greatest = bars.back().to;
  const double margin = std::max((greatest - least) * 0.04, greatest * 1e-4);
  return chart::histogram_element({stream.name, "latency, us", "frames"}, bars, std::max(0.0, least - margin),
                                  greatest + margin);
}

std::string streams(const RunResult& result) {
  if (result.streams.empty()) return {};
  std::vector<const StreamResult*> order;
  for (const StreamResult& stream : result.streams) order.push_back(&stream);
  const auto worst = [](const StreamResult* stream) {
    return stream->latency ? stream->latency->max : sim::Duration();
  };
  std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) { return worst(a) > worst(b); });
  chart::Table table({"stream", "sent", "delivered", "lost", "min", "mean", "p99", "max", "dropped"});
  std::vector<std::string> pictures;
  for (const StreamResult* stream : order) {
    std::string dropped;
    for (const auto& [reason, count] : stream->dropped)
      dropped += fmt::format("{}{} {}", dropped.empty() ? "" : ", ", count, reason);
    const auto time = [&](sim::Duration results::LatencySummary::*part) {
      return chart::Cell{stream->latency ? readable((*stream->latency).*part) : "-", true};
    };
    table.row({{stream->name},
               {std::to_string(stream->sent), true},
               {std::to_string(stream->delivered), true},
               {std::to_string(stream->lost), true, stream->lost > 0 ? "fail" : ""},
               time(&results::LatencySummary::min),
               time(&results::LatencySummary::mean),
               time(&results::LatencySummary::p99),
               time(&results::LatencySummary::max),
               {dropped}});
    if (!stream->histogram.empty() && pictures.size() < most_histograms) pictures.push_back(histogram_of(*stream));
  }
  std::string text =
      chart::section("Streams", "The slowest first; times from the talker's application to the listener's.") +
      table.take();
  if (!pictures.empty())
    text += "<details><summary>Latencies of the slowest</summary>" + chart::charts(pictures) + "</details>\n";
  return text;
}

std::string reactions(const RunResult& result, const Replay& replay) {
  chart::Table table({"program", "reaction", "from", "cause", "at", "took"});
  for (const results::ProgramResult& program : result.programs)
    for (const results::ReactionResult& each : program.reactions)
      table.row({{program.name},
                 {each.kind},
                 {each.initiator},
                 {each.cause},
                 {readable(each.began.since_start()), true},
                 {each.completed    ? readable(*each.duration())
                  : each.superseded ? "superseded"
                                    : "not complete",
                  true, each.completed || each.superseded ? "" : "undecided"}});
  const std::string rows = table.take();
  if (rows.empty()) return {};
  std::string text = chart::section("Reactions", "From the cause until all living participants are there.") + rows;
  const std::vector<chart::SequenceChart> sequences = replay.sequences();
  if (!sequences.empty())
    text +=
        "<h3>Who told whom</h3><p class=\"note\">Of each kind the slowest. Arrows: the message by which the others "
        "hear of a change first.</p>\n<svg width=\"0\" height=\"0\">" +
        std::string(chart::arrow_heads()) + "</svg>\n";
  for (const chart::SequenceChart& sequence : sequences)
    text += chart::wide_chart(chart::sequence_chart_element(sequence));
  return text;
}

std::string violations(const RunResult& result) {
  chart::Table table({"at", "program", "invariant", "participant", ""});
  for (const results::ProgramResult& program : result.programs)
    for (const results::ViolationResult& each : program.violations)
      table.row({{readable(each.at.since_start()), true},
                 {program.name},
                 {each.invariant, false, "fail"},
                 {each.participant},
                 {each.text}});
  const std::string rows = table.take();
  return rows.empty() ? rows : chart::section("Violations of invariants") + rows;
}

std::string clocks(const RunResult& result, const std::optional<chart::LineChart>& curves) {
  std::vector<const results::ClockResult*> order;
  for (const results::ClockResult& clock : result.clocks) order.push_back(&clock);
  const auto worst = [](const results::ClockResult* clock) {
    return std::max(std::abs(clock->least.ps()), std::abs(clock->greatest.ps()));
  };
  std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) { return worst(a) > worst(b); });
  chart::Table table(
      {"clock", "grandmaster", "state at the end", "locked after", "least", "greatest", "greatest at", "rms"}, 60);
  for (const results::ClockResult* clock : order)
    table.row({{clock->node},
               {clock->grandmaster},
               {clock->state},
               {clock->time_to_lock          ? readable(*clock->time_to_lock)
                : clock->was_never_to_lock() ? "-"
                                             : "never",
                true, clock->time_to_lock || clock->was_never_to_lock() ? "" : "fail"},
               {readable(clock->least), true},
               {readable(clock->greatest), true},
               {clock->greatest_at ? readable(clock->greatest_at->since_start()) : "-", true},
               {readable(clock->rms), true}});
  const std::string rows = table.take();
  if (rows.empty()) return rows;
  chart::Table leaders({"at", "grandmaster", ""}, 60);
  for (const results::GrandmasterResult& each : result.grandmasters)
    leaders.row({{readable(each.at.since_start()), true}, {each.node}, {each.event}});
  chart::Table differences({"clocks of", "greatest difference", "at", "ahead", "behind"}, 60);
  for (const results::ClockDifferenceResult& each : result.clock_differences)
    if (each.greatest)
      differences.row({{each.name},
                       {readable(*each.greatest), true},
                       {readable(each.at->since_start()), true},
                       {each.ahead},
                       {each.behind}});
  chart::Table links({"port", "to", "not capable of gPTP"}, 60);
  for (const results::GptpLinkResult& each : result.gptp_links)
    if (!each.is_capable)
      links.row({{fmt::format("{}:{}", each.node, each.port)}, {each.peer}, {each.why_not, false, "fail"}});
  return chart::section("Clocks", "Offsets from the grandmaster since a clock was locked first; the worst first.") +
         (curves ? chart::charts({draw(*curves)}) : std::string()) + rows + leaders.take() + differences.take() +
         links.take();
}

std::string drops(const RunResult& result) {
  chart::Table table({"why frames ended early", "frames"});
  for (const auto& [reason, count] : result.dropped) table.row({{reason}, {std::to_string(count), true}});
  const std::string rows = table.take();
  return rows.empty() ? rows : chart::section("Drops") + rows;
}

std::string ports(const RunResult& result) {
  std::vector<const results::PortResult*> order;
  for (const results::PortResult& port : result.ports) order.push_back(&port);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->utilisation > b->utilisation; });
  chart::Table table({"port", "to", "used", "frames", "longest queue", "dropped"}, 40);
  for (const results::PortResult* port : order)
    table.row({{fmt::format("{}:{}", port->node, port->port)},
               {port->peer},
               {fmt::format("{:.2f} %", 100 * port->utilisation), true},
               {std::to_string(port->frames), true},
               {std::to_string(port->queue_peak), true},
               {std::to_string(port->dropped), true, port->dropped > 0 ? "fail" : ""}});
  const std::string rows = table.take();
  return rows.empty() ? rows : chart::section("Ports", "The busiest first.") + rows;
}

}  // namespace

std::string run_page(const scenario::Resolved& resolved, const RunResult& result, const Replay& replay) {
  std::string page = chart::page_head(result.scenario);
  page += verdict_line(results::name_of(result.verdict), sentence(result)) + head(result) + requirements(result) +
          violations(result);
  page += chart::section("The network") + chart::charts({draw(network_figure(resolved, &result))});
  if (const auto gates = replay.gates(); gates && !gates->rows.empty())
    page += (replay.shows_gates()
                 ? chart::section("Gates",
                                  "Green: the gate of the class is open. Bars: frames on the wire; crosses: frames "
                                  "that were discarded; rest the mouse on one.")
                 : chart::section(
                       "Discarded frames",
                       "Bars: frames on the wire; crosses: frames that were discarded; rest the mouse on one.")) +
            chart::charts({draw(*gates)});
  page += reactions(result, replay) + streams(result) + ways_section(replay.ways()) + ports(result) +
          clocks(result, replay.clocks()) + drops(result);
  return page + chart::page_end();
}

}  // namespace takt::report
