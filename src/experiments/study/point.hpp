// SPDX-License-Identifier: Apache-2.0
// One point of a study: a variant with a seed, run once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/plan.hpp"

namespace takt::study {

/// How a point ended.
enum class Status : std::uint8_t {
  done,        ///< the run came to its end
  impossible,  ///< the variant is no sound scenario
  too_long,    ///< it took more CPU time than a point may
  too_large,   ///< it took more memory than a point may
  failed,      ///< takt itself is wrong there: an invariant broke, or the process died
};
/// "done", "impossible", "too-long", "too-large", "failed".
std::string_view name_of(Status status);
std::optional<Status> status_named(std::string_view name);

struct Outcome {
  Status status = Status::done;
  std::string error;    ///< why it is not done
  bool passes = false;  ///< it is done and keeps every limit
  std::string verdict;  ///< of the scenario's own requirements, of a study that verifies: pass, refuted, undecided; of
                        ///< schedules: scheduled, infeasible, undecided
  std::uint64_t digest = 0;
  std::uint64_t events = 0;
  std::uint64_t cpu_us = 0;                   ///< differs from run to run, as nothing else here does
  std::vector<std::optional<double>> values;  ///< by measure, in its unit
};

/// Builds, runs and measures a point in this process: on `threads` threads where that is faster; all but the time is
/// the same for any number.
Outcome run_point(const Plan& plan, std::uint64_t point, unsigned threads = 1);
/// The same for any variant and seed.
Outcome run_variant(const Plan& plan, const Variant& variant, std::uint64_t seed, unsigned threads = 1);
/// The same for a scenario that somebody else has made, without verification: measures worst.X and bound.X have the
/// value of X in the run, and verdict is that of the run.
Outcome run_scenario(const Plan& plan, const scenario::Scenario& scenario, unsigned threads = 1);

/// The mistakes of a variant, one a line; empty if it is a sound scenario.
std::string mistakes_of(const Plan& plan, std::size_t variant);

/// A line of bytes and back, for another process. Nothing if it is not one.
std::string packed(const Outcome& outcome);
std::optional<Outcome> unpacked(std::string_view text);

}  // namespace takt::study
