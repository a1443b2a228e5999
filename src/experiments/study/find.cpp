// SPDX-License-Identifier: Apache-2.0
#include "study/find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "json/suggest.hpp"
#include "study/pool.hpp"
#include "study/statistics.hpp"

namespace takt::study {
namespace {

std::optional<std::size_t> factor_named(const Plan& plan, const std::string& name, std::string& problem) {
  std::vector<std::string_view> names;
  for (std::size_t f = 0; f < plan.factors.size(); ++f) {
    if (plan.factors[f].name == name) return f;
    names.push_back(plan.factors[f].name);
  }
  const std::string near = json::suggest(name, names);
  problem = "the study has no factor " + json::quote(name) + (near.empty() ? "" : " (did you mean \"" + near + "\"?)");
  return std::nullopt;
}

std::size_t add_measure(Plan& plan, PlannedMeasure measure, const std::string& name, Basis basis) {
  measure.name = name;
  measure.basis = basis;
  plan.measures.push_back(std::move(measure));
  return plan.measures.size() - 1;
}

/// The worst found and the bound of a measure of runs, where it has them.
void verify_measure(Plan& plan, std::size_t measure, Question& question) {
  const PlannedMeasure asked = plan.measures[measure];
  const bool is_known = std::any_of(question.verified.begin(), question.verified.end(),
                                    [&](const VerifiedFigure& each) { return each.measure == measure; });
  if (is_known || plan.study.schedule || asked.basis != Basis::run || !has_worst_case(asked)) return;
  const std::size_t worst = add_measure(plan, asked, "worst." + asked.name, Basis::worst);
  question.verified.push_back({measure, worst, add_measure(plan, asked, "bound." + asked.name, Basis::bound)});
}

void verify_pass(Plan& plan, Question& question) {
  if (plan.study.schedule) return;
  Measure measure;
  measure.name = measure.of = "verdict";
  json::Diagnostics none;
  question.verdict = add_measure(plan, *plan_study_measure(measure, none), "verdict", Basis::verdict);
  for (const PlannedLimit& limit : plan.limits) verify_measure(plan, limit.measure, question);
}

/// Sees to it that a name of the condition can be looked up.
bool know_name(Plan& plan, const std::string& name, Question& question, std::string& problem) {
  if (name == "pass") return verify_pass(plan, question), true;
  const auto found = std::find_if(plan.measures.begin(), plan.measures.end(),
                                  [&](const PlannedMeasure& measure) { return measure.name == name; });
  if (found != plan.measures.end())
    return verify_measure(plan, static_cast<std::size_t>(found - plan.measures.begin()), question), true;
  Measure measure;
  measure.name = "figure";
  measure.of = name;
  json::Diagnostics diagnostics;
  auto planned =
      plan.study.schedule ? plan_scheduling_measure(measure, diagnostics) : plan_study_measure(measure, diagnostics);
  if (!planned) {
    problem =
        json::quote(name) + " is neither a measure of the study, nor a short form such as reaction.start.max, nor pass";
    return false;
  }
  const Basis basis = planned->basis;
  verify_measure(plan, add_measure(plan, std::move(*planned), name, basis), question);
  return true;
}

bool set_level(const Plan& plan, const std::string& setting, Variant& variant, std::string& problem) {
  const std::size_t equals = setting.find('=');
  const auto factor = factor_named(plan, setting.substr(0, equals), problem);
  if (!factor) return false;
  const std::string wanted = equals == std::string::npos ? "" : setting.substr(equals + 1);
  const std::vector<Level>& levels = plan.factors[*factor].levels;
  const auto found =
      std::find_if(levels.begin(), levels.end(), [&](const Level& level) { return level.text == wanted; });
  if (found == levels.end())
    return problem = json::quote(wanted) + " is not a level of the factor " + plan.factors[*factor].name, false;
  variant[*factor] = static_cast<std::uint32_t>(found - levels.begin());
  return true;
}

const VerifiedFigure* verified_figure(const Question& question, std::size_t measure) {
  const auto found = std::find_if(question.verified.begin(), question.verified.end(),
                                  [&](const VerifiedFigure& each) { return each.measure == measure; });
  return found == question.verified.end() ? nullptr : &*found;
}

/// What the measure may be in the measure's unit: of a verified one, from the worst found to the bound. Nothing if some
/// run has no such figure.
std::optional<Between> possible_value(const Question& question, std::size_t measure, const Outcome& outcome) {
  const VerifiedFigure* const verified = verified_figure(question, measure);
  const std::optional<double>& least = outcome.values[verified != nullptr ? verified->worst : measure];
  if (!least) return std::nullopt;
  return Between{*least, verified != nullptr
                             ? outcome.values[verified->bound].value_or(std::numeric_limits<double>::infinity())
                             : *least};
}

/// Whether the point passes in every run that the variant allows.
Between possible_pass(const Plan& plan, const Question& question, const Outcome& outcome) {
  if (!outcome.passes) return {0, 0};
  if (!question.verdict) return {1, 1};
  bool is_certain = !plan.study.requirements_count || outcome.values[*question.verdict] == 1.0;
  for (const PlannedLimit& limit : plan.limits) {
    const std::optional<Between> value = possible_value(question, limit.measure, outcome);
    if (!value) return {0, 0};
    const bool least_keeps_it = limit.holds(value->least), greatest_keeps_it = limit.holds(value->greatest);
    if (!least_keeps_it && !greatest_keeps_it) return {0, 0};
    is_certain = is_certain && least_keeps_it && greatest_keeps_it;
  }
  return {is_certain ? 1.0 : 0.0, 1};
}

Truth decide(const Plan& plan, const Question& question, const Outcome& outcome) {
  return question.condition->decide([&](const std::string& name) -> PossibleOperand {
    if (name == "pass") return possible_pass(plan, question, outcome);
    for (std::size_t m = 0; m < plan.measures.size(); ++m) {
      if (plan.measures[m].name != name) continue;
      const std::optional<Between> value = possible_value(question, m, outcome);
      if (!value) return {};
      return Between{value->least / plan.measures[m].in_base_unit, value->greatest / plan.measures[m].in_base_unit};
    }
    return {};
  });
}

/// By the run of the point alone.
bool holds_in_run(const Plan& plan, const Question& question, const Outcome& outcome) {
  return question.condition->holds([&](const std::string& name) -> Operand {
    if (name == "pass") return outcome.passes ? 1.0 : 0.0;
    for (std::size_t m = 0; m < plan.measures.size(); ++m) {
      if (plan.measures[m].name != name) continue;
      if (!outcome.values[m]) return {};
      return *outcome.values[m] / plan.measures[m].in_base_unit;
    }
    return {};
  });
}

/// The greatest of two replications; none if one has none.
void keep_greatest(std::optional<double>& kept, const std::optional<double>& value, bool is_first) {
  kept = is_first ? value : kept && value ? std::optional(std::max(*kept, *value)) : std::nullopt;
}

void note_outcome(const Plan& plan, const Question& question, const std::optional<Outcome>& outcome,
                  Finding::Tried& tried) {
  const bool is_first = tried.runs++ == 0;
  if (!outcome || outcome->status != Status::done) {
    tried.truth = Truth::no;
    return;
  }
  tried.held += holds_in_run(plan, question, *outcome) ? 1 : 0;
  tried.truth = std::min(tried.truth, decide(plan, question, *outcome));
  tried.seen.resize(question.verified.size());
  for (std::size_t i = 0; i < question.verified.size(); ++i) {
    keep_greatest(tried.seen[i].of_runs, outcome->values[question.verified[i].measure], is_first);
    keep_greatest(tried.seen[i].worst, outcome->values[question.verified[i].worst], is_first);
    keep_greatest(tried.seen[i].bound, outcome->values[question.verified[i].bound], is_first);
  }
}

class Search {
 public:
  Search(const Plan& plan, const Question& question, const RunOptions& options)
      : plan_(plan), question_(question), options_(options) {}

