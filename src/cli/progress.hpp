// The progress bar of long runs, on a terminal only.
#pragma once

#include <chrono>
#include <cstdint>

#include "sim/time.hpp"

namespace takt::cli {

/// Draws on standard error, at most ten times a second and not before the first second, and removes itself at the end.
class Progress {
 public:
  explicit Progress(bool is_wanted);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(sim::Duration done, sim::Duration wanted, std::uint64_t events);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_wanted_;
  bool is_drawn_ = false;
  Clock::time_point began_ = Clock::now();
  Clock::time_point drawn_ = began_;
};

}  // namespace takt::cli
