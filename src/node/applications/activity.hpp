// What threads have done, and whether it was what was expected: the two criteria, window by window.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace takt::node {

/// The calls of a thread, each with the activation that it answers: written by the thread, read by the scheduler's.
class ActivityLog {
 public:
  struct Sum {
    std::uint64_t calls = 0;
    std::uint64_t values = 0;
    bool operator==(const Sum&) const = default;
  };

  /// Room for so many calls between two looks; later ones are not noted.
  explicit ActivityLog(std::size_t room = 16'384) : calls_(room) {}

  /// Activations come in rising order. `values`: samples that the call took into the buffer of its thread.
  void add(std::int64_t activation, std::uint32_t values);
  /// What was done for the activations from `from` to below `to`. All before `to` are forgotten.
  Sum take(std::int64_t from, std::int64_t to);

 private:
  struct Call {
    std::int64_t activation = 0;
    std::uint32_t values = 0;
  };
  std::mutex mutex_;
  std::vector<Call> calls_;  ///< a ring
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

/// As many happenings count as were expected in a window; more are noted as beyond.
struct WindowFigures {
  std::uint64_t tests = 0;
  std::uint64_t expected = 0;       ///< in all tests
  std::uint64_t counted = 0;        ///< at most the expected ones of each
  std::uint64_t beyond = 0;
  std::uint64_t windows_below = 0;  ///< with fewer than expected
  std::uint64_t discarded = 0;      ///< windows that were no tests
  void add(std::uint64_t happened, std::uint64_t expected_in_window);
  /// 100 where all that was expected happened; nothing without a test.
  std::optional<double> percent() const;
  bool operator==(const WindowFigures&) const = default;
};

/// The windows of one thread. Window k lasts from k * length to (k + 1) * length of the clock; a call belongs to the window of the activation
/// that it answers, so it does not matter how late the scheduler looks. A look that is later than the tolerance says that the scheduler itself
/// was not let run, as the whole machine was perhaps: that window and those that it slept through are no tests. Nanoseconds.
class WindowCheck {
 public:
  struct Settings {
    std::int64_t window = 0;     ///< at least; the least multiple of `every` that is not shorter is taken
    std::int64_t every = 0;      ///< of the thread
    std::int64_t offset = 0;     ///< of the thread
    std::int64_t begin = 0;      ///< no test begins before
    std::int64_t tolerance = 0;
    std::optional<std::uint64_t> most_tests;
    bool has_values = false;     ///< whether it subscribes
  };
  explicit WindowCheck(const Settings& settings);

  /// The end of the window that is open; nothing when all tests are done.
  std::optional<std::int64_t> next() const;
  /// Looks, if a window is over.
  void look(std::int64_t now, ActivityLog& log);

  std::int64_t window() const { return length_; }
  const WindowFigures& calls() const { return calls_; }
  const WindowFigures& values() const { return values_; }

 private:
  std::int64_t first_activation_of(std::int64_t window) const;

  Settings settings_;
  std::int64_t length_;
  std::int64_t window_;  ///< that is open
  WindowFigures calls_;
  WindowFigures values_;
};

}  // namespace takt::node
