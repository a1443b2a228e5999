// SPDX-License-Identifier: Apache-2.0
// A small input format that uses every kind of field. The tests here and the fuzz target decode it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "json/fields.hpp"
#include "sim/units.hpp"

namespace takt::sample {

using namespace sim::literals;

enum class Os : std::uint8_t { preempt_rt, general_purpose, guest };
const json::Enumeration& describe(json::Type<Os>);

struct Host {
  json::Source where;
  Os os = Os::preempt_rt;
  std::vector<std::uint16_t> ports = {4840};
  bool operator==(const Host&) const = default;
};
const json::Object& describe(json::Type<Host>);

struct Switch {
  std::uint8_t queues = 8;
  sim::Duration delay = 1_us;
  bool operator==(const Switch&) const = default;
};
const json::Object& describe(json::Type<Switch>);

using NetworkNode = std::variant<Host, Switch>;
const json::Tagged& describe(json::Type<NetworkNode>);

struct Link {
  json::Source where;
  std::vector<std::string> ends;
  sim::DataRate rate{1'000'000'000};
  sim::Length length{10'000};
  std::optional<json::Probability> loss;
  bool operator==(const Link&) const = default;
};
const json::Object& describe(json::Type<Link>);

struct Oscillator {
  json::Source where;
  sim::FrequencyOffset offset{};
  json::FrequencyDrift drift{};
  bool operator==(const Oscillator&) const = default;
};
const json::Object& describe(json::Type<Oscillator>);

struct Fault {
  json::Source where;
  sim::Duration at{};
  std::optional<std::vector<std::string>> link_down;
  std::optional<std::string> crash;
  bool operator==(const Fault&) const = default;
};
const json::Object& describe(json::Type<Fault>);

/// "all" or a list of names: a type with functions of its own.
struct Selection {
  bool all = false;
  std::vector<std::string> names;
  bool operator==(const Selection&) const = default;
};
const json::Custom& describe(json::Type<Selection>);

/// A tree: a struct that contains its like.
struct Group {
  std::string name;
  std::vector<Group> parts;
  bool operator==(const Group&) const = default;
};
const json::Object& describe(json::Type<Group>);

struct Sample {
  json::Source where;
  std::string name;
  std::uint64_t seed = 1;
  std::int32_t level = 0;
  double weight = 0.5;
  bool traced = false;
  sim::Duration duration = 10_s;
  std::optional<sim::Duration> phase;
  sim::Octets payload{100};
  json::Located<std::string> master;
  json::NameMap<NetworkNode> nodes;
  std::vector<Link> links;
  Oscillator oscillator;
  std::vector<Fault> faults;
  Selection captured;
  std::optional<Group> group;
  bool operator==(const Sample&) const = default;
};
const json::Object& describe(json::Type<Sample>);

/// A check of meaning, as the scenario's checks will be: the ends of links must be nodes.
void check(const Sample& sample, json::Diagnostics& diagnostics);

/// A text that has every field, without mistakes.
extern const std::string_view full_text;

}  // namespace takt::sample
