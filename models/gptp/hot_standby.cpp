// SPDX-License-Identifier: Apache-2.0
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

sim::Duration DomainClock::take(const SyncSample& sample) {
  const sim::LocalTime shown = shown_at(sample.at);
  const ServoAction action = target_.sample(sample, shown);
  since_ = sample.at;
  shown_ = shown + action.step;
  rate_ = ClockRate::one_plus(action.adjustment);
  return target_.offset();
}

HotStandby::HotStandby(const HotStandbyConfig& config, const ClockTargetConfig& target)
    : config_(config),
      sides_{Side{IsSynced(config.is_synced), DomainClock(target)},
             Side{IsSynced(config.is_synced), DomainClock(target)}} {}

void HotStandby::sample(HotStandbyRole of, const SyncSample& sample, sim::LocalTime shown, sim::LocalTime now) {
  side(of).is_synced.sample(side(of).clock.take(sample));
  compare(sample.at, shown);
  evaluate(now);
}

/// A domain whose grandmaster the node is has the time of its disciplined clock, which `shown` is at the local instant
/// `at`.
void HotStandby::compare(sim::LocalTime at, sim::LocalTime shown) {
  const auto time_of = [&](const Side& each) { return each.is_grandmaster ? shown : each.clock.shown_at(at); };
  difference_ = magnitude(time_of(sides_[0]) - time_of(sides_[1]));
}

void HotStandby::sync_lost(HotStandbyRole of, sim::LocalTime now) {
  side(of).is_synced.lost();
  evaluate(now);
}

void HotStandby::set_grandmaster(HotStandbyRole of, bool is_grandmaster, sim::LocalTime now) {
  side(of).is_grandmaster = is_grandmaster;
  side(of).is_synced.set_grandmaster(is_grandmaster);
  evaluate(now);
}

/// From init there is no way without both: it waits for them. Two that disagree are no standby for each other.
bool HotStandby::may_go_up() const {
  switch (state_) {
    case HotStandbyState::init:
      return are_both_synced();
    case HotStandbyState::not_redundant:
      return may_be_redundant();
    case HotStandbyState::out_of_sync:
      return is_either_synced();
    case HotStandbyState::redundant:
      break;
  }
  return false;
}

// Down at once, up only after the waiting time.
void HotStandby::evaluate(sim::LocalTime now) {
  if (state_ == HotStandbyState::redundant && !may_be_redundant())
    enter(is_either_synced() ? HotStandbyState::not_redundant : HotStandbyState::out_of_sync);
  if (state_ == HotStandbyState::not_redundant && !is_either_synced()) enter(HotStandbyState::out_of_sync);
  const bool has_primary = is_synced(HotStandbyRole::primary);
  if (state_ ==
      HotStandbyState::init)  // the grandmaster of the secondary has its own time until it has that of the primary
    active_ = side(HotStandbyRole::secondary).is_grandmaster && !has_primary ? HotStandbyRole::secondary
                                                                             : HotStandbyRole::primary;
  else if (is_either_synced())
    active_ = has_primary ? HotStandbyRole::primary : HotStandbyRole::secondary;

  if (!may_go_up()) {
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
