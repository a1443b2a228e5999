// A clock of the kernel in nanoseconds, and waiting for absolute deadlines on it.
#pragma once

#include <cstdint>

#include "application/activation_grid.hpp"
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

/// The activations of a thread, from the next one that is due on.
class Deadlines {
 public:
  Deadlines(const application::ActivationGrid& grid, std::int64_t now) : grid_(grid), number_(grid.latest_at(now) + 1) {}

  std::int64_t due() const { return grid_.due(number_); }
  std::int64_t number() const { return number_; }
  /// The thread is awake, at `due` or later. Activations that were over before count as missed; the last that was due is the one to answer now.
  void awake(std::int64_t now);
  void next() { ++number_; }

  std::uint64_t missed() const { return missed_; }

 private:
  application::ActivationGrid grid_;
  std::int64_t number_;
  std::uint64_t missed_ = 0;
};

}  // namespace takt::node
