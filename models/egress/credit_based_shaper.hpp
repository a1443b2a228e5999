// SPDX-License-Identifier: Apache-2.0
// The credit-based shaper of one traffic class, in exact integers (IEEE 802.1Q clause 8.6.8.2, formerly Qav).
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <limits>

#include "sim/check.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// A rate of credit in bit/s, as an exact ratio: the operational slope under a gate is rarely a whole number.
struct CreditSlope {
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;
  bool operator==(const CreditSlope&) const = default;
};

/// oper_idle_slope = admin_idle_slope * oper_cycle_time / gate_open_time (8.6.8.2, b): the class gets its bandwidth
/// over the whole cycle although its credit only grows while its gate is open. Give a shaper the admin_idle_slope
/// itself if the scenario means the bandwidth of the open part. Precondition: 0 < open <= cycle. Exact; only a ratio
/// that no 62 bits hold, with `port_transmit_rate` on the same denominator, is rounded down to whole bit/s.
CreditSlope operational_idle_slope(sim::DataRate admin_idle_slope, sim::Duration open, sim::Duration cycle,
                                   sim::DataRate port_transmit_rate);

/// An amount of credit. The unit is a bit times 10^-12, divided by the slope's denominator: a slope times picoseconds
/// is then a whole number of units, so credit is exact whatever the intervals. Amounts of different shapers do not
/// compare.
struct Credit {
  sim::int128 units = 0;
  constexpr auto operator<=>(const Credit&) const = default;
};

/// Credit as a function of what happened. All calls take true time, which does not decrease from call to call; what is
/// told of the past at one instant happens in the order of the calls. Ends of transmissions need no call: their time is
/// known.
///
/// - Credit falls with send_slope = idle_slope - port_transmit_rate during a transmission. A transmission lasts until
/// the
///   medium is free for the next one: preamble, frame and inter-packet gap, 8 + L + 12 octets. The idle slope counts
///   the same octets (34.4), so a class that sends all its frames at exactly idle_slope neither gains nor loses.
/// - It grows with idle_slope while nothing of the class is sent, the gate is open and the queue holds a frame or the
/// credit is
///   negative; in an empty queue not above 0.
/// - Positive credit is lost at once when the queue is empty and nothing is sent, gate open or not.
/// - A closed gate freezes it, but for a transmission under way, whose gap may reach beyond the close.
/// - In the instant at which a transmission ends with nothing queued, the loss comes before a frame that arrives then.
class CreditBasedShaper {
 public:
  /// 0 <= idle_slope <= port_transmit_rate, both below 2^62 on the slope's denominator. Credit 0, queue empty, gate
  /// open.
  CreditBasedShaper(CreditSlope idle_slope, sim::DataRate port_transmit_rate);

  Credit credit(sim::TrueTime now) const {
    CreditBasedShaper then = *this;
    then.advance(now);
    return then.credit_;
  }
  /// No frame of the class is under way, its gate is open and its credit is not negative.
  bool may_start(sim::TrueTime now) const { return now >= free_at_ && gate_open_ && credit(now).units >= 0; }
  /// The first instant at or after `now` at which may_start() is true while the gate stays as it is, rounded up to the
  /// next picosecond; never() with a closed gate, or if the credit can't grow.
  sim::TrueTime eligible_time(sim::TrueTime now) const;
  /// How long credit must grow to reach 0, not counting the transmission under way and closed gates; Duration::max() if
  /// it can't.
  sim::Duration growth_needed(sim::TrueTime now) const;

  /// A frame waits in the queue.
  void frame_enqueued(sim::TrueTime now) {
    advance(now);
    queue_empty_ = false;
    recovery_ps_ = unknown;
  }
  /// frame_enqueued() and transmission_started() of a frame that comes where none waits, if credit is known to be back
  /// at 0 since the one before it: true then. Otherwise nothing has happened.
  bool starts_at_rest(sim::TrueTime now, sim::Duration occupancy) {
    if ((now - free_at_).ps() < recovery_ps_) return false;
    TAKT_CHECK(now >= updated_, "a shaper is not asked about its past");
    credit_.units = 0;
    updated_ = now;
    free_at_ = now + occupancy;
    recovery_ps_ = recovery_of(occupancy);
    return true;
  }
  /// No frame waits any more, for another reason than a start.
  void queue_emptied(sim::TrueTime now) {
    advance(now);
    queue_empty_ = true;
    advance(now);
  }
  /// A frame leaves the queue and occupies the medium for `occupancy`. Precondition: may_start(now).
  void transmission_started(sim::TrueTime now, sim::Duration occupancy, bool queue_empty_now);
  /// The rest of a preempted frame goes on, whatever the credit. Precondition: nothing of the class is being sent.
  void transmission_resumed(sim::TrueTime now, sim::Duration occupancy);
  /// The transmission under way ends at `free_at` instead: it is preempted.
  void transmission_cut(sim::TrueTime now, sim::TrueTime free_at);
  void gate_opened(sim::TrueTime now) {
    advance(now);
    gate_open_ = true;
  }
  void gate_closed(sim::TrueTime now) {
    advance(now);
    gate_open_ = false;
    recovery_ps_ = unknown;
  }
  /// Another slope from now on: the gate list has changed. The denominator may change; credit is rounded towards minus
  /// infinity.
  void set_idle_slope(sim::TrueTime now, CreditSlope idle_slope);

