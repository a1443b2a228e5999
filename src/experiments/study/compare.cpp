// SPDX-License-Identifier: Apache-2.0
#include "study/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "json/record.hpp"
#include "output/text_report.hpp"
#include "scenario/resolve.hpp"
#include "study/magnitude.hpp"
#include "study/pool.hpp"

namespace takt::study {
namespace {

constexpr const char* compared_figures[] = {"reaction.start.max",
                                            "reaction.suspend.max",
                                            "reaction.resume.max",
                                            "reaction.halt.max",
                                            "reaction.reset.max",
                                            "latency.max",
                                            "latency.p99",
                                            "latency.mean",
                                            "dropped",
                                            "delivered",
                                            "violations",
                                            "sync",
                                            "queue",
                                            "utilisation",
                                            "verdict"};

/// NaN: it has none.
double figure_of(const Outcome& outcome, std::size_t m) {
  return m < outcome.values.size() ? outcome.values[m].value_or(NAN) : NAN;
}

ComparedMeasure compared(const PlannedMeasure& measure, std::size_t m, const std::vector<Outcome>& a,
                         const std::vector<Outcome>& b) {
  ComparedMeasure result{measure.name, measure.unit, {}, {}, {}, 0};
  std::vector<double> of_a;
  std::vector<double> of_b;
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double left = figure_of(a[i], m);
    const double right = figure_of(b[i], m);
    if (!std::isnan(left)) of_a.push_back(left);
    if (!std::isnan(right)) of_b.push_back(right);
    if (!std::isnan(left) && !std::isnan(right)) differences.push_back(right - left);
    result.unpaired += std::isnan(left) != std::isnan(right) ? 1 : 0;
  }
  result.a = summary_of(of_a);
  result.b = summary_of(of_b);
  result.difference = summary_of(differences);
  return result;
}

std::optional<Divergence> divergence_of(const Plan& a, const Plan& b, std::uint64_t seed, const RunOptions& options) {
  json::Diagnostics diagnostics;
  auto first = scenario_of(a, {}, seed, diagnostics);
  auto second = scenario_of(b, {}, seed, diagnostics);
  if (!first || !second) return std::nullopt;
  const auto left = scenario::resolve(std::move(*first), diagnostics);
  const auto right = scenario::resolve(std::move(*second), diagnostics);
  if (!left || !right) return std::nullopt;
  auto divergence = first_divergence(*left, *right, options.interrupted);
  if (divergence) divergence->seed = seed;
  return divergence;
}

std::string interval(const Summary& summary) {
  if (summary.count == 0) return "-";
  if (!summary.half_width) return short_number(summary.mean);
  return fmt::format("{} +- {}", short_number(summary.mean), short_number(*summary.half_width));
}

/// What the interval of the difference says; "" if nothing can be said.
std::string verdict_of(const ComparedMeasure& measure) {
  const Summary& d = measure.difference;
  if (d.count > 0 && d.min == 0 && d.max == 0) return "the same";
  if (!d.half_width) return "";
  if (std::abs(d.mean) <= *d.half_width) return "no difference shown";
  return d.mean > 0 ? "B is greater" : "B is less";
}

bool has_values(const Summary& summary) { return summary.count > 0; }

}  // namespace

Plan plain_plan(json::Document base, std::uint32_t replications, std::uint64_t first_seed) {
  Plan plan{{}, std::move(base), {}, {}, {}, {Variant()}, {}, 0, false};
  plan.study.replications = {replications, first_seed};
  json::Diagnostics none;
  for (const char* const figure : compared_figures) {
    Measure measure;
    measure.name = "figure";
    measure.of = figure;
    auto planned = plan_measure(measure, none);
    planned->name = figure;
    plan.measures.push_back(std::move(*planned));
  }
  return plan;
}

