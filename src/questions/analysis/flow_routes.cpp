// SPDX-License-Identifier: Apache-2.0
#include "analysis/flow_routes.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "analysis/dds_sources.hpp"
#include "analysis/outages.hpp"
#include "models/egress/class_set.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/cqf.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/redundancy.hpp"
#include "sim/check.hpp"

namespace takt::analysis {
namespace {

using models::NodeIndex;
using models::TrafficClass;
using scenario::Path;

class RouteMaker {
 public:
  RouteMaker(const scenario::Resolved& resolved, FlowGraph& graph) : r_(resolved), graph_(graph) {
    has_bypass_ = has_bypass(resolved);
    for (std::uint32_t p = 0; p < graph.ports.size(); ++p)
      port_at_[{graph.ports[p].node.value, graph.ports[p].number}] = p;
    for (const scenario::ResolvedRedundancy& redundancy : resolved.redundancies)
      redundancy_[redundancy.stream.value] = &redundancy;
  }

  void make(std::uint32_t flow) {
    const scenario::ResolvedStream& stream = r_.streams[graph_.flows[flow].stream.value];
    const models::StreamPlan& plan = r_.plan.streams[stream.index.value];
    const auto redundant = redundancy_.find(stream.index.value);
    const scenario::ResolvedRedundancy* const redundancy = redundant == redundancy_.end() ? nullptr : redundant->second;
    hop_at_.clear();
    const std::size_t listeners = plan.listeners.size();
    graph_.flows[flow].last.assign(listeners, {});
    prefixes_.clear();
    if (redundancy != nullptr && has_bypass_) {
      make_members(flow, *redundancy);
      return;
    }
    if (redundancy != nullptr) prepare_copies(graph_.flows[flow], flow, *redundancy);
    const auto possible = possible_paths(r_, stream, plan.vlan, plan.destination);
    if (!possible) graph_.uncertain_paths.push_back(plan.name);
    if (possible && !possible->empty()) {
      add_possible(flow, *possible, nullptr, {}, plan.destination);
      return;
    }
    for (std::size_t i = 0; i < stream.paths.size(); ++i) {
      const Path& path = stream.paths[i];
      if (redundancy == nullptr) {
        note_last(flow, i, walk(flow, path, nullptr, {}, false));
        receive(flow, path, plan.destination);
        continue;
      }
      const std::vector<scenario::OnHop> hops = scenario::on_hops(r_, *redundancy, i);
      note_last(flow, redundancy->is_ladder() ? 0 : i / redundancy->members.size(),
                walk(flow, path, redundancy, hops, false));
      receive(flow, path,
              redundancy->merges_in_host ? redundancy->members[*hops.back().member].destination : plan.destination);
      if (redundancy->is_ladder() && i == 0) add_late_copies(flow, path, *redundancy, hops);
    }
  }

  /// Flows of one stream, and members of a redundant one, may meet at one scheduler or meter; hops of one frame to
  /// several ports do not.
  void note_shared_tokens() {
    using Pass = std::pair<std::uint32_t, std::vector<std::uint32_t>>;
    std::map<std::uint64_t, std::set<Pass>> of_scheduler, of_meter;
    for (const Hop& hop : graph_.hops) {
      if (hop.ats) of_scheduler[hop.ats->scheduler].insert({hop.flow, hop.parents});
      if (hop.policing.meter) of_meter[hop.policing.number].insert({hop.flow, hop.parents});
    }
    for (Hop& hop : graph_.hops) {
      if (hop.ats && of_scheduler[hop.ats->scheduler].size() > 1) hop.ats->is_shared = true;
      if (hop.policing.meter && of_meter[hop.policing.number].size() > 1) hop.policing.always_may_drop = true;
    }
  }

 private:
  static constexpr std::uint32_t nobody = 0xFFFF'FFFF;
  static constexpr std::uint32_t bypassed = 0x8000'0000;  // with the number of a node
  static constexpr std::size_t first_prefix = 0x1'0000;   // more than a stream has members

