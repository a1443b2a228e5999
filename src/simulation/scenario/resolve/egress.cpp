// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/egress.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "scenario/resolve/control_list.hpp"
#include "scenario/resolve/port_configs.hpp"

namespace takt::scenario {
namespace {

const std::vector<Egress>& egress_entries_of(const TopologyNode& node) { return ports_of(node.description).egress; }

class EgressResolver {
 public:
  EgressResolver(Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    for (std::uint32_t n = 0; n < r_.topology.nodes.size(); ++n) check_neighbours(n);
    for (models::LinkPlan& link : r_.plan.links) {
      configure(link.a, link.b, link.rate);
      configure(link.b, link.a, link.rate);
    }
  }

 private:
  void check_neighbours(std::uint32_t n) {
    std::set<std::string> seen;
    for (const Egress& egress : egress_entries_of(r_.topology.nodes[n])) {
      const std::string to = egress.to.value_or("");
      if (!seen.insert(to).second)
        diagnostics_.error(
            egress.where.place(), "a port configured twice",
            {egress.to ? json::quote(to) + " a second time" : "all ports a second time", "one entry for a port"});
      if (!egress.to) continue;
      const auto is_meant = [&](const Neighbour& neighbour) {
        return r_.topology.is_named(to, neighbour.node, neighbour.their_port);
      };
      if (std::ranges::none_of(r_.topology.neighbours[n], is_meant))
        report_no_neighbour(r_.topology, to, r_.topology.nodes[n].name, egress.where.at("to"), diagnostics_);
    }
  }

  void configure(models::LinkPlan::End& end, const models::LinkPlan::End& peer, DataRate rate) {
    const TopologyNode& node = r_.topology.nodes[end.node.value];
    // An entry for the link goes before one for the neighbour, and that before one for all.
    const Egress* chosen = nullptr;
    for (const Egress& egress : egress_entries_of(node)) {
      const bool is_meant = !egress.to || r_.topology.is_named(*egress.to, peer.node.value, peer.port);
      if (is_meant && (chosen == nullptr || egress.to.value_or("").size() > chosen->to.value_or("").size()))
        chosen = &egress;
    }
    if (chosen == nullptr) return;
    models::PortConfig config = r_.plan.port_configs[r_.plan.nodes[end.node.value].port_config];
    config.shaping = shaping_of(*chosen, rate);
    if (chosen->preemption) config.preemption = preemption_of(*chosen->preemption);
    config.cut_through = set_of(chosen->cut_through);
    config.untagged = chosen->untagged;
    check_combinations(*chosen, config, node, r_.topology.nodes[peer.node.value]);
    end.port_config = port_config_index(r_.plan, config);
  }

  static models::ClassSet set_of(const std::vector<std::uint8_t>& classes) {
    models::ClassSet set = 0;
    for (const std::uint8_t q : classes)
      if (q < models::traffic_class_count) set = models::with(set, q);  // the table has refused others
    return set;
  }

  static models::PreemptionConfig preemption_of(const Preemption& preemption) {
    return {set_of(preemption.preemptable),
            models::AddFragSize(static_cast<std::uint8_t>(preemption.add_frag_size & 3u)), preemption.hold_advance,
            preemption.release_advance};
  }

  /// Whether a gate list or a shaper could not be read, so that they are not compared.
  bool is_refused(const std::optional<Gates>& gates, const Shaper& shaper) const {
    return (gates && diagnostics_.is_refused(gates->where.place())) || diagnostics_.is_refused(shaper.where.place()) ||
           (!shaper.where.is_known() && diagnostics_.has_errors());
  }

  static std::string classes(models::ClassSet set) {
    std::string text = "class";
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
      if (models::contains(set, q)) text += " " + std::to_string(q);
    return text;
  }

