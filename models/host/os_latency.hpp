// SPDX-License-Identifier: Apache-2.0
// The time that an operating system takes between a program and the wire.
#pragma once

#include <string>
#include <string_view>

#include "sim/distribution.hpp"
#include "sim/random.hpp"

namespace takt::models {

/// Three delays of a host. Each is fixed or drawn from a random stream named after its user.
struct OsLatency {
  sim::Distribution transmit = sim::Distribution::constant({});  ///< application to network interface
  sim::Distribution receive = sim::Distribution::constant({});   ///< network interface to application
  sim::Distribution wake_up = sim::Distribution::constant({});   ///< timer expiry to application
};

/// One of these delays with its own stream of chance. Later samples never overtake earlier ones.
class LatencyLine {
 public:
  LatencyLine(const sim::Distribution& distribution, std::uint64_t seed, std::string_view path,
              std::string_view purpose)
      : distribution_(&distribution), stream_(seed, path, purpose) {}

  bool is_none() const { return distribution_->is_constant() && distribution_->greatest() == sim::Duration(); }

  /// When something that begins at `start` is through.
  sim::TrueTime pass(sim::TrueTime start) {
    const sim::TrueTime end = start.plus_saturated(distribution_->draw(stream_));
    last_ = end > last_ ? end : last_;
    return last_;
  }
  /// The same where several components use the line: what they hand on at one instant would not be in order.
  sim::TrueTime pass_strictly(sim::TrueTime start) {
    const sim::TrueTime before = last_;
    const sim::TrueTime end = pass(start);
    if (end == before) last_ = end + sim::Duration::from_ps(1);
    return last_;
  }
  /// A sample that does not queue behind earlier ones.
  sim::Duration sample() { return distribution_->draw(stream_); }

 private:
  const sim::Distribution* distribution_;
  sim::RandomStream stream_;
  sim::TrueTime last_;
};

}  // namespace takt::models
