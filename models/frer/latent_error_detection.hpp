// SPDX-License-Identifier: Apache-2.0
// Latent error detection (IEEE 802.1CB clause 7.4.4): do as many copies arrive as there are paths?
#pragma once

#include <cstdint>

#include "models/frer/sequence_recovery.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// What management sets (frerSeqRcvyLatentError...). Not together with individual recovery.
struct LatentErrorDetectionConfig {
  std::uint32_t paths = 2;       ///< copies of each frame that should arrive; each passed one has paths - 1 discarded
  std::uint64_t difference = 0;  ///< the greatest difference that is no error
  sim::Duration period = sim::Duration::from_ps(2'000'000'000'000);         ///< between tests; 2000 ms
  sim::Duration reset_period = sim::Duration::from_ps(30'000'000'000'000);  ///< between resets; 30 s
  bool operator==(const LatentErrorDetectionConfig&) const = default;
};

/// The caller runs the two timers and calls test() and reset() when they expire.
class LatentErrorDetection {
 public:
  explicit LatentErrorDetection(const LatentErrorDetectionConfig& config) : config_(config) {}

  /// LatentErrorTest: true if a latent error is to be signalled. A period in which the recovery was reset is not
  /// judged.
  bool test(const SequenceRecoveryCounters& counters) {
    const bool recovery_was_reset = counters.resets != recovery_resets_;
    recovery_resets_ = counters.resets;
    if (recovery_was_reset) return false;
    const std::int64_t difference = missing(counters) - base_;
    const bool error = static_cast<std::uint64_t>(difference < 0 ? -difference : difference) > config_.difference;
    if (error) ++errors_;
    return error;
  }
  /// LatentErrorReset: what is missing now is forgiven.
  void reset(const SequenceRecoveryCounters& counters) {
    base_ = missing(counters);
    ++resets_;
  }

  const LatentErrorDetectionConfig& config() const { return config_; }
  std::uint64_t resets() const { return resets_; }  ///< frerCpsSeqRcvyLatentErrorResets
  std::uint64_t errors() const { return errors_; }  ///< tests that failed

 private:
  std::int64_t missing(const SequenceRecoveryCounters& counters) const {
    const std::uint64_t expected = counters.passed_packets * (config_.paths - 1);
    return static_cast<std::int64_t>(expected - counters.discarded_packets);
  }

  LatentErrorDetectionConfig config_;
  std::int64_t base_ = 0;              // CurBaseDifference
  std::uint64_t recovery_resets_ = 1;  // BEGIN was before the first period
  std::uint64_t resets_ = 0;
  std::uint64_t errors_ = 0;
};

}  // namespace takt::models
