// SPDX-License-Identifier: Apache-2.0
// A scenario as its file says it: plain structs, one for each JSON object. tables*.cpp read, write and document them;
// what they mean together is checked by resolve.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "json/any.hpp"
#include "json/fields.hpp"
#include "plant/latency.hpp"
#include "plant/program.hpp"
#include "plant/role.hpp"
#include "scenario/description/applications.hpp"
#include "scenario/description/clocks.hpp"
#include "scenario/description/cpu.hpp"
#include "scenario/description/faults.hpp"
#include "scenario/description/figures.hpp"
#include "scenario/description/gate_limits.hpp"
#include "scenario/description/ingress.hpp"
#include "scenario/description/medium.hpp"
#include "scenario/description/requirements.hpp"
#include "scenario/description/route.hpp"
#include "scenario/description/traffic_classes.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::scenario {

// What node files have too.
using plant::DataField;
using plant::DataType;
using plant::Latency;
using plant::LatencyTail;
using plant::Method;
using plant::OnReplacement;
using plant::ProcessData;
using plant::Program;
using plant::Publish;
using plant::Reply;
using plant::Role;
using plant::Subscription;
using plant::Variant;
using plant::Violations;

using sim::DataRate;
using sim::Duration;
using sim::Length;
using sim::Octets;
using namespace sim::literals;  // NOLINT: units in default values

enum class OsProfile : std::uint8_t {
  none,
  preempt_rt,
  preempt_rt_isolated,
  preempt_rt_arm,
  general_purpose,
  virtual_machine,
  virtual_machine_rt
};

/// The operating system of a host: a profile, single delays of which may be replaced.
struct OperatingSystem {
  json::Source where;
  OsProfile profile = OsProfile::none;
  std::optional<Latency> transmit;
  std::optional<Latency> receive;
  std::optional<Latency> wake_up;
  bool operator==(const OperatingSystem&) const = default;
};

/// How long a Program's application works at process data that has come before it replies.
struct Processing {
  json::Source where;
  std::optional<Latency> per_message;
  std::optional<Latency> per_field;
  bool operator==(const Processing&) const = default;
};

/// Which frame is lost when a queue is full.
enum class FullQueue : std::uint8_t { newest, oldest };

/// What the eight queues of a port may hold.
struct Queues {
  json::Source where;
  std::optional<std::uint32_t> frames;
  std::optional<Octets> octets;
  FullQueue drop = FullQueue::newest;
  /// Other limits for single classes.
  struct PerClass {
    json::Source where;
    std::uint8_t traffic_class = 0;
    std::optional<std::uint32_t> frames;
    std::optional<Octets> octets;
    std::optional<FullQueue> drop = {};
    bool operator==(const PerClass&) const = default;
  };
  std::vector<PerClass> classes;
  bool operator==(const Queues&) const = default;
};

enum class MacOperation : std::uint8_t { none, hold, release };

/// One entry of a gate control list.
struct GateEntry {
  json::Source where;
  std::vector<std::uint8_t> open;
  Duration interval;
  MacOperation mac = MacOperation::none;
  bool operator==(const GateEntry&) const = default;
};

/// The transmission gates of a port.
struct Gates {
  json::Source where;
  std::optional<Duration> cycle;
  Duration base_time;
  Duration extension;
  std::vector<GateEntry> entries;
  bool running = false;
  bool operator==(const Gates&) const = default;
};

enum class SlopeOf : std::uint8_t { cycle, window };

/// The credit-based shaper of a class.
struct Shaper {
  json::Source where;
  std::uint8_t traffic_class = 0;
  DataRate idle_slope;
  SlopeOf of = SlopeOf::cycle;
  bool operator==(const Shaper&) const = default;
};

/// What a class gets of the bandwidth that classes without a share leave.
struct Share {
  json::Source where;
  std::uint8_t traffic_class = 0;
  std::uint8_t bandwidth = 0;  ///< percent
  bool operator==(const Share&) const = default;
};

struct MaxSdu {
  json::Source where;
  std::uint8_t traffic_class = 0;
  Octets size{0};
  bool operator==(const MaxSdu&) const = default;
};

