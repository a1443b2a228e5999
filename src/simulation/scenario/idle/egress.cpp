// SPDX-License-Identifier: Apache-2.0
// Ports: classes that nobody uses, sizes that no frame exceeds, shapers that are too slow or never act.
#include <algorithm>

#include "scenario/idle/usage.hpp"

namespace takt::scenario {
namespace {

using Ports = std::vector<const PortUse*>;

class EgressTeller {
 public:
  EgressTeller(const Usage& usage, const EgressUse& use, json::Diagnostics& diagnostics)
      : usage_(usage), egress_(*use.egress), ports_(use.ports), diagnostics_(diagnostics) {}

  void run() {
    if (ports_.empty())
      return warn(egress_.where.place(), "an entry for no port",
                  {"all ports have entries of their own", "a port without one"});
    if (egress_.preemption) preemption(*egress_.preemption);
    for (const Shaper& each : egress_.shapers) shaper(each);
    for (const MaxSdu& each : egress_.max_sdu) max_sdu(each);
    for (std::size_t i = 0; i < egress_.ats.size(); ++i) ats(i);
    for (const Share& each : egress_.ets) share(each);
    for (std::size_t i = 0; i < egress_.cut_through.size(); ++i) cut_through(i);
    if (egress_.untagged) untagged();
  }

 private:
  void warn(json::Place place, std::string message, json::Details details) {
    warn_once(diagnostics_, std::move(place), std::move(message), std::move(details));
  }

  bool is_used(models::TrafficClass q) const {
    return std::any_of(ports_.begin(), ports_.end(), [q](const PortUse* port) { return port->uses(q); });
  }
  /// Reports a class that no frame is in.
  bool reports_unused(models::TrafficClass q, const json::Place& place, const std::string& what) {
    if (is_used(q)) return false;
    warn(place, what + " of a class that no stream has",
         {"class " + std::to_string(q) + " at " + usage_.name(ports_) + ": " + usage_.why_unused(q, ports_),
          usage_.classes_in_use(ports_)});
    return true;
  }
  /// The same of a class in a list. Who lists all classes but some says nothing of each of them; but a list none of
  /// whose classes is used does nothing, and a class that is taken for a priority, whose own class is not listed, is a
  /// mistake.
  bool reports_unused(const std::vector<std::uint8_t>& list, std::size_t i, const json::Place& place,
                      const std::string& what) {
    const models::TrafficClass q = list[i];
    if (is_used(q)) return false;
    const bool none_is_used =
        std::none_of(list.begin(), list.end(), [&](std::uint8_t other) { return is_used(other); });
    const std::optional<models::TrafficClass> meant = usage_.class_of_priority(q, ports_);
    const bool misses = meant && std::find(list.begin(), list.end(), *meant) == list.end();
    if (none_is_used || misses) reports_unused(q, place, what);
    return true;
  }
  /// The streams in a class, at any of the ports.
  template <class F>
  void for_streams(models::TrafficClass q, F&& f) const {
    for (const PortUse* port : ports_)
      for (const StreamAtPort* at : port->streams)
        if (models::contains(at->classes, q)) f(*port, *at);
  }

  static bool holds(const PortUse& port) {
    return std::any_of(port.gates.begin(), port.gates.end(), [](const models::GateConfig* gates) {
      return std::any_of(gates->admin_control_list.begin(), gates->admin_control_list.end(),
                         [](const models::GateControlEntry& entry) {
                           return entry.operation == models::GateOperation::set_and_hold_mac;
                         });
    });
  }

