// SPDX-License-Identifier: Apache-2.0
// Asynchronous traffic shaping (IEEE 802.1Q clauses 8.6.5.6 and 8.6.11, formerly Qcr): from when may a frame be sent?
//
// Arithmetic is exact. A bit of the committed information rate rarely lasts a whole number of picoseconds, so the
// scheduler counts time in units of 1 ps / CIR, in which the bucket's times are integers whatever the rate. Only the
// eligibility time that a frame is given is a whole picosecond: that of the standard rounded *up*, so no frame is
// eligible too early. The bucket goes on with the time before rounding: the frames after it lose nothing, and a stream
// that keeps its rate is never delayed by a picosecond or more.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "sim/check.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// A scheduler group (8.6.5.6): all schedulers of one reception port and one upstream traffic class. Eligibility times
/// ascend within a group, which keeps its frames in order.
struct AtsGroup {
  sim::Duration maximum_residence_time = sim::Duration::max();
  sim::LocalTime group_eligibility_time;  ///< the latest eligibility time given so far
  std::uint64_t discarded_frames = 0;     ///< frames that would have stayed longer than the maximum residence time
};

/// One ATS scheduler instance. Its clock is that of the arrival times it gets; it has none.
class AtsScheduler {
 public:
  /// 1 b/s to 1 Tb/s; the burst in *bits*, at least that of the longest frame (the caller's to see to), at most 2^56.
  /// The bucket is full at `start`.
  AtsScheduler(sim::DataRate committed_information_rate, std::uint64_t committed_burst_size_bits,
               sim::LocalTime start = {});

  /// ProcessFrame (8.6.11.3): the eligibility time of a frame whose last bit came at `arrival`, or nothing if it is to
  /// be discarded, which changes nothing but the group's count. `length` counts what the configuration counts, media
  /// overhead included if it is to be shaped too. Not before `arrival`, not before the group's last eligibility time.
  std::optional<sim::LocalTime> process(sim::Octets length, sim::LocalTime arrival, AtsGroup& group) {
    return passes_full(length, arrival, group) || passes_at_once(length, arrival, group)
               ? arrival
               : process_late(length, arrival, group);
  }
  // The same in three parts, of which the next one follows where one says false; then nothing has happened.
  /// True: the frame is eligible at `arrival`, since the bucket has refilled after the previous frame, the common case.
  bool passes_full(sim::Octets length, sim::LocalTime arrival, AtsGroup& group) {
    if ((arrival - last_).ps() < filling_ps_ || arrival < group.group_eligibility_time || length.count > most_full_)
      return false;
    group.group_eligibility_time = arrival;
    note_full(length, arrival);
    return true;
  }
  /// True: neither group nor bucket keeps the frame, which is eligible at `arrival`.
  bool passes_at_once(sim::Octets length, sim::LocalTime arrival, AtsGroup& group);
  std::optional<sim::LocalTime> process_late(sim::Octets length, sim::LocalTime arrival, AtsGroup& group);

  sim::DataRate committed_information_rate() const { return {static_cast<std::uint64_t>(rate_)}; }
  std::uint64_t committed_burst_size_bits() const {
    return static_cast<std::uint64_t>(empty_to_full_ / units_in_a_bit);
  }
  /// When the bucket was or will be empty (BucketEmptyTime), rounded down to a picosecond; for tests and displays.
  sim::LocalTime bucket_empty_time() const;

 private:
  /// Time in units of 1 ps / CIR: one bit at CIR lasts 10^12 of them, whatever CIR is.
  using FineTime = sim::int128;
  static constexpr FineTime units_in_a_bit = 1'000'000'000'000;
  /// How long the bucket takes to get the tokens of a frame.
  static FineTime length_recovery(sim::Octets length) { return units_in_a_bit * 8 * length.count; }
  FineTime fine(sim::LocalTime time) const { return static_cast<FineTime>(time.ps()) * rate_; }

  static constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();
  static constexpr std::uint64_t most_full_octets = 1u << 20;  // 8 * 10^12 ps times so many is below 2^63 ps
  /// The bucket was full when a frame took its tokens.
  void note_full(sim::Octets length, sim::LocalTime arrival) {
    last_ = arrival;
    last_length_ = length.count;
    filling_ps_ = octet_ps_ * length.count;
  }
  /// BucketEmptyTime, which is worked out where it is asked for if the bucket was full.
  FineTime empty_time() const {
    return filling_ps_ == unknown ? bucket_empty_time_ : fine(last_) - empty_to_full_ + length_recovery({last_length_});
  }
  void set_empty_time(FineTime time) {
    filling_ps_ = unknown;
    bucket_empty_time_ = time;
  }

  std::int64_t filling_ps_ = 0;  // so long after last_, when a frame of last_length_ octets found it full, the bucket
                                 // is full again; or unknown
  sim::LocalTime last_;
  std::uint32_t last_length_ = 0;
  std::int64_t octet_ps_ = 0;       // in which it gets the tokens of an octet, rounded up
  std::uint32_t most_full_;         // a full bucket has tokens for a frame of so many octets
  FineTime bucket_empty_time_ = 0;  // if filling_ps_ is unknown
  FineTime empty_to_full_;          // EmptyToFullDuration: committed burst size / committed information rate
  std::int64_t rate_;               // b/s
};

}  // namespace takt::models
