#include "verify/adversary.hpp"

#include <algorithm>
#include <utility>

#include "sim/random.hpp"
#include "verify/critical.hpp"
#include "verify/probe.hpp"
#include "verify/shortened.hpp"

namespace takt::verify {
namespace {

using results::RequirementKind;
using results::RequirementResult;
using scenario::Scenario;
using sim::Duration;

constexpr std::uint64_t cost_of_a_node = 300;    // of building a run, in events
constexpr std::size_t most_in_a_batch = 64;
constexpr std::size_t seeds_at_a_place = 16;

/// What a shorter run says of a requirement counts only if a longer one would say it too.
bool counts_in_a_part(RequirementKind kind) {
  return kind == RequirementKind::reaction || kind == RequirementKind::latency || kind == RequirementKind::jitter || kind == RequirementKind::invariants;
}

class Searcher {
 public:
  Searcher(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options)
      : resolved_(resolved), bounds_(bounds), options_(options), instants_(resolved, free_variables_of(resolved)), chance_(resolved.scenario.seed, "adversary", "search") {
    search_.variables = free_variables_of(resolved);
  }

  Search run() {
    if (!run_as_it_is()) {
      search_.partial = true;
      return std::move(search_);
    }
    shorten();
    for (std::size_t line = 0; line < search_.findings.size() && !search_.partial; ++line) {
      limit_ = spent_ + (options_.events - std::min(options_.events, spent_)) / (search_.findings.size() - line);
      const std::uint64_t before = search_.runs;
      best_.reset();
      look_for(line);
      run_in_full(line);
      search_.findings[line].runs = search_.runs - before;
    }
    return std::move(search_);
  }

 private:
  bool interrupted() const { return options_.interrupted && options_.interrupted(); }
  Choice as_it_is() const { return {resolved_.scenario.seed, std::vector<Duration>(search_.variables.size())}; }

  bool run_as_it_is() {
    std::vector<Scenario> scenarios;
    for (unsigned s = 0; s < std::max(1u, options_.seeds); ++s) {
      Choice choice = as_it_is();
      choice.seed += s;
      scenarios.push_back(scenario_of(resolved_.scenario, search_.variables, choice));
    }
    const auto probes = probe_all(scenarios, bounds_, options_.jobs, options_.interrupted);
    for (std::size_t i = 0; i < probes.size(); ++i) {
      if (!probes[i]) return false;
      ++search_.runs;
      cost_of_run_ = probes[i]->events + cost_of_a_node * resolved_.plan.nodes.size();
      if (i == 0)
        for (const RequirementResult& requirement : probes[i]->requirements) search_.findings.emplace_back().requirement = requirement;
      note(*probes[i], scenarios[i], false, true);
    }
    for (Finding& finding : search_.findings) {
      finding.simulated = finding.longest.measured;
      finding.failed_as_it_is = finding.worst.failed;
    }
    return true;
  }

  void shorten() {
    Duration longest;
    for (const Finding& finding : search_.findings)
      for (const std::optional<Duration>& time : {finding.requirement.limit, finding.simulated})
        if (time && finding.requirement.taken_as == RequirementKind::reaction) longest = std::max(longest, *time * 2);
    shorter_ = shortened(resolved_.scenario, longest);
    is_shorter_ = shorter_.duration != resolved_.scenario.duration;
    if (!is_shorter_) return;
    const std::optional<Probe> once = probe(shorter_, bounds_, options_.interrupted);
    if (once) cost_of_run_ = once->events + cost_of_a_node * resolved_.plan.nodes.size();
  }

  void note(const Probe& probe, const Scenario& scenario, bool is_part, bool is_as_it_is = false) {
    for (const Violation& violation : probe.violations)
      if (std::none_of(search_.violations.begin(), search_.violations.end(), [&](const Violation& known) { return known.assumption == violation.assumption; })) search_.violations.push_back(violation);
    if (!probe.contradiction.empty() && !search_.contradiction) search_.contradiction = Contradiction{probe.contradiction, scenario};
    for (std::size_t i = 0; i < search_.findings.size() && i < probe.requirements.size(); ++i) {
      const RequirementResult& seen = probe.requirements[i];
      Finding& finding = search_.findings[i];
      if (is_part && !counts_in_a_part(seen.taken_as)) continue;
      // How many frames come until the end depends on when the talker begins, and says nothing about the network.
      const bool is_of_latency = seen.kind == RequirementKind::figure && !seen.subject.empty();
      if (!is_as_it_is && (seen.kind == RequirementKind::delivered || (seen.figure && !seen.figure->is_upper && !is_of_latency))) continue;
      // What was not complete at the end might have been so later.
      const bool failed = seen.verdict == results::Verdict::fail && (!is_part || seen.measured || seen.kind == RequirementKind::invariants) &&
                          !(is_part && seen.measured && seen.limit && *seen.measured <= *seen.limit && !is_too_fast(seen));
      Worst made{seen.measured, failed || finding.worst.failed, scenario, seen.figure ? seen.figure->found : std::nullopt};
      if (finding.longest.scenario.name.empty() || seen.measured > finding.longest.measured) finding.longest = made;
      const bool worse = (failed && !finding.worst.failed) || (failed == finding.worst.failed && seen.measured > finding.worst.measured);
      if (!worse && !finding.worst.scenario.name.empty()) continue;
      finding.worst = std::move(made);
    }
  }

