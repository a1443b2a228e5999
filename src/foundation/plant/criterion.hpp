// SPDX-License-Identifier: Apache-2.0
// Whether a thread did what was expected of it, window by window: criterion 1 is of its calls, criterion 2 of the
// values that they took.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "json/type.hpp"

namespace takt::plant {

/// As many happenings count as were expected in a window; more are noted as beyond.
struct CriterionFigures {
  std::uint64_t tests = 0;
  std::uint64_t expected = 0;       ///< in all tests
  std::uint64_t counted = 0;        ///< at most the expected ones of each
  std::uint64_t beyond = 0;         ///< more than were expected in their windows
  std::uint64_t windows_below = 0;  ///< with fewer than expected
  std::uint64_t windows_above = 0;  ///< with more
  std::uint64_t discarded = 0;      ///< windows that were no tests
  /// 100 where all that was expected happened; nothing without a test.
  std::optional<double> percent() const;
  bool operator==(const CriterionFigures&) const = default;
};
const json::Record& describe(json::Type<CriterionFigures>);

/// Window k lasts from phase + k * length to phase + (k + 1) * length of the clock, and each whole window is a test.
/// What happens belongs to the window in which the activation was due that it answers, so it does not matter how late
/// the scheduler looks. A look that is later than the tolerance says that the scheduler itself was not let run, as the
/// whole machine was perhaps: that window and those that it slept through are no tests, nor is one that a crash or a
/// step of the clock cuts short. All times in one unit of the host's clock: ps in a simulation, ns on a real node.
class Criterion {
 public:
  struct Settings {
    std::int64_t length = 0;     ///< greater than 0
    std::int64_t phase = 0;      ///< of the thread: an activation begins each window
    std::uint64_t expected = 1;  ///< in a window
    std::int64_t after = 0;      ///< no window begins before
    std::optional<std::uint64_t> most_tests = {};
    std::int64_t tolerance = 0;
  };
  struct Window {
    std::int64_t from = 0;
    std::int64_t to = 0;
    bool operator==(const Window&) const = default;
  };
  explicit Criterion(const Settings& settings);

  /// The first window is the next that begins.
  void begin(std::int64_t now);
  /// The window that is open is discarded; the next one begins with begin().
  void end();
  /// The window that is open; nothing before the beginning, and when all tests are done.
  std::optional<Window> open() const;
  /// So many for the activation that was due then; one before the open window counts nowhere.
  void add(std::int64_t due, std::uint64_t count = 1);
  /// The scheduler looks. If the open window is over, it has been a test or is discarded.
  void look(std::int64_t now);

  const CriterionFigures& figures() const { return figures_; }

 private:
  struct Happened {
    std::int64_t window = 0;
    std::uint64_t count = 0;
  };
  Happened& happened_in(std::int64_t window);

  Settings settings_;
  bool has_begun_ = false;
  std::int64_t number_ = 0;         // of the open window
  std::vector<Happened> happened_;  // in the newest windows, at their numbers modulo the room: the scheduler may look
                                    // when later ones have begun
  CriterionFigures figures_;
};

}  // namespace takt::plant
