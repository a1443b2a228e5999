// SPDX-License-Identifier: Apache-2.0
#include "study/plan.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "scenario/figures/requirement.hpp"
#include "scenario/resolve.hpp"
#include "sim/digest.hpp"
#include "study/design.hpp"
#include "study/phases.hpp"

namespace takt::study {
namespace {

constexpr std::size_t most_to_look_at = 64;  // variants, for the sake of names in measures

std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = sim::mix64(text.size() + 0x9E3779B97F4A7C15ULL);
  for (const char c : text) hash = sim::mix64(hash ^ static_cast<unsigned char>(c)) + 0x9E3779B97F4A7C15ULL;
  return hash;
}

std::optional<json::Document> base_of(const Study& study, const std::string& path, json::Diagnostics& diagnostics) {
  if (study.scenario) {
    if (study.scenario->node.kind == json::Kind::object) return json::Document(study.scenario->node, path, "/scenario");
    diagnostics.error(study.scenario->where.place(), "not a scenario",
                      {json::excerpt(study.scenario->node), "an object"});
    return std::nullopt;
  }
  if (!study.base) return std::nullopt;  // reported by the table
  const std::filesystem::path beside = std::filesystem::path(path).parent_path() / *study.base;
  std::error_code error;
  if (!std::filesystem::is_regular_file(beside, error)) {
    diagnostics.error(study.where.at("base"), "no such scenario",
                      {beside.string(), "the path of a scenario, beside the study"});
    return std::nullopt;
  }
  return json::parse_file(beside.string(), diagnostics);
}

void check_names(const Study& study, json::Diagnostics& diagnostics) {
  std::set<std::string> names;
  for (const Factor& factor : study.factors)
    if (!names.insert(factor.name).second)
      diagnostics.error(factor.where.at("name"), "a name occurs twice",
                        {json::quote(factor.name), "names that differ"});
  for (const Measure& measure : study.measures)
    if (!names.insert(measure.name).second)
      diagnostics.error(measure.where.at("name"), "a name occurs twice",
                        {json::quote(measure.name), "names of factors and measures that differ"});
}

/// What the digest is of: all that decides what the points are and what is measured, but not what a run may take.
std::string text_of(const Study& study, const std::vector<PlannedFactor>& factors, const json::Document& base) {
  Study decisive = study;
  decisive.schema.reset();
  decisive.description.reset();
  decisive.base.reset();
  decisive.scenario.reset();
  decisive.effort = {};
  json::Node node = json::encode_value(decisive);
  // What a GraphML file says, too.
  json::Node networks = json::Node::array();
  for (std::size_t f = 0; f < factors.size(); ++f)
    if (study.factors[f].topologies)
      for (const Level& level : factors[f].levels) networks.items.push_back(level.replacements.front().value);
  if (!networks.items.empty()) node.add("networks", std::move(networks));
  node.add("scenario", base.root());
  return json::compact(node);
}

}  // namespace

std::unique_ptr<Plan> load_plan(const std::string& path, json::Diagnostics& diagnostics) {
  const auto document = json::parse_file(path, diagnostics);
  if (!document) return nullptr;
  Study study;
  json::decode(*document, study, diagnostics);
  if (!study.where.is_known()) return nullptr;
  const auto base = base_of(study, path, diagnostics);
  check_names(study, diagnostics);
  auto plan = std::make_unique<Plan>(
      Plan{study, base.value_or(json::Document(json::Node::object(), path)), {}, {}, {}, {}, {}, 0, !study.schedule});
  std::optional<std::size_t> failures;
  for (std::size_t i = 0; i < study.factors.size(); ++i) {
    plan->factors.push_back(
        plan_factor(study.factors[i], std::filesystem::path(path).parent_path().string(), diagnostics));
    if (!study.factors[i].link_failures) continue;
    if (failures)
      diagnostics.error(study.factors[i].where.at("link_failures"), "a second factor of link failures",
                        {"", "at most one; \"at_once\": 2 fails pairs of links"});
    failures = i;
  }
  for (const Measure& measure : study.measures)
    if (auto planned =
            study.schedule ? plan_scheduling_measure(measure, diagnostics) : plan_study_measure(measure, diagnostics))
      plan->measures.push_back(std::move(*planned));
  for (const Limit& limit : study.limits)
    if (auto planned = plan_limit(limit, plan->measures, diagnostics)) plan->limits.push_back(std::move(*planned));
  if (!base) return nullptr;
  expand(*plan, diagnostics);
  if (diagnostics.has_errors()) return nullptr;
  if (failures) expand_link_failures(*plan, *failures, diagnostics);
  if (plan->points() > most_points)
    diagnostics.error(study.where.place(), "too many points",
                      {fmt::format("{} variants with {} replications", plan->variants.size(), study.replications.count),
                       fmt::format("at most {}", most_points)});
  if (diagnostics.has_errors()) return nullptr;
  if (!study.schedule) check_names_of_measures(*plan, 0, diagnostics);
  if (diagnostics.has_errors()) return nullptr;
  plan->text = text_of(study, plan->factors, *base);
  plan->digest = hash_of(plan->text);
  return plan;
}

std::string name_of(const Plan& plan, const Variant& variant) {
  std::string text;
  for (std::size_t f = 0; f < plan.factors.size(); ++f)
    text += fmt::format("{}{} = {}", f == 0 ? "" : ", ", plan.factors[f].name, plan.level_of(variant, f).text);
  return text;
}

