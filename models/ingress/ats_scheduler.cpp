// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/ats_scheduler.hpp"

#include <algorithm>
#include <limits>

namespace takt::models {

AtsScheduler::AtsScheduler(sim::DataRate committed_information_rate, std::uint64_t committed_burst_size_bits,
                           sim::LocalTime start)
    : last_(start),
      most_full_(static_cast<std::uint32_t>(std::min(committed_burst_size_bits / 8, most_full_octets))),
      rate_(static_cast<std::int64_t>(committed_information_rate.bits_per_second)) {
  TAKT_CHECK(committed_information_rate.bits_per_second >= 1, "an ATS scheduler has a rate");
  TAKT_CHECK(committed_information_rate.bits_per_second <= 1'000'000'000'000, "an ATS scheduler has at most 1 Tb/s");
  TAKT_CHECK(committed_burst_size_bits <= std::uint64_t{1} << 56, "a committed burst size is at most 2^56 bits");
  empty_to_full_ = units_in_a_bit * static_cast<FineTime>(committed_burst_size_bits);
  octet_ps_ = static_cast<std::int64_t>((8'000'000'000'000 + committed_information_rate.bits_per_second - 1) /
                                        committed_information_rate.bits_per_second);
}

bool AtsScheduler::passes_at_once(sim::Octets length, sim::LocalTime arrival, AtsGroup& group) {
  const FineTime fine_arrival = fine(arrival), empty = empty_time();
  if (arrival < group.group_eligibility_time || empty + length_recovery(length) > fine_arrival) return false;
  group.group_eligibility_time = arrival;
  // A full bucket takes no more.
  const FineTime empty_if_full = fine_arrival - empty_to_full_;
  if (empty <= empty_if_full && length.count <= most_full_)
    note_full(length, arrival);
  else
    set_empty_time(std::max(empty, empty_if_full) + length_recovery(length));
  return true;
}

std::optional<sim::LocalTime> AtsScheduler::process_late(sim::Octets length, sim::LocalTime arrival, AtsGroup& group) {
  const FineTime empty = empty_time();
  const FineTime scheduler_eligibility = empty + length_recovery(length);
  const sim::LocalTime not_before = std::max(arrival, group.group_eligibility_time);
  FineTime eligibility = fine(not_before);
  FineTime eligibility_ps = not_before.ps();
  if (scheduler_eligibility > eligibility) {
    eligibility = scheduler_eligibility;
    // Division truncates, which rounds up what is negative; only a quotient below the true value is raised.
    eligibility_ps = eligibility / rate_;
    if (eligibility_ps * rate_ < eligibility) ++eligibility_ps;
  }
  if (eligibility_ps - arrival.ps() > group.maximum_residence_time.ps() ||
      eligibility_ps >= std::numeric_limits<std::int64_t>::max()) {
    ++group.discarded_frames;
    return std::nullopt;
  }
  group.group_eligibility_time = sim::LocalTime::from_ps(static_cast<std::int64_t>(eligibility_ps));
  set_empty_time(std::max(empty, eligibility - empty_to_full_) + length_recovery(length));
  return group.group_eligibility_time;
}

sim::LocalTime AtsScheduler::bucket_empty_time() const {
  const FineTime empty = empty_time();
  const FineTime quotient = empty / rate_;
  const FineTime floor = quotient - (quotient * rate_ > empty ? 1 : 0);
  return sim::LocalTime::from_ps(static_cast<std::int64_t>(floor));
}

}  // namespace takt::models
