// SPDX-License-Identifier: Apache-2.0
// What JSON files say of applications with threads that publish and subscribe, wherever they run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "plant/dds.hpp"
#include "plant/latency.hpp"
#include "plant/program.hpp"
#include "plant/uadp.hpp"
#include "sim/time.hpp"

namespace takt::plant {

using namespace sim::literals;  // NOLINT: units in default values

enum class Protocol : std::uint8_t { opc_ua, dds };
enum class Pattern : std::uint8_t { counter, alternate };
enum class Overflow : std::uint8_t { overwrite_oldest, drop_newest, keep_latest };

/// What a thread publishes: the first field that is a number says it, all others are zero or empty but for `values`; or
/// what another topic last said.
struct Payload {
  json::Source where;
  std::optional<Pattern> pattern;
  std::optional<std::string> copy_of;
  std::optional<std::uint32_t> instance;  ///< of a topic with keys, as the next
  std::optional<std::uint32_t> instances;
  json::NameMap<std::string> values = {};  ///< of fields that are no numbers, as text
  bool operator==(const Payload&) const = default;
};

enum class Publication : std::uint8_t { synchronous, asynchronous };

/// What an asynchronous writer may send at once.
struct FlowControl {
  json::Source where;
  std::uint32_t octets = 0;
  Duration every;
  bool operator==(const FlowControl&) const = default;
};

/// A data set that applications publish and subscribe to.
struct Topic {
  json::Source where;
  std::string name;
  Protocol protocol = Protocol::opc_ua;
  json::NameMap<TopicField> fields;
  std::optional<std::uint16_t> publisher_id = {};  ///< of OPC UA; by its position if absent
  std::optional<std::uint8_t> pcp;
  std::uint16_t vlan = 0;
  std::optional<UadpLayout> uadp = {};  ///< of OPC UA; as UadpLayout() if absent
  std::vector<std::string> keys = {};   ///< of DDS, as all below: fields that tell instances apart
  std::optional<std::string> type;
  std::optional<std::uint16_t> domain;
  std::optional<Qos> qos;
  std::optional<Publication> publication;
  std::optional<FlowControl> flow_control;
  bool operator==(const Topic&) const = default;
};

/// A digital output that follows the first field of what a thread takes: high unless it is zero.
struct Signal {
  json::Source where;
  std::string name;
  std::optional<Duration> pulse;
  bool operator==(const Signal&) const = default;
};

/// A thread is activated at offset + n * every on its host's clock. Exactly one of publish and subscribe is there.
struct Thread {
  json::Source where;
  std::string name;
  std::optional<std::string> publish;
  std::optional<std::string> subscribe;
  Duration every;
  Duration offset;
  std::optional<Latency> response;
  std::optional<std::uint64_t> tests = {};
  std::optional<Payload> payload;
  std::optional<std::uint32_t> buffer;
  std::optional<Signal> signal;
  std::optional<std::string> round_trip = {};  ///< topic
  std::optional<Qos> qos;
  std::optional<std::string> filter = {};  ///< of DDS: an expression over the fields of what it subscribes to
  bool operator==(const Thread&) const = default;
};

/// The thread that checks what the other threads of its application have done in each of its windows.
struct Scheduler {
  json::Source where;
  Duration window = 10_ms;
  Duration after;
  std::optional<std::uint64_t> tests;
  std::optional<Latency> response;
  Duration tolerance = 1_ms;
  bool operator==(const Scheduler&) const = default;
};

struct Application {
  json::Source where;
  std::string name;
  std::string on;
  std::vector<Thread> threads;
  Scheduler scheduler = {};
  bool operator==(const Application&) const = default;
};

/// Takes from a topic of one protocol into a shared buffer, and publishes from there to a topic of the other, each at
/// its own rate.
struct Gateway {
  json::Source where;
  std::string name;
  std::string on;
  std::string from;
  std::string to;
  Duration receive_every;
  Duration receive_offset;
  std::optional<Latency> receive_response;
  Duration send_every;
  Duration send_offset;
  std::optional<Latency> send_response;
  std::uint32_t buffer = 1;
  Overflow overflow = Overflow::overwrite_oldest;
  std::optional<Duration> stale_after;
  Scheduler scheduler = {};
  bool operator==(const Gateway&) const = default;
};

const json::Enumeration& describe(json::Type<Protocol>);
const json::Enumeration& describe(json::Type<Pattern>);
const json::Enumeration& describe(json::Type<Overflow>);
const json::Object& describe(json::Type<Payload>);
const json::Enumeration& describe(json::Type<Publication>);
const json::Object& describe(json::Type<FlowControl>);
const json::Object& describe(json::Type<Topic>);
const json::Object& describe(json::Type<Signal>);
const json::Object& describe(json::Type<Thread>);
const json::Object& describe(json::Type<Scheduler>);
const json::Object& describe(json::Type<Application>);
const json::Object& describe(json::Type<Gateway>);

}  // namespace takt::plant
