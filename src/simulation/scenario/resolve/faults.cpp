// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/faults.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "json/suggest.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/known_names.hpp"
#include "scenario/resolve/rerouting.hpp"

namespace takt::scenario {
namespace {

models::Probability probability(double value) {
  return models::Probability::from_multiple(static_cast<std::uint64_t>(value * 0x1p63));
}

class FaultResolver {
 public:
  FaultResolver(const Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  FaultPlan run() {
    for (const Fault& fault : r_.scenario.faults) std::visit([this](const auto& each) { add(each); }, fault);
    if (r_.scenario.rerouting) reroute();
    return std::move(made_);
  }

 private:
  void reroute() {
    if (r_.scenario.faults.empty() && !diagnostics_.is_refused(r_.scenario.where.at("faults")))
      diagnostics_.warning(r_.scenario.rerouting->where.place(), "nothing to reroute for",
                           {"no \"faults\"", "a fault that takes a link down"});
    std::stable_sort(outages_.begin(), outages_.end(), [](const Outage& a, const Outage& b) { return a.at < b.at; });
    if (diagnostics_.has_errors()) return;
    for (ResolvedAction& action : plan_rerouting(r_, outages_, r_.scenario.rerouting->delay))
      made_.actions.push_back(std::move(action));
  }

  template <class F>
  sim::TrueTime begin_of(const F& fault) {
    if (r_.scenario.duration > Duration() && fault.at > r_.scenario.duration)
      diagnostics_.warning(fault.where.at("at"), "after the end of the simulation",
                           {json::to_text(fault.at), "at most " + json::to_text(r_.scenario.duration)});
    return sim::TrueTime() + fault.at;
  }
  template <class F>
  std::optional<sim::TrueTime> end_of(const F& fault) {
    if (!fault.lasts) return std::nullopt;
    return (sim::TrueTime() + fault.at).plus_saturated(*fault.lasts);
  }

  /// What was refused of them is not compared.
  template <class F>
  bool has_times(const F& fault) const {
    return !diagnostics_.is_refused(fault.where.at("at")) && !diagnostics_.is_refused(fault.where.at("lasts"));
  }

  struct End {
    std::uint32_t node = 0;
    std::optional<std::uint16_t> port;
  };
  std::optional<End> end_named(const std::string& text, const json::Place& place) {
    const std::size_t colon = text.find(':');
    const std::string_view name = std::string_view(text).substr(0, colon);
    const auto node = r_.topology.find(name);
    if (!node) {
      report_unknown_node(r_.topology, name, place, "the name of a node", diagnostics_);
      return std::nullopt;
    }
    End end{*node, std::nullopt};
    if (colon != std::string::npos) {
      std::uint16_t port = 0;
      const char* const last = text.data() + text.size();
      const auto [read, error] = std::from_chars(text.data() + colon + 1, last, port);
      if (error != std::errc() || read != last) {
        diagnostics_.error(place, "not a port", {json::quote(text), "\"node:number\""});
        return std::nullopt;
      }
      end.port = port;
    }
    return end;
  }

  /// The link between two ends; a mistake is reported.
  std::optional<std::uint32_t> link_named(const std::vector<std::string>& ends, const json::Source& where) {
    if (ends.size() != 2) return std::nullopt;  // the table has reported it
    const auto a = end_named(ends[0], where.at("link", 0));
    const auto b = end_named(ends[1], where.at("link", 1));
    if (!a || !b) return std::nullopt;
    const auto is = [](const models::LinkPlan::End& end, const End& wanted) {
      return end.node.value == wanted.node && (!wanted.port || *wanted.port == end.port);
    };
    for (std::uint32_t l = 0; l < r_.plan.links.size(); ++l) {
      const models::LinkPlan& link = r_.plan.links[l];
      if ((is(link.a, *a) && is(link.b, *b)) || (is(link.a, *b) && is(link.b, *a))) return l;
    }
    diagnostics_.error_unless(
        !r_.topology.has_all_links, where.at("link"), "no link",
        {"none between " + json::quote(ends[0]) + " and " + json::quote(ends[1]), "two nodes that a link joins"});
    return std::nullopt;
  }

  std::optional<std::uint32_t> node_named(const std::string& name, const json::Place& place) {
    const auto node = r_.topology.find(name);
    if (!node) report_unknown_node(r_.topology, name, place, "the name of a node", diagnostics_);
    return node;
  }

  void add(const LinkDown& fault) {
    const auto link = link_named(fault.link, fault.where);
    const sim::TrueTime begin = begin_of(fault);
    if (!link) return;
    made_.failing_links.insert(*link);
    made_.actions.push_back({begin, ResolvedLink{*link, false}});
    outages_.push_back({begin, {*link}, false});
    if (const auto end = end_of(fault)) {
      made_.actions.push_back({*end, ResolvedLink{*link, true}});
      outages_.push_back({*end, {*link}, true});
    }
  }

  void add(const FrameErrors& fault) {
    const auto link = link_named(fault.link, fault.where);
    models::Impairment impairment;
    if (fault.loss) impairment.loss = models::IndependentLoss{probability(*fault.loss)};
    if (fault.burst_loss)
      impairment.loss = models::GilbertElliottLoss{
          probability(fault.burst_loss->good_to_bad), probability(fault.burst_loss->bad_to_good),
          probability(fault.burst_loss->loss_in_good), probability(fault.burst_loss->loss_in_bad)};
    if (fault.corruption) impairment.corruption = models::Corruption::per_frame(probability(*fault.corruption));
    if (fault.bit_error_rate) impairment.corruption = models::Corruption::per_bit(probability(*fault.bit_error_rate));
    if (fault.duplication) impairment.duplication = models::Duplication{probability(*fault.duplication)};
    if (!impairment.loss && !impairment.corruption && !impairment.duplication)
      diagnostics_.error_unless(
          diagnostics_.is_refused(fault.where.place()), fault.where.place(), "nothing goes wrong",
          {"no probability", "\"loss\", \"burst_loss\", \"corruption\", \"bit_error_rate\" or \"duplication\""});
    impairment.from = begin_of(fault);
    impairment.until = end_of(fault).value_or(sim::TrueTime::never());
    if (!link) return;
    const models::LinkPlan& plan = r_.plan.links[*link];
    made_.failing_links.insert(*link);
    std::optional<bool> only_from_a;
    if (fault.towards) {
      const auto to = node_named(*fault.towards, fault.where.at("towards"));
      if (!to) return;
      if (*to != plan.a.node.value && *to != plan.b.node.value) {
        diagnostics_.error(
            fault.where.at("towards"), "not an end of the link",
            {json::quote(*fault.towards), json::quote(fault.link[0]) + " or " + json::quote(fault.link[1])});
        return;
      }
      only_from_a = *to == plan.b.node.value;
    }
    if (only_from_a.value_or(true)) made_.impairments.push_back({*link, true, impairment});
    if (!only_from_a.value_or(false)) made_.impairments.push_back({*link, false, impairment});
  }

  void add(const Crash& fault) {
    const auto node = node_named(fault.node, fault.where.at("node"));
    const sim::TrueTime begin = begin_of(fault);
    if (!node) return;
    const models::NodeIndex index{*node};
    std::vector<std::uint32_t> links;
    for (std::uint32_t l = 0; l < r_.plan.links.size(); ++l) {
      const models::LinkPlan& link = r_.plan.links[l];
      if (link.a.node != index && link.b.node != index) continue;
      made_.failing_links.insert(l);
      links.push_back(l);
    }
    made_.actions.push_back({begin, ResolvedNode{index, false}});
    outages_.push_back({begin, links, false});
    const auto* const station = std::get_if<StationNode>(&r_.topology.nodes[*node].description.get());
    std::optional<sim::TrueTime> end = end_of(fault);
    if (station != nullptr && station->bypass) end = bypass(*station, index, begin, end);
    if (end) {
      made_.actions.push_back({*end, ResolvedNode{index, true}});
      outages_.push_back({*end, links, true});
    }
  }

  /// The relay joins the cables once it has switched, and the station is back when it has switched again.
  std::optional<sim::TrueTime> bypass(const StationNode& station, models::NodeIndex node, sim::TrueTime begin,
                                      std::optional<sim::TrueTime> end) {
    check_bypass(station, node);
    const sim::TrueTime joined = begin.plus_saturated(station.bypass_switching);
    if (end && *end <= joined) return end;
    made_.actions.push_back({joined, ResolvedBypass{node, true}});
    if (!end) return std::nullopt;
    made_.actions.push_back({*end, ResolvedBypass{node, false}});
    return end->plus_saturated(station.bypass_switching);
  }

  void check_bypass(const StationNode& station, models::NodeIndex node) {
    if (!checked_bypasses_.insert(node.value).second) return;
    const json::Place place = station.where.at("bypass");
    std::vector<const models::LinkPlan*> cables;
    Duration slowest;
    for (const models::LinkPlan& link : r_.plan.links) {
      slowest = slowest + link.delay;
      for (const models::LinkPlan::End* const end : {&link.a, &link.b})
        if (end->node == node && end->port < 2) cables.push_back(&link);
    }
    if (cables.size() != 2) {
      diagnostics_.error_unless(
          !r_.topology.has_all_links, place, "a bypass of one cable",
          {"no links at both port 0 and port 1 of " + json::quote(r_.topology.nodes[node.value].name), "two links"});
      return;
    }
    if (cables[0]->rate != cables[1]->rate)
      diagnostics_.error(
          place, "a bypass between links of different rates",
          {json::to_text(cables[0]->rate) + " and " + json::to_text(cables[1]->rate), "links of one rate"});
    // A frame that was on its way to or in a node has come to its end before another link takes its place.
    Duration in_nodes;
    for (const models::NodePlan& each : r_.plan.nodes) {
      const sim::Distribution& receive = r_.plan.os_latencies[each.os_latency].receive;
      in_nodes =
          std::max(in_nodes, std::max(each.forwarding_delay, receive.is_constant() ? receive.greatest() : Duration()));
    }
    if (station.bypass_switching <= slowest + in_nodes)
      diagnostics_.error(station.where.at("bypass_switching"), "a bypass that switches faster than frames pass",
                         {json::to_text(station.bypass_switching),
                          "more than " + json::to_text(slowest + in_nodes) + ", the cables and the slowest node"});
    for (const Fault& fault : r_.scenario.faults) {
      const auto* const errors = std::get_if<FrameErrors>(&fault);
      if (errors == nullptr || errors->link.size() != 2) continue;
      const bool is_beside = std::ranges::any_of(errors->link, [&](const std::string& end) {
        return end.substr(0, end.find(':')) == r_.topology.nodes[node.value].name;
      });
      if (is_beside)
        diagnostics_.error(
            errors->where.at("link"), "frame errors on a cable that a bypass joins to another",
            {"a link of " + json::quote(r_.topology.nodes[node.value].name), "another link, or no \"bypass\""});
    }
  }

  void add(const Babble& fault) {
    const auto found = std::find_if(r_.streams.begin(), r_.streams.end(), [&](const ResolvedStream& s) {
      return r_.plan.streams[s.index.value].name == fault.stream;
    });
    const sim::TrueTime begin = begin_of(fault);
    if (found == r_.streams.end() || found->of_program) {
      std::vector<std::string_view> names;
      for (const Stream& stream : r_.scenario.streams) names.push_back(stream.name);
      const bool is_refused = StreamNames(r_, diagnostics_).may_be(fault.stream) && (found == r_.streams.end());
      diagnostics_.error_unless(
          is_refused, fault.where.at("stream"), "unknown stream",
          {json::quote(fault.stream), "the name of an entry of \"streams\"", json::suggest(fault.stream, names)});
      return;
    }
    const models::StreamPlan& plan = r_.plan.streams[found->index.value];
    Duration every = fault.every.value_or(Duration());
    if (!fault.every) {
      const Octets wire =
          models::wire_length(models::frame_length(plan.headers + found->largest_payload, plan.priority.has_value()));
      for (const models::LinkPlan& link : r_.plan.links)
        if (link.a.node == plan.talker || link.b.node == plan.talker) every = link.rate.octet_time() * wire.count;
      if (every == Duration()) return;  // a talker without a link, reported elsewhere
    }
    models::TalkerPlan talker{found->index, found->largest_payload,
                              models::PeriodicSchedule{begin.since_start(), every, {}}};
    if (const auto end = end_of(fault)) talker.until = sim::LocalTime() + end->since_start();
    talker.babbles = true;
    const sim::TrueTime over = end_of(fault).value_or(sim::TrueTime::never());
    for (const Babbling& other : has_times(fault) ? babbling_ : std::vector<Babbling>{})
      if (other.stream == fault.stream && begin < other.end && other.begin < over)
        diagnostics_.error(fault.where.place(), "a talker that babbles twice at a time",
                           {json::quote(fault.stream) + ", which babbles from " +
                                json::to_text(other.begin.since_start()) + " on already",
                            "times that do not overlap"});
    if (has_times(fault)) babbling_.push_back({fault.stream, begin, over});
    talker.name = plan.name + "/babble";
    made_.babblers.push_back(std::move(talker));
  }

  void add(const StuckGate& fault) {
    const auto node = node_named(fault.node, fault.where.at("node"));
    const sim::TrueTime begin = begin_of(fault);
    if (!node) return;
    bool found = false;
    for (const Neighbour& neighbour : r_.topology.neighbours[*node]) {
      if (fault.to && !r_.topology.is_named(*fault.to, neighbour.node, neighbour.their_port)) continue;
      found = true;
      const models::NodeIndex index{*node};
      made_.stuck_ports.insert({*node, neighbour.port});
      refuse_overlap(fault, {*node, neighbour.port, fault.traffic_class}, begin);
      made_.actions.push_back(
          {begin, ResolvedStuckGate{index, neighbour.port, fault.traffic_class, fault.state == GateFault::open}});
      if (const auto end = end_of(fault))
        made_.actions.push_back({*end, ResolvedStuckGate{index, neighbour.port, fault.traffic_class, std::nullopt}});
    }
    if (!found)
      report_no_neighbour(r_.topology, fault.to.value_or(fault.node), fault.node,
                          fault.where.at(fault.to ? "to" : "node"), diagnostics_);
  }

  void add(const ClockFault& fault) {
    const auto node = node_named(fault.node, fault.where.at("node"));
    const sim::TrueTime begin = begin_of(fault);
    if (!node) return;
    if (!r_.plan.nodes[*node].clock) {
      diagnostics_.error_unless(
          diagnostics_.is_refused(r_.scenario.where.at("clocks")), fault.where.at("node"),
          "a clock fault without a clock",
          {json::quote(fault.node) + ", which knows true time", "a node with a clock of its own, see \"clocks\""});
      return;
    }
    made_.actions.push_back({begin, ResolvedClockFault{models::NodeIndex{*node}, fault.step, fault.offset}});
  }

  /// A gate is stuck in one way at a time.
  void refuse_overlap(const StuckGate& fault, const std::tuple<std::uint32_t, std::uint16_t, std::uint8_t>& gate,
                      sim::TrueTime begin) {
    const sim::TrueTime end = end_of(fault).value_or(sim::TrueTime::never());
    if (!has_times(fault)) return;
    for (const Stuck& other : stuck_)
      if (other.gate == gate && begin < other.end && other.begin < end)
        diagnostics_.error(fault.where.place(), "a gate stuck twice at a time",
                           {"class " + std::to_string(fault.traffic_class) + " of " + json::quote(fault.node) +
                                ", stuck from " + json::to_text(other.begin.since_start()) + " on already",
                            "times that do not overlap"});
    stuck_.push_back({gate, begin, end});
  }

  struct Stuck {
    std::tuple<std::uint32_t, std::uint16_t, std::uint8_t> gate;  // node, port, class
    sim::TrueTime begin;
    sim::TrueTime end;
  };
  const Resolved& r_;
  FaultPlan made_;
  json::Diagnostics& diagnostics_;
  struct Babbling {
    std::string stream;
    sim::TrueTime begin;
    sim::TrueTime end;
  };
  std::vector<Babbling> babbling_;
  std::vector<Stuck> stuck_;
  std::vector<Outage> outages_;
  std::set<std::uint32_t> checked_bypasses_;  // by node
};

}  // namespace

FaultPlan plan_faults(const Resolved& resolved, json::Diagnostics& diagnostics) {
  return FaultResolver(resolved, diagnostics).run();
}

}  // namespace takt::scenario
