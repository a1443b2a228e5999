// SPDX-License-Identifier: Apache-2.0
// When a class of a port may send (IEEE 802.1Q 8.6.8): its transmission gate, its transmission selection algorithm, its
// maximum SDU size.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "models/clock/local_clock.hpp"
#include "models/egress/credit_based_selection.hpp"
#include "models/egress/deficit_round_robin.hpp"
#include "models/egress/gate_schedule.hpp"
#include "models/egress/shaping_config.hpp"
#include "models/ethernet/sizes.hpp"
#include "models/ethernet/traffic.hpp"

namespace takt::models {

/// The frame at the head of a queue, as far as shaping asks.
struct Head {
  std::uint32_t length = 0;  ///< DA to FCS; of a frame that was cut what is left of it
  sim::LocalTime eligible;   ///< counts in timed classes
};

class PortShaping {
 public:
  /// All references outlive it. The gates run on `clock`.
  PortShaping(const ShapingConfig& config, const LocalClock& clock, sim::Duration octet_time);

  /// Management sets ConfigChange at `now`.
  ConfigChange request_gates(sim::TrueTime now, const GateConfig& gates);

  /// `now` if the class with that first frame may send: its gate is open for long enough, and its credit not negative.
  /// Otherwise the instant at which to ask again.
  ///
  /// A frame may start if its last bit leaves before or when the gate closes: preamble and SFD count, the gap after it
  /// does not. `delay`: the medium becomes free only so much later; a frame must end before its gate closes all the
  /// same.
  sim::TrueTime ready_time(sim::TrueTime now, TrafficClass q, const Head& head, sim::Duration delay = {});
  /// For the rest of a frame that was cut: its gate must let it end, its credit does not matter.
  sim::TrueTime rest_ready_time(sim::TrueTime now, TrafficClass q, std::uint32_t remaining);
  /// Why ready_time() is not `now`.
  BlockedRecord refusal(sim::TrueTime now, TrafficClass q, const Head& head);
  /// The same of rest_ready_time().
  BlockedRecord gate_refusal(sim::TrueTime now, TrafficClass q);
  /// Neither credit nor eligibility times have a say in this class: when its gate lets a frame pass the frame may
  /// start.
  bool is_gated_only(TrafficClass q) const { return credits_[q] == nullptr && !is_timed(q); }

  // What the credit of a class should know.
  /// A frame of the class waits, or stands at the port to be selected.
  void frame_waits(sim::TrueTime now, TrafficClass q) {
    if (CreditBasedShaper* const credit = credit_of(q, now)) credit->frame_enqueued(now);
  }
  /// The frame that waited was dropped, and no other waits.
  void none_waits(sim::TrueTime now, TrafficClass q) {
    if (round_) round_->emptied(q);
    if (CreditBasedShaper* const credit = credit_of(q, now)) credit->queue_emptied(now);
  }
  /// A frame of the class starts; `queue_is_empty`: none of the class is left.
  void started(sim::TrueTime now, TrafficClass q, std::uint32_t length, bool queue_is_empty) {
    if (CreditBasedShaper* const credit = credit_of(q, now))
      credit->transmission_started(now, occupancy(length), queue_is_empty);
  }
  // A frame comes where none of its class waits and the medium is free.
  /// The cheap test of each piece: the frame is in a known window of its gate, its time has come, its credit is at
  /// rest. True: it has started. False: nothing has happened, and start_slow() follows.
  bool starts_at_once(sim::TrueTime now, TrafficClass q, const Frame& frame) {
    if (contains(gated_, q)) return is_in_known_window(now, q, frame);
    if (!clock_->is_ideal() || has_gates_ || (is_timed(q) && frame.marked && frame.eligible > clock_->local_at(now)))
      return false;
    CreditBasedSelection* const credit = credit_based(q);
    return credit == nullptr || credit->starts_at_rest(now, occupancy(frame.length));
  }
  /// frame_waits() and ready_time(), and started() if that is `now`. `now` if it has started.
  sim::TrueTime start_slow(sim::TrueTime now, TrafficClass q, const Head& head);
  /// ready_time() of the first frame of a queue.
  sim::TrueTime ready_time_of_head(sim::TrueTime now, TrafficClass q, const Frame& frame) {
    return is_in_known_window(now, q, frame) ? now : ready_time(now, q, {frame.length, eligible_of(frame)});
  }
  /// Counts in timed classes.
  static sim::LocalTime eligible_of(const Frame& frame) {
    return frame.marked ? frame.eligible : sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min());
  }
  /// The frame under way is cut; the medium is free at `free_at`.
  void cut(sim::TrueTime now, TrafficClass q, sim::TrueTime free_at) {
    if (CreditBasedShaper* const credit = credit_of(q, now)) credit->transmission_cut(now, free_at);
  }
  /// What is left of it goes on.
  void resumed(sim::TrueTime now, TrafficClass q, std::uint32_t remaining) {
    if (CreditBasedShaper* const credit = credit_of(q, now)) credit->transmission_resumed(now, occupancy(remaining));
  }

