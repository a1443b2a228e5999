// SPDX-License-Identifier: Apache-2.0
#include "verify/trials.hpp"

#include <algorithm>

#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "verify/shortened.hpp"

namespace takt::verify {

using results::RequirementKind;
using results::RequirementResult;
using scenario::Scenario;
using sim::Duration;

namespace {

constexpr std::size_t most_in_a_batch = 64;
constexpr std::size_t most_visits = 100'000;
/// Frames that come so shortly before or after each other, all together, keep a run from the bound.
constexpr Duration next_to_nothing = Duration::from_ps(5'000);

/// What a shorter run says of a requirement counts only if a longer one would say it too.
bool counts_in_a_part(RequirementKind kind) {
  return kind == RequirementKind::reaction || kind == RequirementKind::latency || kind == RequirementKind::jitter ||
         kind == RequirementKind::invariants || is_of_misses(kind);
}

/// A frame came sooner than an exact latency allows, which no later one mends. Of jitter a part shows less than the
/// whole.
bool is_too_fast(const RequirementResult& seen) {
  return seen.kind == RequirementKind::latency && seen.least_measured && seen.least_limit &&
         *seen.least_measured < *seen.least_limit;
}

}  // namespace

Trials::Trials(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options,
               Budget& budget)
    : resolved_(resolved),
      bounds_(bounds),
      options_(options),
      budget_(budget),
      ground_(std::make_shared<Ground>(Ground{resolved.scenario, {}, free_variables_of(resolved)})) {}

bool Trials::run_baseline() {
  if (!run_seeds(0, 1)) return false;
  // What has rare causes may differ for the first time with a later seed; all else that chance decides differs at once.
  const bool may_be_rare = !resolved_.plan.impairments.empty();
  bool goes_on = options_.seeds < 2 || run_seeds(1, 1);
  is_without_chance_ = goes_on && search_.runs > 1 && digests_differ_ == 0 && !may_be_rare;
  for (unsigned from = 2; goes_on && !is_without_chance_ && from < options_.seeds; from += most_in_a_batch)
    goes_on = run_seeds(from, std::min<unsigned>(options_.seeds - from, most_in_a_batch));
  for (Finding& finding : search_.findings) {
    finding.simulated = finding.longest.measured;
    finding.failed_as_it_is = finding.worst.failed;
  }
  return !search_.partial;
}

/// Runs of the scenario as it is, with so many seeds from that one on. False if no more shall be made: there is no
/// budget for it, or it was interrupted.
bool Trials::run_seeds(unsigned from, unsigned many) {
  std::vector<FoundRun> runs;
  for (unsigned s = 0; s < many && (from == 0 || budget_.spent() + (s + 1) * cost_of_run_ <= budget_.events() / 4);
       ++s) {
    Choice choice = as_it_is();
    choice.seed += from + s;
    runs.push_back(run_of(choice));
  }
  const auto probes = probe_all(runs, bounds_, options_.jobs, budget_.interrupted());
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!probes[i]) {
      search_.partial = true;
      return false;
    }
    ++search_.runs;
    cost_of_run_ = cost_of_run(resolved_, probes[i]->events);
    if (!as_it_is_) {
      as_it_is_ = probes[i];
      search_.cost_of_run = cost_of_run_;
      for (const RequirementResult& requirement : probes[i]->requirements)
        search_.findings.emplace_back().requirement = requirement;
    } else {
      budget_.spend(cost_of_run_);
      digests_differ_ += as_it_is_->digest != probes[i]->digest;
    }
    note(*probes[i], runs[i], true);
  }
  return runs.size() == many;
}

/// Nothing else happened in it: the same reactions, none of them cut short, and frames no faster.
bool Trials::shows_the_same(const Probe& part) const {
  if (part.reactions != as_it_is_->reactions) return false;
  if (!resolved_.programs.empty()) return true;
  for (std::size_t i = 0; i < part.requirements.size(); ++i) {
    const RequirementResult& seen = part.requirements[i];
    if (counts_in_a_part(seen.taken_as) && seen.measured != as_it_is_->requirements[i].measured) return false;
  }
  return true;
}