  /// A frame came sooner than an exact latency allows, which no later one mends. Of jitter a part shows less than the whole.
  static bool is_too_fast(const RequirementResult& seen) {
    return seen.kind == RequirementKind::latency && seen.least_measured && seen.least_limit && *seen.least_measured < *seen.least_limit;
  }

  /// How bad it is for the requirement; the greater the worse.
  static std::int64_t badness(const Probe& probe, std::size_t line) {
    const RequirementResult& seen = probe.requirements[line];
    if (seen.measured) return seen.measured->ps();
    return seen.verdict == results::Verdict::fail ? 1 : 0;
  }

  bool affordable() {
    if (interrupted()) search_.partial = true;
    return !search_.partial && spent_ + cost_of_run_ <= limit_;
  }

  /// Runs as many of the choices as are affordable; the badness of each that was run.
  std::vector<std::int64_t> try_all(const std::vector<Choice>& choices, std::size_t line) {
    std::vector<std::int64_t> found;
    for (std::size_t from = 0; from < choices.size() && affordable(); ) {
      std::size_t many = std::min(choices.size() - from, most_in_a_batch);
      many = std::min<std::size_t>(many, std::max<std::uint64_t>(1, (limit_ - spent_) / std::max<std::uint64_t>(1, cost_of_run_)));
      std::vector<Scenario> scenarios;
      for (std::size_t i = 0; i < many; ++i) scenarios.push_back(scenario_of(shorter_, search_.variables, choices[from + i]));
      const auto probes = probe_all(scenarios, bounds_, options_.jobs, options_.interrupted);
      for (std::size_t i = 0; i < many; ++i) {
        if (!probes[i]) {  // interrupted
          search_.partial = true;
          return found;
        }
        ++search_.runs;
        spent_ += probes[i]->events + cost_of_a_node * resolved_.plan.nodes.size();
        if (loses_too_much(choices[from + i], *probes[i])) {
          found.push_back(-1);
          continue;
        }
        note(*probes[i], scenarios[i], is_shorter_);
        found.push_back(badness(*probes[i], line));
        if (!best_ || found.back() > best_->first) best_ = {found.back(), choices[from + i]};
      }
      from += many;
      if (options_.progress) options_.progress(spent_, options_.events);
    }
    return found;
  }

  void run_in_full(std::size_t line) {
    const RequirementKind kind = search_.findings[line].requirement.taken_as;
    if (!is_shorter_ || !best_ || search_.partial || (kind != RequirementKind::latency && kind != RequirementKind::jitter)) return;
    const Scenario full = scenario_of(resolved_.scenario, search_.variables, best_->second);
    const std::optional<Probe> seen = probe(full, bounds_, options_.interrupted);
    if (!seen) return;
    ++search_.runs;
    note(*seen, full, false);
  }

  void look_for(std::size_t line) {
    const RequirementResult requirement = search_.findings[line].requirement;
    if (search_.variables.empty()) {
      try_seeds(line);
      return;
    }
    const Choice start = as_it_is();
    // What is likely to be bad comes first, whatever the rest may cost.
    try_all({meeting(requirement, start)}, line);
    if (try_combinations(line, requirement, start)) return;
    climb(line, requirement, start);
    climb(line, requirement, meeting(requirement, start));
    while (affordable()) climb(line, requirement, anywhere());
  }

  void try_seeds(std::size_t line) {
    for (std::uint64_t s = 1; affordable() && s <= 64; ++s) {
      Choice choice = as_it_is();
      choice.seed += s;
      try_all({choice}, line);
    }
  }

  /// All combinations of critical instants, if they are affordable.
  bool try_combinations(std::size_t line, const RequirementResult& requirement, const Choice& start) {
    std::vector<std::vector<Duration>> values;
    const std::uint64_t affordable_runs = (limit_ - std::min(limit_, spent_)) / std::max<std::uint64_t>(1, cost_of_run_);
    std::uint64_t combinations = 1;
    for (std::size_t f = 0; f < search_.variables.size(); ++f) {
      values.push_back(instants_.of(f, requirement, start));
      combinations *= values.back().size();
      if (combinations > affordable_runs) return false;
    }
    std::vector<Choice> all;
    for (std::uint64_t number = 0; number < combinations; ++number) {
      Choice choice = start;
      std::uint64_t rest = number;
      for (std::size_t f = 0; f < values.size(); ++f) {
        choice.values[f] = values[f][rest % values[f].size()];
        rest /= values[f].size();
      }
      all.push_back(std::move(choice));
    }
    const std::vector<std::int64_t> found = try_all(all, line);
    search_.findings[line].exhaustive = found.size() == all.size();
    if (!found.empty()) refine(line, all[static_cast<std::size_t>(std::max_element(found.begin(), found.end()) - found.begin())]);
    return true;
  }

