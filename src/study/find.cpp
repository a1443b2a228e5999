#include "study/find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

/// Sees to it that a name of the condition can be looked up.
bool know_name(Plan& plan, const std::string& name, std::string& problem) {
  const auto is_it = [&](const PlannedMeasure& measure) { return measure.name == name; };
  if (name == "pass" || std::any_of(plan.measures.begin(), plan.measures.end(), is_it)) return true;
  Measure measure;
  measure.name = "figure";
  measure.of = name;
  json::Diagnostics diagnostics;
  auto planned = plan.study.schedule ? plan_scheduling_measure(measure, diagnostics) : plan_measure(measure, diagnostics);
  if (!planned) {
    problem = json::quote(name) + " is neither a measure of the study, nor a short form such as reaction.start.max, nor pass";
    return false;
  }
  planned->name = name;
  plan.measures.push_back(std::move(*planned));
  return true;
}

bool set_level(const Plan& plan, const std::string& setting, Variant& variant, std::string& problem) {
  const std::size_t equals = setting.find('=');
  const auto factor = factor_named(plan, setting.substr(0, equals), problem);
  if (!factor) return false;
  const std::string wanted = equals == std::string::npos ? "" : setting.substr(equals + 1);
  const std::vector<Level>& levels = plan.factors[*factor].levels;
  const auto found = std::find_if(levels.begin(), levels.end(), [&](const Level& level) { return level.text == wanted; });
  if (found == levels.end()) return problem = json::quote(wanted) + " is not a level of the factor " + plan.factors[*factor].name, false;
  variant[*factor] = static_cast<std::uint32_t>(found - levels.begin());
  return true;
}

bool holds(const Plan& plan, const Question& question, const Outcome& outcome) {
  if (outcome.status != Status::done) return false;
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

class Search {
 public:
  Search(const Plan& plan, const Question& question, const RunOptions& options) : plan_(plan), question_(question), options_(options) {}

  Finding run() {
    // Positions count from the side where the condition is expected to hold.
    std::size_t good = 0;
    std::size_t bad = question_.levels.size() - 1;
    if (!try_at(good)) return finish(std::nullopt);
    if (try_at(bad)) {
      finding_.is_at_end = true;
      return finish(bad);
    }
    while (bad - good > 1 && finding_.problem.empty() && !finding_.interrupted) {
      const std::size_t middle = good + (bad - good) / 2;
      (try_at(middle) ? good : bad) = middle;
    }
    return finish(good);
  }

 private:
  std::uint32_t level_at(std::size_t position) const { return question_.levels[question_.is_max ? position : question_.levels.size() - 1 - position]; }

  bool try_at(std::size_t position) {
    if (!finding_.problem.empty() || finding_.interrupted) return false;
    Finding::Tried tried;
    tried.level = level_at(position);
    Variant variant = question_.variant;
    variant[question_.factor] = tried.level;
    const std::uint32_t replications = plan_.study.replications.count;
    const auto run_one = [&](std::uint64_t r) {
      return packed(run_variant(plan_, variant, plan_.study.replications.first_seed + r, options_.threads));
    };
    Pool pool(std::min(options_.jobs, replications), {plan_.study.effort.cpu, plan_.study.effort.memory.count}, run_one);
    std::uint64_t next = 0;
    finding_.problem = pool.run([&]() -> std::optional<std::uint64_t> { return next < replications ? std::optional(next++) : std::nullopt; },
                                [&](std::uint64_t, const Answer& answer) {
                                  const auto outcome = answer.kind == Answer::Kind::answered ? unpacked(answer.text) : std::nullopt;
                                  ++tried.runs;
                                  if (outcome && holds(plan_, question_, *outcome)) ++tried.held;
                                  if (!outcome || outcome->status != Status::done) tried.trouble = outcome ? outcome->error : answer.text;
                                  return true;
                                },
                                [&] {
                                  if (options_.progress) options_.progress(plan_.factors[question_.factor].levels[tried.level].text.c_str(), tried.runs, replications);
                                  finding_.interrupted = options_.interrupted && options_.interrupted();
                                  return !finding_.interrupted;
                                });
    const bool is_good = tried.runs == replications && tried.held == tried.runs;
    good_at_[position] = is_good;
    finding_.tried.push_back(std::move(tried));
    return is_good;
  }

  Finding finish(std::optional<std::size_t> position) {
    if (position) finding_.level = level_at(*position);
    bool is_broken = false;
    for (const auto& [at, is_good] : good_at_) {
      if (is_good && is_broken) finding_.is_monotone = false;
      is_broken = is_broken || !is_good;
    }
    // n runs without a failure: a share p of failing seeds would have shown with probability 1 - (1 - p)^n.
    finding_.worst_share = 1 - std::pow(1 - confidence, 1.0 / plan_.study.replications.count);
    const std::vector<Level>& levels = plan_.factors[question_.factor].levels;
    std::sort(finding_.tried.begin(), finding_.tried.end(), [&](const Finding::Tried& a, const Finding::Tried& b) { return *levels[a.level].number < *levels[b.level].number; });
    return std::move(finding_);
  }

  const Plan& plan_;
  const Question& question_;
  const RunOptions& options_;
  Finding finding_;
  std::map<std::size_t, bool> good_at_;
};

}  // namespace