  /// The classes that share bandwidth: each once, with nothing else that selects, and all of the port.
  void check_shares(const Egress& egress, const models::PortConfig& config, models::ClassSet ats) {
    if (egress.ets.empty()) return;
    const bool is_read = !diagnostics_.is_refused(egress.where.at("ets"));
    models::ClassSet shared = 0;
    unsigned sum = 0;
    for (const Share& share : egress.ets) {
      const models::TrafficClass q = share.traffic_class & 7u;
      const bool is_shaped = std::any_of(egress.shapers.begin(), egress.shapers.end(),
                                         [q](const Shaper& shaper) { return shaper.traffic_class == q; });
      if (models::contains(shared, q))
        diagnostics_.error_unless(!is_read, share.where.at("class"), "a class with two shares",
                                  {"class " + std::to_string(q) + " a second time", "one share for a class"});
      if (is_shaped || models::contains(ats, q))
        diagnostics_.error_unless(
            !is_read, share.where.at("class"), "two transmission selection algorithms",
            {classes(models::only(q)) + " with ETS and " + (is_shaped ? "a credit-based shaper" : "ATS"),
             "one for a class"});
      shared = models::with(shared, q);
      sum += share.bandwidth;
    }
    if (sum != 100)
      diagnostics_.error_unless(!is_read, egress.where.at("ets"), "shares that are not all of the bandwidth",
                                {std::to_string(sum) + " percent in all", "percentages that sum to 100"});
    const auto preemptable =
        static_cast<models::ClassSet>(config.preemption ? config.preemption->preemptable & shared : 0);
    if (preemptable != 0 && preemptable != shared)
      diagnostics_.error_unless(!is_read || diagnostics_.is_refused(egress.preemption->where.place()),
                                egress.where.at("ets"),
                                "express classes that share bandwidth with preemptable ones, which they cut",
                                {classes(preemptable) + " preemptable, " +
                                     classes(static_cast<models::ClassSet>(shared & ~preemptable)) + " express",
                                 "classes that are all express or all preemptable"});
  }

  /// What cannot be, with the reason.
  void check_combinations(const Egress& egress, const models::PortConfig& config, const TopologyNode& node,
                          const TopologyNode& peer) {
    if (!reported_.insert(&egress).second && !egress.untagged) return;  // once for all ports that it configures
    const auto refuse = [&](std::string_view key, const std::string& what, const std::string& found,
                            const std::string& expected) {
      diagnostics_.error(egress.where.at(key), what, {found, expected});
    };
    if (egress.untagged && peer.forwards())
      refuse("untagged", "tags taken off before a switch",
             "a port to " + json::quote(peer.name) + ", which would forget the priorities", "ports to hosts");
    if (egress.untagged && config.cut_through != 0)
      refuse("cut_through", "cut-through where tags are taken off", "\"untagged\" too: such frames are stored",
             "one of them");
    if (!node.forwards() && config.cut_through != 0)
      refuse("cut_through", "cut-through in a host", "a host, which forwards nothing", "a switch");
    const EndStation* const talker = end_station_of(node.description);
    if (!node.forwards() && !egress.ats.empty() && (talker == nullptr || talker->ats.empty()) &&
        !diagnostics_.is_refused(node.where.at("ats")))
      refuse("ats", "ATS in a host", "a host, whose frames meet no ATS scheduler",
             "schedulers in its \"ats\", or \"launch\" of a stream");
    if (const models::ClassSet both =
            config.preemption ? static_cast<models::ClassSet>(config.preemption->preemptable & config.cut_through)
                              : models::ClassSet{0};
        both != 0)
      refuse("cut_through", "cut-through of a preemptable class",
             classes(both) + ", whose frames may be cut while they come", "express classes");
    const models::ClassSet ats = set_of(egress.ats);
    if (const auto both = static_cast<models::ClassSet>(ats & config.cut_through); both != 0)
      refuse("cut_through", "cut-through of a class with ATS",
             classes(both) + ", whose eligibility times count from the last bit", "classes without ATS");
    check_shares(egress, config, ats);
    models::ClassSet shaped = 0;
    for (const Shaper& shaper : egress.shapers) shaped = models::with(shaped, shaper.traffic_class & 7u);
    if (const auto both = static_cast<models::ClassSet>(ats & shaped); both != 0)
      refuse("ats", "two transmission selection algorithms", classes(both) + " with a credit-based shaper and ATS",
             "one for a class");
    if (!config.shaping.gates || config.shaping.gates->admin_control_list.empty() ||
        config.shaping.gates->admin_cycle_time <= Duration())
      return;
    const models::GateControlList list(config.shaping.gates->admin_control_list,
                                       config.shaping.gates->admin_cycle_time);
    const auto asks_for = [&](MacOperation operation) {
      return std::any_of(egress.gates->entries.begin(), egress.gates->entries.end(),
                         [&](const GateEntry& entry) { return entry.mac == operation; });
    };
    if (config.preemption && egress.gates && asks_for(MacOperation::hold) && !asks_for(MacOperation::release))
      if (!diagnostics_.is_refused(egress.gates->where.place()))
        refuse("gates", "preemptable frames that are never released", "an entry that holds and none that releases",
               "an entry with \"mac\": \"release\"");
    for (std::size_t i = 0; i < egress.shapers.size(); ++i) {
      const models::TrafficClass q = egress.shapers[i].traffic_class & 7u;
      if (list.open_share(q).open == Duration())
        diagnostics_.error_unless(is_refused(egress.gates, egress.shapers[i]), egress.shapers[i].where.at("class"),
                                  "a shaper behind a gate that never opens",
                                  {"class " + std::to_string(q), "a gate list that opens the class"});
    }
  }

