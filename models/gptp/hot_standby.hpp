// Hot standby: two PTP instances in two domains, and which of them gives the time. IEEE 802.1ASdm, HotStandbySystem.
#pragma once

#include <array>
#include <cstdint>

#include "sim/time.hpp"

namespace takt::models::gptp {

struct IsSyncedConfig {
  sim::Duration offset_max = sim::Duration::from_ps(1'000'000);  // offsetFromTimeTransmitterMax
  int met_count = 4;                                             // offsetMaxMetCountThresh
  int exceeded_count = 2;                                        // offsetMaxExceededCountThresh
  int rx_sync_count = 4;                                         // rxSyncCountThresh
};

/// Whether one instance is synced: met_count offsets in a row within the limit, after rx_sync_count Syncs; until exceeded_count in a
/// row are beyond it, or Sync is lost.
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

enum class HotStandbyState : std::uint8_t { init, redundant, not_redundant, out_of_sync };
enum class HotStandbyRole : std::uint8_t { primary, secondary };

struct HotStandbyConfig {
  IsSyncedConfig is_synced = {};
  sim::Duration primary_secondary_offset_thresh = sim::Duration::from_ps(1'000'000);
  sim::Duration waiting_time = {};  // 2^hotStandbySystemLogSyncTimeThresh s; 0: none
};

/// Fed with what both instances hear; says from which of them time comes. Offsets are those of the clock that is disciplined, so the
/// difference between primary and secondary is the difference of their offsets.
class HotStandby {
 public:
  explicit HotStandby(const HotStandbyConfig& config);

  void sample(HotStandbyRole of, sim::Duration offset, sim::LocalTime now);
  void sync_lost(HotStandbyRole of, sim::LocalTime now);
  void set_grandmaster(HotStandbyRole of, bool is_grandmaster, sim::LocalTime now);
  /// When the waiting time is over the state can change without other input; never() if nothing waits.
  sim::LocalTime next_evaluation() const { return waiting_until_; }
  void evaluate(sim::LocalTime now);

  HotStandbyState state() const { return state_; }
  /// The instance whose samples discipline the clock: the primary unless only the secondary is synced. In out_of_sync nobody is; the
  /// clock holds over.
  HotStandbyRole active() const { return active_; }
  bool is_synced(HotStandbyRole of) const { return side(of).is_synced.is_synced(); }

 private:
  struct Side {
    IsSynced is_synced;
    sim::Duration offset = {};
  };
  Side& side(HotStandbyRole of) { return sides_[static_cast<std::size_t>(of)]; }
  const Side& side(HotStandbyRole of) const { return sides_[static_cast<std::size_t>(of)]; }
  bool may_be_redundant() const;
  void enter(HotStandbyState state);

  HotStandbyConfig config_;
  std::array<Side, 2> sides_;
  HotStandbyState state_ = HotStandbyState::init;
  HotStandbyRole active_ = HotStandbyRole::primary;
  sim::LocalTime waiting_until_ = sim::LocalTime::never();
};

}  // namespace takt::models::gptp
