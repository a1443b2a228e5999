// SPDX-License-Identifier: Apache-2.0
#include "study/shrink.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "study/point.hpp"
#include "study/pool.hpp"

namespace takt::study {
namespace {

using Faults = std::vector<scenario::Fault>;

/// The study's limit as a requirement of a scenario.
scenario::Requirement requirement_of(const Plan& plan, const Limit& limit) {
  const auto measure =
      static_cast<std::size_t>(std::find_if(plan.measures.begin(), plan.measures.end(),
                                            [&](const PlannedMeasure& m) { return m.name == limit.measure; }) -
                               plan.measures.begin());
  const Measure& said = plan.study.measures[measure];
  scenario::Requirement requirement;
  requirement.figure = said.of;
  if (plan.measures[measure].basis == Basis::worst || plan.measures[measure].basis == Basis::bound)
    requirement.figure->erase(0, said.of.find('.') + 1);
  requirement.only = said.only;
  if (said.of.starts_with('/')) requirement.take = said.take;  // a short form says it itself
  if (!plan.measures[measure].unit.empty()) requirement.unit = plan.measures[measure].unit;
  requirement.at_most = limit.at_most;
  requirement.at_least = limit.at_least;
  return requirement;
}

/// The scenario judges as the study does. A limit of the verdict is kept by what the scenario requires itself.
void require_limits(const Plan& plan, scenario::Scenario& scenario) {
  const auto is_verdict = [&](const Limit& limit) {
    return std::any_of(plan.measures.begin(), plan.measures.end(), [&](const PlannedMeasure& m) {
      return m.name == limit.measure && m.steps.front() == "verdict";
    });
  };
  if (!plan.study.requirements_count && std::none_of(plan.study.limits.begin(), plan.study.limits.end(), is_verdict))
    scenario.require.clear();
  for (const Limit& limit : plan.study.limits)
    if (!is_verdict(limit)) scenario.require.push_back(requirement_of(plan, limit));
}

class Shrinker {
 public:
  Shrinker(const Plan& plan, const RunOptions& options, Shrunk& shrunk)
      : plan_(plan), options_(options), shrunk_(shrunk) {}

  void run() {
    shrunk_.faults_before = shrunk_.scenario.faults.size();
    const auto outcome = try_with(shrunk_.scenario.faults);
    if (!outcome || outcome->status != Status::done) {
      shrunk_.problem = shrunk_.interrupted ? "" : "the point has no result" + (outcome ? ": " + outcome->error : "");
      return;
    }
    note_broken(*outcome);
    if (outcome->passes) {
      shrunk_.problem =
          plan_.is_verified()
              ? "the run of the point passes: if it fails, then by a worst case or a bound, which takt verify shows"
              : "the point passes: there is nothing to shrink";
      return;
    }
    leave_out();
    shorten();
  }

 private:
  /// One run in a process of its own.
  std::optional<Outcome> try_with(const Faults& faults) {
    scenario::Scenario scenario = shrunk_.scenario;
    scenario.faults = faults;
    ++shrunk_.runs;
    std::optional<Outcome> outcome;
    bool is_asked = false;
    Pool pool(1, {plan_.study.effort.cpu, plan_.study.effort.memory.count},
              [&](std::uint64_t) { return packed(run_scenario(plan_, scenario)); });
    const std::string problem = pool.run(
        [&]() -> std::optional<std::uint64_t> {
          return std::exchange(is_asked, true) ? std::nullopt : std::optional<std::uint64_t>(0);
        },
        [&](std::uint64_t, const Answer& answer) {
          if (answer.kind == Answer::Kind::answered) outcome = unpacked(answer.text);
          return true;
        },
        [&] {
          if (options_.progress)
            options_.progress("shrinking", shrunk_.faults_before - shrunk_.scenario.faults.size(),
                              shrunk_.faults_before);
          shrunk_.interrupted = options_.interrupted && options_.interrupted();
          return !shrunk_.interrupted;
        });
    if (!problem.empty()) shrunk_.problem = problem;
    return outcome;
  }

  /// Keeps the faults if the point fails with them.
  bool keep_if_failing(const Faults& faults) {
    if (shrunk_.interrupted) return false;
    const auto outcome = try_with(faults);
    if (!outcome || outcome->status != Status::done || outcome->passes) return false;
    shrunk_.scenario.faults = faults;
    note_broken(*outcome);
    return true;
  }

  void note_broken(const Outcome& outcome) {
    shrunk_.broken.clear();
    for (const PlannedLimit& limit : plan_.limits)
      if (outcome.status == Status::done && !limit.holds(outcome.values[limit.measure]))
        shrunk_.broken.push_back(limit.text);
  }

  /// Without ever smaller parts, until no single fault can be left out.
  void leave_out() {
    for (std::size_t part = (shrunk_.scenario.faults.size() + 1) / 2; part >= 1;) {
      bool is_less = false;
      for (std::size_t begin = 0; begin < shrunk_.scenario.faults.size();) {
        Faults rest = shrunk_.scenario.faults;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(begin),
                   rest.begin() + static_cast<std::ptrdiff_t>(std::min(begin + part, rest.size())));
        if (keep_if_failing(rest))
          is_less = true;
        else
          begin += part;
      }
      if (part == 1 && !is_less) return;
      part = is_less ? std::min(part, std::max<std::size_t>(1, shrunk_.scenario.faults.size() / 2)) : part / 2;
      if (shrunk_.scenario.faults.empty() || shrunk_.interrupted) return;
    }
  }

  void shorten() {
    for (std::size_t i = 0; i < shrunk_.scenario.faults.size(); ++i) {
      for (bool is_less = true; is_less;) {
        Faults faults = shrunk_.scenario.faults;
        is_less = halve(faults[i]) && keep_if_failing(faults);
      }
    }
  }

  /// Half as long, down to 1 us. False if it cannot be shorter.
  bool halve(scenario::Fault& fault) const {
    return std::visit(
        [&](auto& one) {
          if constexpr (requires { one.lasts; }) {
            const sim::Duration left = shrunk_.scenario.duration - one.at;
            const sim::Duration now = std::min(one.lasts.value_or(left), left);
            if (now.ps() < 2'000'000) return false;
            one.lasts = sim::Duration::from_ps(now.ps() / 2'000'000 * 1'000'000);
            return true;
          } else {
            return false;
          }
        },
        fault);
  }

  const Plan& plan_;
  const RunOptions& options_;
  Shrunk& shrunk_;
};

}  // namespace

Shrunk shrink(const Plan& plan, std::uint64_t point, const RunOptions& options) {
  Shrunk shrunk;
  if (plan.study.schedule) {
    shrunk.problem = "a study of schedules, whose points are not run and have no faults to leave out";
    return shrunk;
  }
  json::Diagnostics diagnostics;
  const Variant& variant = plan.variants[plan.variant_of(point)];
  auto scenario = scenario_of(plan, variant, plan.seed_of(point), diagnostics);
  if (!scenario) {
    shrunk.problem = diagnostics.to_text();
    return shrunk;
  }
  shrunk.scenario = std::move(*scenario);
  require_limits(plan, shrunk.scenario);
  Shrinker(plan, options, shrunk).run();
  return shrunk;
}

}  // namespace takt::study
