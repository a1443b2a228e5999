// SPDX-License-Identifier: Apache-2.0
#include "node/applications/deadlines.hpp"

#include <time.h>

namespace takt::node {
namespace {

constexpr std::int64_t ns_per_s = 1'000'000'000;

std::int64_t read_clock(clockid_t id) {
  timespec time = {};
  ::clock_gettime(id, &time);
  return static_cast<std::int64_t>(time.tv_sec) * ns_per_s + time.tv_nsec;
}

}  // namespace

std::int64_t DeadlineClock::now() const { return read_clock(name_ == ClockName::tai ? CLOCK_TAI : CLOCK_MONOTONIC); }

/// CLOCK_TAI through CLOCK_MONOTONIC, as node/clock.cpp does: the error is what the two drift apart within one wait.
void DeadlineClock::wait_until(std::int64_t time) const {
  const std::int64_t at = name_ == ClockName::tai ? read_clock(CLOCK_MONOTONIC) + (time - now()) : time;
  timespec until = {};
  until.tv_sec = at / ns_per_s;
  until.tv_nsec = static_cast<long>(at % ns_per_s);
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

Deadlines::Deadlines(const application::ActivationGrid& grid, const application::ActivationPlan& plan, std::int64_t now)
    : grid_(grid), plan_(plan), first_(grid.latest_at(now) + 1), last_done_(first_ - 1) {
  plan_.begin(first_);
}

bool Deadlines::awake(std::int64_t now) {
  const std::int64_t last_due = grid_.latest_at(now);
  if (last_due > plan_.number())
    plan_.begin(last_due);
  else if (!plan_.is_call())
    plan_.next();
  return plan_.is_call() && at() <= now;
}

void Deadlines::next() {
  last_done_ = plan_.number();
  ++done_;
  plan_.next();
}

}  // namespace takt::node
