// SPDX-License-Identifier: Apache-2.0
// A point that is not run but scheduled: streams that are drawn on the network of the scenario, and what the search of
// takt schedule says of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json/fields.hpp"
#include "scenario/resolved/resolved.hpp"
#include "schedule/decide.hpp"

namespace takt::study {

/// From one host to another, each with a period, a payload and a latency out of the lists. Those of a seed are the
/// first of an endless list: fewer are the same ones.
struct DrawnStreams {
  json::Source where;
  std::uint32_t count = 10;
  std::vector<sim::Duration> every = {sim::Duration::from_ps(1'000'000'000)};
  std::vector<sim::Octets> payload = {sim::Octets{100}};
  std::vector<sim::Duration> latency;  ///< empty: as long as it takes
  bool operator==(const DrawnStreams&) const = default;
};

enum class SearchedRoutes : std::uint8_t { shortest, search };

struct Scheduling {
  json::Source where;
  DrawnStreams streams;
  SearchedRoutes routes = SearchedRoutes::search;
  bool waiting = false;         ///< frames may wait in bridges
  sim::Duration margin;         ///< that clocks of two nodes differ by at most
  std::uint32_t attempts = 32;  ///< of the search, before it is undecided
  bool operator==(const Scheduling&) const = default;
};

/// The part of a study file that factors find under /schedule.
struct SchedulingPart {
  json::Source where;
  Scheduling schedule;
  bool operator==(const SchedulingPart&) const = default;
};

const json::Object& describe(json::Type<SchedulingPart>);
const json::Object& describe(json::Type<DrawnStreams>);
const json::Enumeration& describe(json::Type<SearchedRoutes>);
const json::Object& describe(json::Type<Scheduling>);

/// The figures that measures can be of, each with what it is.
struct SchedulingFigure {
  std::string_view name;
  std::string_view help;
};
std::vector<SchedulingFigure> scheduling_figures();

/// Reports what a study of schedules cannot have: streams and Programs of its own, hosts that are too few.
void check_scheduling(const scenario::Resolved& resolved, const Scheduling& wanted, json::Diagnostics& diagnostics);

/// The network of the scenario, and the streams of that seed.
schedule::Problem drawn_problem(const scenario::Resolved& resolved, const Scheduling& wanted, std::uint64_t seed);

/// What became of it, judged.
struct Scheduled {
  std::string verdict;       ///< "scheduled", "infeasible", "undecided"
  std::uint64_t digest = 0;  ///< of verdict and schedule
  std::uint64_t steps = 0;   ///< of the search: streams placed or placed again
  json::Node figures;        ///< by the names of scheduling_figures()
};
/// The same for any number of threads. CHECKs that what it says is right: a schedule by its definition, a proof by its
/// numbers.
Scheduled schedule_point(const schedule::Problem& problem, const Scheduling& wanted, std::uint64_t seed,
                         unsigned threads);

}  // namespace takt::study