bool Trials::adopt_shorter(Scenario shorter) {
  if (shorter.duration >= resolved_.scenario.duration) return true;  // then it stays as it is
  ground_->shorter = std::move(shorter);
  const std::optional<Probe> once = probe(ground_->shorter, bounds_, budget_.interrupted());
  if (!once) return true;
  budget_.spend(cost_of_run(resolved_, once->events));
  if (!shows_the_same(*once)) return false;
  is_shorter_ = true;
  cost_of_run_ = cost_of_run(resolved_, once->events);
  return true;
}

void Trials::shorten() {
  Duration simulated;
  Duration allowed;
  for (const Finding& finding : search_.findings) {
    if (finding.requirement.taken_as != RequirementKind::reaction) continue;
    simulated = std::max(simulated, finding.simulated.value_or(Duration()) * 2);
    allowed = std::max({allowed, simulated, finding.requirement.limit.value_or(Duration()) * 2});
  }
  if (adopt_shorter(shortened(resolved_.scenario, simulated, Pauses::brief))) return;
  adopt_shorter(shortened(resolved_.scenario, allowed, Pauses::ample));
}

void Trials::begin(std::size_t line, std::uint64_t events) {
  line_ = line;
  limit_ = budget_.spent() + events;
  best_.reset();
}

const analysis::RequirementBound* Trials::standing_bound(std::size_t line) const {
  const RequirementResult& requirement = search_.findings[line].requirement;
  if (!requirement.requirement || *requirement.requirement >= bounds_.requirements.size())
    return nullptr;  // nobody asked for bounds
  const analysis::RequirementBound& bound = bounds_.requirements[*requirement.requirement];
  return bounds_.ledger.objection(bound.assumptions, requirement.from).empty() ? &bound : nullptr;
}

bool Trials::is_at_bound() const {
  const analysis::RequirementBound* const bound = standing_bound(line_);
  const std::optional<Duration>& found = search_.findings[line_].longest.measured;
  return bound != nullptr && bound->duration && found && *found + next_to_nothing >= *bound->duration;
}

bool Trials::is_proved(std::size_t line) const {
  const analysis::RequirementBound* const bound = standing_bound(line);
  const std::optional<Duration>& limit = search_.findings[line].requirement.limit;
  return bound != nullptr && ((bound->duration && limit && *bound->duration <= *limit) || bound->count == 0);
}

void Trials::note(const Probe& probe, const FoundRun& run, bool is_as_it_is) {
  const bool is_part = run.is_shorter;
  for (const Violation& violation : probe.violations)
    if (std::none_of(search_.violations.begin(), search_.violations.end(),
                     [&](const Violation& known) { return known.assumption == violation.assumption; }))
      search_.violations.push_back(violation);
  if (!probe.contradiction.empty() && !search_.contradiction)
    search_.contradiction = Contradiction{probe.contradiction, run.scenario()};
  for (std::size_t i = 0; i < search_.findings.size() && i < probe.requirements.size(); ++i) {
    const RequirementResult& seen = probe.requirements[i];
    Finding& finding = search_.findings[i];
    if (is_part && !counts_in_a_part(seen.taken_as)) continue;
    if (probe.broken[i] > finding.broken) {
      finding.broken = probe.broken[i];
      finding.worst.run = run;
    }
    // How many frames come until the end depends on when the talker begins, and says nothing about the network.
    const bool is_of_latency = seen.kind == RequirementKind::figure && !seen.subject.empty();
    const bool is_of_all_frames = seen.figure && !seen.figure->is_upper && !is_of_latency && !is_of_misses(seen.kind);
    if (!is_as_it_is && (seen.kind == RequirementKind::delivered || is_of_all_frames)) continue;
    // What was not complete at the end might have been so later.
    const bool failed =
        seen.verdict == results::Verdict::fail &&
        (!is_part || seen.measured || seen.kind == RequirementKind::invariants || is_of_misses(seen.kind)) &&
        !(is_part && seen.measured && seen.limit && *seen.measured <= *seen.limit && !is_too_fast(seen));
    Worst made{seen.measured, failed || finding.worst.failed, run, seen.figure ? seen.figure->found : std::nullopt};
    if (!finding.longest.run || seen.measured > finding.longest.measured) finding.longest = made;
    const bool worse =
        (failed && !finding.worst.failed) || (failed == finding.worst.failed && seen.measured > finding.worst.measured);
    if (!worse && finding.worst.run) continue;
    finding.worst = std::move(made);
  }
}