  void preemption(const Preemption& preemption) {
    models::ClassSet preemptable = 0;
    for (std::size_t i = 0; i < preemption.preemptable.size(); ++i) {
      const models::TrafficClass q = preemption.preemptable[i];
      preemptable = models::with(preemptable, q);
      reports_unused(preemption.preemptable, i, preemption.where.at("preemptable", i), "preemption");
    }
    const bool is_held = std::any_of(ports_.begin(), ports_.end(), [](const PortUse* port) { return holds(*port); });
    if (preemption.hold_advance && !is_held)
      warn(preemption.where.at("hold_advance"), "an advance of what is never held",
           {"no gate list that holds", "an entry with \"mac\": \"hold\""});
    if (preemption.release_advance != Duration() && !is_held)
      warn(preemption.where.at("release_advance"), "an advance of what is never held",
           {"no gate list that holds", "an entry with \"mac\": \"hold\""});
    const bool is_cut = std::any_of(ports_.begin(), ports_.end(), [&](const PortUse* port) {
      return (port->classes & preemptable) != 0 && ((port->classes & ~preemptable) != 0 || holds(*port));
    });
    if (!is_cut && (preemptable & in_use()) != 0)
      warn(preemption.where.place(), "preemption without express frames",
           {"at " + usage_.name(ports_) + " all frames are preemptable: class " + text_of_classes(in_use()),
            "a class in use that is not preemptable"});
  }

  models::ClassSet in_use() const {
    models::ClassSet all = 0;
    for (const PortUse* port : ports_) all = static_cast<models::ClassSet>(all | port->classes);
    return all;
  }

  void shaper(const Shaper& shaper) {
    const models::TrafficClass q = shaper.traffic_class;
    if (reports_unused(q, shaper.where.at("class"), "a shaper")) return;
    for (const PortUse* port : ports_) {
      double slope = static_cast<double>(shaper.idle_slope.bits_per_second);
      const auto& gates = port->config->shaping.gates;
      const bool is_of_window = shaper.of == SlopeOf::window && gates && !gates->admin_control_list.empty();
      if (is_of_window) {
        const models::OpenShare share =
            models::GateControlList(gates->admin_control_list, gates->admin_cycle_time).open_share(q);
        slope *= static_cast<double>(share.open.ps()) / static_cast<double>(share.cycle.ps());
      }
      const double load = usage_.load(*port, q);
      if (load <= slope * (1 + 1e-9)) continue;
      return warn(shaper.where.at("idle_slope"), "a shaper slower than its class",
                  {json::to_text(shaper.idle_slope) +
                       (is_of_window ? " while the gate is open, " +
                                           json::to_text(DataRate{static_cast<std::uint64_t>(slope)}) + " in all,"
                                     : std::string()) +
                       " for " + json::to_text(DataRate{static_cast<std::uint64_t>(load)}) + " of class " +
                       std::to_string(q) + " at " + usage_.name({port}) + ", preamble and gap included",
                   "a slope that carries them"});
    }
    const bool never_acts = std::all_of(ports_.begin(), ports_.end(), [&](const PortUse* port) {
      return shaper.idle_slope >= port->link->rate && port->gates.empty();
    });
    if (never_acts)
      warn(shaper.where.at("idle_slope"), "a shaper as fast as its link",
           {json::to_text(shaper.idle_slope) + " at " + usage_.name(ports_), "a slope below the rate of the link"});
  }

  void max_sdu(const MaxSdu& most) {
    const models::TrafficClass q = most.traffic_class;
    if (reports_unused(q, most.where.at("class"), "a maximum SDU")) return;
    Octets longest{0};
    std::string dropped;
    for_streams(q, [&](const PortUse&, const StreamAtPort& at) {
      longest = std::max(longest, at.msdu);
      if (at.msdu > most.size && dropped.empty())
        dropped = json::quote(usage_.plan(at).name) + " of " + json::to_text(at.msdu);
    });
    if (longest.count == 0) return;  // gPTP alone
    if (!dropped.empty())
      warn(most.where.at("size"), "a maximum SDU that drops frames",
           {json::to_text(most.size) + " at " + usage_.name(ports_) + ", and frames of " + dropped,
            "at least the longest"});
    else if (longest < most.size)
      warn(most.where.at("size"), "a maximum SDU that no frame exceeds",
           {json::to_text(most.size) + ", and the longest of class " + std::to_string(q) + " at " +
                usage_.name(ports_) + " has " + json::to_text(longest),
            "a size below it"});
  }

