// SPDX-License-Identifier: Apache-2.0
// When a clock shows times that come at equal distances, one after the other: by additions, for a talker asks for each
// frame.
//
// While the clock runs at one rate, the true distance is step * 2^62 / rate = whole + part / rate, and the first
// instant at which it shows a time is the exact one rounded up by early / rate, early < rate. Nothing is lost, however
// many steps are taken.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "sim/time.hpp"

namespace takt::models {

/// Made by LocalClock::steps_from. The value is stale after a change of the clock: its holder listens to the clock.
class EqualSteps {
 public:
  /// Of no clock.
  EqualSteps() = default;

  bool is_set() const { return rate_ != 0; }
  /// What LocalClock::true_at() says of the next time. Precondition: is_set().
  sim::TrueTime next() {
    // Below 2^64: neither is beyond the last instant, and there is at most one more.
    std::uint64_t sum = time_ + whole_;
    const bool needs_one_more = part_ > early_;
    early_ = needs_one_more ? early_ + (rate_ - part_) : early_ - part_;
    sum += needs_one_more ? 1 : 0;
    time_ = std::min(sum, last);
    return sim::TrueTime::from_ps(static_cast<std::int64_t>(time_));
  }

 private:
  friend class LocalClock;
  static constexpr auto last = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());

  std::uint64_t time_ = 0;   // of the last time that was asked for, in ps
  std::uint64_t whole_ = 0;  // at most the last instant
  std::uint64_t part_ = 0;   // below rate_
  std::uint64_t early_ = 0;  // below rate_: how much less than it does then the clock might show, in 2^-62 ps
  std::uint64_t rate_ = 0;   // 0: not set
};

}  // namespace takt::models