  /// Whose turn it is among classes that share bandwidth; null without such classes.
  DeficitRoundRobin* round() { return round_.get(); }

  /// A broken gate: from now on it is open, or closed, whatever the list says; nothing: it works again.
  void force_gate(sim::TrueTime now, TrafficClass q, std::optional<bool> open);

  /// To be called when the clock has changed, too.
  void find_gated();

  bool is_timed(TrafficClass q) const { return contains(timed_, q); }
  bool limits_sdu() const { return limits_sdu_; }
  bool fits_max_sdu(TrafficClass q, std::uint32_t msdu) const {
    return config_->queue_max_sdu[q].count == 0 || msdu <= config_->queue_max_sdu[q].count;
  }

  GateSchedule& gates() { return gates_; }
  const GateSchedule& gates() const { return gates_; }
  bool has_gates() const { return has_gates_; }
  /// The states of the gates with broken ones as they are stuck.
  GateStates with_forced(GateStates states) const {
    return static_cast<GateStates>((states & ~(forced_open_ | forced_closed_)) | forced_open_);
  }
  /// What the gates are at `now`, broken ones as they are stuck.
  GateStates gate_states(sim::TrueTime now) { return with_forced(gates_.gate_states(clock_->local_at(now))); }
  /// Frames that were still being sent when their gate closed, by class (TransmissionOverrun): only a change of lists
  /// or a broken gate does that.
  std::uint64_t transmission_overrun(TrafficClass q) const { return transmission_overrun_[q]; }
  /// The frame under way ends at `last_bit`: counts it if the gates that are now in force close before.
  void check_overrun(sim::TrueTime now, TrafficClass q, sim::TrueTime last_bit);

 private:
  ConfigChange request_gates(sim::TrueTime now, sim::LocalTime asked, const GateConfig& gates);
  /// Only its gate restricts the class, and the gate is known to let the frame pass.
  bool is_in_known_window(sim::TrueTime now, TrafficClass q, const Frame& frame) {
    return contains(gated_, q) &&
           gates_.starts_in_known_window(q, sim::LocalTime::from_ps(now.ps()), occupancy_until_last_bit(frame.length));
  }
  /// From the first bit of its preamble to its last bit, which must leave before its gate closes.
  sim::Duration occupancy_until_last_bit(std::uint32_t length) const {
    return octet_time_ * (preamble_and_sfd.count + std::int64_t{length});
  }
  /// Its time is still to come.
  bool is_held(TrafficClass q, sim::TrueTime now, const Head& head) const {
    return is_timed(q) && head.eligible > clock_->local_at(now);
  }
  sim::Duration occupancy(std::uint32_t length) const { return octet_time_ * wire_length(Octets{length}).count; }
  sim::TrueTime gate_ready_time(sim::TrueTime now, TrafficClass q, std::uint32_t length, sim::Duration delay);
  bool is_stuck(TrafficClass q) const { return ((forced_open_ | forced_closed_) >> q & 1u) != 0; }
  GateInForce gate_of(TrafficClass q) const { return {clock_, has_gates_, is_stuck(q)}; }
  CreditBasedSelection* credit_based(TrafficClass q) { return credits_[q].get(); }
  /// Null without a shaper; its gate has been followed.
  CreditBasedShaper* credit_of(TrafficClass q, sim::TrueTime now) {
    CreditBasedSelection* const credit = credit_based(q);
    return credit == nullptr ? nullptr : &credit->credit_at(gate_of(q), now);
  }

  const ShapingConfig* config_;
  const LocalClock* clock_;
  sim::Duration octet_time_;
  bool has_gates_;
  bool limits_sdu_;
  ClassSet timed_;
  ClassSet gated_ =
      0;  // classes in which a gate that is not stuck has a say, and nothing else; none where the clock is not ideal
  ClassSet forced_open_ = 0;
  ClassSet forced_closed_ = 0;
  GateSchedule gates_;
  std::vector<std::unique_ptr<GateControlList>> lists_;  // all that were ever requested; spans point to them
  std::array<std::unique_ptr<CreditBasedSelection>, traffic_class_count> credits_;  // null: another algorithm
  std::unique_ptr<DeficitRoundRobin> round_;
  std::array<std::uint64_t, traffic_class_count> transmission_overrun_{};
};

}  // namespace takt::models
