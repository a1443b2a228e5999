// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/limits.hpp"

namespace takt::interchange::yang {

std::optional<sim::Duration> seconds_of(const Data& rational) {
  const auto numerator = rational.number("numerator");
  const auto denominator = rational.number("denominator");
  if (!numerator || !denominator || *denominator == 0) return std::nullopt;
  const sim::int128 ps = static_cast<sim::int128>(*numerator) * 1'000'000'000'000;
  if (ps % static_cast<sim::int128>(*denominator) != 0 ||
      ps / static_cast<sim::int128>(*denominator) > sim::Duration::max().ps() / 4)
    return std::nullopt;
  return sim::Duration::from_ps(static_cast<std::int64_t>(ps / static_cast<sim::int128>(*denominator)));
}

PortLimits limits_of(const Data& gates) {
  PortLimits limits;
  limits.entries = gates.number("supported-list-max");
  if (const Data* const cycle = gates.find("supported-cycle-max")) limits.longest_cycle = seconds_of(*cycle);
  limits.longest_interval_ns = gates.number("supported-interval-max");
  limits.tick_tenths_of_ns = gates.number("tick-granularity");
  for (const Data& child : gates.children) {
    if (child.schema->name != "min-gating-times") continue;
    PortLimits::Shortest& shortest = limits.shortest[child.number("speed").value_or(0)];
    if (const Data* const cycle = child.find("min-cycle-time")) shortest.cycle = seconds_of(*cycle);
    shortest.interval_ns = child.number("min-interval-time");
  }
  return limits;
}

}  // namespace takt::interchange::yang
