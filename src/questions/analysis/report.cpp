// SPDX-License-Identifier: Apache-2.0
#include "analysis/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/report_record.hpp"
#include "json/page_text.hpp"
#include "json/quantity.hpp"
#include "json/record.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::analysis {
namespace {

using sim::Duration;

std::string text_of(const std::optional<Duration>& value) { return value ? json::to_page_text(*value) : "unbounded"; }

std::string numbers_of(const Assumptions& assumptions, const std::vector<Assumption>& all) {
  std::string text;
  for (const Assumption assumption : assumptions.list())
    text += (text.empty() ? "" : ",") + std::to_string(std::find(all.begin(), all.end(), assumption) - all.begin() + 1);
  return text.empty() ? "" : " [" + text + "]";
}

/// What any of the bounds rests on.
std::vector<Assumption> all_assumptions(const Bounds& bounds) {
  Assumptions all;
  for (const StreamBound& stream : bounds.streams) all.add(stream.assumptions);
  for (const ReactionBound& reaction : bounds.reactions) all.add(reaction.assumptions);
  return all.list();
}

/// "0 to 2.5", "at least 3"; in the figure's unit.
std::string range_text(const FigureRange& range) {
  if (range.least && range.greatest) return fmt::format("{:.6g} to {:.6g}", *range.least, *range.greatest);
  return range.least ? fmt::format("at least {:.6g}", *range.least) : fmt::format("at most {:.6g}", *range.greatest);
}

std::string requirement_answer(const RequirementBound& bound, const AssumptionLedger& ledger, Duration from) {
  const bool is_range = bound.figure && (bound.figure->least || bound.figure->greatest);
  if (!bound.duration && !bound.count && !is_range) return "no bound: " + bound.reason;
  const std::string objection = ledger.objection(bound.assumptions, from);
  if (is_range && !bound.duration)
    return range_text(*bound.figure) + (bound.reason.empty() ? "" : "; " + bound.reason) +
           (objection.empty() ? "" : ", but " + objection);
  return (bound.duration ? text_of(bound.duration) : std::to_string(*bound.count)) +
         (objection.empty() ? "" : ", but " + objection);
}

/// What becomes of an assumption: "discharged by its base times", "open: ...".
std::string standing_text(const AssessedAssumption& each) {
  if (each.standing == Standing::condition) return "a condition";
  const char* const joint = each.standing == Standing::discharged ? " by " : ": ";
  return std::string(name_of(each.standing)) + (each.why.empty() ? "" : joint + each.why);
}

std::string streams_text(const Bounds& bounds, const scenario::Resolved& r, const std::vector<Assumption>& all) {
  std::string text =
      "Streams: the longest latency from production to delivery, by total-flow and by separated-flow analysis; of each "
      "port the longest delay and the greatest backlog of the class\n";
  std::size_t width = 24;
  for (const StreamBound& stream : bounds.streams) {
    width = std::max(width, stream.name.size());
    for (const HopBound& hop : stream.hops) width = std::max(width, hop.name.size() + 2);
  }
  for (const StreamBound& stream : bounds.streams) {
    const std::string second = stream.separated_flow ? text_of(stream.separated_flow) : "-";
    text += fmt::format("  {:<{}} {:>16} {:>16}  to {}{}{}\n", stream.name, width, text_of(stream.total_flow), second,
                        r.plan.nodes[stream.listener.value].name, numbers_of(stream.assumptions, all),
                        stream.reason.empty() ? "" : "  " + stream.reason);
    for (const HopBound& hop : stream.hops)
      text += fmt::format("    {:<{}} {:>16} {:>16}  {}\n", hop.name, width - 2, text_of(hop.delay), "",
                          hop.backlog_bits ? fmt::format("{} bits", *hop.backlog_bits) : "unbounded");
  }
  return text;
}

std::string threads_text(const Bounds& bounds, const scenario::Resolved& r) {
  std::string text;
  for (const ReportedThread& thread : threads_of(r, bounds)) {
    if (text.empty()) text = "\nThreads of hosts: from when a job is ready to its end\n";
    text += fmt::format("  {:<32} {:>16}{}\n", thread.name, text_of(duration_of(thread.time->worst)),
                        thread.time->reason.empty() ? "" : "  " + thread.time->reason);
  }
  return text;
}

std::string deliveries_text(const Bounds& bounds, const scenario::Resolved& r, const std::vector<Assumption>& all) {
  std::string text;
  for (const ReportedDelivery& each : deliveries_of(r, bounds)) {
    if (text.empty())
      text =
          "\nTopics: from the call that writes a sample until a reader has it, of one that is not lost; over DDS also "
          "of one that is lost once, if its repair is not\n";
    const DeliveryBound& bound = *each.bound;
    const std::string loss = bound.reaches_all ? "nothing is lost" : bound.loss_reason;
    text +=
        fmt::format("  {:<32} {:>16} {:>16}  {} to {}{}  {}{}{}\n", each.topic, text_of(bound.one_way),
                    bound.repaired ? text_of(bound.repaired) : "-", each.from, each.to,
                    numbers_of(bound.assumptions, all), loss, bound.reason.empty() ? "" : "; " + bound.reason,
                    bound.repaired || bound.repair_reason == bound.reason ? "" : "; no repair: " + bound.repair_reason);
  }
  return text;
}

std::string reactions_text(const Bounds& bounds, const scenario::Resolved& r, const std::vector<Assumption>& all) {
  std::string text;
  for (const ReactionBound& reaction : bounds.reactions) {
    if (text.empty())
      text = "\nReactions: from the call, or from what else causes them, until all who live have reached the state\n";
    const bool is_called = reaction.cause == handshake::Cause::command;
    const std::string what = fmt::format("{}{}", scenario::spelling(reaction.kind),
                                         is_called ? "" : fmt::format(", {}", scenario::spelling(reaction.cause)));
    text += fmt::format("  {:<22} {:<14} {:>16}{}{}\n",
                        r.programs[reaction.program].name + (reaction.of_tree ? " and within" : ""), what,
                        text_of(reaction.bound), numbers_of(reaction.assumptions, all),
                        reaction.reason.empty() ? "" : "  " + reaction.reason);
    for (const ReactionPart& part : reaction.parts)
      text += fmt::format("    {:<28} {:>18}\n", part.what, text_of(part.duration));
  }
  return text;
}

}  // namespace

