// SPDX-License-Identifier: Apache-2.0
// Hot standby: two PTP instances in two domains, and which of them gives the time. IEEE 802.1ASdm, HotStandbySystem.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "models/gptp/clock_target.hpp"
#include "sim/time.hpp"

namespace takt::models::gptp {

struct IsSyncedConfig {
  sim::Duration offset_max = sim::Duration::from_ps(1'000'000);  // offsetFromTimeTransmitterMax
  int met_count = 4;                                             // offsetMaxMetCountThresh
  int exceeded_count = 2;                                        // offsetMaxExceededCountThresh
  int rx_sync_count = 4;                                         // rxSyncCountThresh
};

/// Whether one instance is synced: met_count offsets in a row within the limit, after rx_sync_count Syncs; until
/// exceeded_count in a row are beyond it, or Sync is lost.
class IsSynced {
 public:
  explicit IsSynced(const IsSyncedConfig& config) : config_(config) {}
  void sample(sim::Duration offset);
  void lost();
  /// A grandmaster is synced with itself.
  void set_grandmaster(bool is_grandmaster) { is_grandmaster_ = is_grandmaster; }
  bool is_synced() const { return is_grandmaster_ || synced_; }

 private:
  IsSyncedConfig config_;
  int received_ = 0;
  int met_ = 0;
  int exceeded_ = 0;
  bool synced_ = false;
  bool is_grandmaster_ = false;
};

/// The time of one domain as its time receiver keeps it: a clock on the node's free-running one that the Syncs of this
/// domain alone discipline. Whether a domain is synced is judged by it, not by the clock of the node, which follows one
/// of the domains only.
class DomainClock {
 public:
  explicit DomainClock(const ClockTargetConfig& config) : target_(config) {}
  /// How far it was ahead of the grandmaster when the Sync came; then it is corrected.
  sim::Duration take(const SyncSample& sample);
  sim::LocalTime shown_at(sim::LocalTime free_running) const { return shown_ + rate_.times(free_running - since_); }

 private:
  ClockTarget target_;
  sim::LocalTime since_;  // of the free-running clock, at which it showed shown_
  sim::LocalTime shown_;
  ClockRate rate_;  // against the free-running clock
};

enum class HotStandbyState : std::uint8_t { init, redundant, not_redundant, out_of_sync };
enum class HotStandbyRole : std::uint8_t { primary, secondary };
inline constexpr std::size_t standby_role_count = 2;

struct HotStandbyConfig {
  IsSyncedConfig is_synced = {};
  sim::Duration primary_secondary_offset_thresh = sim::Duration::from_ps(1'000'000);
  sim::Duration waiting_time = {};  // 2^hotStandbySystemLogSyncTimeThresh s; 0: none
};

/// Fed with what both instances hear; says from which of them time comes: from the primary while it is synced,
/// otherwise from the secondary.
class HotStandby {
 public:
  /// `target`: the servo of the node, with which each domain's own clock is kept as well.
  explicit HotStandby(const HotStandbyConfig& config, const ClockTargetConfig& target = {});

  /// `shown` by the disciplined clock at sample.at: the time of a domain whose grandmaster the node itself is.
  void sample(HotStandbyRole of, const SyncSample& sample, sim::LocalTime shown, sim::LocalTime now);
  void sync_lost(HotStandbyRole of, sim::LocalTime now);
  void set_grandmaster(HotStandbyRole of, bool is_grandmaster, sim::LocalTime now);
  /// When the waiting time is over the state can change without other input; never() if nothing waits.
  sim::LocalTime next_evaluation() const { return waiting_until_; }
  void evaluate(sim::LocalTime now);

  HotStandbyState state() const { return state_; }
  /// The instance whose samples discipline the clock: the primary unless only the secondary is synced. In init it is
  /// the primary, in out_of_sync the one before; then nobody is synced, and the clock holds over.
  HotStandbyRole active() const { return active_; }
  bool is_synced(HotStandbyRole of) const { return side(of).is_synced.is_synced(); }

 private:
  struct Side {
    IsSynced is_synced;
    DomainClock clock;
    bool is_grandmaster = false;
  };
  Side& side(HotStandbyRole of) { return sides_[static_cast<std::size_t>(of)]; }
  const Side& side(HotStandbyRole of) const { return sides_[static_cast<std::size_t>(of)]; }
  bool is_either_synced() const { return is_synced(HotStandbyRole::primary) || is_synced(HotStandbyRole::secondary); }
  bool are_both_synced() const { return is_synced(HotStandbyRole::primary) && is_synced(HotStandbyRole::secondary); }
  bool may_be_redundant() const { return are_both_synced() && difference_ <= config_.primary_secondary_offset_thresh; }
  bool may_go_up() const;
  void compare(sim::LocalTime at, sim::LocalTime shown);
  void enter(HotStandbyState state);

  HotStandbyConfig config_;
  std::array<Side, standby_role_count> sides_;
  sim::Duration difference_;  // between the times of the domains, without sign
  HotStandbyState state_ = HotStandbyState::init;
  HotStandbyRole active_ = HotStandbyRole::primary;
  sim::LocalTime waiting_until_ = sim::LocalTime::never();
};

}  // namespace takt::models::gptp