  /// What is known of copies that are made at known times: whether they leave their talker one behind the other, and
  /// whether they come to the merge one after the other.
  void prepare_copies(Flow& flow, std::uint32_t number, const scenario::ResolvedRedundancy& redundancy) {
    come_apart_ = false;
    if (!flow.produced || redundancy.is_ladder()) return;
    if (redundancy.splits_in_host && !flow.train)
      flow.train = number;  // those of Programs are numbers of flows of their own
    Ps least = unbounded_ps, most = 0, longest = 0;
    const scenario::ResolvedStream& stream = r_.streams[flow.stream.value];
    const sim::Octets frame = models::frame_length(
        r_.plan.streams[stream.index.value].headers + flow.payload.value_or(stream.largest_payload), true, true);
    for (const Path& path : stream.paths) {
      Ps way = 0;
      for (std::size_t at = 0; at + 1 < path.size() && path[at] != redundancy.merge; ++at) {
        const GraphPort& port = graph_.ports[port_at_.at({path[at], port_out(r_.topology, path, at)})];
        longest = std::max(longest, port.octet_time * models::wire_length(frame).count);
        way = sum(way, port.octet_time * models::wire_length(frame).count, port.propagation,
                  r_.plan.nodes[path[at + 1]].greatest_forwarding_delay().ps());
      }
      least = std::min(least, way);
      most = std::max(most, way);
    }
    come_apart_ = most - least > longest;
  }

  void add_possible(std::uint32_t flow, const std::vector<PossiblePath>& possible,
                    const scenario::ResolvedRedundancy* redundancy, const scenario::OnHop& on,
                    models::AddressIndex address) {
    for (const PossiblePath& each : possible) {
      const std::uint32_t last = walk(flow, each.path, redundancy,
                                      std::vector<scenario::OnHop>(each.path.size() - 1, on), true, &each.is_bypassed);
      if (each.listener == PossiblePath::nobody) continue;
      note_last(flow, each.listener, last);
      receive(flow, each.path, address);
    }
    share_schedulers(flow);
  }

  /// Members of a redundant stream, on all ways that relays may open to them. Of those that bridges split or merge not
  /// all ways are known.
  void make_members(std::uint32_t flow, const scenario::ResolvedRedundancy& redundancy) {
    const scenario::ResolvedStream& stream = r_.streams[graph_.flows[flow].stream.value];
    const bool is_known = redundancy.splits_in_host && redundancy.merges_in_host && !redundancy.is_ladder();
    if (!is_known) graph_.uncertain_paths.push_back(r_.plan.streams[stream.index.value].name);
    for (std::size_t member = 0; member < redundancy.members.size() && is_known; ++member) {
      const models::StreamMember& its = redundancy.members[member];
      const auto possible = possible_paths(r_, stream, its.vlan, its.destination);
      if (!possible) {
        graph_.uncertain_paths.push_back(r_.plan.streams[stream.index.value].name);
      } else if (!possible->empty()) {
        add_possible(flow, *possible, &redundancy, {member, true}, its.destination);
        continue;
      }
      for (std::size_t i = member; i < stream.paths.size(); i += redundancy.members.size()) {
        note_last(flow, i / redundancy.members.size(),
                  walk(flow, stream.paths[i], &redundancy, scenario::on_hops(r_, redundancy, i), false));
        receive(flow, stream.paths[i], its.destination);
      }
    }
    if (is_known) return;
    for (std::size_t i = 0; i < stream.paths.size(); ++i)  // so that it has hops at all
      note_last(flow, 0, walk(flow, stream.paths[i], &redundancy, scenario::on_hops(r_, redundancy, i), false));
  }

  /// What goes over the links of a ladder and comes to no listener: copies that end where one has passed before, at a
  /// relay that they have come by. No relay sends back by the port by which a frame came.
  void add_late_copies(std::uint32_t flow, const Path& path, const scenario::ResolvedRedundancy& redundancy,
                       const std::vector<scenario::OnHop>& hops) {
    const auto split = std::ranges::find(path, redundancy.split) + 1;
    std::vector<Path> open{Path(path.begin(), split)};
    const std::size_t common = open.front().size() - 1;
    while (!open.empty()) {
      const Path way = std::move(open.back());
      open.pop_back();
      for (auto link = redundancy.member_of_link.lower_bound({way.back(), 0});
           link != redundancy.member_of_link.end() && link->first.first == way.back(); ++link) {
        const std::uint32_t next = link->first.second;
        if (next == redundancy.merge || (way.size() > 1 && next == way[way.size() - 2])) continue;
        Path longer = way;
        longer.push_back(next);
        if (std::ranges::find(way, next) == way.end()) {
          open.push_back(std::move(longer));
          continue;
        }
        std::vector<scenario::OnHop> on(hops.begin(), hops.begin() + static_cast<std::ptrdiff_t>(common));
        for (std::size_t i = common; i + 1 < longer.size(); ++i)
          on.push_back({redundancy.member_of_link.at({longer[i], longer[i + 1]}), true});
        walk(flow, longer, &redundancy, on, false);
        graph_.flows[flow].comes_back = true;
      }
    }
  }

