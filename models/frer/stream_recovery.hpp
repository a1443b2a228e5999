// SPDX-License-Identifier: Apache-2.0
// Makes one stream of its members again: individual recovery of each, sequence recovery of all, latent error detection
// (IEEE 802.1CB clauses 7.4.3, 7.4.4, 7.5).
//
// No timer runs. A reset that was due before a frame came has the same effect when it is made up for as the frame
// comes, and so has a latent error test, since nothing counts in between. At one instant the order is: reset, latent
// error test, latent error reset, frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/ethernet/traffic.hpp"
#include "models/frer/redundancy_config.hpp"

namespace takt::models {

/// A sequence recovery function with its reset timer (RemainingTicks).
class TimedRecovery {
 public:
  TimedRecovery(const SequenceRecoveryConfig& config, sim::Duration reset_timeout)
      : recovery_(config), reset_timeout_(reset_timeout) {}

  /// Precondition: expire(now) has been called. True: the frame passes.
  bool recover(std::optional<SequenceNumber> sequence, sim::LocalTime now) {
    const SequenceRecovery::Decision decision = recovery_.recover(sequence);
    if (decision.restart_timer) resets_at_ = now.plus_saturated(reset_timeout_);
    return decision.pass;
  }
  /// RECOVERY_TIMEOUT, if it has come until `now`.
  void expire(sim::LocalTime now) {
    if (now < resets_at_) [[likely]]
      return;
    resets_at_ = sim::LocalTime::never();
    recovery_.reset();
  }
  sim::LocalTime resets_at() const { return resets_at_; }
  const SequenceRecovery& recovery() const { return recovery_; }

 private:
  SequenceRecovery recovery_;
  sim::Duration reset_timeout_;
  sim::LocalTime resets_at_ = sim::LocalTime::never();
};

class StreamRecovery {
 public:
  static constexpr std::size_t no_member = 0xFFFF;

  /// `where`: the component that records name as the place.
  explicit StreamRecovery(const StreamRecoveryConfig& config, sim::ComponentId where = {});

  /// What became of a frame: nothing if it is a copy too many (the caller drops it, as DropReason::duplicate),
  /// otherwise the record with which the caller's copy goes on: addressed to the compound stream and, unless the tag is
  /// kept, without R-TAG. `member` is the number of its member stream, or no_member. `now` is a time of the node that
  /// is never stepped (LocalClock::unstepped_at); it does not decrease from call to call.
  std::optional<FrameIndex> receive(Traffic& traffic, FrameIndex frame, std::size_t member, std::uint16_t port,
                                    sim::LocalTime now);

  /// The member to which a frame with that address belongs, or no_member.
  std::size_t member_of(AddressIndex destination, VlanId vlan) const;

  /// Catches up on resets and latent error tests due until `now`. To be called before counters are read.
  void catch_up(sim::LocalTime now);

  struct Individual {
    std::uint16_t member = 0;
    std::uint16_t port = 0;
    TimedRecovery recovery;
  };
  const StreamRecoveryConfig& config() const { return config_; }
  const SequenceRecoveryCounters& counters() const { return compound_.recovery().counters(); }
  /// In the order in which their first frames came.
  const std::vector<Individual>& individual() const { return individual_; }
  /// Null if it is not configured.
  const LatentErrorDetection* latent_error_detection() const { return latent_ ? &*latent_ : nullptr; }
  /// When the first latent error was signalled; never() if none was.
  sim::LocalTime first_latent_error() const { return first_latent_error_; }

 private:
  TimedRecovery& individual_of(std::size_t member, std::uint16_t port);
  void run_latent_error_detection(sim::LocalTime until);

  StreamRecoveryConfig config_;
  sim::ComponentId where_;
  TimedRecovery compound_;
  std::vector<Individual> individual_;
  std::optional<LatentErrorDetection> latent_;
  sim::LocalTime next_test_ = sim::LocalTime::never();
  sim::LocalTime next_latent_reset_ = sim::LocalTime::never();
  sim::LocalTime first_latent_error_ = sim::LocalTime::never();
};

}  // namespace takt::models
