// SPDX-License-Identifier: Apache-2.0
#include "analysis/frame_arrivals.hpp"

namespace takt::analysis {
namespace {

constexpr sim::int128 ps_in_a_second = 1'000'000'000'000;

/// One pattern against the bucket: at the jumps of one period, since the period itself brings no more than the rate.
bool conforms(const ArrivalPattern& pattern, std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second) {
  const auto allowed = [&](Ps length, std::int64_t frames) {
    return static_cast<sim::int128>(frames) * bits * ps_in_a_second <=
           static_cast<sim::int128>(burst_bits) * ps_in_a_second + static_cast<sim::int128>(bits_per_second) * length;
  };
  if (is_bounded(pattern.period) && static_cast<sim::int128>(pattern.frames) * bits * ps_in_a_second >
                                        static_cast<sim::int128>(bits_per_second) * pattern.period)
    return false;
  constexpr int most_jumps = 100'000;
  Ps length = 0;
  for (int i = 0; i < most_jumps; ++i) {
    if (!allowed(length, pattern.count(length))) return false;
    length = pattern.next_jump(length);
    if (length > pattern.period || !is_bounded(length)) return true;
  }
  return false;
}

}  // namespace

Ps longest_hold(const FrameArrivals& arrivals, std::int64_t bits, std::int64_t burst_bits,
                std::int64_t bits_per_second) {
  if (!arrivals.is_limited() || burst_bits < bits || bits_per_second <= 0) return unbounded_ps;
  const ArrivalPattern& calm = arrivals.calmest();
  if (is_bounded(calm.period) && static_cast<sim::int128>(calm.frames) * bits * ps_in_a_second >
                                     static_cast<sim::int128>(bits_per_second) * calm.period)
    return unbounded_ps;
  constexpr int most_jumps = 100'000;
  Ps longest = 0;
  Ps length = 0;
  Ps same_since = unbounded_ps;  // from there on the calmest pattern is the least
  for (int i = 0; i < most_jumps; ++i) {
    // The last of the frames that have come has its tokens when all of them have.
    const std::int64_t count = arrivals.count(length);
    const sim::int128 lacking = (static_cast<sim::int128>(count) * bits - burst_bits) * ps_in_a_second;
    const sim::int128 eligible = lacking <= 0 ? 0 : (lacking + bits_per_second - 1) / bits_per_second;
    if (eligible - length > longest)
      longest = eligible - length < unbounded_ps ? static_cast<Ps>(eligible - length) : unbounded_ps;
    same_since = count == calm.count(length) ? std::min(same_since, length) : unbounded_ps;
    if (is_bounded(same_since) && !is_bounded(calm.next_jump(length))) return longest;
    length = arrivals.next_jump(length);
    // A period of the calmest pattern brings no more than the rate: what follows is no worse.
    if (!is_bounded(length) || (is_bounded(same_since) && length - same_since > calm.period)) return longest;
  }
  return unbounded_ps;
}

bool conforms(const FrameArrivals& arrivals, std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second) {
  return std::any_of(arrivals.patterns().begin(), arrivals.patterns().end(), [&](const ArrivalPattern& pattern) {
    return conforms(pattern, bits, burst_bits, bits_per_second);
  });
}

ArrivalPattern pattern_of_token_bucket(std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second) {
  ArrivalPattern pattern;
  pattern.jitter = unbounded_ps;
  if (burst_bits < bits || bits_per_second <= 0) return pattern;
  pattern.period = static_cast<Ps>(static_cast<sim::int128>(bits) * ps_in_a_second / bits_per_second);
  if (pattern.period == 0) return pattern;
  pattern.jitter = static_cast<Ps>(
      (static_cast<sim::int128>(burst_bits - bits) * ps_in_a_second + bits_per_second - 1) / bits_per_second);
  return pattern;
}

}  // namespace takt::analysis
