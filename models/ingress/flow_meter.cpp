#include "models/ingress/flow_meter.hpp"

#include <algorithm>

namespace takt::models {

FlowMeter::FlowMeter(const FlowMeterConfig& config)
    : committed_tokens_(tokens(config.committed_burst_size)), excess_tokens_(tokens(config.excess_burst_size)), config_(config) {
  constexpr std::uint64_t greatest = 1'000'000'000'000;  // keeps rate * 2^63 ps below 2^127
  TAKT_CHECK(config.committed_information_rate.bits_per_second <= greatest, "a meter's CIR is at most 1 Tb/s");
  TAKT_CHECK(config.excess_information_rate.bits_per_second <= greatest, "a meter's EIR is at most 1 Tb/s");
}

FlowMeter::Verdict FlowMeter::meter(sim::Octets length, bool drop_eligible, sim::LocalTime arrival) {
  fill(std::max(arrival - last_, sim::Duration()));
  last_ = arrival;
  if (mark_all_frames_red_) return {FrameColor::red, false, drop_eligible};

  const bool arrived_green = config_.color_mode == ColorMode::color_blind || !drop_eligible;
  Verdict verdict{color(tokens(length), arrived_green), true, drop_eligible};
  if (verdict.color == FrameColor::yellow) verdict.drop_eligible = true;
  verdict.pass = verdict.color == FrameColor::green || (verdict.color == FrameColor::yellow && !config_.drop_on_yellow);
  if (!verdict.pass && config_.mark_all_frames_red_enable) mark_all_frames_red_ = true;
  return verdict;
}

void FlowMeter::fill(sim::Duration elapsed) {
  const Tokens committed_burst = tokens(config_.committed_burst_size);
  const Tokens excess_burst = tokens(config_.excess_burst_size);
  const auto brought_by = [&](sim::DataRate rate) {
    return static_cast<Tokens>(rate.bits_per_second) * static_cast<Tokens>(elapsed.ps());
  };
  committed_tokens_ += brought_by(config_.committed_information_rate);
  const Tokens overflow = std::max(Tokens{0}, committed_tokens_ - committed_burst);
  committed_tokens_ -= overflow;
  // Each summand is below 2^104, so the sum is exact.
  excess_tokens_ = std::min(excess_burst, excess_tokens_ + brought_by(config_.excess_information_rate) +
                                              (config_.coupling_flag ? overflow : Tokens{0}));
}

FrameColor FlowMeter::color(Tokens length, bool arrived_green) {
  if (arrived_green && length <= committed_tokens_) {
    committed_tokens_ -= length;
    return FrameColor::green;
  }
  if (length <= excess_tokens_) {
    excess_tokens_ -= length;
    return FrameColor::yellow;
  }
  return FrameColor::red;
}

}  // namespace takt::models