  /// In a station what is for the host passes the ingress, too. How meters and buckets stand there is not followed.
  void receive(std::uint32_t flow, const scenario::Path& path, models::AddressIndex address) {
    const std::uint32_t node = path.back();
    if (!r_.plan.nodes[node].ingress) return;
    const scenario::ResolvedStream& stream = r_.streams[graph_.flows[flow].stream.value];
    const models::StreamPlan& plan = r_.plan.streams[stream.index.value];
    const sim::Octets largest = graph_.flows[flow].payload.value_or(stream.largest_payload);
    Hop taken;
    taken.frame = models::frame_length(plan.headers + largest, plan.priority.has_value(), true);
    taken.shortest = taken.frame;
    taken.msdu = plan.headers + largest + models::r_tag;
    const models::PortConfig& config = r_.plan.port_configs[r_.plan.nodes[node].port_config];
    pass_ingress(taken, config, plan, node, port_in(r_.topology, path, path.size() - 1), address);
    const bool is_dropped_late = taken.ats && is_bounded(taken.ats->longest_residence);
    if (taken.policing.always_may_drop || taken.policing.meter || is_dropped_late || !taken.unsupported.empty())
      graph_.flows[flow].loss_at_host =
          "a stream filter may drop frames before the host of " + r_.plan.nodes[node].name;
  }

  void note_last(std::uint32_t flow, std::size_t listener, std::uint32_t hop) {
    std::vector<std::uint32_t>& all = graph_.flows[flow].last[listener];
    if (std::find(all.begin(), all.end(), hop) == all.end()) all.push_back(hop);
  }

  /// The hops of a rerouted flow at one port take the tokens of one scheduler.
  void share_schedulers(std::uint32_t flow) {
    for (const std::uint32_t h : graph_.flows[flow].hops)
      if (graph_.hops[h].ats) graph_.hops[h].ats->is_shared = true;
  }