std::string text_report(const scenario::Resolved& resolved, const Bounds& bounds) {
  const std::vector<Assumption> all = all_assumptions(bounds);
  std::string text = fmt::format("{}: bounds of {} streams and {} Programs\n\n", resolved.scenario.name,
                                 bounds.streams.size(), resolved.programs.size());
  text += streams_text(bounds, resolved, all) + threads_text(bounds, resolved) +
          deliveries_text(bounds, resolved, all) + reactions_text(bounds, resolved, all);
  if (!bounds.requirements.empty()) text += "\nRequirements and what they can be at most\n";
  for (std::size_t i = 0; i < bounds.requirements.size(); ++i)
    text += fmt::format("  {:<48} {}\n", results::titled(resolved.requirements[i].name, resolved.requirements[i].text),
                        requirement_answer(bounds.requirements[i], bounds.ledger, resolved.requirements[i].from));
  if (!all.empty()) text += "\nThese bounds rest on\n";
  for (std::size_t i = 0; i < all.size(); ++i)
    text += fmt::format("  [{}] {}: {} ({})\n", i + 1, name_of(all[i]), bounds.ledger[all[i]].text,
                        standing_text(bounds.ledger[all[i]]));
  return text;
}

std::string json_report(const scenario::Resolved& resolved, const Bounds& bounds) {
  BoundReport report;
  report.scenario = resolved.scenario.name;
  for (const StreamBound& stream : bounds.streams)
    report.streams.push_back({&stream, resolved.plan.nodes[stream.listener.value].name});
  for (const QueueBound& queue : bounds.queues)
    report.queues.push_back({&queue, resolved.plan.nodes[queue.node.value].name});
  for (const ReactionBound& reaction : bounds.reactions)
    report.reactions.push_back({&reaction, resolved.programs[reaction.program].name});
  report.threads = threads_of(resolved, bounds);
  report.deliveries = deliveries_of(resolved, bounds);
  for (std::size_t i = 0; i < bounds.requirements.size(); ++i) {
    const scenario::RequiredFigure& asked = resolved.requirements[i];
    std::string objection = bounds.ledger.objection(bounds.requirements[i].assumptions, asked.from);
    report.requirements.push_back({asked.name, asked.text, &bounds.requirements[i],
                                   objection.empty() ? std::nullopt : std::optional(std::move(objection))});
  }
  for (const Assumption assumption : all_assumptions(bounds))
    report.assumptions.emplace_back(name_of(assumption), bounds.ledger[assumption]);
  return json::write(report);
}

}  // namespace takt::analysis
