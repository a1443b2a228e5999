// SPDX-License-Identifier: Apache-2.0
#include "study/verified.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/figures/requirement.hpp"
#include "scenario/resolve.hpp"
#include "sim/check.hpp"
#include "verify/probe.hpp"

namespace takt::study {
namespace {

using scenario::RequiredFigure;
using verify::Conclusion;

/// The requirement that a measure's figure is looked for and bounded by.
struct Asked {
  std::size_t measure = 0;
  std::size_t requirement = 0;  ///< in Resolved::requirements
};

bool is_same_figure(const scenario::Figure& a, const scenario::Figure& b) {
  return a.steps == b.steps && a.take == b.take &&
         std::equal(a.only.begin(), a.only.end(), b.only.begin(), b.only.end(),
                    [](const auto& x, const auto& y) { return x.first == y.first && json::equal(x.second, y.second); });
}

/// How far the search looks behind the cause of a reaction: several times as long as one took, and as the study allows.
double limit_for(const Plan& plan, std::size_t measure, const std::optional<double>& of_run) {
  constexpr double times_longer = 4;
  const PlannedMeasure& asked = plan.measures[measure];
  double limit = of_run ? times_longer * *of_run : 1e12 / asked.divisor;  // a second
  for (const PlannedLimit& each : plan.limits)
    if (each.is_upper() && is_same_figure(plan.measures[each.measure], asked))
      limit = std::max(limit, each.value * plan.measures[each.measure].divisor / asked.divisor);
  return limit;
}

scenario::Requirement requirement_on(const scenario::Figure& figure, double limit) {
  scenario::Requirement requirement;
  requirement.figure.emplace();
  for (const std::string& step : figure.steps) *requirement.figure += json::pointer_step(step);
  for (const auto& [key, value] : figure.only) requirement.only.emplace_back(key, json::Any{value, {}});
  requirement.take = figure.take;
  const auto limit_in_ps = static_cast<std::int64_t>(std::clamp(std::ceil(limit * figure.divisor), 1e3, 1e18));
  requirement.at_most = json::Any{json::Node::of_string(std::to_string(limit_in_ps) + "ps"), {}};
  return requirement;
}

/// One that the scenario has already and that is about the same figure from the same instant on.
std::optional<std::size_t> own_requirement(const scenario::Resolved& resolved, const scenario::Figure& figure,
                                           sim::Duration from) {
  const auto found =
      std::find_if(resolved.requirements.begin(), resolved.requirements.end(), [&](const RequiredFigure& each) {
        return each.limit.is_upper() && each.longest && each.from == from && is_same_figure(each.figure, figure);
      });
  return found == resolved.requirements.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - resolved.requirements.begin()));
}

/// A run has no such figure at all: the requirement is broken though nothing that was measured exceeds its limit.
bool is_missing_somewhere(const verify::Line& line) {
  const bool is_reaction = line.requirement.taken_as == results::RequirementKind::reaction;
  return is_reaction && line.verdict == Conclusion::refuted &&
         (!line.adversarial || (line.requirement.limit && *line.adversarial <= *line.requirement.limit));
}

/// What is said of the scenario's own requirements, the Programs' invariants among them.
void judge_own(const verify::Verification& verification, std::size_t own, Verified& verified) {
  verified.verdict = Conclusion::pass;
  for (const verify::Line& line : verification.lines) {
    if (line.requirement.requirement && *line.requirement.requirement >= own) continue;
    verified.is_required = true;
    if (line.verdict == Conclusion::refuted) verified.verdict = Conclusion::refuted;
    if (line.verdict == Conclusion::undecided && verified.verdict == Conclusion::pass)
      verified.verdict = Conclusion::undecided;
  }
}

class Verifier {
 public:
  Verifier(const Plan& plan, const scenario::Scenario& ran, const std::vector<std::optional<double>>& of_run)
      : plan_(plan), ran_(ran), of_run_(of_run) {
    verified_.values.resize(plan.measures.size());
  }

