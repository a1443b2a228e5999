// Applications with threads that publish and subscribe to topics, as scenario files say them. See scenario/description/description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "scenario/applications/description_dds.hpp"
#include "scenario/description/latency.hpp"
#include "sim/time.hpp"
#include "vocabulary/application.hpp"
#include "vocabulary/program.hpp"

namespace takt::scenario {

using namespace sim::literals;  // NOLINT: units in default values

// The words that node files have too.
using vocabulary::Overflow;
using vocabulary::Pattern;
using vocabulary::Payload;
using vocabulary::Protocol;

/// A data set that applications publish and subscribe to.
struct Topic {
  json::Source where;
  std::string name;
  Protocol protocol = Protocol::opc_ua;
  json::NameMap<vocabulary::DataField> fields;
  std::optional<std::uint8_t> pcp;
  std::uint16_t vlan = 0;
  std::vector<std::string> keys = {};         ///< of DDS, as all below: fields that tell instances apart
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
  std::optional<Qos> qos;
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

/// Takes from a topic of one protocol into a shared buffer, and publishes from there to a topic of the other, each at its own rate.
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

/// A persistence service: keeps topics of DDS whose durability is transient or persistent.
struct Persistence {
  json::Source where;
  std::string name;
  std::string on;
  std::vector<std::string> topics;
  bool operator==(const Persistence&) const = default;
};

const json::Object& describe(json::Type<Topic>);
const json::Object& describe(json::Type<Signal>);
const json::Object& describe(json::Type<Thread>);
const json::Object& describe(json::Type<Scheduler>);
const json::Object& describe(json::Type<Application>);
const json::Object& describe(json::Type<Gateway>);
const json::Object& describe(json::Type<Persistence>);

}  // namespace takt::scenario
