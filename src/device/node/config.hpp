// SPDX-License-Identifier: Apache-2.0
// The file of a node: which participant of which Programs it is, and how it reaches the others.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "json/fields.hpp"
#include "node/key_access.hpp"
#include "node/key_file.hpp"
#include "node/message_security.hpp"
#include "node/server_config.hpp"
#include "plant/protocol.hpp"
#include "sim/time.hpp"
#include "wire/program_node.hpp"

namespace takt::node {

using sim::Duration;

// What scenario files have too.
using plant::DataField;
using plant::DataType;
using plant::Method;
using plant::OnReplacement;
using plant::ProcessData;
using plant::Program;
using plant::Publish;
using plant::Role;
using plant::Subscription;
using plant::Variant;

enum class ClockName : std::uint8_t { monotonic, tai };

/// UADP over UDP.
struct UdpTransport {
  json::Source where;
  std::optional<std::string> interface;
  std::uint16_t port = 4840;
  std::vector<std::string> destinations;  ///< "address" or "address:port"; multicast ones are joined
  std::uint8_t pcp = 6;
  bool operator==(const UdpTransport&) const = default;
};

/// UADP over Ethernet.
struct EthernetTransport {
  json::Source where;
  std::string interface;
  std::string destination = "01:00:5e:7f:00:01";
  std::optional<std::uint16_t> vlan;  ///< with it frames carry a tag
  std::uint8_t pcp = 6;
  bool operator==(const EthernetTransport&) const = default;
};

using Transport = std::variant<UdpTransport, EthernetTransport>;

/// What a node that offers its skills does as a whole.
enum class Membership : std::uint8_t { join, leave };

struct ScriptEntry {
  json::Source where;
  std::optional<std::string> program;  ///< the only one that is not nested in another of this node, if absent
  Duration at;                         ///< after the start of this node
  std::optional<Method> call;          ///< or
  std::optional<Membership> membership;
  bool operator==(const ScriptEntry&) const = default;
};

enum class SourceKind : std::uint8_t { counter, constant, sine };

/// Where values of an own data set come from. Integers are rounded, and kept within their range.
struct Source {
  json::Source where;
  std::optional<std::string> program;  ///< needed where several have a data set of this name
  std::string data_set;
  std::optional<std::string> field;  ///< all fields without
  SourceKind kind = SourceKind::counter;
  double value = 0;                                        ///< constant: it; counter: the first; sine: around which
  double step = 1;                                         ///< counter: from message to message
  double amplitude = 1;                                    ///< sine
  Duration period = Duration::from_ps(1'000'000'000'000);  ///< sine; its phase is 0 at multiples on the clock
  bool operator==(const Source&) const = default;
};

struct Config {
  json::Source where;
  std::string node;
  std::optional<Program> program;   ///< this one, or
  std::vector<Program> programs;    ///< those, of which the node is in some
  std::vector<std::string> offers;  ///< skills, of a candidate
  bool absent = false;              ///< a candidate that announces itself only when it is told to
  Transport transport;
  ClockName clock = ClockName::monotonic;
  std::optional<Duration> duration;
  bool realtime = false;
  std::optional<Duration> launch_lead;
  std::optional<std::string> control;
  std::optional<MessageSecurity> security;
  std::vector<Source> sources;
  std::optional<Duration> log_values_every;
  std::vector<ScriptEntry> script;
  std::optional<ServerConfig> server;
  bool operator==(const Config&) const = default;
};

const json::Enumeration& describe(json::Type<ClockName>);
const json::Object& describe(json::Type<UdpTransport>);
const json::Object& describe(json::Type<EthernetTransport>);
const json::Tagged& describe(json::Type<Transport>);
const json::Enumeration& describe(json::Type<Membership>);
const json::Object& describe(json::Type<ScriptEntry>);
const json::Enumeration& describe(json::Type<SourceKind>);
const json::Object& describe(json::Type<Source>);
const json::Object& describe(json::Type<Config>);

/// A Program that the node is in, and what it is there; but for the incarnation.
struct LoadedProgram : wire::NodeSettings {
  Program program;
  std::optional<std::size_t> outer;  ///< in LoadedConfig::programs: this node is a slave there, and the master here
};

/// What the script does.
struct LoadedCall {
  Duration at;
  std::size_t program = 0;  ///< in LoadedConfig::programs
  std::variant<program::Method, Membership> what;
};

/// A file that has been checked, and the endpoints that it asks for.
struct LoadedConfig {
  Config config;
  std::vector<LoadedProgram> programs;             ///< in the order of the file; at least one
  std::vector<LoadedCall> script;                  ///< by time
  std::optional<LoadedKeys> keys = {};             ///< if its messages are secured with keys of a file, or
  std::optional<LoadedKeyAccess> key_access = {};  ///< with those of a key service
  std::vector<LoadedGroup> served = {};            ///< keys that its server gives
  std::uint16_t sender = 0;                        ///< number in nonces, of a node without Programs
};

/// Which of a node's Programs a command that names none is for: the only one that is not nested in another of them.
std::optional<std::size_t> outermost(const std::vector<LoadedProgram>& programs);

/// The one in which the node offers its skills; nothing if there is none.
std::optional<std::size_t> offered_in(const std::vector<LoadedProgram>& programs);

/// Null if there was a mistake.
std::unique_ptr<LoadedConfig> load_config(const std::string& path, json::Diagnostics& diagnostics);

}  // namespace takt::node