  bool gate_is_open() const { return gate_open_; }
  /// Nothing waits or is being sent, and credit is 0: so it stays, whatever the gate does.
  bool is_at_rest(sim::TrueTime now) const {
    return queue_empty_ && now >= free_at_ && updated_ >= free_at_ && credit_.units == 0;
  }

  /// Up to when the credit is known.
  sim::TrueTime updated() const { return updated_; }
  CreditSlope idle_slope() const { return idle_slope_; }
  /// How many units are one bit.
  sim::int128 units_per_bit() const { return sim::int128{idle_slope_.denominator} * 1'000'000'000'000; }

  /// The least credit, if no transmission of the class occupies the medium for longer: max_frame_size * send_slope / R.
  /// Two fragments of a preempted frame count together if credit does not get back to 0 between them.
  Credit lo_credit(sim::Duration longest_occupancy) const {
    return {sim::int128{send_slope_} * longest_occupancy.ps()};
  }
  /// The greatest credit, if no frame of the class waits for longer with credit: max_interference_size * idle_slope /
  /// R.
  Credit hi_credit(sim::Duration longest_interference) const {
    return {sim::int128{idle_slope_.numerator} * longest_interference.ps()};
  }

 private:
  static constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();
  static constexpr int factor_bits = 8;
  static constexpr std::int64_t greatest_factor = 1 << 14;
  static constexpr std::int64_t longest_known = std::int64_t{1}
                                                << 48;  // its product with greatest_factor does not overflow

  /// How long credit that is 0 or more when a transmission begins takes at most to get back to 0 after it, with an open
  /// gate; unknown where that is not worth knowing.
  std::int64_t recovery_of(sim::Duration occupancy) const {
    if (recovery_factor_ == unknown || occupancy.ps() > longest_known) return unknown;
    return (occupancy.ps() * recovery_factor_ >> factor_bits) + 1;
  }
  /// Credit at `now`, from what is known since updated_.
  void advance(sim::TrueTime now) {
    TAKT_CHECK(now >= updated_, "a shaper is not asked about its past");
    if (updated_ < free_at_) {
      const sim::TrueTime sent_until = std::min(now, free_at_);
      credit_.units += sim::int128{send_slope_} * (sent_until - updated_).ps();
      updated_ = sent_until;
      if (now < free_at_) return;
    }
    if (queue_empty_ && credit_.units > 0) credit_.units = 0;
    if (gate_open_ && (!queue_empty_ || credit_.units < 0)) {
      credit_.units += sim::int128{idle_slope_.numerator} * (now - updated_).ps();
      if (queue_empty_ && credit_.units > 0) credit_.units = 0;
    }
    updated_ = now;
  }
  void set_slopes(CreditSlope idle_slope);

  /// So long after free_at_ credit is 0, unless something else happens: nothing waits, and the gate is open. Or
  /// unknown.
  std::int64_t recovery_ps_ = unknown;
  std::int64_t recovery_factor_ = unknown;  ///< -send_slope / idle_slope in 2^-factor_bits, rounded up
  Credit credit_;                           // at updated_
  sim::TrueTime updated_;
  sim::TrueTime free_at_;  // when the transmission under way, or the last one, ends
  CreditSlope idle_slope_;
  std::int64_t send_slope_ = 0;  // on the denominator of idle_slope_; not positive
  std::uint64_t port_transmit_rate_ = 0;
  bool queue_empty_ = true;
  bool gate_open_ = true;
};

/// The longest interference that a shaped class meets from above and below if one shaped class stands above it and no
/// other: a longest frame of the unshaped classes, during which class A gains credit, then A's burst to its last frame
/// (Annex L.3): lower / (R - idle_slope_A) + frame_a / R, rounded up. Both sizes count preamble and gap. Precondition:
/// idle_slope_a < R.
sim::Duration second_class_interference(sim::Octets lower, sim::Octets frame_a, CreditSlope idle_slope_a,
                                        sim::DataRate port_transmit_rate);

}  // namespace takt::models
