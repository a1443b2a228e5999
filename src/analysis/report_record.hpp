// What `takt bound --format json` holds: the bounds with the scenario's names.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/bounds.hpp"
#include "scenario/json/type.hpp"

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

struct ReportedRequirement {
  std::string text;
  const RequirementBound* bound = nullptr;
  std::optional<std::string> objection;
};

struct BoundReport {
  std::string scenario;
  std::vector<ReportedStream> streams;
  std::vector<ReportedQueue> queues;
  std::vector<ReportedReaction> reactions;
  std::vector<ReportedRequirement> requirements;
  std::vector<std::pair<std::string, AssessedAssumption>> assumptions;   ///< by name
};

/// The names, as reports list them.
std::vector<std::string> names_of(const Assumptions& assumptions);

const scenario::json::Record& describe(scenario::json::Type<HopBound>);
const scenario::json::Record& describe(scenario::json::Type<ReactionPart>);
const scenario::json::Record& describe(scenario::json::Type<FigureRange>);
const scenario::json::Record& describe(scenario::json::Type<ReportedStream>);
const scenario::json::Record& describe(scenario::json::Type<ReportedQueue>);
const scenario::json::Record& describe(scenario::json::Type<ReportedReaction>);
const scenario::json::Record& describe(scenario::json::Type<ReportedRequirement>);
const scenario::json::Record& describe(scenario::json::Type<BoundReport>);

}  // namespace takt::analysis
