// SPDX-License-Identifier: Apache-2.0
// A time that passes in a host, as files say it: what the simulator draws, and a real node takes as it comes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "json/fields.hpp"
#include "sim/time.hpp"

namespace takt::plant {

using sim::Duration;

// Not within Latency: clang takes a class with default values for complete only behind the class around it.
struct WeibullLatency {
  Duration scale;
  double shape = 1;
  bool operator==(const WeibullLatency&) const = default;
};
struct LogNormalLatency {
  Duration median;
  double sigma = 1;
  bool operator==(const LogNormalLatency&) const = default;
};
/// Rare values instead of those of the distribution, all of an interval equally likely.
struct LatencyTail {
  json::Source where;
  Duration from;
  Duration to;
  double per_million = 1;
  bool operator==(const LatencyTail&) const = default;
};

/// A time that passes in a host: fixed, or drawn from a distribution.
struct Latency {
  struct Uniform {
    Duration from;
    Duration to;
    bool operator==(const Uniform&) const = default;
  };
  struct Normal {
    Duration mean;
    Duration deviation;
    bool operator==(const Normal&) const = default;
  };
  struct Exponential {
    Duration mean;
    bool operator==(const Exponential&) const = default;
  };
  using Weibull = WeibullLatency;
  using LogNormal = LogNormalLatency;
  struct Point {
    Duration value;
    std::uint32_t weight = 1;
    bool operator==(const Point&) const = default;
  };

  json::Source where;
  std::optional<Duration> fixed;
  std::optional<Uniform> uniform;
  std::optional<Normal> normal;
  std::optional<Exponential> exponential;
  std::optional<Weibull> weibull;
  std::optional<LogNormal> log_normal;
  std::optional<std::vector<Point>> table;
  Duration min;
  std::optional<Duration> max;
  using Tail = LatencyTail;
  std::optional<LatencyTail> tail;
  bool operator==(const Latency&) const = default;
};

const json::Object& describe(json::Type<Latency>);
const json::Object& describe(json::Type<Latency::Uniform>);
const json::Object& describe(json::Type<Latency::Normal>);
const json::Object& describe(json::Type<Latency::Exponential>);
const json::Object& describe(json::Type<Latency::Weibull>);
const json::Object& describe(json::Type<Latency::LogNormal>);
const json::Object& describe(json::Type<Latency::Point>);
const json::Object& describe(json::Type<LatencyTail>);

}  // namespace takt::plant
