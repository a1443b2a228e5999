// SPDX-License-Identifier: Apache-2.0
// What takt schedule says about a scenario that changes while it runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json/record.hpp"
#include "synthesis/scenario_change.hpp"

namespace takt::synthesis {

struct ChangedStreamRow {
  std::string name;
  std::string what;  ///< "comes", "goes", "moves", "lost"
  bool was_cut = false;
  std::optional<std::vector<std::string>> path_before, path;
  std::optional<Duration> offset_before, offset;
  std::optional<std::uint64_t> step;    ///< in which its talker changes over, from 1; of one that pauses the last one
  std::optional<Duration> last, first;  ///< when the last frame at the old time is due, and the first one at the new
};

struct WrittenEntryRow {
  std::vector<std::uint64_t> open;
  Duration interval;
};

struct WrittenListRow {
  std::uint64_t step = 0;  ///< from 1
  std::string port;
  Duration written, holds_from, cycle;
  std::vector<WrittenEntryRow> entries;
};

/// What is written and printed of a ScenarioChange.
struct ChangeSummary {
  std::string scenario;
  std::string verdict;  ///< "changed", "partly", "undecided"
  std::string how;
  std::optional<Duration> at, end, duration;
  std::vector<ChangedStreamRow> changes;
  std::vector<std::string> without_place, without_way, would_pause;
  std::vector<WrittenListRow> lists;
  std::uint64_t frames = 0;
  std::vector<CarriedStream> streams;
};

ChangeSummary summary_of(const std::string& scenario, const ScenarioChange& change);
/// Some lines for people, with a table of the steps.
std::string text_of(const ChangeSummary& summary);

const json::Record& describe(json::Type<ChangedStreamRow>);
const json::Record& describe(json::Type<WrittenEntryRow>);
const json::Record& describe(json::Type<WrittenListRow>);
const json::Record& describe(json::Type<CarriedStream>);
const json::Record& describe(json::Type<ChangeSummary>);

}  // namespace takt::synthesis