namespace {

constexpr std::string_view scheduling_root = "/schedule";

/// Of a study of schedules: the pointer leads to how points are scheduled, and not into the scenario.
bool is_of_scheduling(const Plan& plan, const std::string& pointer) {
  return plan.study.schedule && (pointer == scheduling_root || pointer.starts_with(std::string(scheduling_root) + "/"));
}

/// The base with what the levels and the seed change in it; false if that cannot be put there.
bool vary(const Plan& plan, const Variant& variant, std::uint64_t seed, json::Document& document,
          json::Diagnostics& diagnostics) {
  std::vector<json::Replacement> replacements;
  if (plan.base.root().find("faults") == nullptr)
    replacements.push_back({"/faults", json::Node::array(), "no faults", plan.study.where.place()});
  for (std::size_t f = 0; f < plan.factors.size(); ++f) {
    if (plan.factors[f].levels.empty()) continue;  // link failures that are not enumerated yet
    const Level& level = plan.level_of(variant, f);
    for (const json::Replacement& each : level.replacements)
      if (!is_of_scheduling(plan, each.pointer)) replacements.push_back(each);
  }
  replacements.push_back({"/seed", json::Node::of_integer(static_cast<sim::int128>(seed)), "replications",
                          plan.study.where.at("replications")});
  return json::replace(document, replacements, diagnostics);
}

}  // namespace

void check_variant(const Plan& plan, const Variant& variant, json::Diagnostics& diagnostics) {
  json::Document document = plan.base;
  if (!vary(plan, variant, plan.study.replications.first_seed, document, diagnostics)) return;
  scenario::Scenario scenario;
  json::decode(document, scenario, diagnostics);
  const auto scheduling = plan.study.schedule ? scheduling_of(plan, variant, diagnostics) : std::nullopt;
  // Checks of meaning run even if single values are wrong, so that all mistakes are seen at once.
  if (!scenario.network.where.is_known()) return;
  const auto resolved = scenario::resolve(std::move(scenario), diagnostics);
  if (resolved && scheduling) check_scheduling(*resolved, *scheduling, diagnostics);
}

std::optional<Scheduling> scheduling_of(const Plan& plan, const Variant& variant, json::Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  json::Document document(json::encode_value(SchedulingPart{{}, *plan.study.schedule}), plan.study.where.place().file);
  std::vector<json::Replacement> replacements;
  for (std::size_t f = 0; f < plan.factors.size(); ++f) {
    if (plan.factors[f].levels.empty()) continue;
    for (const json::Replacement& each : plan.level_of(variant, f).replacements)
      if (is_of_scheduling(plan, each.pointer)) replacements.push_back(each);
  }
  if (!json::replace(document, replacements, diagnostics)) return std::nullopt;
  SchedulingPart made;
  json::decode(document, made, diagnostics);
  if (diagnostics.errors() != errors_before) return std::nullopt;
  return made.schedule;
}

std::optional<scenario::Scenario> scenario_of(const Plan& plan, const Variant& variant, std::uint64_t seed,
                                              json::Diagnostics& diagnostics) {
  auto scenario = undrawn_scenario_of(plan, variant, seed, diagnostics);
  if (!scenario || !plan.draws_phases) return scenario;
  if (scenario->gates && scenario->gates->plan == scenario::GatePlanning::automatic) {
    // Gates are laid for the phases that the scenario gives, not for those that are drawn.
    const auto resolved = scenario::resolve(std::move(*scenario), diagnostics);
    if (!resolved) return std::nullopt;
    scenario = resolved->scenario;
  }
  return with_drawn_phases(*scenario);
}

std::optional<scenario::Scenario> undrawn_scenario_of(const Plan& plan, const Variant& variant, std::uint64_t seed,
                                                      json::Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  json::Document document = plan.base;
  if (!vary(plan, variant, seed, document, diagnostics)) return std::nullopt;
  scenario::Scenario scenario;
  json::decode(document, scenario, diagnostics);
  if (diagnostics.errors() != errors_before) return std::nullopt;
  return scenario;
}

void check_names_of_measures(const Plan& plan, std::size_t first, json::Diagnostics& diagnostics) {
  std::map<std::size_t, scenario::UnknownName> unknown;  // by measure, as long as no variant has the name
  std::set<std::pair<std::size_t, std::uint32_t>> levels_seen;
  bool is_first = true;
  std::size_t looked_at = 0;
  for (const Variant& variant : plan.variants) {
    if (!is_first && unknown.empty()) return;
    bool is_new = false;
    for (std::size_t f = 0; f < variant.size(); ++f) is_new = levels_seen.emplace(f, variant[f]).second || is_new;
    if (!is_new && plan.variants.size() > most_to_look_at) continue;
    ++looked_at;
    json::Diagnostics ignored;  // a variant that cannot be is told of when the variants are checked
    auto scenario = scenario_of(plan, variant, plan.study.replications.first_seed, ignored);
    const auto resolved = scenario ? scenario::resolve(std::move(*scenario), ignored) : nullptr;
    if (!resolved) continue;
    for (std::size_t m = first; m < plan.measures.size(); ++m) {
      if (!is_first && !unknown.contains(m)) continue;
      if (const auto name = scenario::unknown_name(plan.measures[m], *resolved))
        unknown.insert_or_assign(m, *name);
      else
        unknown.erase(m);
    }
    is_first = false;
  }
  for (const auto& [m, name] : unknown) {
    const json::Place place =
        m < plan.study.measures.size() ? plan.study.measures[m].where.at("of") : json::Place{"--find", 0, 0, ""};
    const json::Details details{json::quote(name.name), "the name of a " + name.kind + " of some variant",
                                name.suggestion};
    if (looked_at == plan.variants.size())
      diagnostics.error(place, "unknown " + name.kind, details);
    else
      diagnostics.warning(place, "unknown " + name.kind, details);
  }
}

}  // namespace takt::study
