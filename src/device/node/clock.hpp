// SPDX-License-Identifier: Apache-2.0
// Local time of a real node: a clock of the kernel, counted from an epoch that all nodes compute alike.
#pragma once

#include "node/config.hpp"
#include "node/socket.hpp"
#include "sim/time.hpp"

namespace takt::node {

class Clock {
 public:
  /// The epoch is the last multiple of `grid` before now, so cycles that begin at multiples of it begin together at
  /// nodes whose clocks agree.
  Clock(ClockName name, Duration grid);

  /// How far into a cycle the epoch is; 0 for the grid.
  Duration phase_in(Duration cycle) const;
  /// Since the epoch.
  sim::LocalTime now() const;
  /// The clock's own nanoseconds (TAI: since 1970) at a local time, for logs.
  std::int64_t nanoseconds_at(sim::LocalTime time) const { return epoch_ns_ + time.ps() / 1000; }

 private:
  std::int64_t read() const;

  int id_;
  std::int64_t epoch_ns_ = 0;
  Duration shift_;  ///< the epoch is that much after epoch_ns_: a grid need not be whole nanoseconds
};

/// Wakes a loop at an absolute time.
class AbsoluteTimer {
 public:
  AbsoluteTimer();
  bool is_open() const { return fd_.is_open(); }
  int file_descriptor() const { return fd_.number(); }
  /// Readable from `time` on by `clock`; sim::LocalTime::never(): not at all.
  void set(const Clock& clock, sim::LocalTime time);

 private:
  FileDescriptor fd_;
};

}  // namespace takt::node
