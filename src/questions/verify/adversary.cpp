// SPDX-License-Identifier: Apache-2.0
#include "verify/adversary.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "sim/random.hpp"
#include "verify/critical.hpp"
#include "verify/meetings.hpp"
#include "verify/trials.hpp"

namespace takt::verify {
namespace {

using results::RequirementKind;
using results::RequirementResult;
using sim::Duration;

constexpr std::size_t seeds_at_a_place = 16;
constexpr std::uint64_t most_seeds = 64;
constexpr std::uint64_t most_anywhere = 16;
constexpr std::uint64_t seeds_of_a_chain = 5;
constexpr std::uint64_t most_combinations = 4096;
/// A climb comes by each variable so often, if it can.
constexpr std::uint64_t rounds_of_a_climb = 3;
constexpr std::uint64_t fewest_values = 6;
/// Where not even so many runs are affordable, the first ones count most.
constexpr std::size_t most_guesses = 64;

/// The budget of the search, as a part of all: the rest is for replays and for what would help.
constexpr std::uint64_t of_all(std::uint64_t events) { return events / 4 * 3; }

/// What a requirement that might be refuted gets, beside one that is proved, and one that phases have little to do
/// with.
constexpr std::uint64_t weight_of(bool is_proved, RequirementKind kind) {
  return is_proved || kind == RequirementKind::sync ? 1 : 4;
}

class Searcher {
 public:
  Searcher(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options,
           Budget& budget)
      : resolved_(resolved),
        bounds_(bounds),
        options_(options),
        budget_(budget),
        trials_(resolved, bounds, options, budget),
        instants_(resolved, trials_.ground().variables),
        chance_(resolved.scenario.seed, "adversary", "search") {
    trials_.search().variables = trials_.ground().variables;
    is_of_phases_ = is_network_of_phases(resolved, variables());
  }

  Search run() {
    if (trials_.run_baseline()) {
      trials_.shorten();
      look_for_all();
    }
    trials_.search().partial = trials_.is_interrupted();
    return std::move(trials_.search());
  }

 private:
  const std::vector<FreeVariable>& variables() const { return trials_.ground().variables; }

  void look_for_all() {
    std::vector<Finding>& findings = trials_.search().findings;
    std::uint64_t weights = 0;
    const auto is_asked = [&](std::size_t line) { return options_.asked.empty() || options_.asked[line]; };
    for (std::size_t line = 0; line < findings.size(); ++line)
      if (is_asked(line)) weights += weight_of(trials_.is_proved(line), findings[line].requirement.kind);
    for (std::size_t line = 0; line < findings.size() && !trials_.is_interrupted(); ++line) {
      if (!is_asked(line)) continue;
      const std::uint64_t weight = weight_of(trials_.is_proved(line), findings[line].requirement.kind);
      const std::uint64_t all = of_all(budget_.events());
      trials_.begin(line, (all - std::min(all, budget_.spent())) / weights * weight);
      weights -= weight;
      const std::uint64_t before = trials_.search().runs;
      const Ended ended = look_for();
      trials_.run_in_full();
      Finding& finding = findings[line];
      finding.runs = trials_.search().runs - before;
      finding.ended = trials_.is_interrupted() ? Ended::interrupted
                      : trials_.is_at_bound()  ? Ended::bound_reached
                                               : ended;
      finding.exhaustive = finding.ended == Ended::nothing_free ||
                           (finding.ended == Ended::all_meetings && !is_of_misses(finding.requirement.kind) &&
                            shows_all_meetings(resolved_, bounds_));
    }
  }

  Ended look_for() {
    const RequirementResult requirement = trials_.requirement();
    if (is_judged_as_it_is(requirement)) return Ended::as_it_is;
    if (variables().empty()) return try_seeds();
    const Choice start = trials_.as_it_is();
    // What is likely to be bad comes first, whatever the rest may cost.
    std::vector<Choice> guesses = guesses_for(requirement, start);
    if (is_of_phases_)
      return run_meetings(trials_, instants_, resolved_, guesses) ? Ended::all_meetings : Ended::budget;
    const std::vector<std::int64_t> found = trials_.try_all(guesses);
    if (!has_time(requirement)) return try_anywhere();
    if (try_combinations(requirement, start)) return Ended::all_instants;
    if (found.empty()) return Ended::budget;
    const auto worst = std::max_element(found.begin(), found.end());
    climb(requirement, guesses[static_cast<std::size_t>(worst - found.begin())]);
    if (!trials_.is_affordable()) return Ended::budget;
    const std::size_t patience = trials_.is_proved(trials_.line()) ? 1 : 3;
    std::size_t fruitless = 0;
    for (std::size_t number = 0; fruitless < patience && trials_.is_affordable(); ++number) {
      const std::int64_t best = trials_.best()->first;
      climb(requirement, number < guesses.size() ? guesses[number] : anywhere());
      fruitless = trials_.best()->first > best ? 0 : fruitless + 1;
    }
    return fruitless < patience ? Ended::budget : Ended::no_worse;
  }
  /// How many frames come until the end depends on when talkers begin, and says nothing about the network.
  static bool is_judged_as_it_is(const RequirementResult& requirement) {
    return requirement.kind == RequirementKind::delivered ||
           (requirement.figure && !requirement.figure->is_upper && requirement.subject.empty() &&
            !is_of_misses(requirement.kind));
  }
  /// Of one that has none there is no uphill.
  static bool has_time(const RequirementResult& requirement) {
    return requirement.limit.has_value() || is_of_misses(requirement.kind);
  }

