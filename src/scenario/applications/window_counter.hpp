// How often something happened in each window of a scheduler, against how often it should have.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/distribution.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

/// Window k lasts from phase + k * length to phase + (k + 1) * length on the host's clock, both ends later by what the scheduler takes to look. Each whole
/// window is a test: as many happenings count as were expected; more are noted as beyond. A test whose window the scheduler has made
/// longer or shorter by more than the tolerance is discarded, as are those that a crash or a step of the clock cuts short.
class WindowCounter {
 public:
  struct Settings {
    sim::Duration length;
    sim::Duration phase;                        ///< of the thread: an activation begins each window
    std::uint64_t expected = 1;                 ///< in a window
    sim::LocalTime after;                       ///< no window begins before
    std::optional<std::uint64_t> most_tests;
    sim::Duration tolerance;
  };
  struct Figures {
    std::uint64_t tests = 0;
    std::uint64_t expected = 0;                 ///< in all tests
    std::uint64_t counted = 0;                  ///< at most the expected ones of each
    std::uint64_t beyond = 0;                   ///< more than were expected in their windows
    std::uint64_t windows_below = 0;            ///< with fewer than expected
    std::uint64_t windows_above = 0;            ///< with more
    std::uint64_t discarded = 0;                ///< tests
    /// 100 where all that was expected happened; nothing without a test.
    std::optional<double> percent() const {
      if (expected == 0) return std::nullopt;
      return 100.0 * static_cast<double>(counted) / static_cast<double>(expected);
    }
  };

  /// `path` names the scheduler in the random streams. The distribution outlives it.
  WindowCounter(const Settings& settings, const sim::Distribution& response, std::uint64_t seed, std::string_view path);

  /// The first window is the next that begins.
  void begin(sim::LocalTime now);
  /// The window that is open is discarded.
  void end();
  /// So many at once, now.
  void add(sim::LocalTime now, std::uint64_t count = 1) {
    close_until(now);
    if (is_open_ && now >= from_) in_window_ += count;
  }
  void close_until(sim::LocalTime now) {
    while (is_open_ && now >= to_) close();
  }
  const Figures& figures() const { return figures_; }

 private:
  void close();
  sim::LocalTime edge(std::int64_t number);

  Settings settings_;
  const sim::Distribution* response_;
  sim::RandomStream chance_;
  bool is_open_ = false;
  std::int64_t number_ = 0;
  sim::LocalTime from_;
  sim::LocalTime to_;
  std::uint64_t in_window_ = 0;
  Figures figures_;
};

}  // namespace takt::scenario
