// SPDX-License-Identifier: Apache-2.0
// The credit of one class (IEEE 802.1Q 8.6.8.2), counted along what is seen on the wire. Exact rational arithmetic.
#pragma once

#include <numeric>

#include "sim/time.hpp"
#include "tests/wire_checker/list_machine.hpp"

namespace takt::wire_checker {

class CreditAccount {
 public:
  CreditAccount(std::uint64_t rate, const models::CreditBased& shaper, models::TrafficClass q)
      : rate_(static_cast<std::int64_t>(rate)),
        idle_(static_cast<std::int64_t>(shaper.idle_slope.bits_per_second)),
        admin_idle_(idle_),
        of_whole_cycle_(shaper.of_whole_cycle),
        class_(q) {}

  /// Time goes on to `to` with the gate as it is. The account has been told of everything before.
  void flow(Ps to, bool gate_open) {
    if (at_ < busy_until_ && at_ < to) {
      const Ps end = std::min(to, busy_until_);
      credit_ += (sim::int128{idle_} - sim::int128{rate_} * denominator_) * (end - at_);
      at_ = end;
    }
    if (at_ < busy_until_) return;
    if (!waiting_ && credit_ > 0) credit_ = 0;
    if (at_ >= to) return;
    if (gate_open && (waiting_ || credit_ < 0)) {
      credit_ += sim::int128{idle_} * (to - at_);
      if (!waiting_ && credit_ > 0) credit_ = 0;
    }
    at_ = to;
  }
  /// The operational idle slope belongs to the list that runs.
  void follow_list(const ListConfig* oper) {
    if (oper == nullptr || !of_whole_cycle_) return;
    const Ps open = open_time_of(*oper, class_);
    if (open == 0) return;
    const sim::int128 numerator = sim::int128{admin_idle_} * oper->cycle_time;
    const sim::int128 divisor = std::gcd(static_cast<std::int64_t>(numerator % open), open);
    const auto denominator = static_cast<std::int64_t>(open / divisor);
    if (denominator != denominator_) {  // rounded towards minus infinity, as takt does
      const sim::int128 scaled = credit_ / denominator_ * denominator;
      const sim::int128 rest = credit_ % denominator_ * denominator;
      credit_ = scaled + rest / denominator_ - (rest % denominator_ < 0 ? 1 : 0);
    }
    slope_has_changed_ = slope_has_changed_ || at_ > 0;
    idle_ = static_cast<std::int64_t>(numerator / divisor);
    denominator_ = denominator;
  }

  void set_waiting(bool waiting) { waiting_ = waiting; }
  void transmit(Ps until) { busy_until_ = until; }

  bool is_negative() const { return credit_ < 0; }
  Ps busy_until() const { return busy_until_; }
  /// How long it must grow to reach 0; never if it can't.
  Ps growth_needed() const {
    if (credit_ >= 0) return 0;
    if (idle_ == 0) return never;
    const sim::int128 ps = (-credit_ + idle_ - 1) / idle_;
    return ps > never / 4 ? never : static_cast<Ps>(ps);
  }
  /// Bits, for texts.
  double bits() const { return static_cast<double>(credit_) / 1e12 / static_cast<double>(denominator_); }
  /// credit >= send_slope * duration, the least that a transmission of that length brings about. Of an unknown former
  /// slope only the port's rate is certain.
  bool is_above_lo(Ps duration) const {
    return credit_ >= ((slope_has_changed_ ? 0 : sim::int128{idle_}) - sim::int128{rate_} * denominator_) * duration;
  }
  /// credit <= idle_slope * duration, the most that so much interference brings about.
  bool is_below_hi(Ps duration) const { return credit_ <= sim::int128{idle_} * duration; }

 private:
  sim::int128 credit_ = 0;  // bits * 10^12 * denominator
  Ps at_ = 0;
  Ps busy_until_ = 0;
  std::int64_t rate_;
  std::int64_t idle_;  // on denominator_
  std::int64_t admin_idle_;
  std::int64_t denominator_ = 1;
  bool of_whole_cycle_;
  bool waiting_ = false;
  bool slope_has_changed_ = false;
  models::TrafficClass class_;
};

}  // namespace takt::wire_checker
