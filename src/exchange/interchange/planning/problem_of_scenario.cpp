// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "interchange/planning/planning.hpp"
#include "interchange/ports.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/port_configs.hpp"

namespace takt::interchange {
namespace {

using schedule::LinkIndex;

class ProblemWriter {
 public:
  ProblemWriter(const scenario::Resolved& resolved, Exported& exported) : r_(resolved), exported_(exported) {}

  PlanningProblem write() {
    problem().name = r_.scenario.name;
    problem().source = "takt";
    problem().model.is_strict = true;
    if (r_.scenario.gates && r_.scenario.gates->margin) problem().model.margin = r_.scenario.gates->margin->value.ps();
    extras().duration = r_.scenario.duration;
    extras().seed = r_.scenario.seed;
    report_unsupported();
    write_nodes();
    write_links();
    for (const scenario::ResolvedStream& stream : r_.streams)
      if (!stream.of_program) write_stream(stream);
    return std::move(made_);
  }

 private:
  schedule::Problem& problem() { return made_.problem; }
  PlanningExtras& extras() { return made_.extras; }

  void report_unsupported() {
    const scenario::Scenario& s = r_.scenario;
    for (const scenario::Program& program : s.programs)
      exported_.lose("program " + program.name, "what it sends: a program's messages are no streams of the file");
    for (const scenario::Application& application : s.applications)
      exported_.lose("application " + application.name, "what it sends");
    for (const scenario::Gateway& gateway : s.gateways) exported_.lose("gateway " + gateway.name, "what it sends");
    if (!s.faults.empty()) exported_.lose("faults", "all of them");
    if (!s.script.empty()) exported_.lose("script", "all of it");
    if (s.rerouting) exported_.lose("rerouting", "that paths change");
    if (s.gates && s.gates->plan == scenario::GatePlanning::listed)
      exported_.lose("gates", "lists that are there already: a planner makes them");
    for (const models::TalkerAtsPlan& ats : r_.plan.talker_ats)
      exported_.lose("stream " + r_.plan.streams[ats.stream.value].name, "its ATS scheduler at the talker");
  }

  void write_nodes() {
    for (const models::NodePlan& node : r_.plan.nodes) {
      const std::string where = "node " + node.name;
      problem().nodes.push_back({node.name, node.forwards()});
      if (node.clock)
        exported_.lose(where, "a clock of its own; the margin of the problem is what clocks may differ by");
      if (node.ingress) exported_.lose(where, "filters and policing of what comes in");
      if (node.forwarding_jitter) exported_.lose(where, "forwarding jitter");
      if (node.cpu) exported_.lose(where, "the threads of its processor");
      const models::OsLatency& os = r_.plan.os_latencies[node.os_latency];
      const auto is_none = [](const sim::Distribution& d) {
        return d.is_constant() && d.greatest() == sim::Duration();
      };
      if (!is_none(os.transmit) || !is_none(os.wake_up) || !os.receive.is_constant())
        exported_.lose(where, "latencies of its operating system, but a constant one of what is received");
      if (node.forwards() && !is_none(os.receive))
        exported_.lose(where, "the latency of the operating system of a station");
    }
    for (const scenario::TopologyNode& node : r_.topology.nodes) {
      const auto* const station = std::get_if<scenario::StationNode>(&node.description.get());
      if (station != nullptr && station->bypass) exported_.lose("node " + node.name, "its bypass relay");
      if (const auto& limits = scenario::ports_of(node.description).gate_limits; limits && limits->entries)
        entries_[node.name] = *limits->entries;
    }
    for (const Device& device : devices_of(r_))
      for (const DevicePort& port : device.ports) look_at_port(device, port);
  }

