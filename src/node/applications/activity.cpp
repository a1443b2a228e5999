#include "node/applications/activity.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::node {
namespace {

std::int64_t divided_up(std::int64_t a, std::int64_t b) { return (a + b - 1) / b; }

}  // namespace

void ActivityLog::add(std::int64_t activation, std::uint32_t values) {
  const std::lock_guard lock(mutex_);
  if (count_ == calls_.size()) return;
  calls_[(first_ + count_) % calls_.size()] = {activation, values};
  ++count_;
}

ActivityLog::Sum ActivityLog::take(std::int64_t from, std::int64_t to) {
  const std::lock_guard lock(mutex_);
  Sum sum;
  while (count_ > 0 && calls_[first_].activation < to) {
    if (calls_[first_].activation >= from) {
      ++sum.calls;
      sum.values += calls_[first_].values;
    }
    first_ = (first_ + 1) % calls_.size();
    --count_;
  }
  return sum;
}

void WindowFigures::add(std::uint64_t happened, std::uint64_t expected_in_window) {
  ++tests;
  expected += expected_in_window;
  counted += std::min(happened, expected_in_window);
  beyond += happened - std::min(happened, expected_in_window);
  windows_below += happened < expected_in_window ? 1 : 0;
}

std::optional<double> WindowFigures::percent() const {
  if (expected == 0) return std::nullopt;
  return 100.0 * static_cast<double>(counted) / static_cast<double>(expected);
}

WindowCheck::WindowCheck(const Settings& settings)
    : settings_(settings), length_(divided_up(settings.window, settings.every) * settings.every), window_(divided_up(settings.begin, length_)) {
  TAKT_CHECK(settings.every > 0 && settings.offset >= 0 && settings.offset < settings.every, "an activation belongs to one window");
}

/// Activation n is due at offset + n * every; windows are whole numbers of intervals, so each has as many.
std::int64_t WindowCheck::first_activation_of(std::int64_t window) const { return window * (length_ / settings_.every); }

std::optional<std::int64_t> WindowCheck::next() const {
  if (settings_.most_tests && calls_.tests >= *settings_.most_tests) return std::nullopt;
  // The last activation of a window is over when the next one is due, which is `offset` into the next window.
  return (window_ + 1) * length_ + settings_.offset;
}

void WindowCheck::look(std::int64_t now, ActivityLog& log) {
  const auto end = next();
  if (!end || now < *end) return;
  if (now - *end > settings_.tolerance) {
    // What began before this look is discarded.
    const std::int64_t open = (now - settings_.offset) / length_;
    calls_.discarded += static_cast<std::uint64_t>(open - window_);
    if (settings_.has_values) values_.discarded = calls_.discarded;
    log.take(first_activation_of(open), first_activation_of(open));
    window_ = open;
    return;
  }
  const ActivityLog::Sum sum = log.take(first_activation_of(window_), first_activation_of(window_ + 1));
  const auto expected = static_cast<std::uint64_t>(length_ / settings_.every);
  calls_.add(sum.calls, expected);
  if (settings_.has_values) values_.add(sum.values, expected);
  ++window_;
}

}  // namespace takt::node
