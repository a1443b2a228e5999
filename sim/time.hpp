// SPDX-License-Identifier: Apache-2.0
// Time in signed 64-bit picoseconds, in types that do not mix.
//
// A byte at 10 Gb/s lasts 800 ps, so nanoseconds would be inexact. 2^63 ps are 106 days, which bounds a simulation.
// An instant belongs to one time scale: true time (the simulator's own), the local time of one clock, or gPTP time.
// Instants of different scales neither compare nor subtract; only a clock (models/clock) maps one to another.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

namespace takt::sim {

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

/// A length of time in picoseconds; may be negative. It carries no time scale: the clock that measures it gives one.
class Duration {
 public:
  constexpr Duration() = default;
  static constexpr Duration from_ps(std::int64_t ps) { return Duration(ps); }
  static constexpr Duration max() { return Duration(std::numeric_limits<std::int64_t>::max()); }
  constexpr std::int64_t ps() const { return ps_; }

  constexpr auto operator<=>(const Duration&) const = default;
  constexpr Duration operator-() const { return Duration(-ps_); }
  constexpr Duration& operator+=(Duration other) {
    ps_ += other.ps_;
    return *this;
  }
  constexpr Duration& operator-=(Duration other) {
    ps_ -= other.ps_;
    return *this;
  }
  friend constexpr Duration operator+(Duration a, Duration b) { return Duration(a.ps_ + b.ps_); }
  friend constexpr Duration operator-(Duration a, Duration b) { return Duration(a.ps_ - b.ps_); }
  friend constexpr Duration operator*(Duration a, std::int64_t n) { return Duration(a.ps_ * n); }
  friend constexpr Duration operator*(std::int64_t n, Duration a) { return Duration(a.ps_ * n); }
  friend constexpr std::int64_t operator/(Duration a, Duration b) { return a.ps_ / b.ps_; }
  friend constexpr Duration operator/(Duration a, std::int64_t n) { return Duration(a.ps_ / n); }
  friend constexpr Duration operator%(Duration a, Duration b) { return Duration(a.ps_ % b.ps_); }

 private:
  constexpr explicit Duration(std::int64_t ps) : ps_(ps) {}
  std::int64_t ps_ = 0;
};

/// An instant of the time scale that Scale names, in picoseconds since that scale's zero (the start of the simulation).
template <class Scale>
class Instant {
 public:
  constexpr Instant() = default;
  static constexpr Instant from_ps(std::int64_t ps) { return Instant(ps); }
  /// Later than every instant that can occur: "never".
  static constexpr Instant never() { return Instant(std::numeric_limits<std::int64_t>::max()); }
  constexpr std::int64_t ps() const { return ps_; }
  constexpr Duration since_start() const { return Duration::from_ps(ps_); }

  /// This instant plus a duration that is not negative; never() where the sum would be beyond all instants.
  constexpr Instant plus_saturated(Duration d) const {
    return d.ps() >= never().ps_ - ps_ ? never() : Instant(ps_ + d.ps());
  }

  constexpr auto operator<=>(const Instant&) const = default;
  constexpr Instant& operator+=(Duration d) {
    ps_ += d.ps();
    return *this;
  }
  friend constexpr Instant operator+(Instant t, Duration d) { return Instant(t.ps_ + d.ps()); }
  friend constexpr Instant operator-(Instant t, Duration d) { return Instant(t.ps_ - d.ps()); }
  friend constexpr Duration operator-(Instant a, Instant b) { return Duration::from_ps(a.ps_ - b.ps_); }

 private:
  constexpr explicit Instant(std::int64_t ps) : ps_(ps) {}
  std::int64_t ps_ = 0;
};

struct TrueScale;   ///< the simulator's own time, which no node can read
struct LocalScale;  ///< what the clock of one node shows
struct PtpScale;    ///< the time of a gPTP domain, as its grandmaster shows it

using TrueTime = Instant<TrueScale>;
using LocalTime = Instant<LocalScale>;
using PtpTime = Instant<PtpScale>;

inline namespace literals {
constexpr Duration operator""_ps(unsigned long long n) { return Duration::from_ps(static_cast<std::int64_t>(n)); }
constexpr Duration operator""_ns(unsigned long long n) {
  return Duration::from_ps(static_cast<std::int64_t>(n) * 1'000);
}
constexpr Duration operator""_us(unsigned long long n) {
  return Duration::from_ps(static_cast<std::int64_t>(n) * 1'000'000);
}
constexpr Duration operator""_ms(unsigned long long n) {
  return Duration::from_ps(static_cast<std::int64_t>(n) * 1'000'000'000);
}
constexpr Duration operator""_s(unsigned long long n) {
  return Duration::from_ps(static_cast<std::int64_t>(n) * 1'000'000'000'000);
}
}  // namespace literals

}  // namespace takt::sim