  void look_at_port(const Device& device, const DevicePort& port) {
    const std::string where = device.name + " to " + port.peer_name;
    const models::PortConfig& config = *port.config;
    models::PortConfig plain;
    plain.cut_through = config.cut_through;
    // Gates that takt has laid out are what a planner is asked for.
    if (r_.gates) plain.shaping.gates = config.shaping.gates;
    if (plain == config) return;
    const models::PortConfig usual;
    if (config.traffic_class_of_priority != usual.traffic_class_of_priority)
      exported_.lose(where, "another map from priorities to classes");
    if (config.queue_limits != usual.queue_limits) exported_.lose(where, "limits of queues");
    if (config.preemption != usual.preemption) exported_.lose(where, "preemption");
    if (config.untagged != usual.untagged) exported_.lose(where, "that tags are taken off");
    if (config.shaping.gates != plain.shaping.gates)
      exported_.lose(where, "a gate control list that is there already: a planner makes them");
    models::ShapingConfig shaping = config.shaping, none;
    shaping.gates = none.gates;
    if (shaping != none) exported_.lose(where, "shapers, shares and sizes of classes");
  }

  void write_links() {
    std::vector<std::uint16_t> next_port(r_.plan.nodes.size());
    bool are_in_order = true;
    for (const models::LinkPlan& plan : r_.plan.links) {
      for (const auto& [from, to] : {std::pair(plan.a, plan.b), std::pair(plan.b, plan.a)}) {
        schedule::Link link;
        link.from = from.node.value;
        link.to = to.node.value;
        link.name = problem().nodes[link.from].name + ">" + problem().nodes[link.to].name;
        if (names_.contains(link.name)) link.name += "#" + std::to_string(from.port);
        names_.emplace(link.name, static_cast<LinkIndex>(problem().links.size()));
        link.octet = plan.rate.octet_time().ps();
        link.propagation = plan.delay.ps();
        const models::NodePlan& node = r_.plan.nodes[link.to];
        link.forwarding = (node.forwards() ? node.greatest_forwarding_delay()
                                           : r_.plan.os_latencies[node.os_latency].receive.greatest())
                              .ps();
        if (const auto entries = entries_.find(problem().nodes[link.from].name); entries != entries_.end())
          link.entries = entries->second;
        link_at_[{link.from, from.port}] = static_cast<LinkIndex>(problem().links.size());
        are_in_order = are_in_order && next_port[link.from]++ == from.port;
        problem().links.push_back(std::move(link));
      }
    }
    if (are_in_order) return;
    for (std::size_t i = 0; i < r_.plan.links.size(); ++i) {
      CableExtras cable;
      cable.link = problem().links[2 * i].name;
      cable.from = r_.plan.links[i].a.port;
      cable.to = r_.plan.links[i].b.port;
      extras().cables.push_back(std::move(cable));
    }
  }