/// Frame preemption.
struct Preemption {
  json::Source where;
  std::vector<std::uint8_t> preemptable;
  std::uint8_t add_frag_size = 0;
  std::optional<Duration> hold_advance;
  Duration release_advance;
  bool operator==(const Preemption&) const = default;
};

/// What ports do beyond strict priority: all of a node, or the one to a certain neighbour.
struct Egress {
  Egress();
  Egress(const Egress&);
  Egress(Egress&&) noexcept;
  Egress& operator=(const Egress&);
  Egress& operator=(Egress&&) noexcept;
  ~Egress();

  json::Source where;
  std::optional<std::string> to;
  std::optional<Gates> gates;
  std::vector<Shaper> shapers;
  std::vector<MaxSdu> max_sdu;
  std::vector<std::uint8_t> ats;
  std::vector<Share> ets;
  std::optional<Preemption> preemption;
  std::vector<std::uint8_t> cut_through;
  bool untagged = false;
  bool operator==(const Egress&) const = default;
};

struct Device;  // device.hpp

/// The type of a node, once its file has been read; what it says stands in the other keys then. It takes no part in
/// comparisons.
struct DeviceType {
  std::shared_ptr<const Device> of = {};
  friend bool operator==(const DeviceType&, const DeviceType&) { return true; }
};

/// "gates": "none" of a node.
enum class NoGates : std::uint8_t { none };

/// What the ports of a node do.
struct NodePorts {
  TrafficClasses traffic_classes = TrafficClasses::standard;
  Queues queues;
  std::vector<Egress> egress;
  std::optional<GateLimits> gate_limits = {};
  std::optional<Octets> mtu = {};          ///< as the network says if absent
  std::optional<NoGates> gates = {};       ///< its ports have none
  std::optional<std::string> device = {};  ///< a file; absent once it has been read
  DeviceType type = {};
  bool operator==(const NodePorts&) const = default;
};

/// The part of a node in which Programs, applications and talkers are.
struct EndStation {
  OperatingSystem os;
  std::optional<Processing> processing = {};
  std::vector<std::string> offers = {};
  std::optional<Cryptography> cryptography = {};
  std::optional<Cpu> cpu = {};
  std::vector<TalkerAts> ats = {};
  bool operator==(const EndStation&) const = default;
};

/// The part of a node that forwards what is not for it.
struct Relay {
  Duration forwarding_delay;
  std::optional<Latency> forwarding_jitter = {};
  Octets cut_through_header{22};
  std::optional<Ingress> ingress = {};
  bool operator==(const Relay&) const = default;
};

struct HostNode : NodePorts, EndStation {
  json::Source where;
  bool operator==(const HostNode&) const = default;
};

struct SwitchNode : NodePorts, Relay {
  json::Source where;
  bool operator==(const SwitchNode&) const = default;
};

/// A bridged end station: an end station whose interface is a bridge of several ports.
struct StationNode : NodePorts, EndStation, Relay {
  json::Source where;
  bool bypass = false;                ///< a relay joins ports 0 and 1 while the station is down
  Duration bypass_switching = 10_ms;  ///< how long it takes to join or to part them
  bool operator==(const StationNode&) const = default;
};

using Node = std::variant<HostNode, SwitchNode, StationNode>;

/// The parts of a node; null if it has none of that kind.
const EndStation* end_station_of(const Node& node);
EndStation* end_station_of(Node& node);
const Relay* relay_of(const Node& node);
Relay* relay_of(Node& node);
const NodePorts& ports_of(const Node& node);
NodePorts& ports_of(Node& node);
const json::Source& source_of(const Node& node);

