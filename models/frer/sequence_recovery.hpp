// SPDX-License-Identifier: Apache-2.0
// The sequence recovery function (IEEE 802.1CB clause 7.4.3): has this frame been here before?
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "models/frer/r_tag.hpp"
#include "sim/check.hpp"

namespace takt::models {

enum class RecoveryAlgorithm : std::uint8_t {
  vector,  ///< remembers the last numbers (7.4.3.4); the default
  match,   ///< remembers one number (7.4.3.5), for streams with one frame in flight
};

struct SequenceRecoveryConfig {
  RecoveryAlgorithm algorithm = RecoveryAlgorithm::vector;
  /// frerSeqRcvyHistoryLength, 2 to 1024. It must exceed the stream's rate times the difference of the path delays,
  /// else a late copy is taken for a rogue.
  std::uint32_t history_length = 2;
  bool take_no_sequence = false;     ///< pass frames without a sequence number (the match algorithm always does)
  bool individual_recovery = false;  ///< of one member stream: a discarded frame shows that the stream lives
  bool operator==(const SequenceRecoveryConfig&) const = default;
};

/// The managed counters of an instance (frerCpsSeqRcvy...).
struct SequenceRecoveryCounters {
  std::uint64_t out_of_order_packets = 0;
  std::uint64_t rogue_packets = 0;  ///< outside the history; among the discarded
  std::uint64_t passed_packets = 0;
  std::uint64_t discarded_packets = 0;
  std::uint64_t lost_packets = 0;  ///< numbers that left the history unseen, see lost_at_start
  std::uint64_t tagless_packets = 0;
  std::uint64_t resets = 0;  ///< the one at the start (BEGIN) included
  /// The part of lost_packets that comes from the empty history after a reset: numbers before the first frame, which
  /// nobody has lost.
  std::uint64_t lost_at_start = 0;
  std::uint64_t really_lost() const { return lost_packets - lost_at_start; }
  bool operator==(const SequenceRecoveryCounters&) const = default;
};

/// One instance: of a compound stream, or of a member stream (individual recovery). The reset timer (RemainingTicks) is
/// the caller's: it is started anew whenever a decision says so and calls reset() when it runs out.
class SequenceRecovery {
 public:
  static constexpr std::uint32_t longest_history = 1024;

  struct Decision {
    bool pass = false;  ///< false: discard the frame
    bool restart_timer = false;
    bool operator==(const Decision&) const = default;
  };

  /// Begins with a reset (BEGIN).
  explicit SequenceRecovery(const SequenceRecoveryConfig& config);

  /// Decides about the next frame; nothing as its number: it has no R-TAG.
  Decision recover(std::optional<SequenceNumber> sequence);
  /// SequenceRecoveryReset: at the start, or RECOVERY_TIMEOUT.
  void reset();

  const SequenceRecoveryConfig& config() const { return config_; }
  const SequenceRecoveryCounters& counters() const { return counters_; }

 private:
  Decision vector_recovery(SequenceNumber sequence);
  Decision match_recovery(SequenceNumber sequence);
  Decision accept_any(SequenceNumber sequence);
  Decision pass();
  Decision discard();
  void shift(bool is_seen);

  // SequenceHistory as a ring: number n has bit n mod 1024, so shifting moves no bits. Bits of numbers outside the
  // history are not read before they are written.
  bool seen(SequenceNumber n) const { return (history_[n % longest_history / 64] >> n % 64 & 1) != 0; }
  void set_seen(SequenceNumber n, bool value) {
    std::uint64_t& word = history_[n % longest_history / 64];
    word = (word & ~(std::uint64_t{1} << n % 64)) | static_cast<std::uint64_t>(value) << n % 64;
  }

  SequenceRecoveryConfig config_;
  SequenceNumber recovery_number_ = 0;  // RecovSeqNum: the greatest number taken
  bool accept_any_ = true;
  std::uint32_t empty_shifts_ = 0;  // shifts that still push out the empty history
  SequenceRecoveryCounters counters_;
  std::array<std::uint64_t, longest_history / 64> history_{};
};

}  // namespace takt::models
