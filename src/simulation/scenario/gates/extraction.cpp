// SPDX-License-Identifier: Apache-2.0
// The problem of automatic gates, out of a resolved scenario.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/gate_limits.hpp"
#include "scenario/gates/resolve_gates.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/redundancy.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::scenario {
namespace {

class Extraction {
 public:
  Extraction(const Resolved& resolved, const Timings& timings, json::Diagnostics& diagnostics)
      : r_(resolved), timing_(timings.of_streams), gates_(*resolved.scenario.gates), diagnostics_(diagnostics) {}

  std::optional<StreamsToGate> run() {
    const std::size_t errors_before = diagnostics_.errors();
    find_ends();
    if (!find_classes()) return std::nullopt;
    problem_.margin = gates_.margin ? gates_.margin->value : has_clocks() ? 1_us : Duration();
    if (r_.scenario.rerouting)
      diagnostics_.error(
          r_.scenario.rerouting->where.place(), "rerouting of scheduled streams",
          {"\"rerouting\" beside \"gates\": \"auto\", whose windows lie along one path", "one of the two"});
    for (const ResolvedStream& stream : r_.streams)
      if (class_at_talker(stream) && classes_.contains(*class_at_talker(stream))) add(stream);
    check_others();
    if (diagnostics_.errors() != errors_before) return std::nullopt;
    if (problem_.streams.empty())
      diagnostics_.warning(gates_.where.place(), "no stream to lay gates for",
                           {"none in the scheduled classes", "streams of these classes"});
    return StreamsToGate{std::move(problem_), std::move(streams_)};
  }

 private:
  struct End {
    const models::LinkPlan* link = nullptr;
    const models::LinkPlan::End* end = nullptr;
  };

  bool has_clocks() const {
    return std::any_of(r_.plan.nodes.begin(), r_.plan.nodes.end(),
                       [](const models::NodePlan& node) { return node.clock.has_value(); });
  }
  void find_ends() {
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* end : {&link.a, &link.b}) ends_[{end->node.value, end->port}] = {&link, end};
  }
  static std::pair<std::uint32_t, std::uint16_t> key_of(const End& at) { return {at.end->node.value, at.end->port}; }
  End end_of(const Path& path, std::size_t at) const { return ends_.at({path[at], port_out(r_.topology, path, at)}); }
  const models::PortConfig& config_of(const models::LinkPlan::End& end) const {
    return r_.plan.port_configs[end.port_config.value_or(r_.plan.nodes[end.node.value].port_config)];
  }
  const models::StreamPlan& plan_of(const ResolvedStream& stream) const { return r_.plan.streams[stream.index.value]; }
  models::TrafficClass class_of(const ResolvedStream& stream, const models::PortConfig& config) const {
    return config.traffic_class_of_priority[plan_of(stream).priority_at_talker()];
  }
  std::optional<models::TrafficClass> class_at_talker(const ResolvedStream& stream) const {
    if (stream.paths.empty()) return std::nullopt;
    return class_of(stream, config_of(*end_of(stream.paths.front(), 0).end));
  }

  bool find_classes() {
    classes_.insert(gates_.classes.begin(), gates_.classes.end());
    if (!gates_.classes.empty()) return true;
    for (const ResolvedStream& stream : r_.streams)
      if (stream.of_program && class_at_talker(stream)) classes_.insert(*class_at_talker(stream));
    if (!classes_.empty()) return true;
    diagnostics_.error(gates_.where.at("classes"), "missing key",
                       {"no programs, whose classes it would be", "\"classes\", the scheduled ones"});
    return false;
  }

  void refuse(const ResolvedStream& stream, const std::string& why) {
    diagnostics_.error(
        stream.where.place(), "a stream that no gates can be laid for",
        {json::quote(plan_of(stream).name) + " with " + why, "what \"gates\": \"auto\" can plan, or another class"});
  }

