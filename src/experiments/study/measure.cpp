// SPDX-License-Identifier: Apache-2.0
#include "study/measure.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "json/suggest.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::study {
namespace {

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  }) && !(text.front() >= '0' && text.front() <= '9');
}

constexpr std::array<std::string_view, 4> basis_names = {"run", "worst", "bound", "verdict"};

}  // namespace

std::string_view name_of(Basis basis) { return basis_names[static_cast<std::size_t>(basis)]; }

std::optional<Basis> basis_named(std::string_view name) {
  const auto found = std::find(basis_names.begin(), basis_names.end(), name);
  return found == basis_names.end() ? std::nullopt : std::optional(static_cast<Basis>(found - basis_names.begin()));
}

bool has_worst_case(const scenario::Figure& figure) {
  if (figure.take != Take::max) return false;
  if (scenario::latency_of(figure)) return figure.steps.back() == "max";
  return scenario::reaction_of(figure).has_value();
}

std::optional<PlannedMeasure> plan_study_measure(const Measure& measure, json::Diagnostics& diagnostics) {
  if (measure.of == "verdict") {
    auto planned = plan_measure(measure, diagnostics);
    if (planned) planned->basis = Basis::verdict;
    return planned;
  }
  for (const Basis basis : {Basis::worst, Basis::bound}) {
    const std::string beginning = std::string(name_of(basis)) + ".";
    if (!measure.of.starts_with(beginning)) continue;
    Measure of_run = measure;
    of_run.of = measure.of.substr(beginning.size());
    auto planned = plan_measure(of_run, diagnostics);
    if (!planned) return std::nullopt;
    planned->basis = basis;
    if (has_worst_case(*planned)) return planned;
    diagnostics.error(measure.where.at("of"), "a figure without a worst case",
                      {json::quote(measure.of), beginning + "reaction.KIND.max, " + beginning +
                                                    "latency.STREAM.max or " + beginning + "latency.max"});
    return std::nullopt;
  }
  return plan_measure(measure, diagnostics);
}

std::optional<PlannedMeasure> plan_measure(const Measure& measure, json::Diagnostics& diagnostics) {
  const bool has_name = is_name(measure.name);
  if (!has_name)
    diagnostics.error(measure.where.at("name"), "not a name for a measure",
                      {json::quote(measure.name), "letters, digits and _, a letter first"});
  const auto take = measure.where.has("take") || measure.take != Take::max ? std::optional(measure.take) : std::nullopt;
  const auto figure =
      scenario::read_figure({measure.where, "of", measure.of, measure.only, take, measure.unit}, diagnostics);
  return figure && has_name ? std::optional(PlannedMeasure{*figure, measure.name}) : std::nullopt;
}

std::optional<PlannedMeasure> plan_scheduling_measure(const Measure& measure, json::Diagnostics& diagnostics) {
  std::vector<std::string_view> names;
  std::string listed;
  for (const SchedulingFigure& figure : scheduling_figures()) {
    names.push_back(figure.name);
    listed += (listed.empty() ? "" : ", ") + std::string(figure.name);
  }
  const bool is_known = std::find(names.begin(), names.end(), measure.of) != names.end();
  if (!is_name(measure.name))
    diagnostics.error(measure.where.at("name"), "not a name for a measure",
                      {json::quote(measure.name), "letters, digits and _, a letter first"});
  if (!is_known)
    diagnostics.error(measure.where.at("of"), "not a figure of a schedule",
                      {json::quote(measure.of), "one of " + listed, json::suggest(measure.of, names)});
  if (!measure.only.empty())
    diagnostics.error(measure.where.at("only"), "nothing to choose from",
                      {"\"only\" of a figure of a schedule", "none, since each point has one"});
  if (!is_known || !is_name(measure.name)) return std::nullopt;
  PlannedMeasure planned;
  planned.name = measure.name;
  planned.steps = {measure.of};
  planned.unit = measure.unit;
  planned.divisor = measure.unit == "%" ? 0.01 : 1;
  return planned;
}

std::optional<PlannedLimit> plan_limit(const Limit& limit, const std::vector<PlannedMeasure>& measures,
                                       json::Diagnostics& diagnostics) {
  const bool is_upper = limit.at_most.has_value();
  const std::optional<Value>& bound = is_upper ? limit.at_most : limit.at_least;
  const auto found =
      std::find_if(measures.begin(), measures.end(), [&](const PlannedMeasure& m) { return m.name == limit.measure; });
  if (found == measures.end()) {
    std::vector<std::string_view> names;
    for (const PlannedMeasure& m : measures) names.push_back(m.name);
    diagnostics.error(limit.where.at("measure"), "unknown measure",
                      {json::quote(limit.measure), "the name of a measure", json::suggest(limit.measure, names)});
    return std::nullopt;
  }
  if (!bound) return std::nullopt;  // reported by the table
  auto read = scenario::read_limit(*found, is_upper ? scenario::Relation::at_most : scenario::Relation::at_least,
                                   bound->node, limit.where.at(is_upper ? "at_most" : "at_least"), diagnostics);
  if (!read) return std::nullopt;
  PlannedLimit planned{*read, static_cast<std::size_t>(found - measures.begin())};
  planned.text = found->name + (is_upper ? " <= " : " >= ") + read->text;
  return planned;
}

}  // namespace takt::study
