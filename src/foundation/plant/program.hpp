// SPDX-License-Identifier: Apache-2.0
// What JSON files say of a Program, wherever it runs: plain values and their tables.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "handshake/participant.hpp"
#include "json/fields.hpp"
#include "plant/message_security.hpp"
#include "plant/role.hpp"
#include "program/method.hpp"
#include "sim/time.hpp"

// Words of files for values of protocol code: a description is looked for in the namespace of what it describes.
namespace takt::handshake {
const json::Enumeration& describe(json::Type<Variant>);
const json::Enumeration& describe(json::Type<Subscription>);
}  // namespace takt::handshake
namespace takt::program {
const json::Enumeration& describe(json::Type<Method>);
}  // namespace takt::program

namespace takt::plant {

using namespace sim::literals;  // NOLINT: units in default values
using handshake::Subscription;
using handshake::Variant;
using program::Method;
using sim::Duration;

enum class Publish : std::uint8_t { cyclic, on_change };
enum class DataType : std::uint8_t {
  boolean,
  sbyte,
  byte,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

struct DataField {
  DataType type = DataType::float64;
  std::uint16_t count = 1;
  bool operator==(const DataField&) const = default;
};

/// A data set that a participant publishes to those that hear it.
struct ProcessData {
  json::Source where;
  std::string name;
  std::string from;
  json::NameMap<DataField> fields;
  bool operator==(const ProcessData&) const = default;
};

enum class Violations : std::uint8_t { forbidden, reported };

/// Process data that is published when other process data has come and has been worked at, not every cycle.
struct Reply {
  json::Source where;
  std::string to;
  std::string with;
  bool operator==(const Reply&) const = default;
};

/// On which participants each method is called; absent: on any of them.
struct Callers {
  json::Source where;
  std::optional<std::vector<std::string>> start = {};
  std::optional<std::vector<std::string>> suspend = {};
  std::optional<std::vector<std::string>> resume = {};
  std::optional<std::vector<std::string>> halt = {};
  std::optional<std::vector<std::string>> reset = {};
  bool operator==(const Callers&) const = default;
};

struct Program {
  Program();
  Program(const Program&);
  Program(Program&&) noexcept;
  Program& operator=(const Program&);
  Program& operator=(Program&&) noexcept;
  ~Program();

  json::Source where;
  std::string name;
  Variant variant = Variant::robust;
  std::string master;
  std::vector<std::string> slaves;
  std::optional<std::string> within;
  std::vector<Role> roles = {};
  std::vector<std::string> candidates = {};
  std::vector<std::string> absent = {};
  std::optional<Duration> announce_every = {};
  OnReplacement on_replacement = OnReplacement::stay_halted;
  Duration cycle;
  std::optional<json::OrAuto<Duration>> offset;  ///< 0 in a run; absent, it is nothing that the plant promises
  json::NameMap<Duration> phases;                ///< of single participants
  Publish publish = Publish::cyclic;
  Subscription subscription = Subscription::star;
  std::optional<Duration> receive_timeout;
  Duration initialisation = 1_ms;
  std::uint8_t pcp = 6;
  std::uint16_t vlan = 0;
  Violations violations = Violations::forbidden;
  std::optional<std::uint16_t> publisher_id =
      {};  ///< of the master, those of the others follow; the next that are free if absent
  std::vector<ProcessData> process_data;
  std::vector<Reply> replies = {};
  std::optional<std::uint32_t> redundancy = {};      ///< copies of each message (IEEE 802.1CB)
  std::vector<std::vector<std::string>> paths = {};  ///< of messages between two members, in either direction
  Callers callers = {};                              ///< what the plant promises of calls
  std::optional<ProgramSecurity> security = {};      ///< in a scenario; the octets are those of real nodes
  bool operator==(const Program&) const = default;
};

/// What security adds to each message.
inline std::uint32_t octets_of_security(const Program& program) {
  return program.security ? static_cast<std::uint32_t>(security::added_octets(program.security->mode)) : 0;
}

/// On whom that method is called; nothing: on anybody.
const std::optional<std::vector<std::string>>& callers_of(const Program& program, Method method);

/// When in its cycle a participant publishes.
sim::Duration phase_of(const Program& program, std::string_view participant);

const json::Enumeration& describe(json::Type<Publish>);
const json::Enumeration& describe(json::Type<DataType>);
const json::Object& describe(json::Type<DataField>);
const json::Object& describe(json::Type<ProcessData>);
const json::Enumeration& describe(json::Type<Violations>);
const json::Object& describe(json::Type<Reply>);
const json::Object& describe(json::Type<Callers>);
const json::Object& describe(json::Type<Program>);

}  // namespace takt::plant