struct Link {
  json::Source where;
  std::vector<std::string> ends;  ///< "node" (its next free port) or "node:port"
  DataRate rate{1'000'000'000};
  std::optional<Length> length;
  std::optional<Duration> delay;
  std::optional<Medium> medium = {};
  bool operator==(const Link&) const = default;
};

enum class Shape : std::uint8_t { line, ring, star, tree, mesh, comb, random, dual_star };

/// A topology in one line.
struct Generator {
  json::Source where;
  Shape shape = Shape::line;
  std::optional<std::uint64_t> switches;
  std::optional<std::uint64_t> depth;
  std::optional<std::uint64_t> fanout;
  std::optional<std::uint64_t> rows;
  std::optional<std::uint64_t> columns;
  std::uint64_t hosts_per_switch = 1;
  std::string switch_prefix = "sw";
  std::string host_prefix = "h";
  DataRate rate{1'000'000'000};
  std::optional<DataRate> host_rate;
  Length length{10'000};
  Duration forwarding_delay;
  OperatingSystem os;
  Queues queues;
  TrafficClasses traffic_classes = TrafficClasses::standard;
  std::vector<Egress> egress;
  std::optional<Ingress> ingress = {};
  std::optional<std::uint64_t> teeth = {};
  std::optional<double> degree = {};
  std::optional<std::uint64_t> seed = {};
  std::optional<std::uint64_t> stations = {};
  std::string station_prefix = "st";
  std::optional<Latency> forwarding_jitter = {};
  std::optional<GateLimits> gate_limits = {};
  std::optional<GateLimits> host_gate_limits = {};
  std::optional<Octets> mtu = {};
  std::optional<NoGates> gates = {};  ///< as of a node, of the switches or stations
  std::optional<std::string> device = {};
  DeviceType type = {};
  bool operator==(const Generator&) const = default;
};

struct NetworkSection {
  NetworkSection();
  NetworkSection(const NetworkSection&);
  NetworkSection(NetworkSection&&) noexcept;
  NetworkSection& operator=(const NetworkSection&);
  NetworkSection& operator=(NetworkSection&&) noexcept;
  ~NetworkSection();

  json::Source where;
  json::NameMap<Node> nodes;
  std::vector<Link> links;
  std::vector<Generator> generate;
  Octets mtu{1500};
  bool operator==(const NetworkSection&) const = default;
};

enum class Encapsulation : std::uint8_t { udp, ethernet };

struct ExponentialGaps {
  Duration mean;
  bool operator==(const ExponentialGaps&) const = default;
};
/// Random gaps of a normal distribution that is cut off.
struct NormalGaps {
  json::Source where;
  Duration mean;
  Duration deviation;
  Duration min;
  std::optional<Duration> max;
  bool operator==(const NormalGaps&) const = default;
};
struct Bursts {
  std::uint32_t frames = 1;
  Duration every;
  Duration spacing;
  bool operator==(const Bursts&) const = default;
};

struct Stream {
  Stream();
  Stream(const Stream&);
  Stream(Stream&&) noexcept;
  Stream& operator=(const Stream&);
  Stream& operator=(Stream&&) noexcept;
  ~Stream();

  json::Source where;
  std::string name;
  std::string from;
  Names to;
  Octets payload{0};
  Encapsulation encapsulation = Encapsulation::udp;
  std::optional<std::uint8_t> pcp;
  std::optional<std::uint8_t> host_priority;
  std::uint16_t vlan = 0;
  std::optional<Duration> every;
  std::optional<ExponentialGaps> exponential;
  std::optional<NormalGaps> normal;
  std::optional<Bursts> burst;
  std::optional<std::string> trace;
  std::optional<json::OrAuto<Duration>> offset;  ///< 0 in a run; absent, it is nothing that the plant promises
  std::optional<Duration> until = {};            ///< no frame is due from then on
  Duration jitter;
  std::optional<Duration> launch;
  std::optional<std::vector<std::string>> path;
  std::optional<Route> route;  ///< the shortest path until takt schedule has written one
  std::optional<Redundancy> redundancy;
  bool operator==(const Stream&) const = default;
};

/// Another gate list for a port.
struct SetGates {
  json::Source where;
  std::string node;
  std::optional<std::string> to;
  Gates gates;
  bool operator==(const SetGates&) const = default;
};

struct ScriptEntry {
  json::Source where;
  Duration at;
  std::optional<std::string> program;
  std::optional<Method> call;
  std::optional<std::string> on;
  std::optional<std::string> join = {};
  std::optional<std::string> leave = {};
  std::optional<SetGates> set_gates;
  bool operator==(const ScriptEntry&) const = default;
};

enum class GatePlanning : std::uint8_t { none, automatic, listed };
enum class GateGuard : std::uint8_t { length_aware, longest_frame };

/// The gates of the whole network.
struct NetworkGates {
  json::Source where;
  GatePlanning plan = GatePlanning::none;
  std::optional<json::OrAuto<Duration>> margin = {};  ///< no gates are laid before "auto" is measured
  std::vector<std::uint8_t> classes = {};
  GateGuard guard = GateGuard::length_aware;
  std::vector<SetGates> lists = {};
  bool operator==(const NetworkGates&) const = default;
};

struct Scenario {
  Scenario();
  Scenario(const Scenario&);
  Scenario(Scenario&&) noexcept;
  Scenario& operator=(const Scenario&);
  Scenario& operator=(Scenario&&) noexcept;
  ~Scenario();

  json::Source where;
  std::optional<std::string> schema;  ///< "$schema", for editors
  std::string name;
  std::optional<std::string> description;
  std::uint64_t seed = 1;
  Duration duration;
  Duration warm_up = {};
  NetworkSection network;
  Clocks clocks;
  std::vector<Program> programs;
  std::vector<Topic> topics = {};
  std::vector<Domain> domains = {};
  std::vector<Application> applications = {};
  std::vector<Gateway> gateways = {};
  std::vector<Persistence> persistence = {};
  std::vector<Stream> streams;
  std::vector<ScriptEntry> script;
  std::vector<Fault> faults;
  std::optional<Rerouting> rerouting;
  std::optional<NetworkGates> gates = {};
  std::vector<Requirement> require;
  bool allow_overload = false;
  bool operator==(const Scenario&) const = default;
};

const json::Object& describe(json::Type<Processing>);
const json::Enumeration& describe(json::Type<OsProfile>);
const json::Object& describe(json::Type<OperatingSystem>);
const json::Enumeration& describe(json::Type<FullQueue>);
const json::Object& describe(json::Type<Queues>);
const json::Object& describe(json::Type<Queues::PerClass>);
const json::Enumeration& describe(json::Type<MacOperation>);
const json::Object& describe(json::Type<GateEntry>);
const json::Object& describe(json::Type<Gates>);
const json::Enumeration& describe(json::Type<SlopeOf>);
const json::Object& describe(json::Type<Shaper>);
const json::Object& describe(json::Type<Share>);
const json::Object& describe(json::Type<MaxSdu>);
const json::Object& describe(json::Type<Preemption>);
const json::Object& describe(json::Type<Egress>);
const json::Enumeration& describe(json::Type<NoGates>);
const json::Object& describe(json::Type<HostNode>);
const json::Object& describe(json::Type<SwitchNode>);
const json::Object& describe(json::Type<StationNode>);
const json::Tagged& describe(json::Type<Node>);
const json::Object& describe(json::Type<Link>);
const json::Enumeration& describe(json::Type<Shape>);
const json::Object& describe(json::Type<Generator>);
const json::Object& describe(json::Type<NetworkSection>);
const json::Enumeration& describe(json::Type<Encapsulation>);
const json::Object& describe(json::Type<ExponentialGaps>);
const json::Object& describe(json::Type<NormalGaps>);
const json::Object& describe(json::Type<Bursts>);
const json::Object& describe(json::Type<Stream>);
const json::Object& describe(json::Type<SetGates>);
const json::Object& describe(json::Type<ScriptEntry>);
const json::Enumeration& describe(json::Type<GatePlanning>);
const json::Enumeration& describe(json::Type<GateGuard>);
const json::Object& describe(json::Type<NetworkGates>);
const json::Object& describe(json::Type<Scenario>);

/// The name of an enum's value as the file spells it.
template <class E>
std::string_view spelling(E value) {
  for (const json::EnumName& name : describe(json::Type<E>{}).names)
    if (name.value == static_cast<std::int64_t>(value)) return name.name;
  return "?";
}

}  // namespace takt::scenario
