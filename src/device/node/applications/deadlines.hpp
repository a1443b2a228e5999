// SPDX-License-Identifier: Apache-2.0
// A clock of the kernel in nanoseconds, and waiting for absolute deadlines on it.
#pragma once

#include <cstdint>

#include "application/activation_grid.hpp"
#include "application/activation_plan.hpp"
#include "node/config.hpp"

namespace takt::node {

class DeadlineClock {
 public:
  explicit DeadlineClock(ClockName name) : name_(name) {}
  std::int64_t now() const;
  /// Returns at that time or later; earlier only for a signal.
  void wait_until(std::int64_t time) const;

 private:
  ClockName name_;
};

/// The activations of a thread, from the next one that is due on: each is answered when its response time is over, or
/// as soon after that as the thread is let run.
class Deadlines {
 public:
  /// Grid and times in ns.
  Deadlines(const application::ActivationGrid& grid, const application::ActivationPlan& plan, std::int64_t now);

  /// When the activation is due that is next.
  std::int64_t due() const { return grid_.due(plan_.number()); }
  std::int64_t number() const { return plan_.number(); }
  /// When the thread has to wake up for it.
  std::int64_t at() const { return due() + plan_.response().ps() / 1000; }
  /// The thread is awake, at `at` or later. Whether the activation is answered now. Those that were over before are
  /// missed; the last that was due is the one to answer, when its response time is over.
  bool awake(std::int64_t now);
  /// It has been answered.
  void next();

  /// Of the activations of which it is known by then.
  std::uint64_t missed(std::int64_t now) const {
    return static_cast<std::uint64_t>(grid_.decided(first_, last_done_, now)) - done_;
  }

 private:
  application::ActivationGrid grid_;
  application::ActivationPlan plan_;
  std::int64_t first_;
  std::int64_t last_done_;  // below first_: none
  std::uint64_t done_ = 0;
};

}  // namespace takt::node