  Finding run() {
    // Positions count from the side where the condition is expected to hold.
    const std::size_t last = question_.levels.size() - 1;
    if (truth_at(0) == Truth::no) return finish();
    const std::size_t open = last_position(0, last, Truth::unknown);
    finding_.open = level_at(open);
    std::size_t answer = open;
    if (truth_at(0) == Truth::yes) {
      answer = last_position(0, open, Truth::yes);
      finding_.proved = level_at(answer);
    }
    finding_.is_at_end = answer == last;
    return finish();
  }

 private:
  std::uint32_t level_at(std::size_t position) const {
    return question_.levels[question_.is_max ? position : question_.levels.size() - 1 - position];
  }

  /// The last position up to which the condition has at least that truth, by bisection; it has it at `good`.
  std::size_t last_position(std::size_t good, std::size_t bad, Truth least) {
    if (truth_at(bad) >= least) return bad;
    while (bad - good > 1 && finding_.problem.empty() && !finding_.interrupted) {
      const std::size_t middle = good + (bad - good) / 2;
      (truth_at(middle) >= least ? good : bad) = middle;
    }
    return good;
  }

  Truth truth_at(std::size_t position) {
    if (const auto known = truths_.find(position); known != truths_.end()) return known->second;
    if (!finding_.problem.empty() || finding_.interrupted) return Truth::no;
    Finding::Tried tried;
    tried.level = level_at(position);
    Variant variant = question_.variant;
    variant[question_.factor] = tried.level;
    const std::uint32_t replications = plan_.study.replications.count;
    const auto run_one = [&](std::uint64_t r) {
      return packed(run_variant(plan_, variant, plan_.study.replications.first_seed + r, options_.threads));
    };
    Pool pool(std::min(options_.jobs, replications), {plan_.study.effort.cpu, plan_.study.effort.memory.count},
              run_one);
    std::uint64_t next = 0;
    finding_.problem = pool.run(
        [&]() -> std::optional<std::uint64_t> { return next < replications ? std::optional(next++) : std::nullopt; },
        [&](std::uint64_t, const Answer& answer) {
          const auto outcome = answer.kind == Answer::Kind::answered ? unpacked(answer.text) : std::nullopt;
          note_outcome(plan_, question_, outcome, tried);
          if (!outcome || outcome->status != Status::done) tried.trouble = outcome ? outcome->error : answer.text;
          return true;
        },
        [&] {
          if (options_.progress)
            options_.progress(plan_.factors[question_.factor].levels[tried.level].text.c_str(), tried.runs,
                              replications);
          finding_.interrupted = options_.interrupted && options_.interrupted();
          return !finding_.interrupted;
        });
    const Truth truth = tried.runs == replications ? tried.truth : Truth::no;
    truths_[position] = truth;
    finding_.tried.push_back(std::move(tried));
    return truth;
  }

