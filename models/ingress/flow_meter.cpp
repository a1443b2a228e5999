// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/flow_meter.hpp"

namespace takt::models {

FlowMeter::FlowMeter(const FlowMeterConfig& config)
    : committed_burst_(tokens(config.committed_burst_size)),
      excess_burst_(tokens(config.excess_burst_size)),
      committed_tokens_(committed_burst_),
      excess_tokens_(excess_burst_),
      is_simple_(config.color_mode == ColorMode::color_blind && config.excess_burst_size.count == 0 &&
                 !config.mark_all_frames_red_enable),
      config_(config) {
  constexpr std::uint64_t greatest = 1'000'000'000'000;  // keeps rate * 2^63 ps below 2^127
  TAKT_CHECK(config.committed_information_rate.bits_per_second <= greatest, "a meter's CIR is at most 1 Tb/s");
  TAKT_CHECK(config.excess_information_rate.bits_per_second <= greatest, "a meter's EIR is at most 1 Tb/s");
  const std::uint64_t rate = config.committed_information_rate.bits_per_second;
  if (rate == 0) return;
  octet_ps_ = static_cast<std::int64_t>((8'000'000'000'000 + rate - 1) / rate);
  most_full_ = std::min(config.committed_burst_size.count, most_full_octets);
}

bool FlowMeter::finds_enough(sim::Octets length, sim::LocalTime arrival) {
  if (!is_simple_) return false;
  const sim::Duration elapsed = std::max(arrival - last_, sim::Duration());
  Tokens left = committed_tokens_ + brought_by(config_.committed_information_rate, elapsed);
  const bool is_full = left >= committed_burst_;
  if (is_full) left = committed_burst_;
  left -= tokens(length);
  if (left < 0) return false;
  committed_tokens_ = left;
  last_ = arrival;
  filling_ps_ = is_full && length.count <= most_full_ ? octet_ps_ * length.count : unknown;
  return true;
}

FlowMeter::Verdict FlowMeter::meter_slow(sim::Octets length, bool drop_eligible, sim::LocalTime arrival) {
  fill(std::max(arrival - last_, sim::Duration()));
  last_ = arrival;
  filling_ps_ = unknown;
  if (mark_all_frames_red_) return {FrameColor::red, false, drop_eligible};

  const bool arrived_green = config_.color_mode == ColorMode::color_blind || !drop_eligible;
  Verdict verdict{color(tokens(length), arrived_green), true, drop_eligible};
  if (verdict.color == FrameColor::yellow) verdict.drop_eligible = true;
  verdict.pass = verdict.color == FrameColor::green || (verdict.color == FrameColor::yellow && !config_.drop_on_yellow);
  if (!verdict.pass && config_.mark_all_frames_red_enable) mark_all_frames_red_ = true;
  return verdict;
}

void FlowMeter::fill(sim::Duration elapsed) {
  committed_tokens_ += brought_by(config_.committed_information_rate, elapsed);
  const Tokens overflow = std::max(Tokens{0}, committed_tokens_ - committed_burst_);
  committed_tokens_ -= overflow;
  // Each summand is below 2^104, so the sum is exact.
  excess_tokens_ = std::min(excess_burst_, excess_tokens_ + brought_by(config_.excess_information_rate, elapsed) +
                                               (config_.coupling_flag ? overflow : Tokens{0}));
}

FrameColor FlowMeter::color(Tokens needed, bool arrived_green) {
  if (arrived_green && needed <= committed_tokens_) {
    committed_tokens_ -= needed;
    return FrameColor::green;
  }
  if (needed <= excess_tokens_) {
    excess_tokens_ -= needed;
    return FrameColor::yellow;
  }
  return FrameColor::red;
}

}  // namespace takt::models
