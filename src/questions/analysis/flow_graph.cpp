// SPDX-License-Identifier: Apache-2.0
#include "analysis/flow_graph.hpp"

#include <algorithm>

#include "analysis/assessment.hpp"
#include "analysis/flow_routes.hpp"
#include "analysis/flow_sources.hpp"
#include "analysis/gate_beginning.hpp"
#include "models/egress/class_set.hpp"
#include "scenario/resolve/cqf.hpp"

namespace takt::analysis {
namespace {

/// What fixed point rounds of a frequency.
constexpr std::int64_t rounding_ppt = 1'000;

std::int64_t magnitude(std::int64_t value) { return value < 0 ? -value : value; }

/// The greatest deviation of an oscillator in a run of that duration, in parts in 10^12.
std::int64_t greatest_deviation(const models::OscillatorConfig& oscillator, sim::Duration duration) {
  double ppt =
      static_cast<double>(magnitude(oscillator.offset.parts_per_trillion)) +
      static_cast<double>(magnitude(oscillator.drift_ppt_per_second)) * static_cast<double>(duration.ps()) * 1e-12;
  if (oscillator.temperature)
    ppt += static_cast<double>(magnitude(oscillator.temperature->amplitude.parts_per_trillion));
  if (oscillator.walk) ppt += static_cast<double>(magnitude(oscillator.walk->bound.parts_per_trillion));
  std::int64_t table = 0;
  for (const models::FrequencyPoint& point : oscillator.table)
    table = std::max(table, magnitude(point.frequency.parts_per_trillion));
  const double bound =
      std::min(ppt + static_cast<double>(table), static_cast<double>(magnitude(oscillator.bound.parts_per_trillion)));
  return static_cast<std::int64_t>(bound) + rounding_ppt;
}

/// A clock that goes at one frequency for ever is known by its sign too.
void set_rate(ClockQuality& quality, const models::OscillatorConfig& oscillator, sim::Duration duration) {
  quality.rate_ppt = greatest_deviation(oscillator, duration);
  quality.slowest_ppt = -quality.rate_ppt;
  quality.fastest_ppt = quality.rate_ppt;
  const std::int64_t offset = oscillator.offset.parts_per_trillion;
  if (!oscillator.is_constant() || !oscillator.table.empty() ||
      magnitude(offset) > magnitude(oscillator.bound.parts_per_trillion))
    return;
  quality.slowest_ppt = offset - rounding_ppt;
  quality.fastest_ppt = offset + rounding_ppt;
}

/// All that chance may make of a node's oscillator, by the ends of the ranges that the scenario gives: a bound holds
/// for every seed.
std::vector<models::OscillatorConfig> possible_oscillators(const scenario::Resolved& r, const models::NodePlan& node) {
  const scenario::Clocks& clocks = r.scenario.clocks;
  const auto own =
      std::find_if(clocks.nodes.begin(), clocks.nodes.end(), [&](const auto& each) { return each.first == node.name; });
  const scenario::Clock* const clock = own != clocks.nodes.end() ? &own->second : clocks.all ? &*clocks.all : nullptr;
  std::vector<models::OscillatorConfig> all{node.clock->oscillator};
  if (clock == nullptr || clock->ideal) return all;
  const auto spread = [&](const scenario::FrequencyRange& range, auto set) {
    if (!range.from || !range.to) return;
    const std::vector<models::OscillatorConfig> before = std::move(all);
    all.clear();
    for (const models::OscillatorConfig& each : before)
      for (const sim::FrequencyOffset end : {*range.from, *range.to}) set(all.emplace_back(each), end);
  };
  spread(clock->offset, [](models::OscillatorConfig& made, sim::FrequencyOffset end) { made.offset = end; });
  spread(clock->drift, [](models::OscillatorConfig& made, sim::FrequencyOffset end) {
    made.drift_ppt_per_second = end.parts_per_trillion;
  });
  return all;
}

PortModel model_of(const scenario::Resolved& r, const GraphPort& port, const BoundOptions& options) {
  PortModel model;
  model.octet_time = port.octet_time;
  model.config = &r.plan.port_configs[port.config];
  model.clock = clock_quality(r, port.node, options);
  model.counts_packets = options.counts_packets;
  const models::NodePlan& node = r.plan.nodes[port.node.value];
  // Times count from the end of the fixed delay; what the jitter keeps, or a clock that is set back, comes later.
  if (node.forwards())
    model.late_by = sum((node.greatest_forwarding_delay() - node.least_forwarding_delay()).ps(), 2 * model.clock.error);
  for (const scenario::ResolvedAction& action : r.script)
    if (const auto* const gates = std::get_if<scenario::ResolvedGates>(&action.what);
        gates != nullptr && gates->node == port.node && gates->port == port.number)
      model.more_gates.push_back(gates->gates);
  const scenario::Relay* const bridge = scenario::relay_of(r.topology.nodes[port.node.value].description);
  if (bridge != nullptr && bridge->ingress && bridge->ingress->cqf) {
    const scenario::Cqf& cqf = *bridge->ingress->cqf;
    const scenario::CqfTimes times = scenario::cqf_times(cqf, r.topology, port.node.value);
    CqfPort made{cqf.cycle.ps(),
                 cqf.base_time.ps(),
                 static_cast<int>(cqf.classes.size()),
                 times.dead_time.ps(),
                 times.offset.ps(),
                 node.forwarding_delay.ps(),
                 0};
    for (const std::uint8_t q : cqf.classes) made.classes = models::with(made.classes, q);
    model.cqf = made;
  }
  return model;
}

/// In a class that is sent by eligibility times, frames without one go before those that wait for theirs.
void note_unordered_classes(FlowGraph& graph) {
  for (std::size_t p = 0; p < graph.ports.size(); ++p) {
    const models::ClassSet timed = graph.models[p].config->shaping.timed();
    for (const std::uint32_t h : graph.ports[p].hops) {
      const Hop& hop = graph.hops[h];
      // By flow, not by stream: what a talker sends that babbles has no launch times.
      const bool has_times = hop.parents.empty() ? graph.flows[hop.flow].is_timed : hop.ats && hop.ats->is_minded;
      for (models::TrafficClass q = hop.lowest_class; q <= hop.highest_class; ++q)
        if (models::contains(timed, q) && !has_times)
          graph.models[p].unordered = models::with(graph.models[p].unordered, q);
    }
  }
}

void note_assumptions(const scenario::Resolved& r, const BoundOptions& options, FlowGraph& graph) {
  Assumptions& all = graph.assumptions;
  all.add(Assumption::nothing_else);
  const auto is_random = [](const sim::Distribution& d) { return d.greatest() != d.least(); };
  for (const models::OsLatency& os : r.plan.os_latencies)
    if (is_random(os.transmit) || is_random(os.receive) || is_random(os.wake_up)) all.add(Assumption::os_latency);
  if (std::any_of(r.plan.nodes.begin(), r.plan.nodes.end(),
                  [](const models::NodePlan& node) { return node.cpu != nullptr; }))
    all.add(Assumption::execution_times);
  if (!r.scenario.faults.empty()) all.add(Assumption::listed_faults_only);
  for (const scenario::ResolvedAction& action : r.script) {
    if (std::holds_alternative<scenario::ResolvedGates>(action.what)) all.add(Assumption::gates_do_not_change);
    if (std::holds_alternative<scenario::ResolvedStuckGate>(action.what) ||
        std::holds_alternative<scenario::ResolvedClockFault>(action.what) ||
        std::holds_alternative<scenario::ResolvedBypass>(action.what))
      all.add(Assumption::no_disturbance);
  }
  if (!graph.uncertain_paths.empty()) all.add(Assumption::no_disturbance);
  if (GateBeginning(r, options).latest_of_all() > sim::Duration()) all.add(Assumption::gates_in_force);
  if (!r.plan.gptp.empty()) {
    all.add(Assumption::gptp_traffic);
    all.add(Assumption::clock_difference);
  }
  if (std::any_of(r.plan.nodes.begin(), r.plan.nodes.end(),
                  [](const models::NodePlan& node) { return node.clock.has_value(); }))
    all.add(Assumption::clock_rate);
  for (const Assumption each : {Assumption::gates_do_not_change, Assumption::no_disturbance, Assumption::gates_in_force,
                                Assumption::clock_difference})
    if (all.contains(each)) all.add(Assumption::drained);
}

}  // namespace

ClockQuality clock_quality(const scenario::Resolved& r, models::NodeIndex node, const BoundOptions& options) {
  ClockQuality quality;
  const models::NodePlan& plan = r.plan.nodes[node.value];
  if (!plan.clock) return quality;
  const bool speaks_gptp = node.value < r.plan.gptp.size() && r.plan.gptp[node.value];
  if (speaks_gptp) {
    // Everybody follows the grandmaster, who may be anybody.
    for (const models::NodePlan& other : r.plan.nodes)
      if (other.clock)
        for (const models::OscillatorConfig& each : possible_oscillators(r, other))
          quality.rate_ppt = std::max(quality.rate_ppt, greatest_deviation(each, r.scenario.duration));
    quality.slowest_ppt = -quality.rate_ppt;
    quality.fastest_ppt = quality.rate_ppt;
    quality.error = clock_premise(r, options).error.ps();
    return quality;
  }
  bool is_first = true;
  for (const models::OscillatorConfig& each : possible_oscillators(r, plan)) {
    ClockQuality one;
    set_rate(one, each, r.scenario.duration);
    quality.rate_ppt = std::max(quality.rate_ppt, one.rate_ppt);
    quality.slowest_ppt = is_first ? one.slowest_ppt : std::min(quality.slowest_ppt, one.slowest_ppt);
    quality.fastest_ppt = is_first ? one.fastest_ppt : std::max(quality.fastest_ppt, one.fastest_ppt);
    is_first = false;
  }
  quality.is_synchronised = false;
  return quality;
}

FlowGraph make_flow_graph(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts) {
  FlowGraph graph;
  for (std::uint32_t l = 0; l < resolved.plan.links.size(); ++l) {
    const models::LinkPlan& link = resolved.plan.links[l];
    const auto doubles = [&](bool from_a) {
      return std::any_of(resolved.plan.impairments.begin(), resolved.plan.impairments.end(),
                         [&](const models::ImpairmentPlan& i) {
                           return i.link == l && i.from_a_to_b == from_a && i.impairment.duplication;
                         });
    };
    for (const auto& [from, to, from_a] : {std::tuple(&link.a, &link.b, true), std::tuple(&link.b, &link.a, false)})
      graph.ports.push_back({from->node,
                             from->port,
                             to->node,
                             link.rate.octet_time().ps(),
                             link.delay.ps(),
                             l,
                             from_a,
                             from->port_config.value_or(resolved.plan.nodes[from->node.value].port_config),
                             doubles(from_a),
                             {}});
  }
  for (const GraphPort& port : graph.ports) graph.models.push_back(model_of(resolved, port, options));
  add_flows(resolved, options, hosts, graph);
  add_routes(resolved, graph);
  note_unordered_classes(graph);
  note_assumptions(resolved, options, graph);
  return graph;
}

}  // namespace takt::analysis