  void write_stream(const scenario::ResolvedStream& resolved) {
    const models::StreamPlan& plan = r_.plan.streams[resolved.index.value];
    const auto described = std::ranges::find(r_.scenario.streams, plan.name, &scenario::Stream::name);
    if (described == r_.scenario.streams.end()) return;  // of an application, which is told as lost
    const scenario::Stream& from = *described;
    const std::string where = "stream " + from.name;
    if (from.exponential || from.normal || from.trace)
      return exported_.lose(where, "random or traced times: a problem has periods");
    if (from.burst && from.burst->spacing > sim::Duration())
      exported_.lose(where, "the distance between the frames of a burst");
    if (from.jitter > sim::Duration()) exported_.lose(where, "jitter of its talker");
    if (from.launch) exported_.lose(where, "launch times");
    if (from.until) exported_.lose(where, "its end");
    if (from.redundancy) return exported_.lose(where, "redundancy");
    if (from.host_priority) exported_.lose(where, "a priority at its talker alone");
    if (from.to.names.size() != plan.listeners.size()) exported_.lose(where, "a listener that is named twice");
    schedule::Stream stream;
    stream.name = from.name;
    stream.talker = plan.talker.value;
    for (const models::NodeIndex listener : plan.listeners) stream.listeners.push_back(listener.value);
    stream.octets =
        static_cast<std::uint32_t>(models::frame_length(from.payload + plan.headers, plan.priority.has_value()).count);
    stream.period = (from.burst ? from.burst->every : from.every.value_or(sim::Duration())).ps();
    stream.frames = from.burst ? from.burst->frames : 1;
    if (from.offset && !from.offset->is_auto && !is_chosen(from.name)) stream.release = from.offset->value.ps();
    stream.traffic_class = models::standard_traffic_classes[plan.priority_at_talker()];
    for (const scenario::Requirement& requirement : r_.scenario.require) {
      if (requirement.stream != from.name) continue;
      if (requirement.latency)
        stream.latency =
            std::min(stream.latency.value_or(schedule::longest_time), requirement.latency->greatest().ps());
      if (requirement.jitter)
        stream.jitter = std::min(stream.jitter.value_or(schedule::longest_time), requirement.jitter->greatest().ps());
    }
    if (from.path) {
      auto& route = stream.route.emplace();
      const scenario::Path& path = resolved.paths.front();
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        route.push_back(link_at_.at({path[i], port_out(r_.topology, path, i)}));
    }
    look_at_way(resolved, stream, where);
    StreamExtras extra;
    extra.stream = from.name;
    extra.encapsulation = from.encapsulation;
    extra.pcp = from.pcp;
    extra.vlan = from.vlan;
    extra.payload = from.payload;
    extra.is_burst = from.burst.has_value();
    extras().streams.push_back(std::move(extra));
    problem().streams.push_back(std::move(stream));
  }

  bool is_chosen(const std::string& name) const {
    return std::ranges::find(r_.chosen_offsets, name, &scenario::ResolvedOffset::name) != r_.chosen_offsets.end();
  }

  /// Where the ports of its bridges cut through, the links that lead there do.
  void look_at_way(const scenario::ResolvedStream& resolved, const schedule::Stream& stream, const std::string& where) {
    for (const scenario::Path& path : resolved.paths)
      for (std::size_t i = 1; i + 1 < path.size(); ++i) {
        const std::uint16_t port = port_out(r_.topology, path, i);
        const bool cuts = models::contains(scenario::port_config_of(r_.plan, end_at(path[i], port)).cut_through,
                                           stream.traffic_class);
        const std::uint32_t octets = static_cast<std::uint32_t>(
            (r_.plan.nodes[path[i]].cut_through_header +
             (r_.plan.streams[resolved.index.value].priority ? models::vlan_tag : sim::Octets{0}))
                .count);
        const std::optional<std::uint32_t> wanted = cuts ? std::optional(octets) : std::nullopt;
        const LinkIndex in = link_at_.at({path[i - 1], port_out(r_.topology, path, i - 1)});
        const auto [known, is_new] = cut_.try_emplace(in, wanted);
        if (!is_new && known->second != wanted)
          exported_.lose(where, "that " + problem().nodes[path[i]].name +
                                    " cuts some frames through and stores others, or after other headers");
        problem().links[in].cut_through = wanted;
      }
  }
  const models::LinkPlan::End& end_at(std::uint32_t node, std::uint16_t port) const {
    const schedule::Link& link = made_.problem.links[link_at_.at({node, port})];
    const models::LinkPlan& plan = r_.plan.links[link_at_.at({node, port}) / 2];
    return plan.a.node.value == link.from && plan.a.port == port ? plan.a : plan.b;
  }

  const scenario::Resolved& r_;
  Exported& exported_;
  PlanningProblem made_;
  std::map<std::string, std::uint32_t> entries_;  // of gate lists, by node
  std::map<std::string, LinkIndex> names_;
  std::map<std::pair<std::uint32_t, std::uint16_t>, LinkIndex> link_at_;  // by node and port
  std::map<LinkIndex, std::optional<std::uint32_t>> cut_;
};

}  // namespace

PlanningProblem problem_of(const scenario::Resolved& resolved, Exported& exported) {
  return ProblemWriter(resolved, exported).write();
}

}  // namespace takt::interchange
