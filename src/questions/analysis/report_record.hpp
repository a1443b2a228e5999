// SPDX-License-Identifier: Apache-2.0
// What `takt bound --format json` holds: the bounds with the scenario's names.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/bounds.hpp"
#include "json/type.hpp"

namespace takt::analysis {

struct ReportedStream {
  const StreamBound* bound = nullptr;
  std::string listener;
};

struct ReportedQueue {
  const QueueBound* bound = nullptr;
  std::string node;
};

struct ReportedReaction {
  const ReactionBound* bound = nullptr;
  std::string program;
};

struct ReportedDelivery {
  const DeliveryBound* bound = nullptr;
  std::string topic;
  std::string from;  ///< "sensor/publish"
  std::string to;
};

/// A thread of a host's processor.
struct ReportedThread {
  std::string name;  ///< "plc/control"
  const ThreadTime* time = nullptr;
};

struct ReportedRequirement {
  std::string name;
  std::string text;
  const RequirementBound* bound = nullptr;
  std::optional<std::string> objection;
};

struct BoundReport {
  std::string scenario;
  std::vector<ReportedStream> streams;
  std::vector<ReportedQueue> queues;
  std::vector<ReportedReaction> reactions;
  std::vector<ReportedThread> threads;
  std::vector<ReportedDelivery> deliveries;
  std::vector<ReportedRequirement> requirements;
  std::vector<std::pair<std::string, AssessedAssumption>> assumptions;  ///< by name
};

/// The names, as reports list them.
std::vector<std::string> names_of(const Assumptions& assumptions);

const json::Record& describe(json::Type<HopBound>);
const json::Record& describe(json::Type<ReactionPart>);
const json::Record& describe(json::Type<FigureRange>);
const json::Record& describe(json::Type<ReportedStream>);
const json::Record& describe(json::Type<ReportedQueue>);
const json::Record& describe(json::Type<ReportedReaction>);
/// In the order of nodes.
std::vector<ReportedThread> threads_of(const scenario::Resolved& resolved, const Bounds& bounds);
const json::Record& describe(json::Type<ReportedThread>);
std::vector<ReportedDelivery> deliveries_of(const scenario::Resolved& resolved, const Bounds& bounds);
const json::Record& describe(json::Type<ReportedDelivery>);
const json::Record& describe(json::Type<ReportedRequirement>);
const json::Record& describe(json::Type<BoundReport>);

}  // namespace takt::analysis
