// The file of a node: which participant of which Program it is, and how it reaches the others.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenario/json/fields.hpp"
#include "sim/time.hpp"
#include "vocabulary/protocol.hpp"
#include "wire/program_endpoint.hpp"

namespace takt::node {

namespace json = scenario::json;
using sim::Duration;

// The words that scenario files have too.
using vocabulary::DataField;
using vocabulary::DataType;
using vocabulary::Method;
using vocabulary::ProcessData;
using vocabulary::Publish;
using vocabulary::Subscription;
using vocabulary::Variant;

enum class ClockName : std::uint8_t { monotonic, tai };

/// As in a scenario; the same for all nodes of the group.
struct Program {
  json::Source where;
  std::string name;
  Variant variant = Variant::robust;
  std::string master;
  std::vector<std::string> slaves;
  Duration cycle;
  Duration offset;
  Publish publish = Publish::cyclic;
  Subscription subscription = Subscription::star;
  std::optional<Duration> receive_timeout;
  Duration initialisation = Duration::from_ps(1'000'000'000);
  std::uint16_t publisher_id = 1;
  std::vector<ProcessData> process_data;
  bool operator==(const Program&) const = default;
};

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

struct ScriptEntry {
  json::Source where;
  Duration at;  ///< after the start of this node
  Method call = Method::start;
  bool operator==(const ScriptEntry&) const = default;
};

enum class SourceKind : std::uint8_t { counter, constant, sine };

/// Where values of an own data set come from. Integers are rounded, and kept within their range.
struct Source {
  json::Source where;
  std::string data_set;
  std::optional<std::string> field;  ///< all fields without
  SourceKind kind = SourceKind::counter;
  double value = 0;      ///< constant: it; counter: the first; sine: around which
  double step = 1;       ///< counter: from message to message
  double amplitude = 1;  ///< sine
  Duration period = Duration::from_ps(1'000'000'000'000);  ///< sine; its phase is 0 at multiples on the clock
  bool operator==(const Source&) const = default;
};

struct Config {
  json::Source where;
  std::string node;
  Program program;
  Transport transport;
  ClockName clock = ClockName::monotonic;
  std::optional<Duration> duration;
  bool realtime = false;
  std::optional<Duration> launch_lead;
  std::optional<std::string> control;
  std::vector<Source> sources;
  std::optional<Duration> log_values_every;
  std::vector<ScriptEntry> script;
  bool operator==(const Config&) const = default;
};

const json::Enumeration& describe(json::Type<ClockName>);
const json::Object& describe(json::Type<Program>);
const json::Object& describe(json::Type<UdpTransport>);
const json::Object& describe(json::Type<EthernetTransport>);
const json::Tagged& describe(json::Type<Transport>);
const json::Object& describe(json::Type<ScriptEntry>);
const json::Enumeration& describe(json::Type<SourceKind>);
const json::Object& describe(json::Type<Source>);
const json::Object& describe(json::Type<Config>);

/// A file that has been checked, and the endpoint that it asks for, but for the incarnation.
struct LoadedConfig {
  Config config;
  wire::EndpointSettings endpoint;
};

/// Null if there was a mistake.
std::unique_ptr<LoadedConfig> load_config(const std::string& path, json::Diagnostics& diagnostics);

}  // namespace takt::node
