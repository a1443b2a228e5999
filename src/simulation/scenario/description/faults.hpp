// SPDX-License-Identifier: Apache-2.0
// What goes wrong in a scenario: plain structs, one for each JSON object. See description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "json/fields.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::scenario {

/// A link goes down, and comes back.
struct LinkDown {
  json::Source where;
  std::vector<std::string> link;
  sim::Duration at;
  std::optional<sim::Duration> lasts;
  bool operator==(const LinkDown&) const = default;
};

/// Losses in bursts (Gilbert-Elliott).
struct BurstLoss {
  double good_to_bad = 0;
  double bad_to_good = 1;
  double loss_in_good = 0;
  double loss_in_bad = 1;
  bool operator==(const BurstLoss&) const = default;
};

/// What chance does to the frames on a link.
struct FrameErrors {
  json::Source where;
  std::vector<std::string> link;
  std::optional<std::string> towards;
  std::optional<double> loss;
  std::optional<BurstLoss> burst_loss;
  std::optional<double> corruption;
  std::optional<double> bit_error_rate;
  std::optional<double> duplication;
  sim::Duration at;
  std::optional<sim::Duration> lasts;
  bool operator==(const FrameErrors&) const = default;
};

/// A node fails and starts again.
struct Crash {
  json::Source where;
  std::string node;
  sim::Duration at;
  std::optional<sim::Duration> lasts;
  bool operator==(const Crash&) const = default;
};

/// The talker of a stream sends more than it should.
struct Babble {
  json::Source where;
  std::string stream;
  sim::Duration at;
  std::optional<sim::Duration> lasts;
  std::optional<sim::Duration> every;
  bool operator==(const Babble&) const = default;
};

enum class GateFault : std::uint8_t { open, closed };

/// A transmission gate that does not move.
struct StuckGate {
  json::Source where;
  std::string node;
  std::optional<std::string> to;
  std::uint8_t traffic_class = 0;
  GateFault state = GateFault::closed;
  sim::Duration at;
  std::optional<sim::Duration> lasts;
  bool operator==(const StuckGate&) const = default;
};

/// A clock jumps, or its oscillator gets another frequency.
struct ClockFault {
  json::Source where;
  std::string node;
  sim::Duration at;
  std::optional<sim::Duration> step;
  std::optional<sim::FrequencyOffset> offset;
  bool operator==(const ClockFault&) const = default;
};

using Fault = std::variant<LinkDown, FrameErrors, Crash, Babble, StuckGate, ClockFault>;

/// What the network does about links that are down.
struct Rerouting {
  json::Source where;
  sim::Duration delay;
  bool operator==(const Rerouting&) const = default;
};

const json::Object& describe(json::Type<LinkDown>);
const json::Object& describe(json::Type<BurstLoss>);
const json::Object& describe(json::Type<FrameErrors>);
const json::Object& describe(json::Type<Crash>);
const json::Object& describe(json::Type<Babble>);
const json::Enumeration& describe(json::Type<GateFault>);
const json::Object& describe(json::Type<StuckGate>);
const json::Object& describe(json::Type<ClockFault>);
const json::Tagged& describe(json::Type<Fault>);
const json::Object& describe(json::Type<Rerouting>);

}  // namespace takt::scenario
