// SPDX-License-Identifier: Apache-2.0
#include "models/egress/credit_based_shaper.hpp"

#include <algorithm>
#include <utility>

namespace takt::models {
namespace {

using sim::Duration;
using sim::int128;
using sim::TrueTime;

constexpr std::int64_t slope_limit = std::int64_t{1} << 62;

int128 greatest_common_divisor(int128 a, int128 b) {
  while (b != 0) a = std::exchange(b, a % b);
  return a;
}

int128 ceil_quotient(int128 a, int128 b) { return a / b + (a % b > 0 ? 1 : 0); }

}  // namespace

CreditSlope operational_idle_slope(sim::DataRate admin_idle_slope, Duration open, Duration cycle,
                                   sim::DataRate port_transmit_rate) {
  TAKT_CHECK(open > Duration() && open <= cycle, "a shaped class has an open gate in its cycle");
  const int128 numerator = static_cast<int128>(admin_idle_slope.bits_per_second) * cycle.ps();
  const int128 divisor = greatest_common_divisor(numerator, open.ps());
  const int128 denominator = open.ps() / divisor;
  const bool exact = numerator / divisor < slope_limit &&
                     static_cast<int128>(port_transmit_rate.bits_per_second) < slope_limit / denominator;
  if (!exact) return {static_cast<std::int64_t>(numerator / open.ps()), 1};
  return {static_cast<std::int64_t>(numerator / divisor), static_cast<std::int64_t>(denominator)};
}

CreditBasedShaper::CreditBasedShaper(CreditSlope idle_slope, sim::DataRate port_transmit_rate)
    : port_transmit_rate_(port_transmit_rate.bits_per_second) {
  set_slopes(idle_slope);
}

Duration CreditBasedShaper::growth_needed(TrueTime now) const {
  const Credit then = credit(std::max(now, free_at_));
  if (then.units >= 0) return Duration();
  if (idle_slope_.numerator == 0) return Duration::max();
  const int128 ps = ceil_quotient(-then.units, idle_slope_.numerator);
  return ps < Duration::max().ps() ? Duration::from_ps(static_cast<std::int64_t>(ps)) : Duration::max();
}

TrueTime CreditBasedShaper::eligible_time(TrueTime now) const {
  const Duration growth = growth_needed(now);
  const TrueTime start = std::max(now, free_at_);
  if (!gate_open_ || growth >= TrueTime::never() - start) return TrueTime::never();
  return start + growth;
}

void CreditBasedShaper::transmission_started(TrueTime now, Duration occupancy, bool queue_empty_now) {
  advance(now);
  TAKT_CHECK(gate_open_ && credit_.units >= 0, "a shaped class starts a frame with an open gate and no debt");
  transmission_resumed(now, occupancy);
  queue_empty_ = queue_empty_now;
  if (queue_empty_) recovery_ps_ = recovery_of(occupancy);
}

void CreditBasedShaper::transmission_resumed(TrueTime now, Duration occupancy) {
  advance(now);
  TAKT_CHECK(now >= free_at_ && occupancy >= Duration(), "one transmission of a class follows another");
  free_at_ = now + occupancy;
  recovery_ps_ = unknown;
}

void CreditBasedShaper::transmission_cut(TrueTime now, TrueTime free_at) {
  advance(now);
  TAKT_CHECK(free_at >= now && now <= free_at_, "only a transmission under way is cut, and not in the past");
  free_at_ = free_at;
  recovery_ps_ = unknown;
}

void CreditBasedShaper::set_idle_slope(TrueTime now, CreditSlope idle_slope) {
  advance(now);
  const std::int64_t former = idle_slope_.denominator;
  set_slopes(idle_slope);
  if (former == idle_slope.denominator) return;
  // Whole units first: the product of an amount and a denominator could pass 128 bits.
  const int128 whole = credit_.units / former;
  const int128 rest = credit_.units % former * idle_slope.denominator;
  credit_.units = whole * idle_slope.denominator + rest / former - (rest % former < 0 ? 1 : 0);
}

void CreditBasedShaper::set_slopes(CreditSlope idle_slope) {
  const int128 rate = static_cast<int128>(port_transmit_rate_) * idle_slope.denominator;
  TAKT_CHECK(idle_slope.denominator > 0 && idle_slope.numerator >= 0, "an idle slope is not negative");
  TAKT_CHECK(rate < slope_limit, "the port's rate on the slope's denominator has at most 62 bits");
  TAKT_CHECK(idle_slope.numerator <= rate, "an idle slope is at most the port's rate");
  idle_slope_ = idle_slope;
  send_slope_ = idle_slope.numerator - static_cast<std::int64_t>(rate);
  recovery_ps_ = unknown;
  recovery_factor_ = unknown;
  if (idle_slope.numerator == 0) return;
  const int128 factor = ceil_quotient(int128{-send_slope_} << factor_bits, idle_slope.numerator);
  if (factor <= greatest_factor) recovery_factor_ = static_cast<std::int64_t>(factor);
}

sim::Duration second_class_interference(sim::Octets lower, sim::Octets frame_a, CreditSlope idle_slope_a,
                                        sim::DataRate port_transmit_rate) {
  const int128 rate = static_cast<int128>(port_transmit_rate.bits_per_second);
  const int128 rest = rate * idle_slope_a.denominator - idle_slope_a.numerator;  // R - idle_slope_A, on its denominator
  TAKT_CHECK(rest > 0, "class A leaves some bandwidth");
  const int128 ps = ceil_quotient(int128{lower.count} * 8 * 1'000'000'000'000 * idle_slope_a.denominator, rest) +
                    ceil_quotient(int128{frame_a.count} * 8 * 1'000'000'000'000, rate);
  return Duration::from_ps(static_cast<std::int64_t>(ps));
}

}  // namespace takt::models
