#include "output/json_report.hpp"

#include <fmt/format.h>

#include "scenario/json/node.hpp"

namespace takt::output {
namespace {

using scenario::json::Node;
using sim::Duration;

Node integer(std::uint64_t value) { return Node::of_integer(static_cast<sim::int128>(value)); }
Node picoseconds(Duration value) { return Node::of_integer(value.ps()); }
Node picoseconds(sim::TrueTime value) { return Node::of_integer(value.ps()); }
template <class T>
Node optional_picoseconds(const std::optional<T>& value) {
  return value ? picoseconds(*value) : Node();
}

Node requirements_of(const results::RunResult& result) {
  Node array = Node::array();
  for (const results::RequirementResult& r : result.requirements) {
    Node node = Node::object();
    node.add("text", Node::of_string(r.text));
    node.add("verdict", Node::of_string(results::name_of(r.verdict)));
    node.add("measured_ps", optional_picoseconds(r.measured));
    node.add("limit_ps", optional_picoseconds(r.limit));
    node.add("remark", Node::of_string(r.remark));
    array.items.push_back(std::move(node));
  }
  return array;
}

Node streams_of(const results::RunResult& result) {
  Node all = Node::object();
  for (const results::StreamResult& s : result.streams) {
    Node node = Node::object();
    node.add("sent", integer(s.sent));
    node.add("delivered", integer(s.delivered));
    Node dropped = Node::object();
    for (const auto& [reason, count] : s.dropped) dropped.add(reason, integer(count));
    node.add("dropped", std::move(dropped));
    node.add("copies", integer(s.copies));
    node.add("in_flight", integer(s.in_flight));
    node.add("listeners", integer(s.listeners));
    Node latency;
    if (s.latency) {
      latency = Node::object();
      latency.add("min", picoseconds(s.latency->min));
      latency.add("mean", picoseconds(s.latency->mean));
      latency.add("p50", picoseconds(s.latency->p50));
      latency.add("p99", picoseconds(s.latency->p99));
      latency.add("max", picoseconds(s.latency->max));
      latency.add("stddev", picoseconds(s.latency->stddev));
    }
    node.add("latency_ps", std::move(latency));
    all.add(s.name, std::move(node));
  }
  return all;
}

Node reaction_node(const results::ReactionResult& r) {
  Node node = Node::object();
  node.add("kind", Node::of_string(r.kind));
  node.add("initiator", Node::of_string(r.initiator));
  node.add("cause", Node::of_string(r.cause));
  node.add("began_ps", picoseconds(r.began));
  node.add("completed_ps", optional_picoseconds(r.completed));
  node.add("duration_ps", optional_picoseconds(r.duration()));
  node.add("superseded", Node::of_bool(r.superseded));
  return node;
}

Node programs_of(const results::RunResult& result) {
  Node all = Node::object();
  for (const results::ProgramResult& p : result.programs) {
    Node node = Node::object();
    node.add("variant", Node::of_string(p.variant));
    Node reactions = Node::array();
    for (const results::ReactionResult& r : p.reactions) reactions.items.push_back(reaction_node(r));
    node.add("reactions", std::move(reactions));
    Node states = Node::object();
    for (std::size_t i = 0; i < p.participants.size(); ++i) states.add(p.participants[i], Node::of_string(p.states[i]));
    node.add("states", std::move(states));
    Node violations = Node::array();
    for (const results::ViolationResult& v : p.violations) {
      Node violation = Node::object();
      violation.add("at_ps", picoseconds(v.at));
      violation.add("invariant", Node::of_string(v.invariant));
      violation.add("participant", Node::of_string(v.participant));
      violation.add("text", Node::of_string(v.text));
      violations.items.push_back(std::move(violation));
    }
    node.add("violations", std::move(violations));
    Node timeline = Node::array();
    for (const results::TimelineEntry& e : p.timeline) {
      Node entry = Node::object();
      entry.add("at_ps", picoseconds(e.at));
      entry.add("participant", Node::of_string(p.participants[e.participant]));
      entry.add(e.call.empty() ? "state" : "call", Node::of_string(e.call.empty() ? e.state : e.call));
      timeline.items.push_back(std::move(entry));
    }
    node.add("timeline", std::move(timeline));
    node.add("changes", integer(p.changes));
    node.add("process_data_received", integer(p.process_data_received));
    all.add(p.name, std::move(node));
  }
  return all;
}

Node ports_of(const results::RunResult& result) {
  Node array = Node::array();
  for (const results::PortResult& p : result.ports) {
    Node node = Node::object();
    node.add("node", Node::of_string(p.node));
    node.add("port", integer(p.port));
    node.add("peer", Node::of_string(p.peer));
    node.add("frames", integer(p.frames));
    node.add("dropped", integer(p.dropped));
    node.add("queue_peak", integer(p.queue_peak));
    node.add("utilisation", Node::of_double(p.utilisation));
    array.items.push_back(std::move(node));
  }
  return array;
}

}  // namespace

std::string run_json(const results::RunResult& result) {
  Node root = Node::object();
  root.add("takt", Node::of_string(result.version));
  root.add("scenario", Node::of_string(result.scenario));
  root.add("seed", integer(result.seed));
  root.add("simulated_ps", picoseconds(result.simulated));
  root.add("partial", Node::of_bool(result.partial));
  root.add("digest", Node::of_string(fmt::format("{:016x}", result.digest)));
  root.add("events", integer(result.events));
  root.add("verdict", Node::of_string(results::name_of(result.verdict)));
  root.add("requirements", requirements_of(result));
  root.add("streams", streams_of(result));
  root.add("programs", programs_of(result));
  root.add("ports", ports_of(result));
  return scenario::json::pretty(root);
}

}  // namespace takt::output
