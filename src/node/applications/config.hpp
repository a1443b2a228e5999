// The file of a node that runs applications and gateways: the words of scenarios, for those of them that are `on` this node.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/key_layout.hpp"
#include "gateway/type_mapping.hpp"
#include "node/config.hpp"
#include "plant/application.hpp"
#include "plant/dds.hpp"

namespace takt::node {

using plant::Overflow;
using plant::Pattern;
using plant::Payload;
using plant::Protocol;
using plant::Scheduler;
using plant::Thread;
using plant::Topic;

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
  std::vector<plant::Application> applications;
  std::vector<plant::Gateway> gateways;
  std::optional<Transport> transport;
  DdsTransport dds = {};
  ClockName clock = ClockName::monotonic;
  std::optional<Duration> duration;
  bool realtime = false;
  std::optional<std::string> statistics;
  bool operator==(const ApplicationsConfig&) const = default;
};

const json::Object& describe(json::Type<DdsTransport>);
const json::Object& describe(json::Type<ApplicationsConfig>);

/// The thread of a gateway that publishes.
inline constexpr const char* sending_thread = "send";

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
  /// By application and thread: which of the publications of its topic it is, for topics of OPC UA.
  std::map<std::pair<std::string, std::string>, std::uint16_t> writer_groups;
  std::size_t topic(const std::string& name) const;
};

/// From a topic of one protocol to one of the other: fields and members are found by their names.
std::optional<gateway::TypeMapping> mapping_between(const TopicShape& from, const TopicShape& to, gateway::Direction direction, std::vector<std::string>& problems);

/// Whether a file is one of these and not one of a Program. A file that cannot be read is none.
bool is_applications_file(const std::string& path);
/// Null if there was a mistake.
std::unique_ptr<LoadedApplications> load_applications(const std::string& path, json::Diagnostics& diagnostics);

}  // namespace takt::node
