#include "results/result_json.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "results/application_json.hpp"
#include "scenario/json/node.hpp"

namespace takt::results {
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

Node dropped_of(const std::vector<std::pair<std::string, std::uint64_t>>& drops) {
  Node node = Node::object();
  for (const auto& [reason, count] : drops) node.add(reason, integer(count));
  return node;
}

Node requirements_of(const RunResult& result) {
  Node array = Node::array();
  for (const RequirementResult& r : result.requirements) {
    Node node = Node::object();
    node.add("text", Node::of_string(r.text));
    node.add("verdict", Node::of_string(name_of(r.verdict)));
    node.add("measured_ps", optional_picoseconds(r.measured));
    node.add("limit_ps", optional_picoseconds(r.limit));
    if (r.least_limit) {
      node.add("least_measured_ps", optional_picoseconds(r.least_measured));
      node.add("least_limit_ps", optional_picoseconds(r.least_limit));
    }
    if (r.from > Duration()) node.add("from_ps", picoseconds(r.from));
    node.add("remark", Node::of_string(r.remark));
    if (r.figure) {
      node.add("figure", Node::of_string(r.figure->name));
      node.add("found", r.figure->found ? Node::of_double(*r.figure->found) : Node());
      node.add(r.figure->within ? "equal" : r.figure->is_upper ? "at_most" : "at_least", Node::of_double(r.figure->asked));
      if (r.figure->within) node.add("within", Node::of_double(*r.figure->within));
      node.add("unit", Node::of_string(r.figure->unit));
    }
    array.items.push_back(std::move(node));
  }
  return array;
}

Node summary_node(const LatencySummary& summary) {
  Node node = Node::object();
  node.add("min", picoseconds(summary.min));
  node.add("mean", picoseconds(summary.mean));
  node.add("p50", picoseconds(summary.p50));
  node.add("p99", picoseconds(summary.p99));
  node.add("max", picoseconds(summary.max));
  node.add("stddev", picoseconds(summary.stddev));
  return node;
}

Node round_trips_of(const ProgramResult& program) {
  Node all = Node::object();
  for (const RoundTripResult& r : program.round_trips) {
    Node node = Node::object();
    node.add("request", Node::of_string(r.request));
    node.add("count", integer(r.count));
    node.add("time_ps", r.time ? summary_node(*r.time) : Node());
    node.add("one_way_ps", r.one_way ? summary_node(*r.one_way) : Node());
    Node histogram = Node::array();
    for (const HistogramBucket& bucket : r.histogram) {
      Node row = Node::array();
      row.items = {picoseconds(bucket.from), picoseconds(bucket.to), integer(bucket.count)};
      histogram.items.push_back(std::move(row));
    }
    node.add("histogram_ps", std::move(histogram));
    all.add(r.reply, std::move(node));
  }
  return all;
}

Node streams_of(const RunResult& result) {
  Node all = Node::object();
  for (const StreamResult& s : result.streams) {
    Node node = Node::object();
    node.add("sent", integer(s.sent));
    node.add("delivered", integer(s.delivered));
    node.add("lost", integer(s.lost));
    node.add("dropped", dropped_of(s.dropped));
    node.add("copies", integer(s.copies));
    node.add("in_flight", integer(s.in_flight));
    node.add("oldest_in_flight_ps", picoseconds(s.oldest_in_flight.value_or(Duration())));
    node.add("listeners", integer(s.listeners));
    node.add("latency_ps", s.latency ? summary_node(*s.latency) : Node());
    all.add(s.name, std::move(node));
  }
  return all;
}

Node reaction_node(const ReactionResult& r) {
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

Node programs_of(const RunResult& result) {
  Node all = Node::object();
  for (const ProgramResult& p : result.programs) {
    Node node = Node::object();
    node.add("variant", Node::of_string(p.variant));
    Node reactions = Node::array();
    for (const ReactionResult& r : p.reactions) reactions.items.push_back(reaction_node(r));
    node.add("reactions", std::move(reactions));
    if (!p.tree_reactions.empty()) {
      Node tree = Node::array();
      for (const ReactionResult& r : p.tree_reactions) tree.items.push_back(reaction_node(r));
      node.add("tree_reactions", std::move(tree));
    }
    if (!p.bindings.empty()) {
      Node bindings = Node::array();
      for (const BindingResult& b : p.bindings) {
        Node binding = Node::object();
        binding.add("at_ps", picoseconds(b.at));
        binding.add("role", Node::of_string(b.role));
        binding.add("node", b.node.empty() ? Node() : Node::of_string(b.node));
        bindings.items.push_back(std::move(binding));
      }
      node.add("bindings", std::move(bindings));
    }
    Node states = Node::object();
    for (std::size_t i = 0; i < p.participants.size(); ++i) states.add(p.participants[i], Node::of_string(p.states[i]));
    node.add("states", std::move(states));
    Node violations = Node::array();
    for (const ViolationResult& v : p.violations) {
      Node violation = Node::object();
      violation.add("at_ps", picoseconds(v.at));
      violation.add("invariant", Node::of_string(v.invariant));
      violation.add("participant", Node::of_string(v.participant));
      violation.add("text", Node::of_string(v.text));
      violations.items.push_back(std::move(violation));
    }
    node.add("violations", std::move(violations));
    Node timeline = Node::array();
    for (const TimelineEntry& e : p.timeline) {
      Node entry = Node::object();
      entry.add("at_ps", picoseconds(e.at));
      if (e.fault.empty()) {
        entry.add("participant", Node::of_string(p.participants[e.participant]));
        entry.add(e.call.empty() ? "state" : "call", Node::of_string(e.call.empty() ? e.state : e.call));
      } else {
        entry.add("fault", Node::of_string(e.fault));
      }
      timeline.items.push_back(std::move(entry));
    }
    node.add("timeline", std::move(timeline));
    node.add("changes", integer(p.changes));
    node.add("process_data_received", integer(p.process_data_received));
    if (!p.round_trips.empty()) node.add("round_trips", round_trips_of(p));
    all.add(p.name, std::move(node));
  }
  return all;
}

Node ports_of(const RunResult& result) {
  Node array = Node::array();
  for (const PortResult& p : result.ports) {
    Node node = Node::object();
    node.add("node", Node::of_string(p.node));
    node.add("port", integer(p.port));
    node.add("peer", Node::of_string(p.peer));
    node.add("frames", integer(p.frames));
    node.add("dropped", integer(p.dropped));
    node.add("queue_peak", integer(p.queue_peak));
    node.add("utilisation", Node::of_double(p.utilisation));
    node.add("fragments_cut", integer(p.fragments_cut));
    node.add("frames_cut_through", integer(p.frames_cut_through));
    node.add("bad_fcs_forwarded", integer(p.bad_fcs_forwarded));
    node.add("transmission_overrun", integer(p.transmission_overrun));
    array.items.push_back(std::move(node));
  }
  return array;
}

Node filter_node(const StreamFilterResult& f) {
  Node node = Node::object();
  node.add("stream", f.stream.empty() ? Node() : Node::of_string(f.stream));
  node.add("pcp", f.priority ? integer(*f.priority) : Node());
  node.add("matching", integer(f.matching));
  node.add("passing", integer(f.passing));
  node.add("not_passing", integer(f.not_passing));
  node.add("passing_sdu", integer(f.passing_sdu));
  node.add("not_passing_sdu", integer(f.not_passing_sdu));
  node.add("red", integer(f.red));
  node.add("blocked_due_to_oversize", Node::of_bool(f.blocked_due_to_oversize));
  return node;
}

Node gate_node(const StreamGateResult& g) {
  Node node = Node::object();
  node.add("passed", integer(g.passed));
  node.add("closed", integer(g.closed));
  node.add("octets_exceeded", integer(g.octets_exceeded));
  node.add("closed_due_to_invalid_rx", Node::of_bool(g.closed_due_to_invalid_rx));
  node.add("closed_due_to_octets_exceeded", Node::of_bool(g.closed_due_to_octets_exceeded));
  return node;
}

Node meter_node(const FlowMeterResult& m) {
  Node node = Node::object();
  node.add("green", integer(m.frames[0]));
  node.add("yellow", integer(m.frames[1]));
  node.add("red", integer(m.frames[2]));
  node.add("discarded", integer(m.discarded));
  node.add("marks_all_red", Node::of_bool(m.marks_all_red));
  return node;
}

Node scheduler_node(const AtsSchedulerResult& s) {
  Node node = Node::object();
  node.add("passed", integer(s.passed));
  node.add("discarded", integer(s.discarded));
  node.add("longest_hold_ps", picoseconds(s.longest_hold));
  return node;
}

/// Tables whose entries have names.
template <class Rows>
Node by_name(const Rows& rows, Node (*node_of)(const typename Rows::value_type&)) {
  Node all = Node::object();
  for (const auto& row : rows) all.add(row.name, node_of(row));
  return all;
}

Node clocks_of(const RunResult& result) {
  Node all = Node::array();
  const auto ps = [](sim::Duration duration) { return Node::of_integer(duration.ps()); };
  for (const ClockResult& c : result.clocks) {
    Node node = Node::object();
    node.add("node", Node::of_string(c.node));
    node.add("grandmaster", Node::of_string(c.grandmaster));
    node.add("state", Node::of_string(c.state));
    node.add("time_to_lock_ps", optional_picoseconds(c.time_to_lock));
    node.add("samples", integer(c.samples));
    Node offset = Node::object();
    offset.add("min_ps", ps(c.least));
    offset.add("mean_ps", ps(c.mean));
    offset.add("rms_ps", ps(c.rms));
    offset.add("max_ps", ps(c.greatest));
    offset.add("abs_max_ps", ps(std::max(c.greatest, sim::Duration() - c.least)));
    node.add("offset", std::move(offset));
    node.add("rate_error_ppt", Node::of_integer(c.frequency_error_ppt));
    node.add("steps", integer(c.steps));
    node.add("messages", integer(c.messages));
    Node changes = Node::array();
    for (const ClockChangeResult& change : c.changes) {
      Node entry = Node::object();
      entry.add("at_ps", ps(change.at.since_start()));
      entry.add("grandmaster", Node::of_string(change.grandmaster));
      entry.add("state", Node::of_string(change.state));
      changes.items.push_back(std::move(entry));
    }
    node.add("history", std::move(changes));
    all.items.push_back(std::move(node));
  }
  return all;
}

Node ingress_of(const RunResult& result) {
  Node all = Node::object();
  for (const IngressResult& i : result.ingress) {
    Node node = Node::object();
    node.add("unidentified", integer(i.unidentified));
    Node filters = Node::array();
    for (const StreamFilterResult& filter : i.filters) filters.items.push_back(filter_node(filter));
    node.add("filters", std::move(filters));
    node.add("gates", by_name(i.gates, gate_node));
    node.add("meters", by_name(i.meters, meter_node));
    node.add("ats", by_name(i.ats, scheduler_node));
    all.add(i.node, std::move(node));
  }
  return all;
}

void add_counters(Node& node, const RecoveryCounters& c) {
  node.add("passed", integer(c.passed));
  node.add("discarded", integer(c.discarded));
  node.add("out_of_order", integer(c.out_of_order));
  node.add("rogue", integer(c.rogue));
  node.add("lost", integer(c.lost));
  node.add("tagless", integer(c.tagless));
  node.add("resets", integer(c.resets));
}

Node recovery_node(const RecoveryResult& r) {
  Node node = Node::object();
  node.add("node", Node::of_string(r.node));
  node.add("stream", Node::of_string(r.stream));
  add_counters(node, r.counters);
  Node latent;
  if (r.latent_errors) {
    latent = Node::object();
    latent.add("paths", integer(r.latent_errors->paths));
    latent.add("errors", integer(r.latent_errors->errors));
    latent.add("resets", integer(r.latent_errors->resets));
    latent.add("first_ps", optional_picoseconds(r.latent_errors->first));
  }
  node.add("latent_errors", std::move(latent));
  Node individual = Node::array();
  for (const RecoveryResult::Individual& each : r.individual) {
    Node one = Node::object();
    one.add("member", each.member ? integer(*each.member) : Node());
    one.add("port", integer(each.port));
    add_counters(one, each.counters);
    individual.items.push_back(std::move(one));
  }
  node.add("individual", std::move(individual));
  return node;
}

Node redundancy_of(const RunResult& result) {
  Node splits = Node::array();
  for (const SplitResult& s : result.redundancy.splits) {
    Node node = Node::object();
    node.add("node", Node::of_string(s.node));
    node.add("stream", Node::of_string(s.stream));
    node.add("members", integer(s.members));
    node.add("frames", integer(s.frames));
    node.add("copies", integer(s.copies));
    splits.items.push_back(std::move(node));
  }
  Node recoveries = Node::array();
  for (const RecoveryResult& r : result.redundancy.recoveries) recoveries.items.push_back(recovery_node(r));
  Node node = Node::object();
  node.add("splits", std::move(splits));
  node.add("recoveries", std::move(recoveries));
  return node;
}

}  // namespace

scenario::json::Node run_node(const RunResult& result) {
  Node root = Node::object();
  root.add("takt", Node::of_string(result.version));
  root.add("scenario", Node::of_string(result.scenario));
  root.add("seed", integer(result.seed));
  root.add("simulated_ps", picoseconds(result.simulated));
  root.add("partial", Node::of_bool(result.partial));
  root.add("digest", Node::of_string(fmt::format("{:016x}", result.digest)));
  root.add("events", integer(result.events));
  if (result.from > Duration()) root.add("from_ps", picoseconds(result.from));
  root.add("verdict", Node::of_string(result.nothing_required ? nothing_was_required : name_of(result.verdict)));
  root.add("requirements", requirements_of(result));
  root.add("streams", streams_of(result));
  root.add("programs", programs_of(result));
  if (!result.applications.empty()) root.add("applications", applications_node(result));
  if (!result.signals.empty()) root.add("signals", signals_node(result));
  root.add("ports", ports_of(result));
  root.add("dropped", dropped_of(result.dropped));
  root.add("clocks", clocks_of(result));
  root.add("ingress", ingress_of(result));
  root.add("redundancy", redundancy_of(result));
  return root;
}

std::string run_json(const RunResult& result) { return scenario::json::pretty(run_node(result)); }

}  // namespace takt::results
