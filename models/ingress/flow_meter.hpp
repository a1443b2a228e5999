// The flow meter of per-stream filtering and policing (IEEE 802.1Q clause 8.6.5.5, the bandwidth profile of MEF 10.3):
// two rates, three colours.
//
// Arithmetic is exact: tokens are counted in units of 1 / (8 * 10^12) octet, of which a rate of r b/s brings r in each
// picosecond, so nothing is lost between frames at any rate.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sim/check.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::models {

enum class ColorMode : std::uint8_t { color_blind, color_aware };
enum class FrameColor : std::uint8_t { green, yellow, red };
constexpr const char* name_of(FrameColor color) {
  constexpr const char* names[] = {"green", "yellow", "red"};
  return names[static_cast<std::size_t>(color)];
}

/// What management sets. Rates up to 1 Tb/s, bursts in octets; a rate or a burst of 0 lets nothing of its colour pass.
struct FlowMeterConfig {
  sim::DataRate committed_information_rate;   ///< CIR
  sim::Octets committed_burst_size;           ///< CBS
  sim::DataRate excess_information_rate;      ///< EIR
  sim::Octets excess_burst_size;              ///< EBS
  bool coupling_flag = false;                 ///< CF: committed tokens that overflow fill the excess bucket
  ColorMode color_mode = ColorMode::color_blind;
  bool drop_on_yellow = false;
  bool mark_all_frames_red_enable = false;    ///< after the first frame that the meter discards, discard all
  bool operator==(const FlowMeterConfig&) const = default;
};

class FlowMeter {
 public:
  struct Verdict {
    FrameColor color = FrameColor::green;
    bool pass = true;             ///< false: the frame is discarded
    bool drop_eligible = false;   ///< the frame's drop_eligible parameter (DEI) from here on
    bool operator==(const Verdict&) const = default;
  };

  /// Both buckets are full.
  explicit FlowMeter(const FlowMeterConfig& config);

  /// Colours a frame of that length (DA to FCS) at that time. Time that runs backwards (a clock step) brings no tokens.
  Verdict meter(sim::Octets length, bool drop_eligible, sim::LocalTime arrival) {
    fill(std::max(arrival - last_, sim::Duration()));
    last_ = arrival;
    const bool arrived_green = config_.color_mode == ColorMode::color_blind || !drop_eligible;
    const Tokens needed = tokens(length);
    if (arrived_green && needed <= committed_tokens_ && !mark_all_frames_red_) [[likely]] {
      committed_tokens_ -= needed;
      return {FrameColor::green, true, drop_eligible};
    }
    return not_green(needed, drop_eligible);
  }

  /// MarkAllFramesRed: set by the meter if enabled, cleared by management.
  bool mark_all_frames_red() const { return mark_all_frames_red_; }
  void clear_mark_all_frames_red() { mark_all_frames_red_ = false; }

  const FlowMeterConfig& config() const { return config_; }
  /// Whole octets in the buckets after the last frame; for tests and displays.
  sim::Octets committed_tokens() const { return octets(committed_tokens_); }
  sim::Octets excess_tokens() const { return octets(excess_tokens_); }

 private:
  using Tokens = sim::int128;
  static constexpr Tokens tokens_in_an_octet = 8'000'000'000'000;
  static constexpr Tokens tokens(sim::Octets octets) { return tokens_in_an_octet * octets.count; }
  static constexpr sim::Octets octets(Tokens tokens) { return {static_cast<std::uint32_t>(tokens / tokens_in_an_octet)}; }

  void fill(sim::Duration elapsed) {
    committed_tokens_ += brought_by(config_.committed_information_rate, elapsed);
    const Tokens overflow = committed_tokens_ - committed_burst_;
    if (overflow > 0) committed_tokens_ = committed_burst_;
    if (excess_burst_ > 0) fill_excess(elapsed, std::max(Tokens{0}, overflow));
  }
  static Tokens brought_by(sim::DataRate rate, sim::Duration elapsed) {
    return static_cast<Tokens>(static_cast<sim::uint128>(rate.bits_per_second) * static_cast<std::uint64_t>(elapsed.ps()));
  }
  void fill_excess(sim::Duration elapsed, Tokens overflow);
  Verdict not_green(Tokens needed, bool drop_eligible);

  Tokens committed_burst_;
  Tokens excess_burst_;
  Tokens committed_tokens_;
  Tokens excess_tokens_;   // none without a burst
  sim::LocalTime last_;
  bool mark_all_frames_red_ = false;
  FlowMeterConfig config_;
};

}  // namespace takt::models