  Ended try_anywhere() {
    std::vector<Choice> choices;
    for (std::uint64_t number = 0; number < most_anywhere; ++number) choices.push_back(anywhere());
    return trials_.try_all(choices).size() == choices.size() ? Ended::no_worse : Ended::budget;
  }

  Ended try_seeds() {
    if (trials_.is_without_chance()) return Ended::nothing_free;
    for (std::uint64_t s = 1; trials_.is_affordable() && s <= most_seeds; ++s) {
      Choice choice = trials_.as_it_is();
      choice.seed += s;
      trials_.try_all({choice});
    }
    return trials_.is_affordable() ? Ended::no_worse : Ended::budget;
  }

  /// The scenario as it is, all meeting each other, and of reactions each chain.
  std::vector<Choice> guesses_for(const RequirementResult& requirement, const Choice& start) const {
    const Choice together = meeting(requirement, start);
    std::vector<Choice> guesses;
    if (requirement.taken_as == RequirementKind::reaction) add_chains(requirement, together, guesses);
    guesses.push_back(together);
    guesses.push_back(start);
    return guesses;
  }

  /// Of each Program that the requirement may be about, and each participant that the change may begin with: that one's
  /// word first, all others hear it just after they have published.
  void add_chains(const RequirementResult& requirement, const Choice& together, std::vector<Choice>& guesses) const {
    for (std::size_t p = 0; p < resolved_.programs.size(); ++p) {
      const scenario::ResolvedProgram& program = resolved_.programs[p];
      if (program.has_roles() || (!requirement.subject.empty() && program.name != requirement.subject)) continue;
      std::set<std::size_t> firsts{0};
      for (const scenario::ScriptEntry& entry : resolved_.scenario.script)
        for (std::size_t k = 0; k < program.participant_names.size(); ++k)
          if (entry.call && entry.on == program.participant_names[k] &&
              (!entry.program || program.name == *entry.program))
            firsts.insert(k);
      for (const std::size_t first : firsts) {
        Choice guess = together;
        instants_.put_publications_before_words(p, first, guess);
        instants_.put_calls_behind_publications(requirement, guess, true);
        guesses.push_back(guess);
        if (trials_.is_without_chance()) continue;
        // A timer that was quick before it is late: chance decides, so several times.
        instants_.put_calls_behind_publications(requirement, guess, false);
        for (std::uint64_t s = 0; s < seeds_of_a_chain; ++s, ++guess.seed) guesses.push_back(guess);
        if (guesses.size() >= most_guesses) return;
      }
    }
  }

  /// All combinations of critical instants, if they are affordable.
  bool try_combinations(const RequirementResult& requirement, const Choice& start) {
    const std::vector<std::size_t> free = instants_.variables_for(requirement);
    std::vector<std::vector<Duration>> values;
    std::uint64_t combinations = 1;
    for (const std::size_t f : free) {
      values.push_back(instants_.of(f, requirement, start));
      combinations *= values.back().size();
      if (combinations > std::min(most_combinations, trials_.affordable_runs())) return false;
    }
    std::vector<Choice> all;
    for (std::uint64_t number = 0; number < combinations; ++number) {
      Choice choice = start;
      std::uint64_t rest = number;
      for (std::size_t i = 0; i < free.size(); ++i) {
        choice.values[free[i]] = values[i][rest % values[i].size()];
        rest /= values[i].size();
      }
      all.push_back(std::move(choice));
    }
    const std::vector<std::int64_t> found = trials_.try_all(all);
    if (!found.empty())
      refine(all[static_cast<std::size_t>(std::max_element(found.begin(), found.end()) - found.begin())], free);
    return found.size() == all.size();
  }

  /// Everybody meets the first of the requirement's streams where they share a port for the first time, and operating
  /// systems are as slow as can be.
  Choice meeting(const RequirementResult& requirement, Choice choice) const {
    for (const std::size_t f : instants_.variables_for(requirement)) {
      const std::vector<Duration> values = instants_.of(f, requirement, choice);
      choice.values[f] = variables()[f].is_latency() && values.size() > 1        ? slowest(variables()[f])
                         : values.size() > 1 && !is_about_chance(variables()[f]) ? values[1]
                                                                                 : values[0];
    }
    return choice;
  }

  /// Where no value is likely to be worse than another.
  static bool is_about_chance(const FreeVariable& variable) {
    return variable.kind == FreeVariable::Kind::losses || variable.kind == FreeVariable::Kind::frequency;
  }

