// SPDX-License-Identifier: Apache-2.0
// Classes that share bandwidth (ETS): what the others send while one of them waits. See docs/bounds.md.
#include "analysis/port_analysis.hpp"

namespace takt::analysis {

using models::traffic_class_count;
using models::TrafficClass;

Ps PortAnalysis::quantum(TrafficClass q) const {
  return octet_ * std::get<models::EnhancedTransmissionSelection>(config_.shaping.selection[q]).bandwidth;
}

/// Whatever the order in which they take turns, no more than has come since all of them, and what goes before them, had
/// nothing. And whatever comes, no more than their turns let them: `own` is what q has sent from when its queue was
/// empty last to the end of the frame that starts.
Ps PortAnalysis::sent_by_sharers(TrafficClass q, const Service& service, Ps length, Ps own) const {
  Ps all = 0;
  for (TrafficClass h = 0; h < traffic_class_count; ++h) {
    if (h == q || demands_[h].is_empty() || !shares(h, q)) continue;
    const Ps rounds = own / quantum(q) + (own % quantum(q) != 0 ? 1 : 0);
    all = sum(all, service.by_turns ? sum(product(quantum(h), rounds), demands_[h].longest() - octet_)
                                    : demands_[h].work(length));
  }
  return all;
}

/// The bound by turns counts from when the queue was empty last, or from when classes before it were busy then: a frame
/// of any of the classes that share, its own too, may be under way.
void PortAnalysis::share_by_turns(TrafficClass q, Service& service) const {
  service.by_turns = true;
  service.blocked = std::max(service.blocked, demands_[q].longest());
  for (TrafficClass h = 0; h < traffic_class_count; ++h)
    if (!demands_[h].is_empty() && shares(h, q)) service.blocked = std::max(service.blocked, demands_[h].longest());
}

/// In the long run, of the rate of the port, with what goes before.
double PortAnalysis::taken_by(TrafficClass q, const Service& service) const {
  double taken = demands_[q].rate();
  if (service.is_shaped) return taken;
  for (TrafficClass h = 0; h < traffic_class_count; ++h) {
    if (h == q || demands_[h].is_empty() || !goes_before(h, q) || !overlap(q, h)) continue;
    if (service.by_turns && shares(h, q))
      taken += demands_[q].rate() * static_cast<double>(quantum(h)) / static_cast<double>(quantum(q));
    else
      taken += is_shaped(h) ? std::min(shaped_rate_[h], demands_[h].rate()) : demands_[h].rate();
  }
  return taken;
}

/// By flow, the lesser of both bounds; empty if there is none, with the reason.
std::vector<Ps> PortAnalysis::delays_in_shares(TrafficClass q, std::string& reason) {
  for (TrafficClass h = 0; h < traffic_class_count; ++h) {
    if (demands_[h].is_empty() || !is_shared(h) || !is_gated(h)) continue;
    reason = "classes that share bandwidth (ETS) behind gates";
    return {};
  }
  std::vector<Ps> delays = delays_in_busy_period(q, reason, false);
  if (!model_.counts_packets) return delays;
  std::string missed;
  const std::vector<Ps> by_turns = delays_in_busy_period(q, missed, true);
  if (delays.empty()) return by_turns;
  for (std::size_t f = 0; f < by_turns.size(); ++f) delays[f] = std::min(delays[f], by_turns[f]);
  return delays;
}

}  // namespace takt::analysis
