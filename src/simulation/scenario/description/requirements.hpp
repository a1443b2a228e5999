// SPDX-License-Identifier: Apache-2.0
// What a scenario requires of a run: plain structs, one for each JSON object. See description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "handshake/cause.hpp"
#include "json/any.hpp"
#include "json/fields.hpp"
#include "scenario/description/figures.hpp"
#include "sim/time.hpp"

namespace takt::handshake {
/// Here, since the words are those of scenario files.
const json::Enumeration& describe(json::Type<Cause>);
}  // namespace takt::handshake

namespace takt::scenario {

using sim::Duration;

/// One name or several.
struct Names {
  std::vector<std::string> names;
  bool operator==(const Names&) const = default;
};

enum class Reaction : std::uint8_t { start, halt, suspend, resume, reset };

/// What a time may be: at most so long, or equal to a value within a tolerance.
struct DurationLimit {
  json::Source where;
  std::optional<Duration> at_most;
  std::optional<Duration> equal;
  std::optional<Duration> within;  ///< of "equal"; absent: exactly
  /// The longest that it may be.
  Duration greatest() const { return equal ? *equal + within.value_or(Duration()) : at_most.value_or(Duration()); }
  /// The shortest, if that is limited.
  std::optional<Duration> least() const {
    return equal ? std::optional(*equal - within.value_or(Duration())) : std::nullopt;
  }
  bool operator==(const DurationLimit&) const = default;
};

/// How far something may be from what it should be: a time or, of a figure that is none, a number.
struct Tolerance {
  json::Source where;
  std::optional<Duration> time;
  double number = 0;  ///< if it is no time
  bool operator==(const Tolerance&) const = default;
  /// Of what is a time for certain.
  operator Duration() const { return time.value_or(Duration()); }  // NOLINT: reactions end within a time
};

struct Requirement {
  Requirement();
  Requirement(const Requirement&);
  Requirement(Requirement&&) noexcept;
  Requirement& operator=(const Requirement&);
  Requirement& operator=(Requirement&&) noexcept;
  ~Requirement();

  json::Source where;
  std::optional<std::string> name = {};  ///< how plans and reports call it: "REQ-12"
  std::optional<Reaction> reaction;
  std::optional<std::string> program;
  std::optional<handshake::Cause> cause = {};
  std::optional<Tolerance> within;
  bool tree = false;
  std::optional<std::string> stream;
  std::optional<DurationLimit> latency;
  std::optional<DurationLimit> jitter;
  std::optional<std::uint64_t> dropped;
  std::optional<std::uint64_t> delivered;
  std::optional<std::uint64_t> lost_in_a_row = {};
  std::optional<std::uint64_t> late_in_a_row = {};
  std::optional<std::uint64_t> met = {};  ///< of any `of` one after another
  std::optional<std::uint64_t> of = {};
  std::optional<Duration> deadline = {};  ///< what takes longer is late
  std::optional<Duration> sync;
  bool given = false;  ///< what a data sheet promises; nothing proves it
  std::optional<std::string> node;
  std::optional<Names> clocks = {};  ///< "*": all nodes
  std::optional<std::string> application = {};
  std::optional<std::string> thread = {};
  std::optional<double> success = {};   ///< percent
  std::optional<double> buffered = {};  ///< percent
  std::optional<std::string> signal = {};
  std::optional<double> irregular = {};  ///< percent
  std::optional<std::string> figure = {};
  json::NameMap<json::Any> only = {};
  std::optional<Take> take = {};
  std::optional<std::string> unit = {};
  std::optional<json::Any> at_most = {};  ///< a number in the unit, or a duration
  std::optional<json::Any> at_least = {};
  std::optional<json::Any> equal = {};  ///< within `within`
  std::optional<Duration> after = {};   ///< instead of the scenario's warm_up
  bool operator==(const Requirement&) const = default;
};

const json::Enumeration& describe(json::Type<Reaction>);
const json::Object& describe(json::Type<DurationLimit>);
const json::Custom& describe(json::Type<Tolerance>);
const json::Object& describe(json::Type<Requirement>);
const json::Custom& describe(json::Type<Names>);

}  // namespace takt::scenario
