// SPDX-License-Identifier: Apache-2.0
// A study that has been read and checked: its factors with their levels, its variants, its measures.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "json/document.hpp"
#include "json/override.hpp"
#include "scenario/description/description.hpp"
#include "study/description.hpp"
#include "study/measure.hpp"

namespace takt::study {

/// One value of a factor.
struct Level {
  std::string text;                             ///< as the study spells it
  std::optional<double> number;                 ///< in PlannedFactor::unit, if it is one
  std::vector<json::Replacement> replacements;  ///< what it changes in the scenario
};

struct PlannedFactor {
  std::string name;
  std::string unit;             ///< of the numbers: "s", "bps" ... or ""
  bool is_logarithmic = false;  ///< its range said so
  std::vector<Level> levels;
  std::size_t baseline = 0;
};

/// A combination of levels: for each factor the index of its level.
using Variant = std::vector<std::uint32_t>;

/// What bounds a study. More is a diagnostic.
constexpr std::uint64_t most_variants = 1'000'000;
constexpr std::uint64_t most_points = 10'000'000;

struct Plan {
  Study study;
  json::Document base;  ///< the scenario before anything is varied
  std::vector<PlannedFactor> factors;
  std::vector<PlannedMeasure> measures;
  std::vector<PlannedLimit> limits;
  std::vector<Variant> variants;
  std::string text;          ///< study and base as one line of JSON: what the configuration digest is of
  std::uint64_t digest = 0;  ///< of the configuration: two stores belong together if theirs are equal

  bool draws_phases = true;  ///< talkers and publishers whose phase nobody gives get one by the seed; else they begin
                             ///< at 0, as takt run has it

  /// Some measure is of the verification of the variant.
  bool is_verified() const {
    return std::any_of(measures.begin(), measures.end(), [](const PlannedMeasure& m) { return m.basis != Basis::run; });
  }
  std::uint64_t points() const { return variants.size() * study.replications.count; }
  std::size_t variant_of(std::uint64_t point) const { return point / study.replications.count; }
  std::uint32_t replication_of(std::uint64_t point) const {
    return static_cast<std::uint32_t>(point % study.replications.count);
  }
  std::uint64_t seed_of(std::uint64_t point) const { return study.replications.first_seed + replication_of(point); }
  const Level& level_of(const Variant& variant, std::size_t factor) const {
    return factors[factor].levels[variant[factor]];
  }
};

/// Reads and expands a study file. Everything but the variants' own soundness (point.hpp) is checked; null after an
/// error.
std::unique_ptr<Plan> load_plan(const std::string& path, json::Diagnostics& diagnostics);

/// Reports names in measures (of streams, Programs ...) from the given one on that nothing has: an error if no variant
/// at all has them, a warning if only so many variants were looked at that together have every level.
void check_names_of_measures(const Plan& plan, std::size_t first, json::Diagnostics& diagnostics);

/// "slaves = 3, cycle = 200us"
std::string name_of(const Plan& plan, const Variant& variant);

/// Reports all that is wrong with a variant, as `takt check` does with its scenario.
void check_variant(const Plan& plan, const Variant& variant, json::Diagnostics& diagnostics);

/// What a study of schedules asks of a variant. Nothing after an error.
std::optional<Scheduling> scheduling_of(const Plan& plan, const Variant& variant, json::Diagnostics& diagnostics);

/// The scenario of a variant with a seed, still to be resolved; with `draws_phases`, with a phase for each talker and
/// publisher. Nothing after an error.
std::optional<scenario::Scenario> scenario_of(const Plan& plan, const Variant& variant, std::uint64_t seed,
                                              json::Diagnostics& diagnostics);

/// The same as the study has it, without phases that are drawn: the one that is verified, for all phases.
std::optional<scenario::Scenario> undrawn_scenario_of(const Plan& plan, const Variant& variant, std::uint64_t seed,
                                                      json::Diagnostics& diagnostics);

}  // namespace takt::study
