// SPDX-License-Identifier: Apache-2.0
#include "application/latency_law.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace takt::application {

using sim::Distribution;
using sim::Duration;
using namespace sim::literals;  // NOLINT: units in limits

namespace {

// Distributions without an end are cut here, as the table of fields cuts what is written.
constexpr Duration longest_latency = 24 * 3600_s;

Distribution body_of(const plant::Latency& latency, json::Diagnostics& diagnostics) {
  const Duration greatest = latency.max.value_or(longest_latency);
  if (latency.min > greatest) {
    diagnostics.error(latency.where.at("min"), "min above max",
                      {json::to_text(latency.min), "at most " + json::to_text(greatest)});
    return Distribution::constant({});
  }
  if (latency.fixed) return Distribution::constant(*latency.fixed).clamped(latency.min, greatest);
  if (latency.uniform) {
    if (latency.uniform->from > latency.uniform->to) {
      diagnostics.error(
          latency.where.at("uniform"), "an empty interval",
          {json::to_text(latency.uniform->from) + " to " + json::to_text(latency.uniform->to), "from at most to"});
      return Distribution::constant({});
    }
    const Distribution raw = Distribution::uniform(latency.uniform->from, latency.uniform->to);
    return raw.clamped(std::max(latency.min, raw.least()), std::max(latency.min, std::min(greatest, raw.greatest())));
  }
  if (latency.normal)
    return Distribution::normal(latency.normal->mean, latency.normal->deviation).clamped(latency.min, greatest);
  if (latency.exponential) return Distribution::exponential(latency.exponential->mean).clamped(latency.min, greatest);
  if (latency.weibull)
    return Distribution::weibull(latency.weibull->scale, latency.weibull->shape).clamped(latency.min, greatest);
  if (latency.log_normal)
    return Distribution::log_normal(latency.log_normal->median, latency.log_normal->sigma)
        .clamped(latency.min, greatest);
  if (latency.table) {
    std::vector<Distribution::Point> points;
    std::uint64_t weight = 0;
    for (const plant::Latency::Point& point : *latency.table) {
      points.push_back({point.value, point.weight});
      weight += point.weight;
    }
    if (weight > 0) return Distribution::empirical(std::move(points)).clamped(latency.min, greatest);
    diagnostics.error(latency.where.at("table"), "a table without weight",
                      {"weights that are all 0", "at least one positive weight"});
  }
  return Distribution::constant({});
}

}  // namespace

sim::Distribution distribution_of(const plant::Latency& latency, json::Diagnostics& diagnostics) {
  if (diagnostics.is_refused(latency.where.place())) {  // its parts do not belong together
    diagnostics.consequence();
    return Distribution::constant({});
  }
  Distribution body = body_of(latency, diagnostics);
  if (!latency.tail) return body;
  const plant::LatencyTail& tail = *latency.tail;
  if (tail.from > tail.to) {
    diagnostics.error(tail.where.place(), "an empty interval",
                      {json::to_text(tail.from) + " to " + json::to_text(tail.to), "from at most to"});
    return body;
  }
  const auto parts_per_billion = static_cast<std::uint32_t>(tail.per_million * 1000 + 0.5);
  const Duration least = std::min(body.least(), tail.from);
  const Duration greatest = std::max(body.greatest(), tail.to);
  return Distribution::mixture(std::move(body), Distribution::uniform(tail.from, tail.to), parts_per_billion)
      .clamped(least, greatest);
}

}  // namespace takt::application
