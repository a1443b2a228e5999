#include "scenario/applications/window_counter.hpp"

#include <algorithm>

namespace takt::scenario {

using sim::Duration;
using sim::LocalTime;

WindowCounter::WindowCounter(const Settings& settings, const sim::Distribution& response, std::uint64_t seed, std::string_view path)
    : settings_(settings), response_(&response), chance_(seed, path, "scheduler") {}

LocalTime WindowCounter::edge(std::int64_t number) {
  return LocalTime::from_ps(settings_.phase.ps() + number * settings_.length.ps()).plus_saturated(response_->draw(chance_));
}

void WindowCounter::begin(LocalTime now) {
  if (settings_.most_tests && figures_.tests >= *settings_.most_tests) return;
  const std::int64_t length = settings_.length.ps();
  const std::int64_t from = std::max({now.ps(), settings_.after.ps(), settings_.phase.ps()}) - settings_.phase.ps();
  number_ = (from + length - 1) / length;
  from_ = edge(number_);
  to_ = std::max(edge(number_ + 1), from_);
  in_window_ = 0;
  is_open_ = true;
}

void WindowCounter::end() {
  if (is_open_) ++figures_.discarded;
  is_open_ = false;
}

void WindowCounter::close() {
  const Duration off = to_ - from_ - settings_.length;
  if (std::max(off, Duration() - off) > settings_.tolerance) {
    ++figures_.discarded;
  } else {
    ++figures_.tests;
    figures_.expected += settings_.expected;
    figures_.counted += std::min(in_window_, settings_.expected);
    figures_.windows_below += in_window_ < settings_.expected ? 1 : 0;
    figures_.windows_above += in_window_ > settings_.expected ? 1 : 0;
    figures_.beyond += in_window_ - std::min(in_window_, settings_.expected);
  }
  in_window_ = 0;
  ++number_;
  from_ = to_;
  to_ = std::max(edge(number_ + 1), from_);
  if (settings_.most_tests && figures_.tests >= *settings_.most_tests) is_open_ = false;
}

}  // namespace takt::scenario