  Finding finish() {
    Truth least = Truth::yes;
    for (const auto& [at, truth] : truths_) {
      if (truth > least) finding_.is_monotone = false;
      least = std::min(least, truth);
    }
    // n runs without a failure: a share p of failing seeds would have shown with probability 1 - (1 - p)^n.
    finding_.worst_share = 1 - std::pow(1 - confidence, 1.0 / plan_.study.replications.count);
    const std::vector<Level>& levels = plan_.factors[question_.factor].levels;
    std::sort(finding_.tried.begin(), finding_.tried.end(), [&](const Finding::Tried& a, const Finding::Tried& b) {
      return *levels[a.level].number < *levels[b.level].number;
    });
    return std::move(finding_);
  }

  const Plan& plan_;
  const Question& question_;
  const RunOptions& options_;
  Finding finding_;
  std::map<std::size_t, Truth> truths_;
};

}  // namespace

std::optional<Question> read_question(Plan& plan, const std::string& text, const std::vector<std::string>& at,
                                      std::string& problem) {
  constexpr std::string_view such_that = " such that ";
  const std::size_t middle = text.find(such_that);
  const bool is_max = text.starts_with("max ");
  if (middle == std::string::npos || middle < 5 || (!is_max && !text.starts_with("min ")))
    return problem = json::quote(text) + " is no question: expected \"max FACTOR such that CONDITION\" or \"min ...\"",
           std::nullopt;
  Question question;
  question.is_max = is_max;
  const auto factor = factor_named(plan, text.substr(4, middle - 4), problem);
  if (!factor) return std::nullopt;
  question.factor = *factor;
  const std::vector<Level>& levels = plan.factors[*factor].levels;
  if (!std::all_of(levels.begin(), levels.end(), [](const Level& level) { return level.number.has_value(); }))
    return problem = "the levels of " + plan.factors[*factor].name +
                     " are no numbers, so there is neither a greatest nor a least",
           std::nullopt;
  if (levels.empty())
    return problem =
               "the factor " + plan.factors[*factor].name + " has no levels: give its range \"step\" or \"steps\"",
           std::nullopt;
  question.levels.resize(levels.size());
  std::iota(question.levels.begin(), question.levels.end(), 0u);
  std::stable_sort(question.levels.begin(), question.levels.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return *levels[a].number < *levels[b].number; });
  question.condition = Expression::parse(text.substr(middle + such_that.size()), problem);
  if (!question.condition) return problem = "not a condition: " + problem, std::nullopt;
  for (const std::string& name : question.condition->names())
    if (!know_name(plan, name, question, problem)) return std::nullopt;
  for (const PlannedFactor& other : plan.factors)
    question.variant.push_back(static_cast<std::uint32_t>(other.baseline));
  for (const std::string& setting : at)
    if (!set_level(plan, setting, question.variant, problem)) return std::nullopt;
  return question;
}

Finding find(const Plan& plan, const Question& question, const RunOptions& options) {
  return Search(plan, question, options).run();
}

