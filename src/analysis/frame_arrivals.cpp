#include "analysis/frame_arrivals.hpp"

namespace takt::analysis {
namespace {

constexpr sim::int128 ps_in_a_second = 1'000'000'000'000;

/// One pattern against the bucket: at the jumps of one period, since the period itself brings no more than the rate.
bool conforms(const ArrivalPattern& pattern, std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second) {
  const auto allowed = [&](Ps length, std::int64_t frames) {
    return static_cast<sim::int128>(frames) * bits * ps_in_a_second <= static_cast<sim::int128>(burst_bits) * ps_in_a_second + static_cast<sim::int128>(bits_per_second) * length;
  };
  if (is_bounded(pattern.period) &&
      static_cast<sim::int128>(pattern.frames) * bits * ps_in_a_second > static_cast<sim::int128>(bits_per_second) * pattern.period)
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

bool conforms(const FrameArrivals& arrivals, std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second) {
  return std::any_of(arrivals.patterns().begin(), arrivals.patterns().end(),
                     [&](const ArrivalPattern& pattern) { return conforms(pattern, bits, burst_bits, bits_per_second); });
}

ArrivalPattern pattern_of_token_bucket(std::int64_t bits, std::int64_t burst_bits, std::int64_t bits_per_second) {
  ArrivalPattern pattern;
  pattern.jitter = unbounded_ps;
  if (burst_bits < bits || bits_per_second <= 0) return pattern;
  pattern.period = static_cast<Ps>(static_cast<sim::int128>(bits) * ps_in_a_second / bits_per_second);
  if (pattern.period == 0) return pattern;
  pattern.jitter = static_cast<Ps>((static_cast<sim::int128>(burst_bits - bits) * ps_in_a_second + bits_per_second - 1) / bits_per_second);
  return pattern;
}

}  // namespace takt::analysis
