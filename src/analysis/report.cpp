#include "analysis/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenario/figures/requirement.hpp"
#include "scenario/figures/requirement_rules.hpp"
#include "scenario/json/node.hpp"
#include "scenario/json/quantity.hpp"

namespace takt::analysis {
namespace {

using scenario::json::Node;
using sim::Duration;

std::string text_of(const std::optional<Duration>& value) { return value ? scenario::json::to_text(*value) : "unbounded"; }
Node picoseconds(const std::optional<Duration>& value) { return value ? Node::of_integer(value->ps()) : Node(); }

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

Node nodes_of(const Assumptions& assumptions) {
  Node array = Node::array();
  for (const Assumption assumption : assumptions.list()) array.items.push_back(Node::of_string(name_of(assumption)));
  return array;
}

std::string figure_text(const scenario::Requirement& requirement) {
  scenario::json::Diagnostics diagnostics;
  const auto asked = scenario::read_figure_requirement(requirement, diagnostics);
  return asked ? fmt::format("figure {} {} {}", asked->name, scenario::text_of(asked->limit.relation), asked->limit.text) : "figure " + *requirement.figure;
}

std::string requirement_text(const scenario::Requirement& requirement, const std::string& what) {
  if (what == "reaction") return fmt::format("reaction {}{}{} within {}", scenario::spelling(*requirement.reaction), requirement.cause ? fmt::format(" because of a {}", scenario::spelling(*requirement.cause)) : "", requirement.tree ? " of the tree" : "", text_of(requirement.within->time));
  if (what == "latency") return fmt::format("stream {} latency {}", *requirement.stream, scenario::text_of(*requirement.latency));
  if (what == "jitter") return fmt::format("stream {} jitter {}", *requirement.stream, scenario::text_of(*requirement.jitter));
  if (what == "dropped") return fmt::format("stream {} drops at most {}", *requirement.stream, *requirement.dropped);
  if (what == "delivered") return fmt::format("stream {} delivers at least {}", *requirement.stream, *requirement.delivered);
  if (what == "success") return fmt::format("application {} done in at least {:g} %", *requirement.application, *requirement.success);
  if (what == "buffered") return fmt::format("application {} values buffered, at least {:g} %", *requirement.application, *requirement.buffered);
  if (what == "irregular") return fmt::format("signal {}: at most {:g} % of its pulses irregular", *requirement.signal, *requirement.irregular);
  if (what == "figure") return figure_text(requirement);
  return fmt::format("synchronised within {}", text_of(requirement.sync));
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
  if (is_range && !bound.duration) return range_text(*bound.figure) + (bound.reason.empty() ? "" : "; " + bound.reason) + (objection.empty() ? "" : ", but " + objection);
  return (bound.duration ? text_of(bound.duration) : std::to_string(*bound.count)) + (objection.empty() ? "" : ", but " + objection);
}

/// What becomes of an assumption: "discharged by its base times", "open: ...".
std::string standing_text(const AssessedAssumption& each) {
  if (each.standing == Standing::condition) return "a condition";
  const char* const joint = each.standing == Standing::discharged ? " by " : ": ";
  return std::string(name_of(each.standing)) + (each.why.empty() ? "" : joint + each.why);
}

std::string streams_text(const Bounds& bounds, const scenario::Resolved& r, const std::vector<Assumption>& all) {
  std::string text = "Streams: the longest latency from production to delivery, by total-flow and by separated-flow analysis; of each port the longest delay and the greatest backlog of the class\n";
  for (const StreamBound& stream : bounds.streams) {
    const std::string second = stream.separated_flow ? text_of(stream.separated_flow) : "-";
    text += fmt::format("  {:<32} {:>16} {:>16}  to {}{}{}\n", stream.name, text_of(stream.total_flow), second, r.plan.nodes[stream.listener.value].name,
                        numbers_of(stream.assumptions, all), stream.reason.empty() ? "" : "  " + stream.reason);
    for (const HopBound& hop : stream.hops)
      text += fmt::format("    {:<30} {:>16} {:>16}  {}\n", hop.name, text_of(hop.delay), "", hop.backlog_bits ? fmt::format("{} bits", *hop.backlog_bits) : "unbounded");
  }
  return text;
}

std::string reactions_text(const Bounds& bounds, const scenario::Resolved& r, const std::vector<Assumption>& all) {
  std::string text;
  for (const ReactionBound& reaction : bounds.reactions) {
    if (text.empty()) text = "\nReactions: from the call, or from what else causes them, until all who live have reached the state\n";
    const bool is_called = reaction.cause == handshake::Cause::command;
    const std::string what = fmt::format("{}{}", scenario::spelling(reaction.kind), is_called ? "" : fmt::format(", {}", scenario::spelling(reaction.cause)));
    text += fmt::format("  {:<22} {:<14} {:>16}{}{}\n", r.programs[reaction.program].name + (reaction.of_tree ? " and within" : ""), what, text_of(reaction.bound), numbers_of(reaction.assumptions, all), reaction.reason.empty() ? "" : "  " + reaction.reason);
    for (const ReactionPart& part : reaction.parts) text += fmt::format("    {:<28} {:>18}\n", part.what, text_of(part.duration));
  }
  return text;
}

}  // namespace

std::string text_report(const scenario::Resolved& resolved, const Bounds& bounds) {
  const std::vector<Assumption> all = all_assumptions(bounds);
  std::string text = fmt::format("{}: bounds of {} streams and {} Programs\n\n", resolved.scenario.name, bounds.streams.size(), resolved.programs.size());
  text += streams_text(bounds, resolved, all) + reactions_text(bounds, resolved, all);
  if (!bounds.requirements.empty()) text += "\nRequirements and what they can be at most\n";
  for (const Bounds::Requirement& requirement : bounds.requirements)
    text += fmt::format("  {:<48} {}\n", requirement_text(resolved.scenario.require[requirement.requirement], requirement.what),
                        requirement_answer(requirement.bound, bounds.ledger, scenario::counts_from(resolved.scenario, resolved.scenario.require[requirement.requirement])));
  if (!all.empty()) text += "\nThese bounds rest on\n";
  for (std::size_t i = 0; i < all.size(); ++i) text += fmt::format("  [{}] {}: {} ({})\n", i + 1, name_of(all[i]), bounds.ledger[all[i]].text, standing_text(bounds.ledger[all[i]]));
  return text;
}

std::string json_report(const scenario::Resolved& resolved, const Bounds& bounds) {
  Node root = Node::object();
  root.add("scenario", Node::of_string(resolved.scenario.name));
  Node& streams = root.add("streams", Node::array());
  for (const StreamBound& stream : bounds.streams) {
    Node node = Node::object();
    node.add("name", Node::of_string(stream.name));
    node.add("bound_ps", picoseconds(stream.latency));
    node.add("tfa_ps", picoseconds(stream.total_flow));
    node.add("sfa_ps", picoseconds(stream.separated_flow));
    node.add("sfa_reason", Node::of_string(stream.separated_flow_reason));
    node.add("least_ps", Node::of_integer(stream.least.ps()));
    node.add("listener", Node::of_string(resolved.plan.nodes[stream.listener.value].name));
    node.add("reason", Node::of_string(stream.reason));
    node.add("loses_nothing", Node::of_bool(stream.loses_nothing));
    Node hops = Node::array();
    for (const HopBound& hop : stream.hops) {
      Node made = Node::object();
      made.add("port", Node::of_string(hop.name));
      made.add("delay_ps", picoseconds(hop.delay));
      made.add("backlog_bits", hop.backlog_bits ? Node::of_integer(static_cast<sim::int128>(*hop.backlog_bits)) : Node());
      hops.items.push_back(std::move(made));
    }
    node.add("hops", std::move(hops));
    node.add("assumptions", nodes_of(stream.assumptions));
    streams.items.push_back(std::move(node));
  }
  Node& queues = root.add("queues", Node::array());
  for (const QueueBound& queue : bounds.queues) {
    Node node = Node::object();
    node.add("node", Node::of_string(resolved.plan.nodes[queue.node.value].name));
    node.add("port", Node::of_integer(queue.port));
    node.add("class", Node::of_integer(queue.traffic_class));
    node.add("backlog_bits", queue.bits ? Node::of_integer(static_cast<sim::int128>(*queue.bits)) : Node());
    node.add("backlog_frames", queue.frames ? Node::of_integer(static_cast<sim::int128>(*queue.frames)) : Node());
    queues.items.push_back(std::move(node));
  }
  Node& reactions = root.add("reactions", Node::array());
  for (const ReactionBound& reaction : bounds.reactions) {
    Node node = Node::object();
    node.add("program", Node::of_string(resolved.programs[reaction.program].name));
    node.add("kind", Node::of_string(scenario::spelling(reaction.kind)));
    node.add("cause", Node::of_string(scenario::spelling(reaction.cause)));
    node.add("tree", Node::of_bool(reaction.of_tree));
    node.add("bound_ps", picoseconds(reaction.bound));
    node.add("reason", Node::of_string(reaction.reason));
    Node parts = Node::array();
    for (const ReactionPart& part : reaction.parts) {
      Node made = Node::object();
      made.add("what", Node::of_string(part.what));
      made.add("duration_ps", Node::of_integer(part.duration.ps()));
      parts.items.push_back(std::move(made));
    }
    node.add("parts", std::move(parts));
    node.add("assumptions", nodes_of(reaction.assumptions));
    reactions.items.push_back(std::move(node));
  }
  Node& requirements = root.add("requirements", Node::array());
  for (const Bounds::Requirement& requirement : bounds.requirements) {
    Node node = Node::object();
    node.add("text", Node::of_string(requirement_text(resolved.scenario.require[requirement.requirement], requirement.what)));
    node.add("bound_ps", picoseconds(requirement.bound.duration));
    node.add("bound_count", requirement.bound.count ? Node::of_integer(static_cast<sim::int128>(*requirement.bound.count)) : Node());
    if (const auto& range = requirement.bound.figure) {
      Node& ends = node.add("range", Node::object());
      ends.add("least", range->least ? Node::of_double(*range->least) : Node());
      ends.add("greatest", range->greatest ? Node::of_double(*range->greatest) : Node());
    }
    node.add("reason", Node::of_string(requirement.bound.reason));
    const std::string objection = bounds.ledger.objection(requirement.bound.assumptions, scenario::counts_from(resolved.scenario, resolved.scenario.require[requirement.requirement]));
    node.add("objection", objection.empty() ? Node() : Node::of_string(objection));
    node.add("assumptions", nodes_of(requirement.bound.assumptions));
    requirements.items.push_back(std::move(node));
  }
  Node& assumptions = root.add("assumptions", Node::object());
  for (const Assumption assumption : all_assumptions(bounds)) {
    const AssessedAssumption& each = bounds.ledger[assumption];
    Node node = Node::object();
    node.add("text", Node::of_string(each.text));
    node.add("standing", Node::of_string(name_of(each.standing)));
    node.add("why", each.why.empty() ? Node() : Node::of_string(each.why));
    node.add("holds_from_ps", Node::of_integer(each.holds_from.ps()));
    assumptions.add(name_of(assumption), std::move(node));
  }
  return scenario::json::pretty(root);
}

}  // namespace takt::analysis
