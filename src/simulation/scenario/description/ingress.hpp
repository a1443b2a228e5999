// SPDX-License-Identifier: Apache-2.0
// What switches do to frames that come in, and redundant streams, as a scenario file says it. See description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::scenario {

using sim::DataRate;
using sim::Duration;
using sim::Octets;

enum class TaggedFrames : std::uint8_t { tagged, priority, all };

/// Null identification: destination address and VLAN.
struct NullIdentity {
  json::Source where;
  std::optional<std::string> destination;  ///< a host
  std::optional<std::string> stream;       ///< the address of this stream
  std::uint16_t vlan = 0;
  TaggedFrames tagged = TaggedFrames::all;
  bool operator==(const NullIdentity&) const = default;
};

struct SourceIdentity {
  json::Source where;
  std::string source;  ///< a host
  std::uint16_t vlan = 0;
  TaggedFrames tagged = TaggedFrames::all;
  bool operator==(const SourceIdentity&) const = default;
};

/// Addresses as text, "02-00-5E-00-00-01".
struct MaskIdentity {
  json::Source where;
  std::string destination = "00-00-00-00-00-00";
  std::string destination_mask = "00-00-00-00-00-00";
  std::string source = "00-00-00-00-00-00";
  std::string source_mask = "00-00-00-00-00-00";
  bool operator==(const MaskIdentity&) const = default;
};

/// An explicit entry of the stream identity table.
struct IdentifiedStream {
  json::Source where;
  std::string name;
  std::optional<NullIdentity> null;
  std::optional<SourceIdentity> source;
  std::optional<MaskIdentity> mask;
  bool operator==(const IdentifiedStream&) const = default;
};

struct StreamFilterEntry {
  json::Source where;
  std::optional<std::string> stream;
  std::optional<std::uint8_t> pcp;
  std::optional<Octets> max_sdu;
  bool block_oversize = false;
  std::optional<std::string> gate;
  std::optional<std::string> meter;
  std::optional<std::string> ats;
  bool operator==(const StreamFilterEntry&) const = default;
};

/// One entry of a stream gate's control list.
struct StreamGateStep {
  json::Source where;
  bool open = true;
  std::optional<std::uint8_t> ipv;
  Duration interval;
  std::optional<Octets> octets;
  bool operator==(const StreamGateStep&) const = default;
};

struct StreamGateEntryList {
  json::Source where;
  std::string name;
  bool open = true;
  std::optional<std::uint8_t> ipv;
  std::optional<Duration> cycle;
  Duration base_time;
  Duration extension;
  std::vector<StreamGateStep> entries;
  bool block_invalid_rx = false;
  bool block_octets_exceeded = false;
  bool running = false;
  bool operator==(const StreamGateEntryList&) const = default;
};

struct Meter {
  json::Source where;
  std::string name;
  DataRate cir;
  Octets cbs{0};
  DataRate eir;
  Octets ebs{0};
  bool coupling = false;
  bool color_aware = false;
  bool drop_on_yellow = false;
  bool block_red = false;
  bool operator==(const Meter&) const = default;
};

enum class LengthOf : std::uint8_t { wire, frame };

struct AtsEntry {
  json::Source where;
  std::string name;
  DataRate rate;
  Octets burst{0};
  LengthOf length = LengthOf::wire;
  std::optional<std::string> group;
  bool operator==(const AtsEntry&) const = default;
};

/// An ATS scheduler of what an end station itself sends.
struct TalkerAts {
  json::Source where;
  std::string stream;
  DataRate rate;
  Octets burst{0};
  LengthOf length = LengthOf::wire;
  bool operator==(const TalkerAts&) const = default;
};

struct AtsGroupEntry {
  json::Source where;
  std::string name;
  std::optional<Duration> max_residence_time;
  bool operator==(const AtsGroupEntry&) const = default;
};

/// Cyclic queuing and forwarding.
struct Cqf {
  json::Source where;
  Duration cycle;
  std::vector<std::uint8_t> classes;
  std::optional<std::uint32_t> buffers;
  std::vector<std::uint8_t> pcp;
  Duration base_time;
  std::optional<Duration> dead_time;
  std::optional<Duration> offset;
  bool operator==(const Cqf&) const = default;
};

/// What a switch does between the medium and its filtering database.
struct Ingress {
  json::Source where;
  std::vector<IdentifiedStream> streams;
  std::vector<StreamFilterEntry> filters;
  std::vector<StreamGateEntryList> gates;
  std::vector<Meter> meters;
  std::vector<AtsEntry> ats;
  std::vector<AtsGroupEntry> ats_groups;
  std::optional<Duration> max_residence_time;
  std::optional<Cqf> cqf;
  bool operator==(const Ingress&) const = default;
};

enum class Recovery : std::uint8_t { vector, match };

struct LatentErrors {
  json::Source where;
  std::uint64_t difference = 0;
  Duration period = Duration::from_ps(2'000'000'000'000);
  Duration reset_period = Duration::from_ps(30'000'000'000'000);
  bool operator==(const LatentErrors&) const = default;
};

/// Frame replication and elimination for a stream.
struct Redundancy {
  json::Source where;
  std::optional<std::uint32_t> count;
  std::optional<std::vector<std::vector<std::string>>> paths;
  std::vector<std::uint16_t> vlans;
  bool ladder = false;
  std::optional<std::string> number;
  std::optional<std::string> split;
  std::optional<std::string> merge;
  Recovery algorithm = Recovery::vector;
  std::uint32_t history = 2;
  Duration reset_timeout = Duration::from_ps(1'000'000'000'000);
  bool individual = false;
  bool take_untagged = false;
  std::optional<LatentErrors> latent_errors;
  bool keep_tag = false;
  bool operator==(const Redundancy&) const = default;
};

const json::Enumeration& describe(json::Type<TaggedFrames>);
const json::Object& describe(json::Type<NullIdentity>);
const json::Object& describe(json::Type<SourceIdentity>);
const json::Object& describe(json::Type<MaskIdentity>);
const json::Object& describe(json::Type<IdentifiedStream>);
const json::Object& describe(json::Type<StreamFilterEntry>);
const json::Object& describe(json::Type<StreamGateStep>);
const json::Object& describe(json::Type<StreamGateEntryList>);
const json::Object& describe(json::Type<Meter>);
const json::Enumeration& describe(json::Type<LengthOf>);
const json::Object& describe(json::Type<AtsEntry>);
const json::Object& describe(json::Type<TalkerAts>);
const json::Object& describe(json::Type<AtsGroupEntry>);
const json::Object& describe(json::Type<Cqf>);
const json::Object& describe(json::Type<Ingress>);
const json::Enumeration& describe(json::Type<Recovery>);
const json::Object& describe(json::Type<LatentErrors>);
const json::Object& describe(json::Type<Redundancy>);

}  // namespace takt::scenario