  void add(const ResolvedStream& stream) {
    const FrameTiming& timing = timing_[stream.index.value];
    if (!timing.no_window.empty()) return refuse(stream, timing.no_window);
    ScheduledStream made;
    made.name = plan_of(stream).name;
    made.period = timing.period;
    made.release = timing.release;
    made.early = timing.early;
    made.train = timing.train;
    const auto redundancy = std::ranges::find(r_.redundancies, stream.index, &ResolvedRedundancy::stream);
    const bool is_redundant = redundancy != r_.redundancies.end();
    if (is_redundant && redundancy->is_ladder())
      return refuse(stream, "ways of a ladder, on which a frame may come at many times");
    std::map<std::vector<std::uint32_t>, std::uint32_t>
        known;  // hops, by the way to them: nodes, and which copy goes on from each
    for (std::size_t p = 0; p < stream.paths.size(); ++p) {
      const Path& path = stream.paths[p];
      const std::vector<OnHop> on = is_redundant ? on_hops(r_, *redundancy, p) : std::vector<OnHop>(path.size() - 1);
      std::vector<std::uint32_t> way;
      std::optional<std::uint32_t> previous;
      bool is_copy = false;  // somewhere before
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        way.push_back(path[i]);
        way.push_back(on[i].member ? static_cast<std::uint32_t>(*on[i].member) + 1 : 0);
        const bool is_merged = is_copy && !on[i].member;
        is_copy = is_copy || on[i].member.has_value();
        way.push_back(path[i + 1]);
        const auto [hop, is_new] = known.emplace(way, static_cast<std::uint32_t>(made.hops.size()));
        way.pop_back();
        if (is_new) {
          const std::string problem = check_node(path[i]);
          if (!problem.empty()) return refuse(stream, problem);
          if (!add_hop(stream, made, end_of(path, i), path[i + 1], previous, on[i].r_tagged)) return;
          made.hops.back().is_merged = is_merged;
        }
        previous = hop->second;
      }
    }
    scheduled_.insert(stream.index.value);
    add_train(made, timing, stream.index);
  }

  /// Each frame of a burst is one a period. Those that are handed over at one instant leave in their order, the others
  /// are there at instants of their own.
  void add_train(const ScheduledStream& first, const FrameTiming& timing, models::StreamIndex stream) {
    for (std::uint32_t frame = 0; frame < timing.frames; ++frame) {
      ScheduledStream made = first;
      if (frame > 0) made.name += " frame " + std::to_string(frame);
      made.release += timing.spacing * frame;
      if (timing.spacing > Duration()) made.train += frame;
      problem_.streams.push_back(std::move(made));
      streams_.push_back(stream);
    }
  }

  std::string check_node(std::uint32_t node) const {
    const Node& description = r_.topology.nodes[node].description;
    const Relay* const bridge = relay_of(description);
    if (ports_of(description).gates)
      return "a way over " + json::quote(r_.topology.nodes[node].name) + ", which has no gates";
    if (r_.plan.nodes[node].forwarding_jitter)
      return "a way over " + json::quote(r_.topology.nodes[node].name) + ", whose forwarding delay has jitter";
    if (bridge == nullptr || !bridge->ingress) return {};
    return "a way over " + json::quote(r_.topology.nodes[node].name) +
           ", whose \"ingress\" may change classes and times";
  }

  bool add_hop(const ResolvedStream& stream, ScheduledStream& made, const End& at, std::uint32_t to,
               std::optional<std::uint32_t> previous, bool r_tagged) {
    const std::uint32_t from = at.end->node.value;
    const models::PortConfig& config = config_of(*at.end);
    const models::TrafficClass q = class_of(stream, config);
    const std::string port = json::quote(r_.topology.nodes[from].name + " to " + r_.topology.nodes[to].name);
    std::string problem;
    if (!std::holds_alternative<models::StrictPriority>(config.shaping.selection[q]))
      problem = "a shaper of its class at " + port;
    if (config.shaping.is_shared(q))
      problem = "a share of the bandwidth (ETS) for its class at " + port +
                ", which makes its delays depend on other traffic";
    if (config.preemption && models::contains(config.preemption->preemptable, q))
      problem = "a preemptable class at " + port;
    const models::StreamPlan& plan = plan_of(stream);
    if (plan.host_priority) problem = "a priority that its frames have at " + port + " and not behind it";
    if (!problem.empty()) return refuse(stream, problem), false;
    const bool tagged = plan.priority.has_value() && !strips_tags(r_.topology, config, from, !previous);
    const Octets frame = models::frame_length(plan.headers + stream.largest_payload, tagged, r_tagged);
    const Duration octet = at.link->rate.octet_time();
    ScheduledHop hop;
    hop.port = port_index(from, to, at, octet);
    hop.previous = previous;
    hop.traffic_class = q;
    hop.transmission = octet * (models::preamble_and_sfd + frame).count;
    hop.behind =
        at.link->delay + r_.plan.nodes[to].greatest_forwarding_delay();  // more than the least only in the listener
    if (previous && models::contains(config.cut_through, q) && !config.untagged) {
      const ScheduledHop& before = made.hops[*previous];
      const GatedPort& link = problem_.ports[before.port];
      // The header of a frame of another rate, or without its tag, comes at another time.
      if (r_tagged || is_untagged(link))
        return refuse(stream, "cut-through at " + port + " of frames whose header is another one"), false;
      const Octets header = r_.plan.nodes[from].cut_through_header + (plan.priority ? models::vlan_tag : Octets{0});
      if (link.gap == problem_.ports[hop.port].gap)
        hop.ahead = std::max(Duration(), before.transmission - octet * header.count);
    }
    made.hops.push_back(hop);
    scheduled_classes_[hop.port] = models::with(scheduled_classes_[hop.port], q);
    return true;
  }

  bool is_untagged(const GatedPort& port) const {
    return config_of(*ends_.at({port.node.value, port.port}).end).untagged;
  }

  std::uint32_t port_index(std::uint32_t from, std::uint32_t to, const End& at, Duration octet) {
    const auto [found, is_new] = ports_.emplace(key_of(at), static_cast<std::uint32_t>(problem_.ports.size()));
    if (!is_new) return found->second;
    const Duration gap = octet * models::inter_packet_gap.count;
    const TopologyNode& node = r_.topology.nodes[from];
    const Octets longest = models::frame_length(node.mtu, true);
    const Duration guard = gates_.guard == GateGuard::longest_frame ? octet * models::wire_length(longest).count : gap;
    problem_.ports.push_back({models::NodeIndex{from}, at.end->port, node.name + " to " + r_.topology.nodes[to].name,
                              gap, guard, list_limits_of(node), longest});
    scheduled_classes_.push_back(0);
    return found->second;
  }

  /// Nobody else is in a scheduled class at a port that has windows.
  void check_others() {
    std::set<std::uint32_t> told;
    for (const StreamAtPort& at : streams_at_ports(r_)) {
      const ResolvedStream& stream = r_.streams[at.stream.value];
      if (scheduled_.contains(at.stream.value) ||
          (class_at_talker(stream) && classes_.contains(*class_at_talker(stream))))
        continue;
      const auto port = ports_.find({at.node, at.port});
      if (port == ports_.end() || (scheduled_classes_[port->second] & at.classes) == 0 ||
          !told.insert(at.stream.value).second)
        continue;
      diagnostics_.error(stream.where.place(), "a stream in a scheduled class",
                         {json::quote(plan_of(stream).name) + " at " + json::quote(problem_.ports[port->second].name) +
                              " between scheduled frames",
                          "another class there"});
    }
    if (!r_.scenario.clocks.gptp) return;
    for (const auto& [key, port] : ports_)
      if (models::contains(scheduled_classes_[port],
                           config_of(*ends_.at(key).end).traffic_class_of_priority[priority_of_gptp])) {
        diagnostics_.error(
            gates_.where.place(), "gPTP in a scheduled class",
            {"the class of priority 7 is scheduled", "other classes, since messages of gPTP have priority 7"});
        return;
      }
  }

  const Resolved& r_;
  const std::vector<FrameTiming>& timing_;  // by stream
  const NetworkGates& gates_;
  json::Diagnostics& diagnostics_;
  std::set<std::uint8_t> classes_;
  std::map<std::pair<std::uint32_t, std::uint16_t>, End> ends_;
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> ports_;  // by node and port
  std::vector<models::ClassSet> scheduled_classes_;                         // by port of the problem
  std::set<std::uint32_t> scheduled_;                                       // streams
  GateProblem problem_;
  std::vector<models::StreamIndex> streams_;  // of the problem
};

}  // namespace

std::optional<StreamsToGate> gate_problem_of(const Resolved& resolved, const Timings& timings,
                                             json::Diagnostics& diagnostics) {
  return Extraction(resolved, timings, diagnostics).run();
}

}  // namespace takt::scenario