  /// A number for the nodes from the talker to this one: hops behind different ones are told apart, and each counts
  /// every frame. Of a frame that may have taken any of them, and of the copies of a multicast that meet again while
  /// entries change, no more than that can come.
  std::size_t number_of_prefix(const Path& path, std::size_t at, const std::vector<bool>* is_bypassed) {
    Path prefix(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    for (std::size_t i = 0; i < prefix.size() && is_bypassed != nullptr; ++i)
      if ((*is_bypassed)[i]) prefix[i] |= bypassed;
    return prefixes_.try_emplace(std::move(prefix), first_prefix + prefixes_.size()).first->second;
  }

  /// Adds the hops of one path that are not there yet; the last one. `on` says what of a redundant stream goes over
  /// each of them.
  std::uint32_t walk(std::uint32_t flow, const Path& path, const scenario::ResolvedRedundancy* redundancy,
                     const std::vector<scenario::OnHop>& on, bool is_rerouted,
                     const std::vector<bool>* is_bypassed = nullptr) {
    const scenario::ResolvedStream& stream = r_.streams[graph_.flows[flow].stream.value];
    const models::StreamPlan& plan = r_.plan.streams[stream.index.value];
    const sim::Octets largest = graph_.flows[flow].payload.value_or(stream.largest_payload);
    const sim::Octets smallest = graph_.flows[flow].payload ? std::min(*graph_.flows[flow].payload, least_dds_message)
                                                            : smallest_payload(stream);
    std::uint32_t parent = nobody;
    bool tagged = plan.priority.has_value();
    bool is_copied = false;  // somewhere before
    Ps beyond = 0;
    for (std::size_t at = 0; at + 1 < path.size(); ++at) {
      if (is_bypassed != nullptr && (*is_bypassed)[at]) {
        beyond = sum(beyond, graph_.ports[port_at_.at({path[at], port_out(r_.topology, path, at)})].propagation);
        continue;
      }
      const std::uint16_t port_number = port_out(r_.topology, path, at);
      const scenario::OnHop here = redundancy != nullptr ? on[at] : scenario::OnHop{};
      const scenario::OnHop before = redundancy != nullptr && at > 0 ? on[at - 1] : scenario::OnHop{};
      const scenario::ResolvedRedundancy::Relay* const relay =
          redundancy != nullptr ? redundancy->relay_at(path[at]) : nullptr;
      const bool splits =
          redundancy != nullptr && (path[at] == redundancy->split || (relay != nullptr && relay->out.size() > 1));
      const std::uint32_t port = port_at_.at({path[at], port_number});
      const models::PortConfig& config = r_.plan.port_configs[graph_.ports[port].config];
      if (scenario::strips_tags(r_.topology, config, path[at], at == 0)) tagged = false;
      // In a ladder, too, what has come another way is another flow until all of it is one again.
      // And behind a merge whose gates are laid for each of the ways: what comes by the longer one does not come at any
      // time in between.
      const bool is_apart = is_copied && !here.member && come_apart_ && config.shaping.gates;
      const bool is_by_prefix = is_rerouted || (here.member && redundancy->is_ladder()) || is_apart;
      is_copied = is_copied || here.member;
      const std::size_t member = is_by_prefix  ? number_of_prefix(path, at, is_bypassed)
                                 : here.member ? *here.member + 1
                                               : 0;
      const auto [known, is_new] =
          hop_at_.try_emplace({member, path[at], port_number}, static_cast<std::uint32_t>(graph_.hops.size()));
      const std::uint32_t hop = known->second;
      if (is_new) {
        Hop made;
        made.flow = flow;
        made.beyond = beyond;
        made.port = port;
        made.frame = models::frame_length(plan.headers + largest, tagged, here.r_tagged);
        made.msdu = plan.headers + largest + (here.r_tagged ? models::r_tag : sim::Octets{0});
        made.shortest = models::frame_length(plan.headers + smallest, tagged, here.r_tagged);
        made.is_copied_here = splits;
        const models::AddressIndex address =
            before.member ? redundancy->members[*before.member].destination : plan.destination;
        const std::uint16_t in_port = at > 0 ? port_in(r_.topology, path, at) : std::uint16_t{0};
        made.lowest_class = made.highest_class =
            config.traffic_class_of_priority[at == 0 ? plan.priority_at_talker() : plan.priority.value_or(0)];
        if (at > 0)
          pass_ingress(made, config, plan, path[at], in_port, address);  // what a station sends itself does not come in
        made.headers_come_first = at > 0 && cuts_through(path[at], plan.priority.value_or(0));
        graph_.hops.push_back(std::move(made));
        graph_.ports[port].hops.push_back(hop);
        graph_.flows[flow].hops.push_back(hop);
      }
      if (parent != nobody) {
        std::vector<std::uint32_t>& parents = graph_.hops[hop].parents;
        if (std::find(parents.begin(), parents.end(), parent) == parents.end()) {
          parents.push_back(parent);
          graph_.hops[parent].children.push_back(hop);
        }
      }
      parent = hop;
      beyond = 0;
    }
    if (beyond > 0) {
      Ps& longest = graph_.flows[flow].beyond[parent];
      longest = std::max(longest, beyond);
    }
    return parent;
  }

  /// The frames of a trace differ.
  sim::Octets smallest_payload(const scenario::ResolvedStream& stream) const {
    sim::Octets smallest = stream.largest_payload;
    for (const models::TalkerPlan& talker : r_.plan.talkers) {
      const auto* const trace =
          talker.stream == stream.index ? std::get_if<models::TraceSchedule>(&talker.schedule) : nullptr;
      if (trace == nullptr) continue;
      for (const models::TraceSchedule::Entry& entry : trace->entries) smallest = std::min(smallest, entry.payload);
    }
    return smallest;
  }

  bool cuts_through(std::uint32_t node, models::Priority priority) const {
    for (auto at = port_at_.lower_bound({node, 0}); at != port_at_.end() && at->first.first == node; ++at) {
      const models::PortConfig& config = r_.plan.port_configs[graph_.ports[at->second].config];
      if (models::contains(config.cut_through, config.traffic_class_of_priority[priority])) return true;
    }
    return false;
  }

  /// What the ingress of the node makes of the flow, its class among it.
  void pass_ingress(Hop& hop, const models::PortConfig& config, const models::StreamPlan& plan, std::uint32_t node,
                    std::uint16_t in_port, models::AddressIndex address) {
    const models::Priority priority = plan.priority.value_or(0);
    const models::NodePlan& node_plan = r_.plan.nodes[node];
    if (!node_plan.ingress) return;
    const models::IngressConfig& ingress = r_.plan.ingress_configs[*node_plan.ingress];
    models::StreamHandle handle;
    for (const models::StreamIdentityEntry& entry : ingress.stream_identity_table) {
      const auto* const null = std::get_if<models::AddressIdentification>(&entry.function);
      if (null == nullptr) {
        hop.unsupported = "streams that are identified otherwise than by their address";
        return;
      }
      if (null->destination == address && handle.is_none()) handle = entry.stream;
    }
    if (node_plan.forwarding_jitter) hop.unsupported = "a forwarding delay with jitter behind filters";
    const auto filter = std::find_if(ingress.stream_filters.begin(), ingress.stream_filters.end(),
                                     [&](const models::StreamFilterConfig& f) {
                                       return (!f.stream_handle || (!handle.is_none() && *f.stream_handle == handle)) &&
                                              (!f.priority || *f.priority == priority);
                                     });
    if (filter == ingress.stream_filters.end()) return;
    hop.policing = policing_of(ingress, *filter, hop.msdu);
    if (hop.policing.meter)
      hop.policing.number = (static_cast<std::uint64_t>(node) + 1) << 32 | filter->flow_meter.value;
    if (!filter->stream_gate.is_none()) set_gate(hop, config, ingress.stream_gates[filter->stream_gate.value]);
    if (!filter->flow_meter.is_none()) set_meter(hop, ingress.flow_meters[filter->flow_meter.value].meter);
    if (filter->ats_scheduler.is_none()) return;
    set_ats(hop, ingress, filter->ats_scheduler.value, node, in_port, priority);
    hop.ats->is_minded = hop.lowest_class == hop.highest_class && config.shaping.is_timed(hop.highest_class);
  }

  static Policing policing_of(const models::IngressConfig& ingress, const models::StreamFilterConfig& filter,
                              sim::Octets msdu) {
    Policing made;
    made.is_there = true;
    made.always_may_drop = filter.maximum_sdu_size.count != 0 && msdu > filter.maximum_sdu_size;
    if (!filter.stream_gate.is_none()) {
      const models::StreamGateConfig& gate = ingress.stream_gates[filter.stream_gate.value];
      const auto may_drop = [](const models::StreamGateEntry& entry) {
        return !entry.open || entry.interval_octet_max;
      };
      const bool drops = gate.admin_control_list.empty()
                             ? !gate.admin_gate_open
                             : std::any_of(gate.admin_control_list.begin(), gate.admin_control_list.end(), may_drop);
      made.always_may_drop = made.always_may_drop || drops;
    }
    if (filter.flow_meter.is_none()) return made;
    const models::FlowMeterConfig& meter = ingress.flow_meters[filter.flow_meter.value].meter;
    const auto users = std::count_if(ingress.stream_filters.begin(), ingress.stream_filters.end(),
                                     [&](const models::StreamFilterConfig& other) {
                                       return !other.flow_meter.is_none() && other.flow_meter == filter.flow_meter;
                                     });
    // What keeps to the committed rate is green. A frame that an earlier meter has marked is not.
    if (users > 1 || !filter.stream_handle || meter.color_mode == models::ColorMode::color_aware)
      made.always_may_drop = true;
    made.meter = TokenMeter{std::int64_t{8} * meter.committed_burst_size.count,
                            static_cast<std::int64_t>(meter.committed_information_rate.bits_per_second)};
    return made;
  }

  static void set_gate(Hop& hop, const models::PortConfig& config, const models::StreamGateConfig& gate) {
    models::ClassSet classes = 0;
    const auto note = [&](const std::optional<models::Priority>& ipv) {
      classes = models::with(classes, ipv ? config.traffic_class_of_priority[*ipv] : hop.highest_class);
    };
    if (gate.admin_control_list.empty()) note(gate.admin_ipv);
    for (const models::StreamGateEntry& entry : gate.admin_control_list)
      if (entry.open) note(entry.ipv);
    if (classes == 0) return;
    TrafficClass lowest = 7;
    for (TrafficClass q = 8; q-- > 0;)
      if (models::contains(classes, q)) lowest = q;
    hop.highest_class = models::highest_class(classes);
    hop.lowest_class = lowest;
    hop.uses_cqf = gate.name == "cqf";
    if (lowest != hop.highest_class && gate.name != "cqf")
      hop.unsupported = "a stream gate that spreads a stream over several classes";
  }

  static void set_meter(Hop& hop, const models::FlowMeterConfig& meter) {
    const bool yellow_passes = !meter.drop_on_yellow;
    const std::int64_t burst =
        8 * (std::int64_t{meter.committed_burst_size.count} + (yellow_passes ? meter.excess_burst_size.count : 0));
    const auto rate = static_cast<std::int64_t>(meter.committed_information_rate.bits_per_second +
                                                (yellow_passes ? meter.excess_information_rate.bits_per_second : 0));
    // Of short frames more pass.
    hop.metered = pattern_of_token_bucket(std::int64_t{8} * std::min(hop.shortest, hop.frame).count, burst, rate);
  }

  void set_ats(Hop& hop, const models::IngressConfig& ingress, std::uint32_t number, std::uint32_t node,
               std::uint16_t in_port, models::Priority priority) {
    const models::AtsSchedulerConfig& scheduler = ingress.ats_schedulers[number];
    const bool is_named = !scheduler.group.is_none();
    AtsHold hold;
    hold.bits = std::int64_t{8} * (scheduler.media_overhead ? models::wire_length(hop.frame) : hop.frame).count;
    hold.burst_bits = std::int64_t{8} * scheduler.committed_burst_size.count;
    hold.rate = static_cast<std::int64_t>(scheduler.committed_information_rate.bits_per_second);
    const sim::Octets shortest = std::min(hop.shortest, hop.frame);
    hold.shaped = pattern_of_token_bucket(
        std::int64_t{8} * (scheduler.media_overhead ? models::wire_length(shortest) : shortest).count, hold.burst_bits,
        hold.rate);
    const std::uint64_t within =
        is_named ? 0x100000ULL + scheduler.group.value : in_port * 8ULL + ingress.traffic_class_of_priority[priority];
    hold.group = (static_cast<std::uint64_t>(node) + 1) << 32 | within;
    const sim::Duration residence =
        is_named ? ingress.ats_groups[scheduler.group.value].maximum_residence_time : ingress.maximum_residence_time;
    if (residence != sim::Duration::max()) hold.longest_residence = residence.ps();
    hold.is_shared = shares_scheduler(node, number);
    hold.scheduler = (static_cast<std::uint64_t>(node) + 1) << 32 | number;
    hop.ats = hold;
  }

  bool shares_scheduler(std::uint32_t node, std::uint32_t number) {
    const models::IngressConfig& ingress = r_.plan.ingress_configs[*r_.plan.nodes[node].ingress];
    std::size_t users = 0;
    for (const models::StreamFilterConfig& filter : ingress.stream_filters)
      if (!filter.ats_scheduler.is_none() && filter.ats_scheduler.value == number)
        users += filter.stream_handle ? 1 : 2;
    return users > 1;
  }

  const scenario::Resolved& r_;
  FlowGraph& graph_;
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> port_at_;
  std::map<std::uint32_t, const scenario::ResolvedRedundancy*> redundancy_;
  std::map<std::tuple<std::size_t, std::uint32_t, std::uint16_t>, std::uint32_t>
      hop_at_;                            // by member or prefix, node, port
  std::map<Path, std::size_t> prefixes_;  // of a flow that may go several ways
  bool come_apart_ = false;               // its copies come to the merge one after the other
  bool has_bypass_ = false;
};

}  // namespace

void add_routes(const scenario::Resolved& resolved, FlowGraph& graph) {
  RouteMaker maker(resolved, graph);
  for (std::uint32_t flow = 0; flow < graph.flows.size(); ++flow) maker.make(flow);
  maker.note_shared_tokens();
}

}  // namespace takt::analysis
