// SPDX-License-Identifier: Apache-2.0
// Is B better than A, and by how much? Both run with the same seeds, and the differences are judged pair by pair.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/behaviour.hpp"
#include "study/divergence.hpp"
#include "study/plan.hpp"
#include "study/runner.hpp"
#include "study/statistics.hpp"

namespace takt::study {

struct ComparedMeasure {
  std::string name;
  std::string unit;
  Summary a;
  Summary b;
  Summary difference;          ///< b - a of each pair in which both have the figure
  std::uint32_t unpaired = 0;  ///< pairs of which one has it and the other has not
};

struct Comparison {
  std::uint32_t behaviour = results::behaviour();  ///< of the takt that ran both
  std::string a;                                   ///< the files, and what was set in them
  std::string b;
  std::uint32_t pairs = 0;
  std::uint32_t same_digest = 0;          ///< pairs that are the same run
  std::vector<ComparedMeasure> measures;  ///< those that any run has
  std::vector<std::string> troubles;
  std::optional<Divergence> divergence;  ///< of the first seed whose runs differ
  bool interrupted = false;
  std::string problem;
};

/// A plan of one scenario without factors, and the measures that are compared unless others are named: reactions,
/// latencies, losses, violations, synchronisation, use of links.
Plan plain_plan(json::Document base, std::uint32_t replications, std::uint64_t first_seed);

/// Both plans have the same measures, replications and seeds.
Comparison compare(const Plan& a, const Plan& b, const RunOptions& options);

std::string text_of(const Comparison& comparison);

// What `takt compare --format json` holds.
const json::Record& describe(json::Type<Comparison>);
const json::Record& describe(json::Type<ComparedMeasure>);
const json::Record& describe(json::Type<Divergence>);
const json::Record& describe(json::Type<Summary>);

}  // namespace takt::study