  /// A timer is at its worst if it is late after it was early; the ways to the network and from it are at their worst
  /// whenever they are slow.
  static Duration slowest(const FreeVariable& latency) {
    return latency.latency == FreeVariable::Latency::wake_up ? either_end : always_greatest;
  }

  Choice anywhere() {
    Choice choice = trials_.as_it_is();
    choice.seed = resolved_.scenario.seed + chance_.below(1u << 16);
    for (std::size_t f = 0; f < variables().size(); ++f)
      choice.values[f] = Duration::from_ps(
          static_cast<std::int64_t>(chance_.below(static_cast<std::uint64_t>(variables()[f].range.ps()))));
    return choice;
  }

  void climb(const RequirementResult& requirement, Choice at) {
    const std::vector<std::int64_t> here = trials_.try_all({at});
    if (here.empty()) return;
    std::int64_t best = here.front();
    const std::vector<std::size_t> free = instants_.variables_for(requirement);
    const bool is_of_frames =
        requirement.taken_as == RequirementKind::latency || requirement.taken_as == RequirementKind::jitter;
    for (bool better = true; better && trials_.is_affordable();) {
      better = false;
      std::vector<MeetingLog::Visit> met;
      if (is_of_frames) met = trials_.meetings_of(at).value_or(std::vector<MeetingLog::Visit>());
      const std::uint64_t of_each = std::max(
          fewest_values, trials_.affordable_runs() / (rounds_of_a_climb * std::max<std::size_t>(1, free.size())));
      for (const std::size_t f : free) {
        if (!trials_.is_affordable()) break;
        std::vector<Choice> steps;
        for (const Duration value : instants_.of(f, requirement, at, met, of_each)) {
          if (value == at.values[f]) continue;
          steps.push_back(at);
          steps.back().values[f] = value;
          // The calls go with the publications that they have just missed.
          if (requirement.taken_as == RequirementKind::reaction && variables()[f].kind == FreeVariable::Kind::publisher)
            instants_.put_calls_behind_publications(requirement, steps.back(), true);
        }
        better = accept_best(steps, best, at) || better;
      }
    }
    refine(at, free);
  }

  /// Small steps around a place, one variable after the other, halved again and again.
  void refine(Choice at, const std::vector<std::size_t>& free) {
    const std::vector<std::int64_t> here = trials_.try_all({at});
    if (here.empty()) return;
    std::int64_t best = here.front();
    for (std::int64_t divisor = 16; divisor <= 4096 && trials_.is_affordable(); divisor *= 4) {
      for (const std::size_t f : free) {
        if (!trials_.is_affordable()) break;
        const Duration range = variables()[f].range;
        const Duration step = range / divisor;
        if (step == Duration()) continue;
        std::vector<Choice> steps(2, at);
        steps[0].values[f] = Duration::from_ps((at.values[f] + step).ps() % range.ps());
        steps[1].values[f] = Duration::from_ps((at.values[f] + range - step).ps() % range.ps());
        accept_best(steps, best, at);
      }
    }
    if (trials_.is_without_chance()) return;
    std::vector<Choice> reseeded(seeds_at_a_place, at);
    for (Choice& choice : reseeded) choice.seed = resolved_.scenario.seed + chance_.below(1u << 16);
    accept_best(reseeded, best, at);
  }

  bool accept_best(const std::vector<Choice>& steps, std::int64_t& best, Choice& at) {
    const std::vector<std::int64_t> found = trials_.try_all(steps);
    if (found.empty()) return false;
    const auto greatest = std::max_element(found.begin(), found.end());
    if (*greatest <= best) return false;
    best = *greatest;
    at = steps[static_cast<std::size_t>(greatest - found.begin())];
    return true;
  }

  const scenario::Resolved& resolved_;
  const analysis::Bounds& bounds_;
  const SearchOptions& options_;
  Budget& budget_;
  Trials trials_;
  CriticalInstants instants_;
  sim::RandomStream chance_;
  bool is_of_phases_ = false;
};

struct Naming {
  const char* name;
  const char* words;
};
constexpr Naming endings[] = {
    {"bound_reached", "the worst found reaches the bound"},
    {"all_meetings", "all meetings of frames were run"},
    {"all_instants", "all combinations of critical instants were run"},
    {"no_worse", "from several beginnings nothing worse was found"},
    {"as_it_is", "only the scenario as it is says anything of it"},
    {"nothing_free", "nothing is free: all runs are the same"},
    {"budget", "the budget was spent"},
    {"interrupted", "it was interrupted"},
};

}  // namespace

const char* words_of(Ended ended) { return endings[static_cast<std::size_t>(ended)].words; }
const char* name_of(Ended ended) { return endings[static_cast<std::size_t>(ended)].name; }

Search search(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options,
              Budget& budget) {
  return Searcher(resolved, bounds, options, budget).run();
}

Search search(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options) {
  Budget budget(options.events, options.interrupted);
  return search(resolved, bounds, options, budget);
}

}  // namespace takt::verify
