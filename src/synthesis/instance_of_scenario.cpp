#include "synthesis/instance_of_scenario.hpp"

#include <algorithm>
#include <map>

#include "json/node.hpp"
#include "scenario/gates/timing.hpp"
#include "scenario/resolve/gates.hpp"
#include "schedule/way.hpp"

namespace takt::synthesis {

using schedule::LinkIndex;
using schedule::Problem;
using schedule::Ps;

InstanceNetwork network_of(const scenario::Resolved& resolved) {
  InstanceNetwork network;
  Problem& problem = network.problem;
  problem.source = "takt";
  for (const scenario::TopologyNode& node : resolved.topology.nodes) problem.nodes.push_back({node.name, node.forwards()});
  for (const models::LinkPlan& plan : resolved.plan.links)
    for (const auto& [from, to] : {std::pair(plan.a, plan.b), std::pair(plan.b, plan.a)}) {
      schedule::Link link;
      link.from = from.node.value;
      link.to = to.node.value;
      link.name = problem.nodes[link.from].name + ">" + problem.nodes[link.to].name;
      if (from.port != 0 && std::any_of(problem.links.begin(), problem.links.end(), [&](const schedule::Link& other) { return other.name == link.name; })) link.name += "#" + std::to_string(from.port);
      link.octet = plan.rate.octet_time().ps();
      link.propagation = plan.delay.ps();
      link.forwarding = resolved.plan.nodes[link.to].greatest_forwarding_delay().ps();
      network.link_at[{link.from, from.port}] = static_cast<LinkIndex>(problem.links.size());
      problem.links.push_back(std::move(link));
    }
  return network;
}

std::optional<ScenarioInstance> instance_of(scenario::Resolved& resolved, const scenario::Scenario& wanted, const OpenRoutes& open, json::Diagnostics& diagnostics, std::string& why_not, bool allows_early) {
  // The problem of gates is what these streams need; with the gates that are asked for, but not yet laid.
  resolved.scenario.gates = wanted.gates;
  const auto gated = scenario::gate_problem_of(resolved, scenario::timings_of(resolved), diagnostics);
  resolved.scenario.gates.reset();
  if (!gated) return std::nullopt;
  auto [network, link_at] = network_of(resolved);
  ScenarioInstance instance{std::move(network), {}};
  Problem& problem = instance.problem;
  problem.name = wanted.name;
  problem.model.is_strict = true;
  problem.model.no_wait = true;
  problem.model.margin = gated->problem.margin.ps();
  std::map<std::string, std::size_t, std::less<>> entry_of;
  for (std::size_t i = 0; i < wanted.streams.size(); ++i) entry_of[wanted.streams[i].name] = i;
  const schedule::Timing timing(problem, schedule::GateTiming::flowing);
  std::map<std::uint32_t, std::size_t> of_train;
  for (const scenario::ScheduledStream& each : gated->problem.streams) ++of_train[each.train];
  for (std::size_t s = 0; s < gated->problem.streams.size(); ++s) {
    const scenario::ScheduledStream& gate = gated->problem.streams[s];
    const scenario::ResolvedStream& from = resolved.streams[gated->streams[s].value];
    if (std::ranges::find(resolved.redundancies, from.index, &scenario::ResolvedRedundancy::stream) != resolved.redundancies.end()) {
      why_not = gate.name + " is redundant, and its copies go several ways";
      return std::nullopt;
    }
    if (of_train[gate.train] > 1 || (gate.early > scenario::Duration() && !allows_early)) {
      why_not = gate.name + (of_train[gate.train] > 1 ? " is one of several that leave at one instant" : " is at its talker's port at no exact time");
      return std::nullopt;
    }
    const auto entry = entry_of.find(gate.name);
    const scenario::Stream* const written = entry == entry_of.end() ? nullptr : &wanted.streams[entry->second];
    schedule::Stream stream;
    stream.name = gate.name;
    stream.talker = from.paths.front().front();
    for (const auto& path : from.paths) stream.listeners.push_back(path.back());
    std::sort(stream.listeners.begin(), stream.listeners.end());
    stream.listeners.erase(std::unique(stream.listeners.begin(), stream.listeners.end()), stream.listeners.end());
    std::vector<LinkIndex> route;
    for (const scenario::ScheduledHop& hop : gate.hops) {
      const scenario::GatedPort& port = gated->problem.ports[hop.port];
      route.push_back(link_at.at({port.node.value, port.port}));
    }
    // Frames may lose a tag on their way: the longest counts, which only takes more than there is.
    Ps octets = 0;
    for (std::size_t h = 0; h < gate.hops.size(); ++h) octets = std::max(octets, gate.hops[h].transmission.ps() / problem.links[route[h]].octet);
    stream.octets = static_cast<std::uint32_t>(octets) - problem.model.preamble;
    stream.period = gate.period.ps();
    stream.traffic_class = gate.hops.front().traffic_class;
    for (const scenario::Requirement& requirement : wanted.require)
      if (requirement.stream == gate.name && requirement.latency) stream.latency = std::min(stream.latency.value_or(schedule::longest_time), requirement.latency->greatest().ps());
    const bool is_free = written != nullptr && written->offset && written->offset->is_auto;
    const bool is_open = open.contains(gate.name);
    if (is_open && !is_free) {
      why_not = json::quote(gate.name) + " says \"route\": \"auto\", and ways are searched for streams with \"offset\": \"auto\"";
      return std::nullopt;
    }
    if (!is_free || (written->path && !is_open) || stream.listeners.size() != 1) stream.route = route;
    if (!is_free) {
      // One start only: deadline and release leave no other.
      schedule::Stream unlimited = stream;
      unlimited.latency.reset();
      const auto way = schedule::make_way(timing, unlimited, route);
      if (!way) {
        why_not = gate.name + " cannot take its path as an instance has it";
        return std::nullopt;
      }
      stream.release = gate.release.ps();
      stream.deadline = stream.release + way->arrival;
    }
    instance.streams.push_back(entry == entry_of.end() ? std::nullopt : std::optional(entry->second));
    problem.streams.push_back(std::move(stream));
  }
  return instance;
}

}  // namespace takt::synthesis
