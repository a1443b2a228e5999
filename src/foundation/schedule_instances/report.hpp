// SPDX-License-Identifier: Apache-2.0
// What takt schedule says about an instance.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/record.hpp"
#include "schedule/decide.hpp"

namespace takt::schedule_instances {

struct LeftOverReport {
  std::string stream;
  std::vector<std::string> in_the_way;
};

struct ScheduleReport {
  std::string instance;
  std::string source;
  std::uint64_t streams = 0;
  std::uint64_t links = 0;
  std::string verdict;               ///< "scheduled", "infeasible", "undecided"
  std::string how;                   ///< what found the schedule: "first fit", "search"; or the kind of the proof
  std::optional<std::string> proof;  ///< why there is no schedule, in words
  double busiest_link = 0;           ///< share of its time that it is used
  std::optional<double> normalised_latency;   ///< mean over streams: latency over the least on any way
  std::optional<std::uint64_t> waiting;       ///< streams that wait in some bridge
  std::optional<std::uint64_t> gate_entries;  ///< of the longest gate control list
  std::optional<sim::Duration> margin;        ///< clock error that it survives
  std::optional<std::string> no_lists;        ///< why there are no gate control lists
  std::vector<LeftOverReport> left_over;
};

/// One change of a schedule that runs.
struct ChangeReport {
  std::string change;  ///< "add", "remove", "fail"
  std::string name;    ///< of the stream, or of the link that failed
  bool done = false;
  std::vector<std::string> moved;  ///< streams that move
  std::vector<std::string> lost;   ///< streams that have no place any more
};

const json::Record& describe(json::Type<LeftOverReport>);
const json::Record& describe(json::Type<ChangeReport>);
const json::Record& describe(json::Type<ScheduleReport>);

ScheduleReport report(const schedule::Problem& problem, const schedule::Decision& decision,
                      const std::optional<std::string>& no_lists);
/// A few lines for people.
std::string text_of(const ScheduleReport& report);
std::string text_of(const ChangeReport& report);

}  // namespace takt::schedule_instances