  void ats(std::size_t i) {
    const models::TrafficClass q = egress_.ats[i];
    const json::Place place = egress_.where.at("ats", i);
    if (reports_unused(egress_.ats, i, place, "ATS")) return;
    bool has_scheduler = false;
    for_streams(q, [&](const PortUse&, const StreamAtPort& at) { has_scheduler = has_scheduler || has_ats(at); });
    if (!has_scheduler)
      warn(place, "ATS without a scheduler",
           {"class " + std::to_string(q) + " at " + usage_.name(ports_) +
                ": its streams meet no ATS scheduler in the switch",
            "a filter with \"ats\" in its \"ingress\""});
  }
  bool has_ats(const StreamAtPort& at) const {
    const Resolved& r = usage_.resolved();
    if (usage_.plan(at).talker.value == at.node)
      return std::ranges::find(r.plan.talker_ats, at.stream, &models::TalkerAtsPlan::stream) != r.plan.talker_ats.end();
    if (!at.filter) return false;
    return !r.plan.ingress_configs[*r.plan.nodes[at.node].ingress].stream_filters[*at.filter].ats_scheduler.is_none();
  }

  void share(const Share& share) {
    const models::TrafficClass q = share.traffic_class;
    const json::Place place = share.where.at("class");
    if (reports_unused(q, place, "a share of the bandwidth")) return;
    const bool is_alone = std::all_of(ports_.begin(), ports_.end(), [&](const PortUse* port) {
      return !port->uses(q) ||
             models::is_one_class(static_cast<models::ClassSet>(port->classes & port->config->shaping.shared()));
    });
    if (is_alone)
      return warn(place, "a share of the bandwidth beside no other",
                  {"class " + std::to_string(q) + " at " + usage_.name(ports_) +
                       ": no other class with a share is in use there",
                   "a share for another class, or none"});
    for (const PortUse* port : ports_) {
      const auto below =
          static_cast<models::ClassSet>(port->classes & ~port->config->shaping.shared() & (models::only(q) - 1));
      if (port->uses(q) && below != 0)
        return warn(place, "a share of the bandwidth that lower classes leave",
                    {"class " + text_of_classes(below) + " at " + usage_.name({port}) +
                         " without a share, and so before class " + std::to_string(q),
                     "shares for the lowest classes"});
    }
  }

  void cut_through(std::size_t i) {
    const models::TrafficClass q = egress_.cut_through[i];
    const json::Place place = egress_.where.at("cut_through", i);
    if (reports_unused(egress_.cut_through, i, place, "cut-through")) return;
    bool has_stream = false;
    bool may = false;
    for_streams(q, [&](const PortUse& port, const StreamAtPort& at) {
      has_stream = true;
      for (const Path& path : usage_.resolved().streams[at.stream.value].paths)
        for (std::size_t hop = 1; hop + 1 < path.size(); ++hop)
          if (path[hop] == at.node && path[hop + 1] == at.peer)
            may = may || rate_of(path[hop - 1], path[hop]) == port.link->rate;
    });
    if (!has_stream && egress_.cut_through.size() > 1) return;  // one of many that are listed
    if (!has_stream)
      warn(place, "cut-through of a class that no stream has",
           {"class " + std::to_string(q) + " at " + usage_.name(ports_) + ": gPTP alone, which is not forwarded",
            usage_.classes_in_use(ports_)});
    else if (!may)
      warn(place, "cut-through between links of different rates",
           {"class " + std::to_string(q) + " at " + usage_.name(ports_) +
                ": its frames come over links of other rates and are stored",
            "links of one rate"});
  }
  DataRate rate_of(std::uint32_t from, std::uint32_t to) const {
    const auto port = usage_.resolved().topology.port_towards(from, to);
    return port ? usage_.port(from, *port).link->rate : DataRate{};
  }

  void untagged() {
    const Topology& topology = usage_.resolved().topology;
    bool strips = false;
    for (const PortUse* port : ports_)
      for (const StreamAtPort* at : port->streams)
        strips = strips || (topology.chooses_ports[port->node] && usage_.plan(*at).priority);
    if (!strips)
      warn(egress_.where.at("untagged"), "tags taken off that no frame has",
           {"no tagged stream leaves a switch through " + usage_.name(ports_), "streams with \"pcp\""});
  }

  const Usage& usage_;
  const Egress& egress_;
  const Ports& ports_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void report_ineffective_egress(const Usage& usage, json::Diagnostics& diagnostics) {
  for (const EgressUse& use : usage.egress()) EgressTeller(usage, use, diagnostics).run();
}

}  // namespace takt::scenario