Comparison compare(const Plan& a, const Plan& b, const RunOptions& options) {
  Comparison comparison;
  const std::uint32_t pairs = a.study.replications.count;
  std::vector<Outcome> outcomes[2] = {std::vector<Outcome>(pairs), std::vector<Outcome>(pairs)};
  std::uint64_t next = 0;
  std::uint64_t done = 0;
  Pool pool(options.jobs, {a.study.effort.cpu, a.study.effort.memory.count},
            [&](std::uint64_t job) { return packed(run_point(job % 2 == 0 ? a : b, job / 2)); });
  comparison.problem = pool.run(
      [&]() -> std::optional<std::uint64_t> {
        return next < 2 * std::uint64_t{pairs} ? std::optional(next++) : std::nullopt;
      },
      [&](std::uint64_t job, const Answer& answer) {
        const auto outcome = answer.kind == Answer::Kind::answered ? unpacked(answer.text) : std::nullopt;
        Outcome& kept = outcomes[job % 2][job / 2];
        if (outcome)
          kept = *outcome;
        else
          kept.status = Status::failed, kept.error = answer.text;
        if (kept.status != Status::done && comparison.troubles.size() < 10)
          comparison.troubles.push_back(
              fmt::format("{} with seed {}: {}", job % 2 == 0 ? "A" : "B", a.seed_of(job / 2), kept.error));
        ++done;
        return true;
      },
      [&] {
        if (options.progress) options.progress("running", done, 2 * std::uint64_t{pairs});
        comparison.interrupted = options.interrupted && options.interrupted();
        return !comparison.interrupted;
      });
  if (comparison.interrupted || !comparison.problem.empty()) return comparison;
  comparison.pairs = pairs;
  std::optional<std::uint64_t> differing_seed;
  for (std::uint32_t i = 0; i < pairs; ++i) {
    const bool are_done = outcomes[0][i].status == Status::done && outcomes[1][i].status == Status::done;
    const bool is_same = are_done && outcomes[0][i].digest == outcomes[1][i].digest;
    comparison.same_digest += is_same ? 1 : 0;
    if (are_done && !is_same && !differing_seed) differing_seed = a.seed_of(i);
  }
  for (std::size_t m = 0; m < a.measures.size(); ++m) {
    ComparedMeasure measure = compared(a.measures[m], m, outcomes[0], outcomes[1]);
    if (measure.a.count + measure.b.count > 0) comparison.measures.push_back(std::move(measure));
  }
  if (differing_seed) comparison.divergence = divergence_of(a, b, *differing_seed, options);
  return comparison;
}

std::string text_of(const Comparison& comparison) {
  std::string text = fmt::format("A: {}\nB: {}\n{} pairs of runs with the same seeds, {} of them the same run\n",
                                 comparison.a, comparison.b, comparison.pairs, comparison.same_digest);
  std::array<std::size_t, 4> widths = {19, 1, 1, 5};  // of the titles
  for (const ComparedMeasure& m : comparison.measures) {
    widths[0] = std::max(widths[0], m.name.size() + (m.unit.empty() ? 0 : m.unit.size() + 1));
    for (const auto& [column, summary] : {std::pair(1, &m.a), std::pair(2, &m.b), std::pair(3, &m.difference)})
      widths[static_cast<std::size_t>(column)] =
          std::max(widths[static_cast<std::size_t>(column)], interval(*summary).size());
  }
  text += fmt::format("\n{:<{}}  {:>{}}  {:>{}}  {:>{}}\n", "mean, 95 % interval", widths[0], "A", widths[1], "B",
                      widths[2], "B - A", widths[3]);
  for (const ComparedMeasure& m : comparison.measures) {
    const std::string name = m.name + (m.unit.empty() ? "" : " " + m.unit);
    text += fmt::format("{:<{}}  {:>{}}  {:>{}}  {:>{}}", name, widths[0], interval(m.a), widths[1], interval(m.b),
                        widths[2], interval(m.difference), widths[3]);
    const std::string verdict = verdict_of(m);
    if (!verdict.empty()) text += "  " + verdict;
    text += m.unpaired > 0
                ? fmt::format("{}in {} pairs only one run has it\n", verdict.empty() ? "  " : "; ", m.unpaired)
                : "\n";
  }
  for (const std::string& trouble : comparison.troubles) text += "without a result: " + trouble + "\n";
  if (!comparison.divergence) return text;
  constexpr std::size_t most = 8;
  text += fmt::format("\nWith seed {} the runs diverge at {}\n", comparison.divergence->seed,
                      output::readable(comparison.divergence->at.since_start()));
  for (const auto& [name, side] :
       {std::pair("A", &comparison.divergence->only_a), std::pair("B", &comparison.divergence->only_b)}) {
    for (std::size_t i = 0; i < std::min(most, side->size()); ++i)
      text += fmt::format("  only in {}: {}\n", name, (*side)[i]);
    if (side->size() > most) text += fmt::format("  only in {}: {} more\n", name, side->size() - most);
  }
  return text;
}