  models::ShapingConfig shaping_of(const Egress& egress, DataRate rate) {
    models::ShapingConfig config;
    if (egress.gates) config.gates = gate_config_of(*egress.gates, diagnostics_);
    std::set<std::uint8_t> shaped;
    for (const Shaper& shaper : egress.shapers) {
      if (!shaped.insert(shaper.traffic_class).second)
        diagnostics_.error(
            shaper.where.at("class"), "a class shaped twice",
            {"class " + std::to_string(shaper.traffic_class) + " a second time", "one shaper for a class"});
      if (shaper.idle_slope > rate)
        diagnostics_.error_unless(diagnostics_.is_refused(r_.scenario.network.where.at("links")),
                                  shaper.where.at("idle_slope"), "a shaper faster than its link",
                                  {json::to_text(shaper.idle_slope), "at most " + json::to_text(rate)});
      else
        config.selection[shaper.traffic_class] = models::CreditBased{shaper.idle_slope, shaper.of == SlopeOf::cycle};
    }
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
      if (models::contains(set_of(egress.ats), q)) config.selection[q] = models::TimeBased{};
    for (const Share& share : egress.ets)
      config.selection[share.traffic_class & 7u] = models::EnhancedTransmissionSelection{share.bandwidth};
    for (const MaxSdu& max_sdu : egress.max_sdu) config.queue_max_sdu[max_sdu.traffic_class] = max_sdu.size;
    return config;
  }

