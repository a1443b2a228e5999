// Adversarial search: the worst run that the scenario allows, for each of its requirements.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "results/run_result.hpp"
#include "verify/free_variable.hpp"
#include "verify/monitor.hpp"

namespace takt::verify {

struct SearchOptions {
  unsigned seeds = 4;                       ///< runs of the scenario as it is, with this seed and those after it
  unsigned jobs = 1;                        ///< threads; the result does not depend on it
  std::uint64_t events = 60'000'000;        ///< what the search may cost, in events of runs, besides those of the scenario as it is
  std::function<bool()> interrupted;        ///< asked between runs, and within long ones
  std::function<void(std::uint64_t events, std::uint64_t of)> progress;   ///< told between runs
};

/// The worst run for a requirement.
struct Worst {
  std::optional<sim::Duration> measured;    ///< of requirements about times
  bool failed = false;
  scenario::Scenario scenario;              ///< a file of it replays the run
  std::optional<double> figure = {};        ///< of requirements about figures
};

/// What was found for one requirement, in the order of RunResult::requirements.
struct Finding {
  results::RequirementResult requirement;   ///< text, kind and limit; of the scenario as it is
  std::optional<sim::Duration> simulated;   ///< worst of the runs of the scenario as it is
  bool failed_as_it_is = false;
  Worst worst;                              ///< of all runs; one that fails is worse than any that does not
  Worst longest;                            ///< that with the greatest measured, which need not be the one that fails: that may have lost a frame instead
  std::uint64_t runs = 0;                   ///< of the search for this requirement
  bool exhaustive = false;                  ///< all combinations of critical instants were run
};

/// A run above a bound whose assumptions all hold: a mistake of takt.
struct Contradiction {
  std::string text;
  scenario::Scenario run;                   ///< a file of it replays the run
};

struct Search {
  std::vector<FreeVariable> variables;
  std::vector<Finding> findings;
  std::uint64_t runs = 0;                   ///< in all
  std::vector<Violation> violations;        ///< the first of each assumption
  std::optional<Contradiction> contradiction = {};   ///< the first
  bool partial = false;                     ///< interrupted
};

/// First the scenario as it is, with several seeds; then, for each requirement in turn, combinations of critical instants: all of them if they
/// are few, otherwise uphill one variable after the other, from the scenario as it is, from where all meet, and from random places. Each
/// run counts for all requirements. Where waiting may be left out (shortened.hpp), it is; the worst choice for a latency or jitter is then
/// run in full length, since chance has its say in every frame.
Search search(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options);

}  // namespace takt::verify