std::optional<Question> read_question(Plan& plan, const std::string& text, const std::vector<std::string>& at, std::string& problem) {
  constexpr std::string_view such_that = " such that ";
  const std::size_t middle = text.find(such_that);
  const bool is_max = text.starts_with("max ");
  if (middle == std::string::npos || middle < 5 || (!is_max && !text.starts_with("min ")))
    return problem = json::quote(text) + " is no question: expected \"max FACTOR such that CONDITION\" or \"min ...\"", std::nullopt;
  Question question;
  question.is_max = is_max;
  const auto factor = factor_named(plan, text.substr(4, middle - 4), problem);
  if (!factor) return std::nullopt;
  question.factor = *factor;
  const std::vector<Level>& levels = plan.factors[*factor].levels;
  if (!std::all_of(levels.begin(), levels.end(), [](const Level& level) { return level.number.has_value(); }))
    return problem = "the levels of " + plan.factors[*factor].name + " are no numbers, so there is neither a greatest nor a least", std::nullopt;
  if (levels.empty()) return problem = "the factor " + plan.factors[*factor].name + " has no levels: give its range \"step\" or \"steps\"", std::nullopt;
  question.levels.resize(levels.size());
  std::iota(question.levels.begin(), question.levels.end(), 0u);
  std::stable_sort(question.levels.begin(), question.levels.end(), [&](std::uint32_t a, std::uint32_t b) { return *levels[a].number < *levels[b].number; });
  question.condition = Expression::parse(text.substr(middle + such_that.size()), problem);
  if (!question.condition) return problem = "not a condition: " + problem, std::nullopt;
  for (const std::string& name : question.condition->names())
    if (!know_name(plan, name, problem)) return std::nullopt;
  for (const PlannedFactor& other : plan.factors) question.variant.push_back(static_cast<std::uint32_t>(other.baseline));
  for (const std::string& setting : at)
    if (!set_level(plan, setting, question.variant, problem)) return std::nullopt;
  return question;
}

Finding find(const Plan& plan, const Question& question, const RunOptions& options) { return Search(plan, question, options).run(); }

std::string text_of(const Plan& plan, const Question& question, const Finding& finding) {
  const PlannedFactor& factor = plan.factors[question.factor];
  std::string text;
  for (std::size_t f = 0; f < plan.factors.size(); ++f)
    if (f != question.factor) text += fmt::format("{}{} = {}", text.empty() ? "with " : ", ", plan.factors[f].name, plan.level_of(question.variant, f).text);
  if (!text.empty()) text += "\n";
  for (const Finding::Tried& tried : finding.tried) {
    text += fmt::format("  {} = {:<12} holds in {} of {} runs", factor.name, factor.levels[tried.level].text, tried.held, tried.runs);
    text += tried.trouble.empty() ? "\n" : "; " + tried.trouble.substr(0, tried.trouble.find('\n')) + "\n";
  }
  if (finding.interrupted) return text + "interrupted\n";
  if (!finding.level) return text + fmt::format("{} does not hold at the {} level already\n", question.condition->text(), question.is_max ? "least" : "greatest");
  text += fmt::format("{} {} such that {}: {}{}\n", question.is_max ? "max" : "min", factor.name, question.condition->text(), factor.levels[*finding.level].text,
                      finding.is_at_end ? " (the end of the range: it holds everywhere that was tried)" : "");
  text += fmt::format("With 95 % confidence at most {:.2g} % of seeds break it there.{}\n", 100 * finding.worst_share,
                      finding.is_monotone ? "" : " It holds again beyond where it broke: the answer is where it breaks first among what was tried.");
  return text;
}

}  // namespace takt::study
