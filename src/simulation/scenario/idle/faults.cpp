// SPDX-License-Identifier: Apache-2.0
// Faults that hit nothing: links and classes that no frame uses, chances of 0, times beyond the run, outages within
// others; rerouting with nothing to do.
#include <algorithm>

#include "scenario/idle/usage.hpp"

namespace takt::scenario {
namespace {

class FaultReport {
 public:
  FaultReport(const Usage& usage, json::Diagnostics& diagnostics)
      : usage_(usage), r_(usage.resolved()), diagnostics_(diagnostics) {}

  void run() {
    const std::vector<Fault>& faults = r_.scenario.faults;
    for (std::size_t i = 0; i < faults.size(); ++i) {
      std::visit([&](const auto& fault) { report_time(fault); }, faults[i]);
      std::visit([&](const auto& fault) { tell(fault); }, faults[i]);
      for (std::size_t other = 0; other < i; ++other)
        if (faults[other] == faults[i]) {
          warn(std::visit([](const auto& fault) { return fault.where.place(); }, faults[i]), "a fault twice",
               {"the same as the entry with number " + std::to_string(other), "it once"});
          break;
        }
    }
    if (r_.scenario.rerouting) report_rerouting(*r_.scenario.rerouting);
  }

 private:
  void warn(json::Place place, std::string message, json::Details details) {
    warn_once(diagnostics_, std::move(place), std::move(message), std::move(details));
  }

  template <class F>
  void report_time(const F& fault) {
    if (r_.scenario.duration > Duration() && usage_.is_after_the_end(fault.at))
      warn(fault.where.at("at"), "after the end of the simulation",
           {json::to_text(fault.at), "less than " + json::to_text(r_.scenario.duration)});
  }

  /// The ports at both ends of a link of the description; `towards` leaves those that send there.
  std::vector<const PortUse*> ports_of(const std::vector<std::string>& link,
                                       const std::optional<std::string>& towards = {}) const {
    const auto is = [&](const std::string& text, std::uint32_t node, std::uint16_t port) {
      const std::size_t colon = text.find(':');
      if (text.substr(0, colon) != r_.topology.nodes[node].name) return false;
      return colon == std::string::npos || text.substr(colon + 1) == std::to_string(port);
    };
    std::vector<const PortUse*> ports;
    for (const PortUse& use : usage_.ports()) {
      const models::LinkPlan::End& peer =
          use.link->a.node.value == use.node && use.link->a.port == use.port ? use.link->b : use.link->a;
      const bool joins = (is(link[0], use.node, use.port) && is(link[1], peer.node.value, peer.port)) ||
                         (is(link[1], use.node, use.port) && is(link[0], peer.node.value, peer.port));
      if (joins && (!towards || *towards == r_.topology.nodes[use.peer].name)) ports.push_back(&use);
    }
    return ports;
  }
  static bool is_idle(const std::vector<const PortUse*>& ports) {
    return std::all_of(ports.begin(), ports.end(), [](const PortUse* port) { return port->classes == 0; });
  }
  std::string names(const std::vector<std::string>& link) const {
    return json::quote(link[0]) + " to " + json::quote(link[1]);
  }