  /// Everybody meets the first of the requirement's streams where they share a port for the first time, and operating systems are as slow as can be.
  Choice meeting(const RequirementResult& requirement, Choice choice) const {
    for (std::size_t f = 0; f < search_.variables.size(); ++f) {
      const std::vector<Duration> values = instants_.of(f, requirement, choice);
      choice.values[f] = search_.variables[f].is_latency() && values.size() > 1 ? slowest(search_.variables[f]) : values.size() > 1 && !is_about_chance(search_.variables[f]) ? values[1] : values[0];
    }
    return choice;
  }

  /// Where no value is likely to be worse than another.
  static bool is_about_chance(const FreeVariable& variable) { return variable.kind == FreeVariable::Kind::losses || variable.kind == FreeVariable::Kind::frequency; }

  /// Frames are lost by choice, and more of them than the scenario's requirements leave room for.
  bool loses_too_much(const Choice& choice, const Probe& probe) const {
    bool loses = false;
    for (std::size_t f = 0; f < search_.variables.size(); ++f) loses = loses || (search_.variables[f].kind == FreeVariable::Kind::losses && choice.values[f] != Duration());
    return loses && std::any_of(probe.requirements.begin(), probe.requirements.end(), [](const RequirementResult& each) {
             const bool is_of_losses = each.kind == RequirementKind::dropped || each.kind == RequirementKind::delivered ||
                                       (each.figure && (each.figure->name == "lost" || each.figure->name == "dropped" || each.figure->name.ends_with("/lost")));
             return is_of_losses && each.verdict == results::Verdict::fail;
           });
  }

  /// A timer is at its worst if it is late after it was early; the ways to the network and from it are at their worst whenever they are slow.
  static Duration slowest(const FreeVariable& latency) { return latency.latency == FreeVariable::Latency::wake_up ? either_end : always_greatest; }

  Choice anywhere() {
    Choice choice = as_it_is();
    choice.seed = resolved_.scenario.seed + chance_.below(1u << 16);
    for (std::size_t f = 0; f < search_.variables.size(); ++f)
      choice.values[f] = Duration::from_ps(static_cast<std::int64_t>(chance_.below(static_cast<std::uint64_t>(search_.variables[f].range.ps()))));
    return choice;
  }

  void climb(std::size_t line, const RequirementResult& requirement, Choice at) {
    std::vector<std::int64_t> here = try_all({at}, line);
    if (here.empty()) return;
    std::int64_t best = here.front();
    for (bool better = true; better && affordable();) {
      better = false;
      for (std::size_t f = 0; f < search_.variables.size() && affordable(); ++f) {
        std::vector<Choice> steps;
        for (const Duration value : instants_.of(f, requirement, at)) {
          if (value == at.values[f]) continue;
          steps.push_back(at);
          steps.back().values[f] = value;
        }
        better = take_best(line, steps, best, at) || better;
      }
    }
    refine(line, at);
  }

  /// Small steps around a place, one variable after the other, halved again and again.
  void refine(std::size_t line, Choice at) {
    std::vector<std::int64_t> here = try_all({at}, line);
    if (here.empty()) return;
    std::int64_t best = here.front();
    for (std::int64_t divisor = 16; divisor <= 4096 && affordable(); divisor *= 4) {
      for (std::size_t f = 0; f < search_.variables.size() && affordable(); ++f) {
        const Duration range = search_.variables[f].range;
        const Duration step = range / divisor;
        if (step == Duration()) continue;
        std::vector<Choice> steps(2, at);
        steps[0].values[f] = Duration::from_ps((at.values[f] + step).ps() % range.ps());
        steps[1].values[f] = Duration::from_ps((at.values[f] + range - step).ps() % range.ps());
        take_best(line, steps, best, at);
      }
    }
    std::vector<Choice> luck(seeds_at_a_place, at);
    for (Choice& choice : luck) choice.seed = resolved_.scenario.seed + chance_.below(1u << 16);
    take_best(line, luck, best, at);
  }

  bool take_best(std::size_t line, const std::vector<Choice>& steps, std::int64_t& best, Choice& at) {
    const std::vector<std::int64_t> found = try_all(steps, line);
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
  CriticalInstants instants_;
  sim::RandomStream chance_;
  Search search_;
  Scenario shorter_;
  bool is_shorter_ = false;
  std::optional<std::pair<std::int64_t, Choice>> best_;   // of the search for the present requirement
  std::uint64_t cost_of_run_ = 1;
  std::uint64_t spent_ = 0;      // events of the search
  std::uint64_t limit_ = 0;      // for the present requirement
};

}  // namespace

Search search(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options) { return Searcher(resolved, bounds, options).run(); }

}  // namespace takt::verify