std::int64_t Trials::badness(const Probe& probe) const {
  const RequirementResult& seen = probe.requirements[line_];
  if (seen.measured) return seen.measured->ps();
  // More in a row are worse, and so are fewer that are met.
  if (is_of_misses(seen.kind) && seen.figure && seen.figure->found)
    return static_cast<std::int64_t>(seen.figure->is_upper ? *seen.figure->found : 1'000'000'000 - *seen.figure->found);
  return seen.verdict == results::Verdict::fail ? 1 : 0;
}

std::vector<std::int64_t> Trials::try_all(const std::vector<Choice>& choices) {
  std::vector<std::int64_t> found;
  for (std::size_t from = 0; from < choices.size() && is_affordable();) {
    const std::size_t many = std::min({choices.size() - from, most_in_a_batch,
                                       static_cast<std::size_t>(std::max<std::uint64_t>(1, affordable_runs()))});
    std::vector<FoundRun> runs;
    for (std::size_t i = 0; i < many; ++i) runs.push_back(run_of(choices[from + i]));
    const auto probes = probe_all(runs, bounds_, options_.jobs, budget_.interrupted());
    for (std::size_t i = 0; i < many; ++i) {
      if (!probes[i]) {  // interrupted
        search_.partial = true;
        return found;
      }
      ++search_.runs;
      budget_.spend(cost_of_run(resolved_, probes[i]->events));
      if (loses_too_much(choices[from + i], *probes[i])) {
        found.push_back(-1);
        continue;
      }
      note(*probes[i], runs[i]);
      found.push_back(badness(*probes[i]));
      if (!best_ || found.back() > best_->first) best_ = {found.back(), choices[from + i]};
    }
    from += many;
    if (options_.progress) options_.progress(budget_.spent(), budget_.events());
  }
  return found;
}

std::optional<std::vector<MeetingLog::Visit>> Trials::meetings_of(const Choice& choice) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(run_of(choice).scenario(), diagnostics);
  if (!resolved) return std::nullopt;
  scenario::Run run(*resolved);
  MeetingLog log(run.network(), most_visits);
  run.simulation().set_trace(&log);
  constexpr std::uint64_t events_a_slice = 100'000;
  while (log.is_complete && !run.advance(events_a_slice))
    if (budget_.is_interrupted()) return std::nullopt;
  budget_.spend(cost_of_run(resolved_, run.simulation().event_count()));
  run.simulation().set_trace(nullptr);
  return log.is_complete ? std::optional(std::move(log.visits)) : std::nullopt;
}

/// Chance has its say in every frame, so a longer run may show more.
void Trials::run_in_full() {
  const RequirementKind kind = requirement().taken_as;
  if (!is_shorter_ || !best_ || is_interrupted() || is_at_bound() ||
      (kind != RequirementKind::latency && kind != RequirementKind::jitter))
    return;
  const FoundRun full{ground_, std::make_shared<const Choice>(best_->second), false};
  if (cost_of_run(resolved_, as_it_is_->events) > budget_.left()) return;
  const std::optional<Probe> seen = probe(full.scenario(), bounds_, budget_.interrupted());
  if (!seen) return;
  ++search_.runs;
  budget_.spend(cost_of_run(resolved_, seen->events));
  note(*seen, full);
}

/// Frames are lost by choice, and more of them than the scenario's requirements leave room for.
bool Trials::loses_too_much(const Choice& choice, const Probe& probe) const {
  bool loses = false;
  for (std::size_t f = 0; f < ground_->variables.size(); ++f)
    loses = loses || (ground_->variables[f].kind == FreeVariable::Kind::losses && choice.values[f] != Duration());
  return loses && std::any_of(probe.requirements.begin(), probe.requirements.end(), [](const RequirementResult& each) {
           const bool is_of_losses = each.kind == RequirementKind::dropped || each.kind == RequirementKind::delivered ||
                                     is_of_misses(each.kind) ||
                                     (each.figure && (each.figure->name == "lost" || each.figure->name == "dropped" ||
                                                      each.figure->name.ends_with("/lost")));
           return is_of_losses && each.verdict == results::Verdict::fail;
         });
}

}  // namespace takt::verify
