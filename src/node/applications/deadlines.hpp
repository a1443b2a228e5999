// A clock of the kernel in nanoseconds, and waiting for absolute deadlines on it.
#pragma once

#include <cstdint>

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

/// The activations of a thread: number n is due at offset + n * every of the clock.
class Deadlines {
 public:
  Deadlines(std::int64_t every, std::int64_t offset, std::int64_t now);

  std::int64_t due() const { return offset_ + number_ * every_; }
  std::int64_t number() const { return number_; }
  /// The thread is awake, at `due` or later. Activations that were over before count as missed; the last that was due is the one to answer now.
  void awake(std::int64_t now);
  void next() { ++number_; }

  std::uint64_t missed() const { return missed_; }

 private:
  std::int64_t every_;
  std::int64_t offset_;
  std::int64_t number_;
  std::uint64_t missed_ = 0;
};

}  // namespace takt::node