const json::Record& describe(json::Type<Summary>) {
  static constexpr std::string_view any = "if any run has the figure";
  static constexpr json::Output outputs[] = {
      json::output<&Summary::count>("count", "How many runs, or pairs, have it."),
      json::only_if<&has_values>(json::output<&Summary::mean>("mean", "Of them."), any),
      json::only_if<&has_values>(json::output<&Summary::min>("min", "The least."), any),
      json::only_if<&has_values>(json::output<&Summary::max>("max", "The greatest."), any),
      json::output_if_any<&Summary::half_width>(
          "half_width_95", "Half of the two-sided 95 % confidence interval of the mean.", "of two values or more"),
  };
  static constexpr json::Record record{"summary", "A figure over several runs, in its unit.", outputs};
  return record;
}

const json::Record& describe(json::Type<ComparedMeasure>) {
  static constexpr json::Output outputs[] = {
      json::output<&ComparedMeasure::unit>("unit", "Of all its figures; empty: a number."),
      json::output<&ComparedMeasure::a>("a", "Of the runs of A."),
      json::output<&ComparedMeasure::b>("b", "Of the runs of B."),
      json::output<&ComparedMeasure::difference>("difference", "B less A, of each pair in which both have the figure."),
      json::output<&ComparedMeasure::unpaired>("unpaired", "Pairs in which only one has it."),
  };
  static constexpr json::Record record{"measure", "A figure that is compared.", outputs};
  return record;
}

const json::Record& describe(json::Type<Divergence>) {
  static constexpr json::Output outputs[] = {
      json::output<&Divergence::seed>("seed", "The first whose runs differ."),
      json::output<&Divergence::at>("at_ps", "The first instant at which not the same happens in both."),
      json::output<&Divergence::only_a>("only_a", "What happens then in A only."),
      json::output<&Divergence::only_b>("only_b", "What happens then in B only."),
  };
  static constexpr json::Record record{"divergence", "Where two runs diverge.", outputs};
  return record;
}

const json::Record& describe(json::Type<Comparison>) {
  static constexpr json::Output outputs[] = {
      json::output<&Comparison::behaviour>("behaviour", "The number of behaviour of the takt that ran both."),
      json::output<&Comparison::a>("a", "The file, and what was set in it."),
      json::output<&Comparison::b>("b", "The other one."),
      json::output<&Comparison::pairs>("pairs", "Pairs of runs, each with one seed for both."),
      json::output<&Comparison::same_digest>("same_digest", "Those that are the same run."),
      json::outputs_by_name<&Comparison::measures, &ComparedMeasure::name>("measures", "Those that any run has.",
                                                                           {.keys = "measure"}),
      json::output<&Comparison::troubles>("troubles", "Runs without a result, and why: the first ten."),
      json::output<&Comparison::divergence>("divergence", "Null if no runs differ."),
  };
  static constexpr json::Record record{"comparison", "Is B better than A, and by how much?", outputs};
  return record;
}

}  // namespace takt::study