  void tell(const LinkDown& fault) {
    if (is_idle(ports_of(fault.link)))
      return warn(fault.where.at("link"), "a fault of a link that no stream takes",
                  {names(fault.link), "a link on the path of a stream"});
    for (const Fault& other : r_.scenario.faults) {
      const auto* const longer = std::get_if<LinkDown>(&other);
      if (longer == nullptr || longer == &fault || *longer == fault || ports_of(longer->link) != ports_of(fault.link))
        continue;
      const bool ends_later = !longer->lasts || (fault.lasts && longer->at + *longer->lasts >= fault.at + *fault.lasts);
      if (longer->at > fault.at || !ends_later) continue;
      return warn(fault.where.at("at"), "a link that is down already",
                  {names(fault.link) + " is down from " + json::to_text(longer->at) +
                       (longer->lasts ? " for " + json::to_text(*longer->lasts) : std::string(" on")),
                   "another time"});
    }
  }
  void tell(const FrameErrors& fault) {
    const bool never =
        fault.loss.value_or(0) == 0 && fault.corruption.value_or(0) == 0 && fault.bit_error_rate.value_or(0) == 0 &&
        fault.duplication.value_or(0) == 0 &&
        (!fault.burst_loss || (fault.burst_loss->loss_in_good == 0 &&
                               (fault.burst_loss->good_to_bad == 0 || fault.burst_loss->loss_in_bad == 0)));
    if (never)
      return warn(fault.where.place(), "a fault with a chance of 0", {"every probability is 0", "one above 0"});
    if (is_idle(ports_of(fault.link, fault.towards)))
      warn(fault.where.at("link"), "a fault of a link that no stream takes",
           {names(fault.link) + (fault.towards ? " towards " + json::quote(*fault.towards) : std::string()),
            "a link on the path of a stream"});
  }
  void tell(const Crash& fault) {
    bool is_used = false;
    for (const PortUse& port : usage_.ports())
      is_used = is_used || (port.classes != 0 && (r_.topology.nodes[port.node].name == fault.node ||
                                                  r_.topology.nodes[port.peer].name == fault.node));
    if (!is_used)
      warn(fault.where.at("node"), "a crash of a node that no stream crosses",
           {json::quote(fault.node), "a node on the path of a stream"});
  }
  void tell(const Babble&) {}
  void tell(const StuckGate& fault) {
    std::vector<const PortUse*> ports;
    for (const PortUse& port : usage_.ports())
      if (r_.topology.nodes[port.node].name == fault.node &&
          (!fault.to || r_.topology.nodes[port.peer].name == *fault.to))
        ports.push_back(&port);
    const models::TrafficClass q = fault.traffic_class;
    if (std::none_of(ports.begin(), ports.end(), [q](const PortUse* port) { return port->uses(q); }))
      return warn(fault.where.at("class"), "a stuck gate of a class that no stream has",
                  {"class " + std::to_string(q) + " at " + usage_.name(ports) + ": " + usage_.why_unused(q, ports),
                   usage_.classes_in_use(ports)});
    if (fault.state == GateFault::open &&
        std::all_of(ports.begin(), ports.end(), [](const PortUse* port) { return port->gates.empty(); }))
      warn(fault.where.place(), "a gate stuck open that is always open",
           {"no gate list at " + usage_.name(ports), "\"gates\" of the port, or \"closed\""});
  }
  void tell(const ClockFault& fault) {
    if (fault.step && *fault.step == Duration() && !fault.offset)
      warn(fault.where.at("step"), "a clock that does not jump", {"a step of 0", "another one"});
  }

  void report_rerouting(const Rerouting& rerouting) {
    const bool has_outage = std::any_of(r_.scenario.faults.begin(), r_.scenario.faults.end(), [](const Fault& fault) {
      return std::holds_alternative<LinkDown>(fault) || std::holds_alternative<Crash>(fault);
    });
    const bool finds = std::any_of(r_.script.begin(), r_.script.end(), [](const ResolvedAction& action) {
      return std::holds_alternative<ResolvedRoutes>(action.what);
    });
    if (!has_outage)
      warn(rerouting.where.place(), "nothing to reroute for",
           {"no fault that takes a link down", "a \"link-down\" or a \"crash\""});
    else if (!finds)
      warn(rerouting.where.place(), "nothing to reroute for",
           {"no other way for any stream while links are down",
            "links around them; streams with \"path\" or \"redundancy\" keep theirs"});
  }

  const Usage& usage_;
  const Resolved& r_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void report_ineffective_faults(const Usage& usage, json::Diagnostics& diagnostics) {
  FaultReport(usage, diagnostics).run();
}

}  // namespace takt::scenario
