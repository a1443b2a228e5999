// SPDX-License-Identifier: Apache-2.0
// How time passes through an instance: Sync in, Sync out, and what happens without it.
#include <algorithm>

#include "models/gptp/ptp_instance.hpp"
#include "sim/check.hpp"

namespace takt::models::gptp {

bool PtpInstance::is_from_transmitter(const Header& header, PortNumber port) const {
  if (at(port).role != PortRole::time_receiver) return false;
  return external() || header.source == information_[port - 1u].priority.source;
}

void PtpInstance::received(const Sync& sync, PortNumber port, sim::LocalTime ingress, const LinkMeasure& link,
                           sim::LocalTime now, Outputs& outputs) {
  if (!is_from_transmitter(sync.header, port)) return;
  const SyncWaiting waiting{sync.header, ingress, link};
  at(port).waiting.reset();
  if (sync.one_step)
    sync_complete(waiting, sync.one_step->origin, sync.header.correction, sync.one_step->information,
                  sync.one_step->drift, port, now, outputs);
  else
    at(port).waiting = waiting;
}

void PtpInstance::received(const FollowUp& follow_up, PortNumber port, sim::LocalTime now, Outputs& outputs) {
  std::optional<SyncWaiting>& waiting = at(port).waiting;
  if (!waiting || waiting->header.source != follow_up.header.source ||
      waiting->header.sequence_id != follow_up.header.sequence_id)
    return;
  const SyncWaiting complete = *waiting;
  waiting.reset();
  if (!complete.header.correction.in_range() || !follow_up.header.correction.in_range()) return;
  sync_complete(complete, follow_up.precise_origin, complete.header.correction + follow_up.header.correction,
                follow_up.information, follow_up.drift, port, now, outputs);
}

void PtpInstance::sync_complete(const SyncWaiting& waiting, const Timestamp& origin, Correction correction,
                                const FollowUpInformation& information, const std::optional<DriftTracking>& drift,
                                PortNumber port, sim::LocalTime now, Outputs& outputs) {
  if (!origin.in_range() || !correction.in_range()) return;
  sync_ = SyncInformation::received(origin, correction, information, waiting.ingress, waiting.link);
  sync_->log_interval = waiting.header.log_message_interval;
  drift_.add(sync_->since, sync_->rate_ratio);
  sync_->drift = drift_.per_second();
  // What the sender says of its own ratio, and what the link shows of the sender's clock (IEEE 802.1ASdm). Not of
  // another grandmaster.
  if (config_.drift_tracking && drift && drift->grandmaster == selection_.grandmaster.root.clock)
    sync_->drift = RateOffset::from_scaled_41(drift->rate_ratio_drift) + waiting.link.neighbor_rate_ratio_drift;
  arm_sync_receipt(port, sync_->log_interval, now, outputs);
  outputs.push_back(SyncSample{index_, waiting.ingress, sync_->grandmaster_time_at(waiting.ingress), sync_->rate_ratio,
                               sync_->log_interval, selection_.grandmaster.root.clock});
  for (PortNumber each = 1; each <= ports(); ++each) {
    if (at(each).role != PortRole::time_transmitter) continue;
    if (goes_along(each))
      send_sync(each, *sync_, outputs);
    else if (!at(each).has_own_interval)
      own_sync_interval_elapsed(each, now, outputs);
  }
}

void PtpInstance::arm_sync_receipt(PortNumber port, int log_interval, sim::LocalTime now, Outputs& outputs) {
  outputs.push_back(ArmTimer{timer(port, TimerPurpose::sync_receipt),
                             now + config_.sync_receipt_timeout * interval_of(log_interval)});
}

void PtpInstance::sync_receipt_expired(PortNumber port, sim::LocalTime now, Outputs& outputs) {
  if (at(port).role != PortRole::time_receiver) return;
  if (!external()) return age(port, now, outputs);  // the port changes its role: SyncLost, or holdover as grandmaster
  if (sync_) outputs.push_back(SyncLost{index_});
  sync_.reset();
}

/// Port 0: the grandmaster sends at all its ports whose interval nobody has changed.
void PtpInstance::sync_interval_elapsed(PortNumber port, sim::LocalTime now, Outputs& outputs) {
  if (port != 0) return own_sync_interval_elapsed(port, now, outputs);
  if (!is_grandmaster()) return;
  next_sync_ = std::max(next_sync_ + interval_of(config_.log_sync_interval), now);
  outputs.push_back(ArmTimer{timer(0, TimerPurpose::sync_interval), next_sync_});
  if (!grandmaster_present()) return;
  SyncInformation sync = source_.information_at(now);
  sync.log_interval = static_cast<std::int8_t>(config_.log_sync_interval);
  for (PortNumber each = 1; each <= ports(); ++each) {
    if (at(each).role != PortRole::time_transmitter) continue;
    if (goes_along(each))
      send_sync(each, sync, outputs);
    else if (!at(each).has_own_interval)
      own_sync_interval_elapsed(each, now, outputs);
  }
}

/// A port that sends when the grandmaster's timer elapses or a Sync is relayed. Others have an interval of their own:
/// of boundary clocks, of relays that are not sync-locked, and where the neighbour has asked for another one
/// (syncLocked, 10.3.18).
bool PtpInstance::goes_along(PortNumber number) const {
  const MessageInterval& interval = at(number).sync_interval;
  if (interval.is_stopped() || interval.lingers()) return false;
  if (is_grandmaster()) return interval.is_initial();
  if (config_.boundary || !config_.sync_locked) return false;
  return interval.is_initial() || (sync_ && interval.log() == sync_->log_interval);
}

void PtpInstance::own_sync_interval_elapsed(PortNumber number, sim::LocalTime now, Outputs& outputs) {
  Port& port = at(number);
  port.has_own_interval = port.role == PortRole::time_transmitter && !goes_along(number) &&
                          !port.sync_interval.is_stopped() &&
                          (is_grandmaster() ? grandmaster_present() : sync_.has_value());
  if (!port.has_own_interval) return;
  SyncInformation sync = gives_own_time() ? source_.information_at(now) : *sync_;
  sync.log_interval = port.sync_interval.announced();
  port.next_own_sync = now + port.sync_interval.sent();
  outputs.push_back(ArmTimer{timer(number, TimerPurpose::sync_interval), port.next_own_sync});
  send_sync(number, sync, outputs);
}

/// After a change of its interval: a timer of its own, or none.
void PtpInstance::follow_sync_interval(PortNumber number, sim::LocalTime now, Outputs& outputs) {
  Port& port = at(number);
  if (port.role != PortRole::time_transmitter) return;
  const bool is_timed =
      !port.sync_interval.is_stopped() && !goes_along(number) && (is_grandmaster() || sync_.has_value());
  if (is_timed) {
    const sim::LocalTime soonest = now + port.sync_interval.length();
    port.next_own_sync = port.has_own_interval ? std::min(port.next_own_sync, soonest) : soonest;
    outputs.push_back(ArmTimer{timer(number, TimerPurpose::sync_interval), port.next_own_sync});
  } else if (port.has_own_interval) {
    outputs.push_back(CancelTimer{timer(number, TimerPurpose::sync_interval)});
  }
  port.has_own_interval = is_timed;
}

std::optional<DriftTracking> PtpInstance::drift_of(const SyncInformation& sync, sim::LocalTime egress) const {
  if (!config_.drift_tracking) return std::nullopt;
  const PriorityVector& best = selection_.grandmaster;
  return DriftTracking{Timestamp::floor_of(sim::PtpTime::from_ps(egress.ps())), best.root.clock, best.steps_removed,
                       sync.drift.scaled_41()};
}

void PtpInstance::send_sync(PortNumber number, const SyncInformation& sync, Outputs& outputs) {
  Port& port = at(number);
  Sync message{header(number, port.next_sync++, sync.log_interval)};
  if (config_.two_step) {
    port.leaving = SyncLeaving{message.header.sequence_id, sync};
    outputs.push_back(SendMessage{number, message});
    return;
  }
  message.header.correction = sync.correction;
  message.one_step = Sync::OneStep{sync.origin, sync.handed_on(sync.since), drift_of(sync, sync.since)};
  outputs.push_back(SendMessage{number, message, OneStepPatch{sync.since, sync.running()}});
}

void PtpInstance::transmitted(const EgressReport& report, Outputs& outputs) {
  Port& port = at(report.port);
  if (report.type != MessageType::sync || !port.leaving || port.leaving->sequence_id != report.sequence_id) return;
  SyncInformation sync = port.leaving->sync;
  port.leaving.reset();
  if (gives_own_time()) {  // the whole nanoseconds at which the Sync left, not at which it was made
    const sim::PtpTime left = sync.grandmaster_time_at(report.egress);
    sync.origin = Timestamp::floor_of(left);
    sync.correction = Correction::of(left - sync.origin.time());
    sync.rate_ratio = sync.rate_ratio_at(report.egress);
    sync.since = report.egress;
  }
  FollowUp follow_up{header(report.port, report.sequence_id, sync.log_interval), sync.origin,
                     sync.handed_on(report.egress), drift_of(sync, report.egress)};
  follow_up.header.correction = sync.correction_at(report.egress);
  outputs.push_back(SendMessage{report.port, follow_up});
}

}  // namespace takt::models::gptp