  Verified run(const scenario::Scenario& scenario, bool run_fails, unsigned threads) {
    json::Diagnostics diagnostics;
    auto resolved = scenario::resolve(scenario, diagnostics);
    TAKT_CHECK(resolved != nullptr, "a variant that has run is sound");
    const std::size_t own = resolved->requirements.size();
    // The resolved copy, so that gates are laid once.
    scenario::Scenario asking = resolved->scenario;
    ask(*resolved, own, asking);
    if (asking.require.size() > resolved->scenario.require.size()) resolved = scenario::resolve(asking, diagnostics);
    TAKT_CHECK(resolved != nullptr, "a requirement on a figure of the study is sound");
    const verify::Verification verification = verify::verify(*resolved, options(threads));
    if (verification.contradiction) verified_.contradiction = verification.contradiction->text;
    judge_own(verification, own, verified_);
    for (const Asked& each : asked_)
      for (const verify::Line& line : verification.lines)
        if (line.requirement.requirement == each.requirement) take(each.measure, line);
    if (run_fails) verified_.verdict = Conclusion::refuted;
    for (std::size_t m = 0; m < plan_.measures.size(); ++m)
      if (plan_.measures[m].basis == Basis::verdict && verified_.verdict != Conclusion::undecided)
        verified_.values[m] = verified_.verdict == Conclusion::pass ? 1 : 0;
    return std::move(verified_);
  }

 private:
  /// One requirement for all measures of one figure.
  void ask(const scenario::Resolved& resolved, std::size_t own, scenario::Scenario& asking) {
    std::vector<Asked> added;
    for (std::size_t m = 0; m < plan_.measures.size(); ++m) {
      const PlannedMeasure& measure = plan_.measures[m];
      if (measure.basis != Basis::worst && measure.basis != Basis::bound) continue;
      std::optional<std::size_t> requirement = own_requirement(resolved, measure, asking.warm_up);
      for (const Asked& each : added)
        if (is_same_figure(plan_.measures[each.measure], measure)) requirement = each.requirement;
      if (!requirement) {
        requirement = own + added.size();
        asking.require.push_back(requirement_on(measure, limit_for(plan_, m, of_run_[m])));
        added.push_back({m, *requirement});
      }
      asked_.push_back({m, *requirement});
    }
  }

  verify::Options options(unsigned threads) const {
    const bool asks_verdict = std::any_of(plan_.measures.begin(), plan_.measures.end(),
                                          [](const PlannedMeasure& m) { return m.basis == Basis::verdict; });
    verify::Options options;
    options.search.seeds = plan_.study.verify.seeds;
    options.search.jobs = threads;
    options.search.events = static_cast<std::uint64_t>(plan_.study.verify.budget * 1e6);
    // States of the handshake matter to the verdict alone.
    options.proof.states =
        asks_verdict ? std::min(options.proof.states, std::max<std::uint64_t>(1, options.search.events)) : 1;
    return options;
  }

  void take(std::size_t m, const verify::Line& line) {
    const PlannedMeasure& measure = plan_.measures[m];
    const auto in_unit = [&](sim::Duration time) { return static_cast<double>(time.ps()) / measure.divisor; };
    if (measure.basis == Basis::bound && line.bound) verified_.values[m] = in_unit(*line.bound);
    if (measure.basis == Basis::worst && line.adversarial && of_run_[m] && !is_missing_somewhere(line))
      verified_.values[m] = std::max(*of_run_[m], in_unit(*line.adversarial));
    if (!line.bound) return;
    if (line.adversarial && *line.adversarial > *line.bound)
      contradict(m, line, in_unit(*line.adversarial), in_unit(*line.bound));
    if (!of_run_[m] || *of_run_[m] <= in_unit(*line.bound)) return;
    // Above the bound: either the run of the point shows that the bound rests on what does not hold, or takt is wrong.
    const std::optional<verify::Probe> seen = verify::probe(ran_, bounds_, {});
    if (!seen || seen->violations.empty()) return contradict(m, line, *of_run_[m], in_unit(*line.bound));
    if (measure.basis == Basis::bound) verified_.values[m].reset();
    if (verified_.verdict == Conclusion::pass) verified_.verdict = Conclusion::undecided;
  }

  void contradict(std::size_t m, const verify::Line& line, double found, double bound) {
    const std::string& unit = plan_.measures[m].unit;
    if (verified_.contradiction.empty())
      verified_.contradiction = line.requirement.text + ": a run with " + scenario::text_of(found, unit) +
                                ", above the bound of " + scenario::text_of(bound, unit);
  }

  const Plan& plan_;
  const scenario::Scenario& ran_;
  const std::vector<std::optional<double>>& of_run_;
  analysis::Bounds bounds_ = {};  // none: what a run shows is asked for, not what it exceeds
  std::vector<Asked> asked_;
  Verified verified_;
};

}  // namespace

Verified verify_variant(const Plan& plan, const scenario::Scenario& scenario, const scenario::Scenario& ran,
                        const std::vector<std::optional<double>>& of_run, bool run_fails, unsigned threads) {
  return Verifier(plan, ran, of_run).run(scenario, run_fails, threads);
}

}  // namespace takt::study
