#include "models/ingress/flow_meter.hpp"

namespace takt::models {

FlowMeter::FlowMeter(const FlowMeterConfig& config)
    : committed_burst_(tokens(config.committed_burst_size)), excess_burst_(tokens(config.excess_burst_size)), committed_tokens_(committed_burst_), excess_tokens_(excess_burst_), config_(config) {
  constexpr std::uint64_t greatest = 1'000'000'000'000;  // keeps rate * 2^63 ps below 2^127
  TAKT_CHECK(config.committed_information_rate.bits_per_second <= greatest, "a meter's CIR is at most 1 Tb/s");
  TAKT_CHECK(config.excess_information_rate.bits_per_second <= greatest, "a meter's EIR is at most 1 Tb/s");
}

/// `overflow`: committed tokens for which there was no room.
void FlowMeter::fill_excess(sim::Duration elapsed, Tokens overflow) {
  // Each summand is below 2^104, so the sum is exact.
  excess_tokens_ = std::min(excess_burst_, excess_tokens_ + brought_by(config_.excess_information_rate, elapsed) + (config_.coupling_flag ? overflow : Tokens{0}));
}

/// A frame that gets no committed tokens.
FlowMeter::Verdict FlowMeter::not_green(Tokens needed, bool drop_eligible) {
  if (mark_all_frames_red_) return {FrameColor::red, false, drop_eligible};
  Verdict verdict{FrameColor::red, false, drop_eligible};
  if (needed <= excess_tokens_) {
    excess_tokens_ -= needed;
    verdict = {FrameColor::yellow, !config_.drop_on_yellow, true};
  }
  if (!verdict.pass && config_.mark_all_frames_red_enable) mark_all_frames_red_ = true;
  return verdict;
}

}  // namespace takt::models
