// SPDX-License-Identifier: Apache-2.0
#include "models/frer/stream_recovery.hpp"

#include <algorithm>

namespace takt::models {

StreamRecovery::StreamRecovery(const StreamRecoveryConfig& config, sim::ComponentId where)
    : config_(config), where_(where), compound_(config.recovery, config.reset_timeout) {
  TAKT_CHECK(config.reset_timeout > sim::Duration(), "a reset timeout is positive");
  TAKT_CHECK(!config.recovery.individual_recovery, "recovery of a compound stream is not individual");
  if (!config.latent_error_detection) return;
  TAKT_CHECK(config.latent_error_detection->period > sim::Duration(), "a latent error period is positive");
  TAKT_CHECK(config.latent_error_detection->reset_period > sim::Duration(), "a latent error reset period is positive");
  latent_.emplace(*config.latent_error_detection);
  next_test_ = sim::LocalTime() + latent_->config().period;
  next_latent_reset_ = sim::LocalTime() + latent_->config().reset_period;
}

std::optional<FrameIndex> StreamRecovery::receive(Traffic& traffic, FrameIndex index, std::size_t member,
                                                  std::uint16_t port, sim::LocalTime now) {
  catch_up(now);
  std::optional<SequenceNumber> sequence;
  if (const Frame& frame = traffic.frame(index); frame.r_tagged) sequence = frame.r_tag_sequence;
  if (config_.individual_recovery && member != no_member) {
    TimedRecovery& individual = individual_of(member, port);
    individual.expire(now);
    if (!individual.recover(sequence, now)) return std::nullopt;
  }
  if (!compound_.recover(sequence, now)) return std::nullopt;

  const FrameIndex own = traffic.own(index, where_);
  Frame& frame = traffic.frame(own);
  frame.on_route = false;
  frame.destination = config_.destination;
  frame.vlan = config_.vlan;
  if (frame.r_tagged && !config_.keep_r_tag) traffic.set_tags(own, frame.tagged, false);
  return own;
}

std::size_t StreamRecovery::member_of(AddressIndex destination, VlanId vlan) const {
  for (std::size_t i = 0; i < config_.members.size(); ++i)
    if (config_.members[i].destination == destination && config_.members[i].vlan == vlan) return i;
  return no_member;
}

void StreamRecovery::catch_up(sim::LocalTime now) {
  if (now < compound_.resets_at() && now < next_test_ && now < next_latent_reset_) [[likely]]
    return;
  if (compound_.resets_at() <= now) {
    run_latent_error_detection(compound_.resets_at() - sim::Duration::from_ps(1));
    compound_.expire(now);
  }
  run_latent_error_detection(now);
}

TimedRecovery& StreamRecovery::individual_of(std::size_t member, std::uint16_t port) {
  const auto found = std::find_if(individual_.begin(), individual_.end(),
                                  [&](const Individual& one) { return one.member == member && one.port == port; });
  if (found != individual_.end()) return found->recovery;
  SequenceRecoveryConfig config = config_.recovery;
  config.individual_recovery = true;
  individual_.push_back({static_cast<std::uint16_t>(member), port, TimedRecovery(config, config_.reset_timeout)});
  return individual_.back().recovery;
}

void StreamRecovery::run_latent_error_detection(sim::LocalTime until) {
  if (!latent_) return;
  while (std::min(next_test_, next_latent_reset_) <= until) {
    if (next_test_ <= next_latent_reset_) {
      if (latent_->test(counters())) first_latent_error_ = std::min(first_latent_error_, next_test_);
      next_test_ = next_test_.plus_saturated(latent_->config().period);
    } else {
      latent_->reset(counters());
      next_latent_reset_ = next_latent_reset_.plus_saturated(latent_->config().reset_period);
    }
  }
}

}  // namespace takt::models
