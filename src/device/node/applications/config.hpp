// SPDX-License-Identifier: Apache-2.0
// The file of a node that runs applications and gateways: the words of scenarios, for those of them that are `on` this
// node.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "application/latency_law.hpp"
#include "application/topic_shape.hpp"
#include "gateway/content_filter.hpp"
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
  std::optional<MessageSecurity> security = {};
  std::uint64_t seed = 1;
  std::optional<std::string> statistics;
  bool operator==(const ApplicationsConfig&) const = default;
};

const json::Object& describe(json::Type<DdsTransport>);
const json::Object& describe(json::Type<ApplicationsConfig>);

/// The threads of a gateway: that which takes, and that which publishes.
inline constexpr const char* receiving_thread = "receive";
inline constexpr const char* sending_thread = "send";

/// A topic that has been checked.
struct LoadedTopic {
  application::TopicShape shape;
  bool is_sound = true;  ///< its fields
  std::uint16_t publisher_id = 1;
  std::uint16_t writer_groups = 1;  ///< of OPC UA: publications of the topic in the file, wherever they are; at least 1
  std::uint16_t domain = 0;
};

/// A thread or gateway that publishes to a topic, on whatever node.
struct LoadedPublication {
  std::string application;
  std::string thread;
  std::string topic;
  std::string on;
  std::uint16_t number = 1;  ///< among those of the topic, from 1 on
  Duration every;
};

/// A file that has been checked. What is on other nodes is no longer in `config`.
struct LoadedApplications {
  ApplicationsConfig config;
  std::vector<LoadedTopic> topics;  ///< as in the file
  std::vector<LoadedPublication> publications;
  /// By application and thread: which of the publications of its topic it is, for topics of OPC UA.
  std::map<std::pair<std::string, std::string>, std::uint16_t> writer_groups;
  /// By application or gateway, and thread: the law of its response, where the file has one.
  std::map<std::pair<std::string, std::string>, sim::Distribution> responses;
  /// By application and thread: the content filter of its subscription, where it has one.
  std::map<std::pair<std::string, std::string>, gateway::ContentFilter> filters;
  /// By application or gateway: that of its scheduler.
  std::map<std::string, sim::Distribution> scheduler_responses;
  /// What secures its topics of OPC UA, as of a node without Programs; null: nothing does.
  std::shared_ptr<const LoadedConfig> secured;
  std::size_t topic(const std::string& name) const;
};

/// Whether a file is one of these and not one of a Program. A file that cannot be read is none.
bool is_applications_file(const std::string& path);
/// Null if there was a mistake.
std::unique_ptr<LoadedApplications> load_applications(const std::string& path, json::Diagnostics& diagnostics);
/// The same of a text; `name` stands for the file in what is said of it.
std::unique_ptr<LoadedApplications> load_applications_text(const std::string& text, const std::string& name,
                                                           json::Diagnostics& diagnostics);

}  // namespace takt::node
