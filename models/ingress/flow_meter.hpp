// SPDX-License-Identifier: Apache-2.0
// The flow meter of per-stream filtering and policing (IEEE 802.1Q clause 8.6.5.5, the bandwidth profile of MEF 10.3):
// two rates, three colours.
//
// Arithmetic is exact: tokens are counted in units of 1 / (8 * 10^12) octet, of which a rate of r b/s brings r in each
// picosecond, so nothing is lost between frames.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

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
  sim::DataRate committed_information_rate;  ///< CIR
  sim::Octets committed_burst_size;          ///< CBS
  sim::DataRate excess_information_rate;     ///< EIR
  sim::Octets excess_burst_size;             ///< EBS
  bool coupling_flag = false;                ///< CF: committed tokens that overflow fill the excess bucket
  ColorMode color_mode = ColorMode::color_blind;
  bool drop_on_yellow = false;
  bool mark_all_frames_red_enable = false;  ///< after the first frame that the meter discards, discard all
  bool operator==(const FlowMeterConfig&) const = default;
};

class FlowMeter {
 public:
  struct Verdict {
    FrameColor color = FrameColor::green;
    bool pass = true;            ///< false: the frame is discarded
    bool drop_eligible = false;  ///< the frame's drop_eligible parameter (DEI) from here on
    bool operator==(const Verdict&) const = default;
  };

  /// Both buckets are full.
  explicit FlowMeter(const FlowMeterConfig& config);

  /// Colours a frame of that length (DA to FCS) at that time. Time that runs backwards (a clock step) brings no tokens.
  Verdict meter(sim::Octets length, bool drop_eligible, sim::LocalTime arrival) {
    if (is_green_fast(length, arrival)) return {FrameColor::green, true, drop_eligible};
    return meter_slow(length, drop_eligible, arrival);
  }
  /// meter() of a meter with committed tokens alone: true if the frame gets some, and goes on as it is. False: nothing
  /// has happened.
  bool is_green_fast(sim::Octets length, sim::LocalTime arrival) {
    return finds_full(length, arrival) || finds_enough(length, arrival);
  }
  // Fast test: the bucket has refilled since the previous frame.
  bool finds_full(sim::Octets length, sim::LocalTime arrival) {
    if ((arrival - last_).ps() < filling_ps_ || length.count > most_full_) return false;
    committed_tokens_ = committed_burst_ - tokens(length);
    last_ = arrival;
    filling_ps_ = octet_ps_ * length.count;
    return true;
  }
  bool finds_enough(sim::Octets length, sim::LocalTime arrival);

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
  static constexpr sim::Octets octets(Tokens tokens) {
    return {static_cast<std::uint32_t>(tokens / tokens_in_an_octet)};
  }

  Verdict meter_slow(sim::Octets length, bool drop_eligible, sim::LocalTime arrival);
  void fill(sim::Duration elapsed);
  static Tokens brought_by(sim::DataRate rate, sim::Duration elapsed) {
    return static_cast<Tokens>(static_cast<sim::uint128>(rate.bits_per_second) *
                               static_cast<std::uint64_t>(elapsed.ps()));
  }
  FrameColor color(Tokens needed, bool arrived_green);

  Tokens committed_burst_;
  Tokens excess_burst_;
  Tokens committed_tokens_;
  Tokens excess_tokens_;
  sim::LocalTime last_;
  static constexpr std::uint32_t most_full_octets = 1u << 20;  // 8 * 10^12 ps times so many is below 2^63 ps
  static constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();
  std::int64_t filling_ps_ = unknown;  // so long after last_ the bucket of a simple meter is full
  std::int64_t octet_ps_ = 0;          // in which it gets the tokens of an octet, rounded up
  std::uint32_t most_full_ = 0;        // a full bucket has tokens for a frame of so many octets; 0 if it gets none
  bool is_simple_ = false;             // colours do not matter, there are no excess tokens, nothing closes it
  bool mark_all_frames_red_ = false;
  FlowMeterConfig config_;
};

}  // namespace takt::models
