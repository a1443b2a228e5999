// The file of a node that runs applications and gateways: the words of scenarios, for those of them that are `on` this node.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/key_layout.hpp"
#include "gateway/type_mapping.hpp"
#include "node/config.hpp"
#include "vocabulary/application.hpp"
#include "vocabulary/dds.hpp"

namespace takt::node {

using vocabulary::Overflow;
using vocabulary::Pattern;
using vocabulary::Payload;
using vocabulary::Protocol;

struct Topic {
  json::Source where;
  std::string name;
  Protocol protocol = Protocol::opc_ua;
  json::NameMap<DataField> fields;
  std::optional<std::uint16_t> publisher_id;  ///< of OPC UA; 1 + the position among the topics if absent
  std::vector<std::string> keys = {};         ///< of DDS, as all below: fields that tell instances apart
  std::optional<std::string> type;            ///< the name of the IDL struct; the topic's if absent
  std::optional<std::uint16_t> domain;
  std::optional<vocabulary::Qos> qos;
  bool operator==(const Topic&) const = default;
};

/// Activated at offset + n * every of the clock. Exactly one of publish and subscribe is there.
struct Thread {
  json::Source where;
  std::string name;
  std::optional<std::string> publish;
  std::optional<std::string> subscribe;
  Duration every;
  Duration offset;
  std::optional<Payload> payload;
  std::optional<std::uint32_t> buffer;
  std::optional<std::uint64_t> tests;
  std::optional<vocabulary::Qos> qos;
  std::uint16_t writer_group = 1;             ///< not in the file: its number among the publications of its topic, if that is of OPC UA
  bool operator==(const Thread&) const = default;
};

/// The thread that checks what the other threads of its application have done in each of its windows.
struct Scheduler {
  json::Source where;
  Duration window = Duration::from_ps(10'000'000'000);
  Duration after;
  std::optional<std::uint64_t> tests;
  Duration tolerance = Duration::from_ps(1'000'000'000);
  bool operator==(const Scheduler&) const = default;
};

struct ApplicationOfNode {
  json::Source where;
  std::string name;
  std::optional<std::string> on;
  std::vector<Thread> threads;
  Scheduler scheduler = {};
  bool operator==(const ApplicationOfNode&) const = default;
};

struct GatewayOfNode {
  json::Source where;
  std::string name;
  std::optional<std::string> on;
  std::string from;
  std::string to;
  Duration receive_every;
  Duration receive_offset;
  Duration send_every;
  Duration send_offset;
  std::uint32_t buffer = 1;
  Overflow overflow = Overflow::overwrite_oldest;
  std::optional<Duration> stale_after;
  Scheduler scheduler = {};
  std::uint16_t writer_group = 1;             ///< as that of a thread
  bool operator==(const GatewayOfNode&) const = default;
};

/// How RTPS travels; ports are those of DDSI-RTPS 2.5, 9.6.1.
struct DdsTransport {
  json::Source where;
  std::optional<std::string> interface;
  bool operator==(const DdsTransport&) const = default;
};

struct ApplicationsConfig {
  json::Source where;
  std::string node;
  std::vector<Topic> topics;
  std::vector<ApplicationOfNode> applications;
  std::vector<GatewayOfNode> gateways;
  std::optional<Transport> transport;
  DdsTransport dds = {};
  ClockName clock = ClockName::monotonic;
  std::optional<Duration> duration;
  bool realtime = false;
  std::optional<std::string> statistics;
  bool operator==(const ApplicationsConfig&) const = default;
};

const json::Object& describe(json::Type<Topic>);
const json::Object& describe(json::Type<Thread>);
const json::Object& describe(json::Type<Scheduler>);
const json::Object& describe(json::Type<ApplicationOfNode>);
const json::Object& describe(json::Type<GatewayOfNode>);
const json::Object& describe(json::Type<DdsTransport>);
const json::Object& describe(json::Type<ApplicationsConfig>);

/// A topic that has been checked.
struct TopicShape {
  std::vector<gateway::DataSetField> fields;
  gateway::IdlStruct type;
  std::uint16_t publisher_id = 1;
  std::uint16_t writer_groups = 1;            ///< of OPC UA: publications of the topic in the file, wherever they are; at least 1
  std::uint16_t domain = 0;
  gateway::KeyLayout key;                     ///< of DDS
  std::vector<std::size_t> key_fields;
  std::size_t value_field = 0;                ///< the first that is no key
};

/// A file that has been checked. What is on other nodes is no longer in `config`.
struct LoadedApplications {
  ApplicationsConfig config;
  std::vector<TopicShape> shapes;  ///< by topic
  std::size_t topic(const std::string& name) const;
};

/// From a topic of one protocol to one of the other: fields and members are found by their names.
std::optional<gateway::TypeMapping> mapping_between(const TopicShape& from, const TopicShape& to, gateway::Direction direction, std::vector<std::string>& problems);

/// Whether a file is one of these and not one of a Program. A file that cannot be read is none.
bool is_applications_file(const std::string& path);
/// Null if there was a mistake.
std::unique_ptr<LoadedApplications> load_applications(const std::string& path, json::Diagnostics& diagnostics);

}  // namespace takt::node
