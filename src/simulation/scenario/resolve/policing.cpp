// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/policing.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/cqf.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::scenario {
namespace {

class Policing {
 public:
  Policing(const Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    if (r_.plan.ingress_configs.empty()) return;
    for_each_stream_at_port(r_, [&](const StreamAtPort& at) {
      if (!at.filter) return;
      const auto& description = relay_of(r_.topology.nodes[at.node].description)->ingress;
      if (!description || diagnostics_.is_refused(description->where.at("filters"))) return;
      const models::IngressConfig& config = r_.plan.ingress_configs[*r_.plan.nodes[at.node].ingress];
      const models::StreamFilterConfig& filter = config.stream_filters[*at.filter];
      // The ingress sees a frame once, however many ports it goes on through.
      if (policed_.insert({at.stream.value, at.node}).second) {
        if (!filter.flow_meter.is_none())
          check_meter(at, config.flow_meters[filter.flow_meter.value].meter,
                      description->meters[filter.flow_meter.value]);
        if (!filter.ats_scheduler.is_none())
          check_scheduler(at, filter.ats_scheduler.value, config, description->ats[filter.ats_scheduler.value]);
      }
      if (description->cqf && !filter.stream_gate.is_none() &&
          config.stream_gates[filter.stream_gate.value].name == "cqf")
        check_cqf(at, *description->cqf);
    });
    if (diagnostics_.has_errors()) return;  // loads may be others then
    for (const auto& [key, asked] : asked_) check_rate(key.first, key.second, asked);
  }

 private:
  std::string frames_of(const StreamAtPort& at) const {
    return "frames of " + json::quote(r_.plan.streams[at.stream.value].name) + " of up to ";
  }

  void check_meter(const StreamAtPort& at, const models::FlowMeterConfig& meter, const Meter& description) {
    const Octets most = meter.drop_on_yellow ? meter.committed_burst_size
                                             : std::max(meter.committed_burst_size, meter.excess_burst_size);
    if (at.policed_frame > most && !diagnostics_.is_refused(description.where.place()))
      diagnostics_.error(description.where.at("cbs"), "a burst smaller than a frame",
                         {json::to_text(most) + " for " + frames_of(at) + json::to_text(at.policed_frame),
                          "at least the longest frame"});
  }

  void check_scheduler(const StreamAtPort& at, std::uint32_t number, const models::IngressConfig& config,
                       const AtsEntry& description) {
    const models::AtsSchedulerConfig& scheduler = config.ats_schedulers[number];
    const Octets counted = scheduler.media_overhead ? models::wire_length(at.policed_frame) : at.policed_frame;
    if (counted > scheduler.committed_burst_size && !diagnostics_.is_refused(description.where.place()))
      diagnostics_.error(description.where.at("burst"), "a burst smaller than a frame",
                         {json::to_text(scheduler.committed_burst_size) + " for " + frames_of(at) +
                              json::to_text(counted) + (scheduler.media_overhead ? " with preamble and gap" : ""),
                          "at least the longest frame"});
    const StreamDemand& demand = r_.streams[at.stream.value].demand;
    asked_[{at.node, number}] +=
        demand.wire_bits_per_second - (scheduler.media_overhead ? 0 : 160 * demand.frames_per_second);
  }

  void check_rate(std::uint32_t node, std::uint32_t number, double asked) {
    const DataRate rate =
        r_.plan.ingress_configs[*r_.plan.nodes[node].ingress].ats_schedulers[number].committed_information_rate;
    if (asked > static_cast<double>(rate.bits_per_second) * (1 + 1e-9))
      diagnostics_.warning(relay_of(r_.topology.nodes[node].description)->ingress->ats[number].where.at("rate"),
                           "a scheduler slower than its streams",
                           {json::to_text(rate) + " for " + json::to_text(DataRate{static_cast<std::uint64_t>(asked)}),
                            "a rate that carries them"});
  }

  void check_cqf(const StreamAtPort& at, const Cqf& cqf) {
    if (diagnostics_.is_refused(cqf.where.place())) return;
    const Duration dead_time = cqf_times(cqf, r_.topology, at.node).dead_time;
    for (const models::LinkPlan& link : r_.plan.links) {
      const bool is_its = (link.a.node.value == at.node && link.a.port == at.port) ||
                          (link.b.node.value == at.node && link.b.port == at.port);
      if (!is_its) continue;
      const Duration needed = link.rate.octet_time() * (models::preamble_and_sfd + at.frame).count;
      if (needed > cqf.cycle - dead_time && told_.insert({at.stream.value, at.node}).second)
        diagnostics_.error(
            cqf.where.at("cycle"), "a cycle shorter than a frame",
            {json::to_text(cqf.cycle) + " with a dead time of " + json::to_text(dead_time) + " for frames of " +
                 json::quote(r_.plan.streams[at.stream.value].name) + " that last " + json::to_text(needed),
             "a cycle that holds the longest frame"});
    }
  }

  const Resolved& r_;
  json::Diagnostics& diagnostics_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> policed_;        // stream, node
  std::set<std::pair<std::uint32_t, std::uint32_t>> told_;           // the same
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> asked_;  // of each scheduler: node, number
};

}  // namespace

void check_policing(const Resolved& resolved, json::Diagnostics& diagnostics) { Policing(resolved, diagnostics).run(); }

}  // namespace takt::scenario
