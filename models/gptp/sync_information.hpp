// SPDX-License-Identifier: Apache-2.0
// What a Sync brings, on its way through a node: the arithmetic of MDSyncReceive and MDSyncSend, IEEE
// 802.1AS-2020 11.2.14 and 11.2.15.
#pragma once

#include <cstdint>

#include "models/gptp/drifting_rate.hpp"
#include "models/gptp/message.hpp"

namespace takt::models::gptp {

/// The link at the port at which a Sync arrives, as LinkDelay measures it.
struct LinkMeasure {
  sim::Duration from_neighbor;  // mean link delay plus asymmetry, in the neighbour's time base
  ClockRate neighbor_rate_ratio;
  RateOffset neighbor_rate_ratio_drift = {};  // per second
};

/// The time of the grandmaster as a function of the node's free-running clock:
/// at the local instant `since` it was origin + correction, and from there it runs at rate_ratio, which changes by
/// drift.
struct SyncInformation {
  Timestamp origin = {};       // handed on unchanged
  Correction correction = {};  // when the Sync left the neighbour
  sim::LocalTime since = {};   // upstreamTxTime: that instant by one's own clock
  ClockRate rate_ratio = {};   // grandmaster / own clock
  RateOffset drift = {};       // of rate_ratio, per second
  FollowUpInformation information = {};
  std::int8_t log_interval = -3;

  /// Precondition: origin and correction are in_range().
  static SyncInformation received(const Timestamp& origin, Correction correction,
                                  const FollowUpInformation& information, sim::LocalTime ingress,
                                  const LinkMeasure& link) {
    const RateOffset upstream = RateOffset::from_scaled_41(information.cumulative_scaled_rate_offset);
    return {.origin = origin,
            .correction = correction,
            .since = ingress - link.neighbor_rate_ratio.divide(link.from_neighbor),
            .rate_ratio = ClockRate::one_plus(upstream + link.neighbor_rate_ratio.minus_one()),
            .information = information};
  }

  /// The correction when it leaves again at `egress`: link and residence are added in the grandmaster's time.
  Correction correction_at(sim::LocalTime egress) const {
    return correction + Correction::of(running().times(egress - since));
  }
  sim::PtpTime grandmaster_time_at(sim::LocalTime at) const {
    return origin.time() + correction.duration() + running().times(at - since);
  }
  ClockRate rate_ratio_at(sim::LocalTime at) const { return running().after(at - since); }
  /// The TLV for the next node, if the Sync leaves at `egress`.
  FollowUpInformation handed_on(sim::LocalTime egress) const {
    FollowUpInformation next = information;
    next.cumulative_scaled_rate_offset = rate_ratio_at(egress).minus_one().scaled_41();
    return next;
  }
  DriftingRate running() const { return {rate_ratio, drift}; }
};

/// Where a grandmaster has its time from: a clock that showed `time` at the local instant `since` and runs at `rate`
/// against the free-running clock.
struct SourceTime {
  sim::LocalTime since = {};
  sim::PtpTime time = {};
  ClockRate rate = {};
  std::uint16_t time_base_indicator = 0;  // grows when the time jumps

  sim::PtpTime time_at(sim::LocalTime at) const { return time + rate.times(at - since); }
  /// Whole nanoseconds in the origin, the rest in the correction.
  SyncInformation information_at(sim::LocalTime at) const {
    const sim::PtpTime now = time_at(at);
    SyncInformation sync{.origin = Timestamp::floor_of(now), .since = at, .rate_ratio = rate};
    sync.correction = Correction::of(now - sync.origin.time());
    sync.information.gm_time_base_indicator = time_base_indicator;
    return sync;
  }
};

}  // namespace takt::models::gptp