  Resolved& r_;
  json::Diagnostics& diagnostics_;
  std::set<const Egress*> reported_;
};

}  // namespace

models::GateConfig gate_config_of(const Gates& gates, json::Diagnostics& diagnostics) {
  models::GateConfig config;
  const std::optional<Duration> sum = length_of_list(gates, diagnostics);
  if (!sum) return config;
  for (const GateEntry& entry : gates.entries) {
    models::GateStates open = 0;
    for (const std::uint8_t q : entry.open) open = static_cast<models::GateStates>(open | 1u << (q & 7u));
    constexpr models::GateOperation operations[] = {models::GateOperation::set_gate_states,
                                                    models::GateOperation::set_and_hold_mac,
                                                    models::GateOperation::set_and_release_mac};
    config.admin_control_list.push_back({operations[static_cast<std::size_t>(entry.mac)], open, entry.interval});
  }
  config.admin_cycle_time = gates.cycle.value_or(*sum);
  if (config.admin_cycle_time < *sum)
    diagnostics.warning(
        gates.where.at("cycle"), "the end of the gate list is cut off",
        {"entries of " + json::to_text(*sum) + " in a cycle of " + json::to_text(config.admin_cycle_time),
         "entries that fit into the cycle"});
  config.admin_cycle_time_extension = gates.extension;
  config.admin_base_time = sim::LocalTime() + gates.base_time;
  config.is_running = gates.running;
  check_running(gates, diagnostics);
  return config;
}

void resolve_egress(Resolved& resolved, json::Diagnostics& diagnostics) { EgressResolver(resolved, diagnostics).run(); }

void add_launch_classes(Resolved& r, json::Diagnostics& diagnostics) {
  std::map<std::uint32_t, std::map<std::uint8_t, models::StreamIndex>>
      priorities;  // of frames with a launch time, by talker
  for (const models::TalkerPlan& talker : r.plan.talkers) {
    const models::StreamPlan& stream = r.plan.streams[talker.stream.value];
    if (talker.launch) priorities[stream.talker.value].try_emplace(stream.priority_at_talker(), talker.stream);
  }
  if (priorities.empty()) return;
  for (models::LinkPlan& link : r.plan.links) {
    for (models::LinkPlan::End* end : {&link.a, &link.b}) {
      const auto found = priorities.find(end->node.value);
      if (found == priorities.end()) continue;
      models::PortConfig config = port_config_of(r.plan, *end);
      for (const auto& [priority, stream] : found->second) {
        const models::TrafficClass q = config.traffic_class_of_priority[priority];
        models::SelectionAlgorithm& selection = config.shaping.selection[q];
        const json::Place place = r.streams[stream.value].where.at("launch");
        if (config.shaping.is_shared(q))
          diagnostics.error_unless(
              diagnostics.is_refused(place), place, "two transmission selection algorithms",
              {"class " + std::to_string(q) + " of " + json::quote(r.topology.nodes[end->node.value].name) +
                   " with ETS and launch times",
               "one for a class"});
        if (auto* const shaper = std::get_if<models::CreditBased>(&selection))
          shaper->has_launch_times = true;
        else
          selection = models::TimeBased{};
      }
      end->port_config = port_config_index(r.plan, config);
    }
  }
}

bool slope_is_possible(const models::CreditBased& shaper, models::TrafficClass q, const models::GateConfig& gates,
                       DataRate rate) {
  if (!shaper.of_whole_cycle || gates.admin_control_list.empty() || gates.admin_cycle_time <= Duration()) return true;
  const models::OpenShare share =
      models::GateControlList(gates.admin_control_list, gates.admin_cycle_time).open_share(q);
  return static_cast<sim::int128>(shaper.idle_slope.bits_per_second) * share.cycle.ps() <=
         static_cast<sim::int128>(rate.bits_per_second) * share.open.ps();
}

void check_slopes(const Resolved& r, json::Diagnostics& diagnostics) {
  std::set<std::pair<const Shaper*, std::uint64_t>> reported;
  for (const models::LinkPlan& link : r.plan.links) {
    for (const auto& [end, peer] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      if (!end->port_config) continue;
      const models::ShapingConfig& config = r.plan.port_configs[*end->port_config].shaping;
      if (!config.gates) continue;
      for (const Egress& egress : egress_entries_of(r.topology.nodes[end->node.value])) {
        if (egress.to && !r.topology.is_named(*egress.to, peer->node.value, peer->port)) continue;
        for (const Shaper& shaper : egress.shapers) {
          const models::TrafficClass q = shaper.traffic_class & 7u;
          if (!config.shaper_of(q) || slope_is_possible(*config.shaper_of(q), q, *config.gates, link.rate) ||
              !reported.insert({&shaper, link.rate.bits_per_second}).second)
            continue;
          const bool is_refused = (egress.gates && diagnostics.is_refused(egress.gates->where.place())) ||
                                  diagnostics.is_refused(shaper.where.place()) ||
                                  (!shaper.where.is_known() && diagnostics.has_errors()) ||
                                  diagnostics.is_refused(r.scenario.network.where.at("links"));
          diagnostics.error_unless(
              is_refused, shaper.where.at("idle_slope"), "a shaper faster than its link while its gate is open",
              {json::to_text(shaper.idle_slope) + " of the whole cycle in the part of it for which the gate of class " +
                   std::to_string(q) + " is open",
               "at most " + json::to_text(link.rate) + " then"});
        }
      }
    }
  }
}

void check_cut_through(const Resolved& r, json::Diagnostics& diagnostics) {
  for (const ResolvedRedundancy& redundancy : r.redundancies) {
    std::vector<std::uint32_t> merges;
    for (const ResolvedRedundancy::Relay& relay : redundancy.relays)
      if (relay.in.size() > 1) merges.push_back(relay.node);
    if (!redundancy.is_ladder()) merges.push_back(redundancy.merge);
    for (const std::uint32_t node : merges) {
      if (node == redundancy.merge && redundancy.merges_in_host) continue;  // hosts get whole frames
      const TopologyNode& merge = r.topology.nodes[node];
      for (const Egress& egress : egress_entries_of(merge))
        if (!egress.cut_through.empty())
          diagnostics.error(egress.where.at("cut_through"), "cut-through where a redundant stream is merged",
                            {json::quote(merge.name) + ", where a damaged frame would take the place of its good copy",
                             "a switch that merges nothing"});
    }
  }
}

}  // namespace takt::scenario
