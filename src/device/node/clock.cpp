// SPDX-License-Identifier: Apache-2.0
#include "node/clock.hpp"

#include <sys/timerfd.h>
#include <time.h>

#include <algorithm>

namespace takt::node {
namespace {

constexpr std::int64_t ns_per_s = 1'000'000'000;

std::int64_t read_clock(int id) {
  timespec time = {};
  ::clock_gettime(id, &time);
  return static_cast<std::int64_t>(time.tv_sec) * ns_per_s + time.tv_nsec;
}

}  // namespace

Clock::Clock(ClockName name, Duration grid) : id_(name == ClockName::tai ? CLOCK_TAI : CLOCK_MONOTONIC) {
  // 128 bits: picoseconds since 1970 are beyond 64.
  const sim::int128 now_ps = sim::int128{read()} * 1000;
  const sim::int128 epoch_ps = now_ps - now_ps % grid.ps();
  epoch_ns_ = static_cast<std::int64_t>(epoch_ps / 1000);
  shift_ = Duration::from_ps(static_cast<std::int64_t>(epoch_ps % 1000));
}

Duration Clock::phase_in(Duration cycle) const {
  return Duration::from_ps(static_cast<std::int64_t>((sim::int128{epoch_ns_} * 1000 + shift_.ps()) % cycle.ps()));
}

std::int64_t Clock::read() const { return read_clock(id_); }

sim::LocalTime Clock::now() const { return sim::LocalTime::from_ps((read() - epoch_ns_) * 1000) - shift_; }

AbsoluteTimer::AbsoluteTimer() : fd_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {}

/// The kernel has no such timers on CLOCK_TAI. Mapped to CLOCK_MONOTONIC at each setting, the error is what the two
/// clocks drift apart within one wait; a time that is woken up to too early is waited for again.
void AbsoluteTimer::set(const Clock& clock, sim::LocalTime time) {
  itimerspec setting = {};
  if (time != sim::LocalTime::never()) {
    const std::int64_t wait_ns = std::max<std::int64_t>((time - clock.now()).ps() + 999, 0) / 1000;
    const std::int64_t at = read_clock(CLOCK_MONOTONIC) + wait_ns;
    setting.it_value.tv_sec = at / ns_per_s;
    setting.it_value.tv_nsec = std::max<long>(static_cast<long>(at % ns_per_s), 1);  // 0 would disarm it
  }
  ::timerfd_settime(fd_.number(), TFD_TIMER_ABSTIME, &setting, nullptr);
}

}  // namespace takt::node
