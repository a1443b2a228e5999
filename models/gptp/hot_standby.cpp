#include "models/gptp/hot_standby.hpp"

#include <algorithm>

namespace takt::models::gptp {
namespace {

sim::Duration magnitude(sim::Duration d) { return d < sim::Duration() ? -d : d; }

}  // namespace

void IsSynced::sample(sim::Duration offset) {
  received_ = std::min(received_ + 1, config_.rx_sync_count);
  const bool within = magnitude(offset) <= config_.offset_max;
  met_ = within ? std::min(met_ + 1, config_.met_count) : 0;
  exceeded_ = within ? 0 : std::min(exceeded_ + 1, config_.exceeded_count);
  if (synced_)
    synced_ = exceeded_ < config_.exceeded_count;
  else
    synced_ = met_ >= config_.met_count && received_ >= config_.rx_sync_count;
}

void IsSynced::lost() {
  received_ = met_ = exceeded_ = 0;
  synced_ = false;
}

HotStandby::HotStandby(const HotStandbyConfig& config)
    : config_(config), sides_{Side{IsSynced(config.is_synced)}, Side{IsSynced(config.is_synced)}} {}

void HotStandby::sample(HotStandbyRole of, sim::Duration offset, sim::LocalTime now) {
  side(of).is_synced.sample(offset);
  side(of).offset = offset;
  evaluate(now);
}

void HotStandby::sync_lost(HotStandbyRole of, sim::LocalTime now) {
  side(of).is_synced.lost();
  evaluate(now);
}

void HotStandby::set_grandmaster(HotStandbyRole of, bool is_grandmaster, sim::LocalTime now) {
  side(of).is_synced.set_grandmaster(is_grandmaster);
  evaluate(now);
}

bool HotStandby::may_be_redundant() const {
  return is_synced(HotStandbyRole::primary) && is_synced(HotStandbyRole::secondary) &&
         magnitude(sides_[0].offset - sides_[1].offset) <= config_.primary_secondary_offset_thresh;
}

// Down at once, up only after the waiting time. From init there is no way but to redundant: it waits for both.
void HotStandby::evaluate(sim::LocalTime now) {
  const bool primary = is_synced(HotStandbyRole::primary);
  const bool secondary = is_synced(HotStandbyRole::secondary);
  if (state_ == HotStandbyState::redundant && !(primary && secondary))
    enter(primary || secondary ? HotStandbyState::not_redundant : HotStandbyState::out_of_sync);
  if (state_ == HotStandbyState::not_redundant && !primary && !secondary) enter(HotStandbyState::out_of_sync);
  if (primary != secondary && state_ != HotStandbyState::init) active_ = primary ? HotStandbyRole::primary : HotStandbyRole::secondary;
  if (state_ == HotStandbyState::redundant) {
    waiting_until_ = sim::LocalTime::never();
    return;
  }

  const bool up = may_be_redundant() || (state_ == HotStandbyState::out_of_sync && (primary || secondary));
  if (!up) {
    waiting_until_ = sim::LocalTime::never();
    return;
  }
  if (waiting_until_ == sim::LocalTime::never()) waiting_until_ = now + config_.waiting_time;
  if (now < waiting_until_) return;
  enter(may_be_redundant() ? HotStandbyState::redundant : HotStandbyState::not_redundant);
}

void HotStandby::enter(HotStandbyState state) {
  state_ = state;
  waiting_until_ = sim::LocalTime::never();
  if (state == HotStandbyState::redundant) active_ = HotStandbyRole::primary;
}

}  // namespace takt::models::gptp
