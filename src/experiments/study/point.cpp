// SPDX-License-Identifier: Apache-2.0
#include "study/point.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/division/division.hpp"
#include "scenario/resolve.hpp"
#include "scenario/division/divided_run.hpp"
#include "scenario/run/run.hpp"
#include "scenario/figures/graph_figures.hpp"
#include "study/cpu_time.hpp"
#include "study/verified.hpp"

namespace takt::study {
namespace {

constexpr std::array<std::string_view, 5> status_names = {"done", "impossible", "too-long", "too-large", "failed"};

bool asks_for_topology(const Plan& plan) {
  return std::any_of(plan.measures.begin(), plan.measures.end(),
                     [](const PlannedMeasure& m) { return m.steps.front() == "topology"; });
}

Outcome impossible(const json::Diagnostics& diagnostics) {
  Outcome outcome;
  outcome.status = Status::impossible;
  outcome.error = diagnostics.to_text();
  while (outcome.error.ends_with('\n')) outcome.error.pop_back();
  return outcome;
}

results::RunResult result_of(const scenario::Resolved& resolved, unsigned threads) {
  if (const scenario::Division division = scenario::divide(resolved, threads); division.is_divided()) {
    scenario::DividedRun run(resolved, division);
    run.advance(run.end());
    return evaluation::evaluate(run.gathered(), false);
  }
  scenario::Run run(resolved);
  run.advance();
  return evaluation::evaluate(run, false);
}

bool keeps_limits(const Plan& plan, const Outcome& outcome) {
  return std::all_of(plan.limits.begin(), plan.limits.end(),
                     [&](const PlannedLimit& limit) { return limit.holds(outcome.values[limit.measure]); });
}

/// What a verification of the variant adds to the outcome of its run.
void add_verification(const Plan& plan, const scenario::Scenario& scenario, const scenario::Scenario& ran,
                      unsigned threads, Outcome& outcome) {
  Verified verified = verify_variant(plan, scenario, ran, outcome.values,
                                     outcome.verdict == results::name_of(results::Verdict::fail), threads);
  if (!verified.contradiction.empty()) {
    outcome = {};
    outcome.status = Status::failed;
    outcome.error = "a contradiction, please report it with the study: " + verified.contradiction;
    return;
  }
  for (std::size_t m = 0; m < plan.measures.size(); ++m)
    if (plan.measures[m].basis != Basis::run) outcome.values[m] = verified.values[m];
  if (verified.is_required) outcome.verdict = verify::name_of(verified.verdict);
  const bool is_refuted = plan.study.requirements_count && verified.verdict == verify::Conclusion::refuted;
  outcome.passes = outcome.passes && !is_refuted && keeps_limits(plan, outcome);
}

class Packer {
 public:
  void number(std::uint64_t value) { text_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void text(const std::string& value) {
    number(value.size());
    text_ += value;
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

class Unpacker {
 public:
  explicit Unpacker(std::string_view text) : rest_(text) {}
  std::uint64_t number() {
    std::uint64_t value = 0;
    if (rest_.size() < sizeof value) return is_sound_ = false, 0;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  std::string text() {
    const std::uint64_t size = number();
    if (size > rest_.size()) return is_sound_ = false, std::string();
    std::string value(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return value;
  }
  bool is_sound() const { return is_sound_; }
  bool is_at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  bool is_sound_ = true;
};

}  // namespace

std::string_view name_of(Status status) { return status_names[static_cast<std::size_t>(status)]; }

std::optional<Status> status_named(std::string_view name) {
  const auto found = std::find(status_names.begin(), status_names.end(), name);
  return found == status_names.end() ? std::nullopt : std::optional(static_cast<Status>(found - status_names.begin()));
}

Outcome run_scenario(const Plan& plan, const scenario::Scenario& scenario, unsigned threads) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(scenario, diagnostics);
  if (!resolved) return impossible(diagnostics);
  const results::RunResult result = result_of(*resolved, threads);
  json::Node node = results::run_node(result);
  if (asks_for_topology(plan)) node.add("topology", topology_node(*resolved));
  Outcome outcome;
  outcome.verdict = result.nothing_required ? results::nothing_was_required : results::name_of(result.verdict);
  outcome.digest = result.digest;
  outcome.events = result.events;
  for (const PlannedMeasure& measure : plan.measures) outcome.values.push_back(value_of(measure, node));
  outcome.passes =
      (!plan.study.requirements_count || result.verdict == results::Verdict::pass) && keeps_limits(plan, outcome);
  return outcome;
}

Outcome run_variant(const Plan& plan, const Variant& variant, std::uint64_t seed, unsigned threads) {
  json::Diagnostics diagnostics;
  const auto scenario = scenario_of(plan, variant, seed, diagnostics);
  if (!scenario) return impossible(diagnostics);
  if (!plan.study.schedule) {
    Outcome outcome = run_scenario(plan, *scenario, threads);
    if (outcome.status == Status::done && plan.is_verified())
      if (const auto undrawn = undrawn_scenario_of(plan, variant, seed, diagnostics))
        add_verification(plan, *undrawn, *scenario, threads, outcome);
    return outcome;
  }
  const auto scheduling = scheduling_of(plan, variant, diagnostics);
  const auto resolved = scheduling ? scenario::resolve(*scenario, diagnostics) : nullptr;
  if (resolved) check_scheduling(*resolved, *scheduling, diagnostics);
  if (!resolved || diagnostics.has_errors()) return impossible(diagnostics);
  const Scheduled made = schedule_point(drawn_problem(*resolved, *scheduling, seed), *scheduling, seed, threads);
  Outcome outcome;
  outcome.verdict = made.verdict;
  outcome.digest = made.digest;
  outcome.events = made.steps;
  for (const PlannedMeasure& measure : plan.measures) outcome.values.push_back(value_of(measure, made.figures));
  outcome.passes = (!plan.study.requirements_count || made.verdict == "scheduled") && keeps_limits(plan, outcome);
  return outcome;
}

Outcome run_point(const Plan& plan, std::uint64_t point, unsigned threads) {
  const std::uint64_t began = cpu_time_us();
  Outcome outcome = run_variant(plan, plan.variants[plan.variant_of(point)], plan.seed_of(point), threads);
  outcome.cpu_us = cpu_time_us() - began;
  return outcome;
}

std::string mistakes_of(const Plan& plan, std::size_t variant) {
  json::Diagnostics diagnostics;
  check_variant(plan, plan.variants[variant], diagnostics);
  std::string text;
  for (const json::Diagnostic& diagnostic : diagnostics.sorted())
    if (diagnostic.severity == json::Severity::error) text += json::to_text(diagnostic) + "\n";
  return text;
}

std::string packed(const Outcome& outcome) {
  Packer packer;
  packer.number(static_cast<std::uint64_t>(outcome.status));
  packer.text(outcome.error);
  packer.number(outcome.passes ? 1 : 0);
  packer.text(outcome.verdict);
  packer.number(outcome.digest);
  packer.number(outcome.events);
  packer.number(outcome.cpu_us);
  packer.number(outcome.values.size());
  for (const std::optional<double>& value : outcome.values) {
    packer.number(value ? 1 : 0);
    std::uint64_t bits = 0;
    const double number = value.value_or(0);
    std::memcpy(&bits, &number, sizeof bits);
    packer.number(bits);
  }
  return packer.take();
}

std::optional<Outcome> unpacked(std::string_view text) {
  Unpacker unpacker(text);
  Outcome outcome;
  const std::uint64_t status = unpacker.number();
  outcome.status = static_cast<Status>(std::min<std::uint64_t>(status, status_names.size() - 1));
  outcome.error = unpacker.text();
  outcome.passes = unpacker.number() != 0;
  outcome.verdict = unpacker.text();
  outcome.digest = unpacker.number();
  outcome.events = unpacker.number();
  outcome.cpu_us = unpacker.number();
  for (std::uint64_t left = unpacker.number(); left > 0 && unpacker.is_sound(); --left) {
    const bool is_there = unpacker.number() != 0;
    const std::uint64_t bits = unpacker.number();
    double number = 0;
    std::memcpy(&number, &bits, sizeof number);
    outcome.values.push_back(is_there ? std::optional(number) : std::nullopt);
  }
  return unpacker.is_sound() && unpacker.is_at_end() && status < status_names.size() ? std::optional(outcome)
                                                                                     : std::nullopt;
}

}  // namespace takt::study