namespace {

/// "halt 0.779 ms in runs, 1.47 ms worst found, at most 1.8 ms"
std::string text_of_seen(const Plan& plan, const Question& question, const Finding::Tried& tried) {
  std::string text;
  for (std::size_t i = 0; i < tried.seen.size(); ++i) {
    const PlannedMeasure& measure = plan.measures[question.verified[i].measure];
    const Finding::Seen& seen = tried.seen[i];
    const auto figure = [&](const std::optional<double>& value, const char* none) {
      return value ? scenario::text_of(*value, measure.unit) : std::string(none);
    };
    text += fmt::format("; {} {} in runs, {}, {}", measure.name, figure(seen.of_runs, "missing"),
                        seen.worst ? figure(seen.worst, "") + " worst found" : "missing in some run that was found",
                        seen.bound ? "bound " + figure(seen.bound, "") : "no bound");
  }
  return text;
}

std::string text_of_tried(const Plan& plan, const Question& question, const Finding::Tried& tried) {
  constexpr const char* truths[] = {"refuted", "undecided", "proved"};
  const PlannedFactor& factor = plan.factors[question.factor];
  std::string text = fmt::format("  {} = {:<12} ", factor.name, factor.levels[tried.level].text);
  if (question.is_verified()) text += fmt::format("{:<9}  ", truths[static_cast<std::size_t>(tried.truth)]);
  text += fmt::format("holds in {} of {} runs{}", tried.held, tried.runs, text_of_seen(plan, question, tried));
  return text + (tried.trouble.empty() ? "\n" : "; " + tried.trouble.substr(0, tried.trouble.find('\n')) + "\n");
}

/// The figures of the condition, and of the limits behind "pass", of which only runs say something.
std::string names_by_runs(const Plan& plan, const Question& question) {
  std::vector<std::string> names;
  const auto add_if_of_runs = [&](std::size_t measure) {
    const std::string& name = plan.measures[measure].name;
    if (plan.measures[measure].basis == Basis::run && verified_figure(question, measure) == nullptr &&
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  };
  for (const std::string& name : question.condition->names()) {
    if (name == "pass" && !question.verdict) names.push_back(name);
    if (name == "pass")
      for (const PlannedLimit& limit : plan.limits) add_if_of_runs(limit.measure);
    for (std::size_t m = 0; m < plan.measures.size(); ++m)
      if (plan.measures[m].name == name) add_if_of_runs(m);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// What the answer rests on: "by the bound", "by the worst found", "by 5 runs".
std::string basis_text(const Plan& plan, const Question& question, const Finding& finding) {
  const std::uint32_t runs = plan.study.replications.count;
  const std::string by_runs = fmt::format("{} run{}", runs, runs == 1 ? "" : "s");
  const std::string names = names_by_runs(plan, question);
  if (!question.is_verified()) return names.empty() ? "" : ", by " + by_runs;
  return fmt::format(", by {}{}", finding.proved ? "the bound" : "the worst found",
                     names.empty() ? "" : fmt::format(" and, of {}, by {}", names, by_runs));
}

}  // namespace

std::string text_of(const Plan& plan, const Question& question, const Finding& finding) {
  const PlannedFactor& factor = plan.factors[question.factor];
  std::string text;
  for (std::size_t f = 0; f < plan.factors.size(); ++f)
    if (f != question.factor)
      text += fmt::format("{}{} = {}", text.empty() ? "with " : ", ", plan.factors[f].name,
                          plan.level_of(question.variant, f).text);
  if (!text.empty()) text += "\n";
  for (const Finding::Tried& tried : finding.tried) text += text_of_tried(plan, question, tried);
  if (finding.interrupted) return text + "interrupted\n";
  if (!finding.level())
    return text + fmt::format("{} does not hold at the {} level already\n", question.condition->text(),
                              question.is_max ? "least" : "greatest");
  text +=
      fmt::format("{} {} such that {}: {}{}{}\n", question.is_max ? "max" : "min", factor.name,
                  question.condition->text(), factor.levels[*finding.level()].text, basis_text(plan, question, finding),
                  finding.is_at_end ? " (the end of the range: it holds everywhere that was tried)" : "");
  if (!finding.proved)
    text += "No run that was found breaks it there, and no bound excludes one: takt verify says what is missing.\n";
  else if (finding.open != finding.proved)
    text += fmt::format("Up to {} no run that was found breaks it, and no bound excludes one.\n",
                        factor.levels[*finding.open].text);
  if (!names_by_runs(plan, question).empty())
    text += fmt::format("With 95 % confidence at most {:.2g} % of seeds break it there.\n", 100 * finding.worst_share);
  if (!finding.is_monotone)
    text += "It holds again beyond where it broke: the answer is where it breaks first among what was tried.\n";
  return text;
}

}  // namespace takt::study
