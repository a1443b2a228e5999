// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/ptp_instance.hpp"

#include <algorithm>
#include <utility>

#include "sim/check.hpp"

namespace takt::models::gptp {

PtpInstance::PtpInstance(const InstanceConfig& config, std::uint8_t index, PortNumber ports)
    : config_(config),
      index_(index),
      ports_(ports, Port{MessageInterval(config.log_sync_interval, config.sync_receipt_timeout),
                         MessageInterval(config.log_announce_interval, config.announce_receipt_timeout)}),
      information_(ports),
      drift_(config.rate_ratio_drift_window) {
  TAKT_CHECK(index != TimerId::no_instance, "an index of an instance");
  TAKT_CHECK(!config.external_roles || config.external_roles->size() == ports, "a role for each port");
  TAKT_CHECK(config.sync_receipt_timeout > 0 && config.announce_receipt_timeout > 0, "time-outs of a few intervals");
  select_roles(config_.system, information_, selection_);
}

PtpInstance::Port& PtpInstance::at(PortNumber port) {
  TAKT_CHECK(port >= 1 && port <= ports_.size(), "a port of the instance");
  return ports_[port - 1u];
}
const PtpInstance::Port& PtpInstance::at(PortNumber port) const {
  TAKT_CHECK(port >= 1 && port <= ports_.size(), "a port of the instance");
  return ports_[port - 1u];
}

void PtpInstance::start(sim::LocalTime now, Outputs& outputs) {
  TAKT_CHECK(!started_, "an instance starts once");
  started_ = true;
  next_sync_ = now;
  path_trace_ = {self()};
  reselect(now, outputs);
  outputs.push_back(GrandmasterChange{index_, selection_.grandmaster.root.clock, selection_.grandmaster.steps_removed});
  if (is_grandmaster()) sync_interval_elapsed(0, now, outputs);
}

void PtpInstance::set_port_capable(PortNumber port, bool capable, sim::LocalTime now, Outputs& outputs) {
  if (at(port).capable == capable) return;
  at(port).capable = capable;
  at(port).sync_interval.reset();
  at(port).announce_interval.reset();
  information(port) = {.info_is = capable ? InfoIs::aged : InfoIs::disabled};
  if (started_) reselect(now, outputs);
}

void PtpInstance::timer_expired(PortNumber port, TimerPurpose purpose, sim::LocalTime now, Outputs& outputs) {
  switch (purpose) {
    case TimerPurpose::announce_interval:
      return send_announce(port, now, outputs);
    case TimerPurpose::announce_receipt:
      return age(port, now, outputs);
    case TimerPurpose::sync_interval:
      return sync_interval_elapsed(port, now, outputs);
    case TimerPurpose::sync_receipt:
      return sync_receipt_expired(port, now, outputs);
    case TimerPurpose::gptp_capable_interval:
    case TimerPurpose::gptp_capable_receipt:  // of the node
    case TimerPurpose::pdelay_interval:
      break;
  }
  TAKT_CHECK(false, "a timer of an instance");
}

// qualifyAnnounce (10.3.11.2.1)
bool PtpInstance::is_qualified(const Announce& announce) const {
  if (announce.header.source.clock == self() || announce.steps_removed >= 255) return false;
  return std::find(announce.path_trace.begin(), announce.path_trace.end(), self()) == announce.path_trace.end();
}

// rcvInfo (10.3.12.2.1): superior to what is known here, or the same sender again.
bool PtpInstance::is_accepted(const PriorityVector& priority, PortNumber port) const {
  const PortInformation& known = information_[port - 1u];
  switch (known.info_is) {
    case InfoIs::disabled:
      return false;
    case InfoIs::aged:
      return true;
    case InfoIs::mine:
      return external() || priority < known.priority;
    case InfoIs::received:
      return external() || priority.source == known.priority.source || priority < known.priority;
  }
  return false;
}

void PtpInstance::received(const Announce& announce, PortNumber port, sim::LocalTime now, Outputs& outputs) {
  if (!is_qualified(announce)) return;
  const PriorityVector priority = PriorityVector::of(announce, port);
  if (!is_accepted(priority, port)) return;
  if (external() && at(port).role != PortRole::time_receiver) return;
  PortInformation& known = information(port);
  const bool repeated =
      known.info_is == InfoIs::received && known.priority == priority && at(port).path_trace == announce.path_trace;
  outputs.push_back(
      ArmTimer{timer(port, TimerPurpose::announce_receipt),
               now + config_.announce_receipt_timeout * interval_of(announce.header.log_message_interval)});
  const bool same_time = at(port).time == announce.time;
  if (repeated && same_time) return;
  known = {InfoIs::received, priority};
  at(port).path_trace = announce.path_trace;
  at(port).time = announce.time;
  reselect(now, outputs);
  if (!same_time && selection_.receiver == port) announce_to_all(now, outputs);
}

// The information of a port is too old.
void PtpInstance::age(PortNumber port, sim::LocalTime now, Outputs& outputs) {
  if (information(port).info_is != InfoIs::received) return;
  information(port).info_is = InfoIs::aged;
  if (!external()) reselect(now, outputs);
}

// updtStatesTree (10.3.13.2.4), and all that follows from other roles.
void PtpInstance::reselect(sim::LocalTime now, Outputs& outputs) {
  const PriorityVector before = selection_.grandmaster;
  const PortNumber receiver_before = selection_.receiver;
  if (external())
    select_external();
  else
    select_roles(config_.system, information_, next_selection_);
  std::swap(selection_, next_selection_);

  std::vector<ClockIdentity> path;
  if (selection_.receiver != 0) path = at(selection_.receiver).path_trace;
  if (path.size() < Announce::longest_path_trace) path.push_back(self());
  const bool path_changed = path != path_trace_;
  path_trace_ = std::move(path);

  for (PortNumber port = 1; port <= ports(); ++port) set_role(port, selection_.roles[port - 1u], outputs);
  adopt_grandmaster(before, receiver_before, now, outputs);
  for (PortNumber port = 1; port <= ports(); ++port) {
    if (at(port).role != PortRole::time_transmitter) continue;
    const bool announced_changed = update_announced(port);
    if (announced_changed || path_changed) send_announce(port, now, outputs);  // newInfo
  }
}

/// Other properties of the time are news (10.3.8): they go on at once.
void PtpInstance::announce_to_all(sim::LocalTime now, Outputs& outputs) {
  for (PortNumber port = 1; port <= ports(); ++port)
    if (at(port).role == PortRole::time_transmitter) send_announce(port, now, outputs);
}

void PtpInstance::select_external() {
  Selection& next = next_selection_;
  next.grandmaster = {config_.system, 0, {self(), 0}, 0};
  next.receiver = 0;
  next.roles = *config_.external_roles;
  for (std::size_t i = 0; i < next.roles.size(); ++i) {
    if (next.roles[i] == PortRole::time_receiver) {
      next.receiver = static_cast<PortNumber>(i + 1);
      if (information_[i].info_is == InfoIs::received) next.grandmaster = information_[i].priority.one_step_further();
    }
    if (!ports_[i].capable) next.roles[i] = PortRole::disabled;
  }
}

void PtpInstance::set_role(PortNumber number, PortRole role, Outputs& outputs) {
  Port& port = at(number);
  if (port.role == role) return;
  const PortRole before = std::exchange(port.role, role);
  if (before == PortRole::time_transmitter) {
    outputs.push_back(CancelTimer{timer(number, TimerPurpose::announce_interval)});
    outputs.push_back(CancelTimer{timer(number, TimerPurpose::sync_interval)});
    port.leaving.reset();
    port.has_own_interval = false;
  }
  if (before == PortRole::time_receiver) {
    outputs.push_back(CancelTimer{timer(number, TimerPurpose::sync_receipt)});
    port.waiting.reset();
    if (sync_) outputs.push_back(SyncLost{index_});
  }
  if (role == PortRole::time_transmitter || role == PortRole::disabled)
    outputs.push_back(CancelTimer{timer(number, TimerPurpose::announce_receipt)});
  if (role == PortRole::time_transmitter) information(number).info_is = InfoIs::aged;  // until update_announced()
  outputs.push_back(RoleChange{index_, number, role});
}

/// True if a time transmitter now announces something else than before.
bool PtpInstance::update_announced(PortNumber port) {
  const PortInformation told{InfoIs::mine, selection_.announced_at(port, self())};
  const bool changed = information(port).info_is != InfoIs::mine || information(port).priority != told.priority;
  information(port) = told;
  return changed;
}

void PtpInstance::adopt_grandmaster(const PriorityVector& before, PortNumber receiver_before, sim::LocalTime now,
                                    Outputs& outputs) {
  if (selection_.receiver != receiver_before) {
    if (selection_.receiver == 0) {
      // Holdover: the time goes on as it did, from the last Sync.
      if (sync_)
        source_ = {now, sync_->grandmaster_time_at(now), sync_->rate_ratio_at(now),
                   sync_->information.gm_time_base_indicator};
      next_sync_ = now;
    }
    outputs.push_back(CancelTimer{timer(0, TimerPurpose::sync_interval)});
  }
  const bool has_other_time = before.root.clock != selection_.grandmaster.root.clock;
  if (selection_.receiver != 0 && !external()) expect_sync(before, receiver_before, now, outputs);
  if (has_other_time)
    // A Follow_Up may come behind the Announce of another grandmaster, and carry the time of the former one.
    for (Port& port : ports_) {
      port.waiting.reset();
      port.leaving.reset();
    }
  if (has_other_time || selection_.receiver == 0 || selection_.receiver != receiver_before ||
      at(selection_.receiver).role != PortRole::time_receiver)
    sync_.reset();
  if (has_other_time || selection_.receiver != receiver_before) drift_.reset();
  const bool changed = before.root.clock != selection_.grandmaster.root.clock ||
                       before.steps_removed != selection_.grandmaster.steps_removed;
  if (changed)
    outputs.push_back(
        GrandmasterChange{index_, selection_.grandmaster.root.clock, selection_.grandmaster.steps_removed});
  if (started_ && selection_.receiver == 0 && receiver_before != 0) sync_interval_elapsed(0, now, outputs);
}

// Sync can be late where a grandmaster is present only (gmPresent in PortAnnounceInformation, 10.3.12): below a root
// that cannot be one, none comes.
void PtpInstance::expect_sync(const PriorityVector& before, PortNumber receiver_before, sim::LocalTime now,
                              Outputs& outputs) {
  const bool was_expected = selection_.receiver == receiver_before && before.root.priority1 < 255;
  if (grandmaster_present() && !was_expected)
    arm_sync_receipt(selection_.receiver, config_.log_sync_interval, now, outputs);
  if (grandmaster_present() || !was_expected) return;
  outputs.push_back(CancelTimer{timer(selection_.receiver, TimerPurpose::sync_receipt)});
  if (sync_ && at(selection_.receiver).role == PortRole::time_receiver) outputs.push_back(SyncLost{index_});
}

void PtpInstance::received(const IntervalRequest& request, PortNumber number, sim::LocalTime now, Outputs& outputs) {
  Port& port = at(number);
  const bool was_stopped = port.announce_interval.is_stopped();
  if (port.announce_interval.request(request.announce) && port.role == PortRole::time_transmitter) {
    const sim::LocalTime soonest = now + port.announce_interval.length();
    port.next_timed_announce = was_stopped ? soonest : std::min(port.next_timed_announce, soonest);
    if (port.announce_interval.is_stopped())
      outputs.push_back(CancelTimer{timer(number, TimerPurpose::announce_interval)});
    else
      outputs.push_back(ArmTimer{timer(number, TimerPurpose::announce_interval), port.next_timed_announce});
  }
  if (port.sync_interval.request(request.time_sync)) follow_sync_interval(number, now, outputs);
}

// PortAnnounceTransmit (10.3.16): a time transmitter announces what it knows, a root that cannot be grandmaster as
// well. So those behind it hear that the grandmaster is gone, and one of them can take over.
void PtpInstance::send_announce(PortNumber number, sim::LocalTime now, Outputs& outputs) {
  Port& port = at(number);
  if (port.role != PortRole::time_transmitter) return;
  if (port.announce_interval.is_stopped()) return;
  port.next_timed_announce = now + port.announce_interval.sent();
  outputs.push_back(ArmTimer{timer(number, TimerPurpose::announce_interval), port.next_timed_announce});
  const bool knows = is_grandmaster() || information(selection_.receiver).info_is == InfoIs::received;
  if (!knows) return;
  Announce announce;
  announce.header = header(number, port.next_announce++, port.announce_interval.announced());
  announce.time = time_properties();
  const PriorityVector& best = selection_.grandmaster;
  announce.grandmaster_priority1 = best.root.priority1;
  announce.grandmaster_quality = best.root.quality;
  announce.grandmaster_priority2 = best.root.priority2;
  announce.grandmaster = best.root.clock;
  announce.steps_removed = best.steps_removed;
  announce.path_trace = path_trace_;
  outputs.push_back(SendMessage{number, std::move(announce)});
}

Header PtpInstance::header(PortNumber port, std::uint16_t sequence_id, int log_interval) const {
  Header header;
  header.domain = config_.domain;
  header.source = {self(), port};
  header.sequence_id = sequence_id;
  header.log_message_interval = static_cast<std::int8_t>(log_interval);
  return header;
}

}  // namespace takt::models::gptp
