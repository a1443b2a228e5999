// SPDX-License-Identifier: Apache-2.0
// A study as its file says it: plain structs, one for each JSON object. The tables stand in description.cpp; what the
// parts mean together is checked by plan.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "json/any.hpp"
#include "json/fields.hpp"
#include "scenario/description/description.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"
#include "study/scheduling.hpp"

namespace takt::study {

using Value = json::Any;
using scenario::Take;

/// A place of the scenario that a factor sets. Without `as` and `each` the level itself is put there.
struct Setting {
  json::Source where;
  std::string at;                 ///< JSON pointer (RFC 6901) into the scenario
  std::optional<std::string> as;  ///< a text in which {} stands for the level: "sw{}"
  std::optional<std::string>
      each;  ///< the level is a count n; an array of this text with {} = first, first + 1 ... (n items)
  std::uint32_t first = 1;
  bool operator==(const Setting&) const = default;
};

enum class Scale : std::uint8_t { linear, logarithmic };

/// From a number or quantity to another of the same kind, both included.
struct Range {
  json::Source where;
  Value from;
  Value to;
  std::optional<Value> step;
  std::optional<std::uint32_t> steps;
  Scale scale = Scale::linear;
  bool operator==(const Range&) const = default;
};

/// Places of the scenario and what is put there.
using Patch = json::NameMap<Value>;

/// Every single, or every single and double, failure of a link between switches, and none.
struct LinkFailures {
  json::Source where;
  std::uint32_t at_once = 1;
  sim::Duration at;
  std::optional<sim::Duration> lasts;
  bool operator==(const LinkFailures&) const = default;
};

/// A network that is drawn in a file.
struct GraphmlLevel {
  json::Source where;
  std::string graphml;  ///< beside the study
  std::uint32_t hosts_per_switch = 1;
  std::string os = "none";
  sim::DataRate rate{1'000'000'000};
  sim::Length length{10'000};
  sim::Duration forwarding_delay;
  bool operator==(const GraphmlLevel&) const = default;
};

/// A whole network as a level: made by a generator of scenarios, or drawn.
struct TopologyLevel {
  std::variant<scenario::Generator, GraphmlLevel> from;
  bool operator==(const TopologyLevel&) const = default;
};

struct Factor {
  json::Source where;
  std::string name;
  std::vector<Setting> set;
  std::optional<std::vector<Value>> values;
  std::optional<Range> range;
  std::optional<json::NameMap<Patch>> patches;
  std::optional<json::NameMap<TopologyLevel>> topologies;
  std::optional<LinkFailures> link_failures;
  std::optional<Value> baseline;  ///< one-at-a-time: the level that the others keep; the first one if absent
  bool operator==(const Factor&) const = default;
};

enum class DesignKind : std::uint8_t { grid, random, latin_hypercube, one_at_a_time };

struct Design {
  json::Source where;
  DesignKind kind = DesignKind::grid;
  std::optional<std::uint32_t> points;  ///< of random and latin-hypercube
  std::uint64_t seed = 1;
  bool operator==(const Design&) const = default;
};

struct Measure {
  json::Source where;
  std::string name;
  std::string of;             ///< a JSON pointer into result.json, "*" for every member, or a short form (measure.hpp)
  json::NameMap<Value> only;  ///< members that an object on the way must have: {"kind": "start"}
  Take take = Take::max;      ///< if there are several values
  std::string unit;           ///< ps ns us ms s for times; % for shares; else a label
  bool operator==(const Measure&) const = default;
};

struct Limit {
  json::Source where;
  std::string measure;
  std::optional<Value> at_most;
  std::optional<Value> at_least;
  bool operator==(const Limit&) const = default;
};

struct Replications {
  std::uint32_t count = 1;
  std::uint64_t first_seed = 1;
  bool operator==(const Replications&) const = default;
};

/// What the search for the worst run of a point may cost, and the runs that it begins with.
struct Verifying {
  double budget = 5;  ///< in millions of events
  std::uint32_t seeds = 2;
  bool operator==(const Verifying&) const = default;
};

/// What a point may take.
struct Effort {
  sim::Duration cpu = sim::Duration::from_ps(600'000'000'000'000);
  sim::Octets memory{2'147'483'648};
  bool operator==(const Effort&) const = default;
};

enum class Impossible : std::uint8_t { refused, recorded };

struct Study {
  json::Source where;
  std::optional<std::string> schema;
  std::string name;
  std::optional<std::string> description;
  std::optional<std::string> base;     ///< a scenario file, beside the study
  std::optional<Value> scenario;       ///< or the scenario itself
  std::optional<Scheduling> schedule;  ///< points are not run: streams are drawn and scheduled
  std::vector<Factor> factors;
  Design design;
  std::vector<std::string> constraints;
  Replications replications;
  std::vector<Measure> measures;
  std::vector<Limit> limits;
  bool requirements_count = true;  ///< a point passes only if the scenario's own requirements do
  Impossible impossible = Impossible::refused;
  Verifying verify;
  Effort effort;
  bool operator==(const Study&) const = default;
};

const json::Object& describe(json::Type<Setting>);
const json::Enumeration& describe(json::Type<Scale>);
const json::Object& describe(json::Type<Range>);
const json::Object& describe(json::Type<LinkFailures>);
const json::Object& describe(json::Type<GraphmlLevel>);
const json::Custom& describe(json::Type<TopologyLevel>);
const json::Object& describe(json::Type<Factor>);
const json::Enumeration& describe(json::Type<DesignKind>);
const json::Object& describe(json::Type<Design>);
const json::Object& describe(json::Type<Measure>);
const json::Object& describe(json::Type<Limit>);
const json::Object& describe(json::Type<Replications>);
const json::Object& describe(json::Type<Verifying>);
const json::Object& describe(json::Type<Effort>);
const json::Enumeration& describe(json::Type<Impossible>);
const json::Object& describe(json::Type<Study>);

}  // namespace takt::study
