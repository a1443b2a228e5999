// SPDX-License-Identifier: Apache-2.0
// Adversarial search: the worst run that the scenario allows, for each of its requirements.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "results/run_result.hpp"
#include "verify/budget.hpp"
#include "verify/found_run.hpp"
#include "verify/free_variable.hpp"
#include "verify/monitor.hpp"

namespace takt::verify {

inline constexpr std::uint64_t default_events = 12'000'000;  // a few seconds at most on any shipped scenario

struct SearchOptions {
  unsigned seeds =
      4;              ///< runs of the scenario as it is, with this seed and those after it; two where chance has no say
  unsigned jobs = 1;  ///< threads; the result does not depend on it
  std::uint64_t events =
      default_events;            ///< what all may cost, in events of runs, besides one run of the scenario as it is
  std::vector<bool> asked = {};  ///< which findings are searched for, in their order; all if empty
  std::function<bool()> interrupted;  ///< asked between runs and within them, and within analyses
  std::function<void(std::uint64_t events, std::uint64_t of)> progress;  ///< told between runs
};

/// The worst run for a requirement.
struct Worst {
  std::optional<sim::Duration> measured;  ///< of requirements about times
  bool failed = false;
  FoundRun run = {};                  ///< a file of its scenario replays it
  std::optional<double> figure = {};  ///< of requirements about figures
};

/// Why no further run was made for a requirement.
enum class Ended : std::uint8_t {
  bound_reached,  ///< none can be worse
  all_meetings,   ///< all phases at which another frame meets another one were run
  all_instants,   ///< all combinations of the critical instants that are known were run
  no_worse,       ///< from several beginnings nothing worse was found
  as_it_is,       ///< only runs of the scenario as it is say anything of it
  nothing_free,   ///< all runs are the same
  budget,         ///< nothing was left
  interrupted,
};
/// "the worst found reaches the bound".
const char* words_of(Ended ended);
/// "bound_reached".
const char* name_of(Ended ended);

/// What was found for one requirement, in the order of RunResult::requirements.
struct Finding {
  results::RequirementResult requirement;  ///< text, kind and limit; of the scenario as it is
  std::optional<sim::Duration> simulated;  ///< worst of the runs of the scenario as it is
  bool failed_as_it_is = false;
  Worst worst;    ///< of all runs; one that fails is worse than any that does not
  Worst longest;  ///< that with the greatest measured, which need not be the one that fails: that may have lost a frame
                  ///< instead
  std::uint64_t runs = 0;            ///< of the search for this requirement
  Ended ended = Ended::interrupted;  ///< what ended the search
  /// No run is worse: all that the scenario leaves open are phases of periodic talkers, its ports send the highest
  /// class first and nothing else, and all meetings were run; or there is one run only.
  bool exhaustive = false;
  std::uint64_t broken = 0;  ///< of a Program's invariants: the most violations in a run
};

/// A run above a bound whose assumptions all hold: a mistake of takt.
struct Contradiction {
  std::string text;
  scenario::Scenario run;  ///< a file of it replays the run
};

struct Search {
  std::vector<FreeVariable> variables;
  std::vector<Finding> findings;
  std::uint64_t runs = 0;                           ///< in all
  std::uint64_t cost_of_run = 0;                    ///< in events: of one in full length
  std::vector<Violation> violations;                ///< the first of each assumption
  std::optional<Contradiction> contradiction = {};  ///< the first
  bool partial = false;                             ///< interrupted
};

/// First the scenario as it is, with several seeds; then runs for each requirement in turn, with a share of the budget
/// that is greater if it is not proved, until one of the reasons above ends them. Each run
/// counts for all requirements. Streams alone: from the worst run so far on, phases at which a frame meets another one
/// as it comes or starts there, with all that it has waited, until there are none
/// that have not been run. Otherwise combinations of critical instants: all of them if they are few, else uphill one
/// variable after the other, from chains in which each participant publishes just before it hears,
/// from the scenario as it is, from where all meet, and from random places. Where waiting may be left out
/// (shortened.hpp), it is; the worst choice for a latency or jitter is then
/// run in full length, since chance has its say in every frame.
Search search(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options,
              Budget& budget);
/// With a budget of its own, that of the options.
Search search(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options);

}  // namespace takt::verify
