// SPDX-License-Identifier: Apache-2.0
// Runs the applications and gateways of a node: a thread for each role, and one for each scheduler.
#pragma once

#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "application/activation_plan.hpp"
#include "application/output_level.hpp"
#include "gateway/channel.hpp"
#include "node/applications/config.hpp"
#include "node/applications/topic_end.hpp"
#include "node/key_mailbox.hpp"
#include "node/node_security.hpp"
#include "node/statistics.hpp"
#include "plant/criterion.hpp"

namespace takt::node {

/// What was seen of a digital output, by the clock of the node.
struct SignalStatistics {
  std::string name;
  Duration pulse;  ///< nominal
  application::PulseFigures figures;
};

/// What a thread of an application or gateway did.
struct ThreadStatistics {
  std::string name;
  std::string role;  ///< "publish", "subscribe"; of a gateway "receive", "send"
  std::string topic;
  std::int64_t every_ns = 0;
  std::int64_t window_ns = 0;
  std::uint64_t calls = 0;
  std::uint64_t missed = 0;     ///< activations
  std::uint64_t sent = 0;       ///< samples that the protocol took
  std::uint64_t timed_out = 0;  ///< of DDS: samples that waited for room for max_blocking_time, and were not sent
  std::uint64_t not_sent = 0;   ///< samples that the protocol or the socket refused
  std::uint64_t taken = 0;      ///< samples that came; those that no activation took any more are taken at the end
  std::uint64_t lost = 0;       ///< of OPC UA: numbers that were jumped over
  Distribution late;  ///< waking up, against when it had to: the activation and the response time that was drawn for it
  Distribution response;                  ///< from an activation to the call that answers it
  plant::CriterionFigures call_windows;   ///< criterion 1
  plant::CriterionFigures value_windows;  ///< criterion 2, of those that take
  std::optional<SignalStatistics> signal = {};
};

struct ApplicationStatistics {
  std::string name;
  bool is_gateway = false;
  std::vector<ThreadStatistics> threads;
  std::optional<gateway::ChannelFigures> channel;  ///< of a gateway
};

/// What a node has to say at its end.
struct ApplicationsReport {
  std::string node;
  std::vector<ApplicationStatistics> all;
  std::vector<HeardSource> sources = {};        ///< of topics of OPC UA
  std::optional<SecurityStatus> security = {};  ///< of topics that are secured
};
const json::Record& describe(json::Type<SignalStatistics>);
const json::Record& describe(json::Type<ThreadStatistics>);
const json::Record& describe(json::Type<ApplicationStatistics>);
const json::Record& describe(json::Type<ApplicationsReport>);

class ApplicationHost {
 public:
  /// Null, and `problem` says why, if the machine does not give what the file asks for. What it can do without is a
  /// line of `warnings`. `keys`, by which those of a key service come, outlives it.
  static std::unique_ptr<ApplicationHost> make(const LoadedApplications& loaded, std::string& problem,
                                               std::string& warnings, KeyMailbox* keys = nullptr);
  ~ApplicationHost();

  /// Runs until the file's duration is over or `stop_requested` says so. Throws what one of its threads has thrown,
  /// after all have ended.
  void run(bool (*stop_requested)(const void* context), const void* context);
  /// After `run`.
  std::vector<ApplicationStatistics> statistics() const;
  ApplicationsReport report() const;

 private:
  struct Task;
  struct Watched;
  ApplicationHost(const LoadedApplications& loaded);
  bool open(std::string& problem, KeyMailbox* keys);
  TopicWriter* writer_of(const std::string& topic, std::uint16_t writer_group, const std::optional<plant::Qos>& qos,
                         std::string& problem);
  /// `filter`: of a subscription over DDS; or null.
  TopicReader* reader_of(const std::string& topic, const std::optional<plant::Qos>& qos,
                         const gateway::ContentFilter* filter, std::string& problem);
  DdsParticipant* participant_of(std::uint16_t domain, std::string& problem);
  bool add_application(const plant::Application& application, std::string& problem);
  bool add_gateway(const plant::Gateway& gateway, std::string& problem);
  application::ActivationPlan plan_of(const Watched& watched, const Task& task) const;
  void run_task(const Watched& watched, Task& task);
  void run_scheduler(Watched& watched);

  std::string path_of(const Watched& watched) const;

  LoadedApplications loaded_;
  sim::Distribution at_once_ =
      sim::Distribution::constant({});      // the response where the file has none: it passes by itself
  std::unique_ptr<NodeSecurity> security_;  ///< of the topics below, under their lock
  std::unique_ptr<OpcUaTopics> opc_ua_;
  std::vector<std::pair<std::uint16_t, std::unique_ptr<DdsParticipant>>> participants_;
  std::vector<std::unique_ptr<TopicWriter>> dds_writers_;
  std::vector<std::unique_ptr<TopicReader>> dds_readers_;
  std::vector<std::unique_ptr<Watched>> watched_;
  std::int64_t started_ = 0;
  std::atomic<bool> is_over_{false};
};

/// One JSON object, as `takt schema statistics` describes it.
std::string to_json(const ApplicationsReport& report);
/// For people.
std::string to_text(const ApplicationsReport& report);

}  // namespace takt::node
