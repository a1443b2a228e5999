#include "scenario/figures/requirement.hpp"

#include <algorithm>

#include "json/quantity.hpp"
#include "json/suggest.hpp"
#include "models/ethernet/frame.hpp"
#include "scenario/figures/known_figures.hpp"
#include "scenario/figures/requirement_rules.hpp"
#include "scenario/resolve/known_names.hpp"

namespace takt::scenario {
namespace {

template <class Rows>
std::vector<std::string_view> names_of(const Rows& rows) {
  std::vector<std::string_view> names;
  for (const auto& row : rows) names.push_back(row.name);
  return names;
}

std::vector<std::string_view> names_of(const Resolved& resolved, std::string_view kind) {
  if (kind == "stream") return names_of(resolved.plan.streams);
  if (kind == "program") return names_of(resolved.programs);
  if (kind == "application") return names_of(resolved.applications);
  if (kind == "signal") return names_of(resolved.signals);
  if (kind == "node") return names_of(resolved.topology.nodes);
  std::vector<std::string_view> reasons;
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(models::DropReason::count); ++i) reasons.emplace_back(models::name_of(static_cast<models::DropReason>(i)));
  return reasons;
}

/// "/streams/*/latency_ps/max (mean)": the pointer and what else says which values are meant.
std::string name_of(const Requirement& requirement) {
  std::string more;
  const auto add = [&](const std::string& text) { more += (more.empty() ? "" : ", ") + text; };
  if (requirement.take)
    for (const json::EnumName& name : describe(json::Type<Take>{}).names)
      if (name.value == static_cast<std::int64_t>(*requirement.take)) add(std::string(name.name));
  for (const auto& [key, value] : requirement.only) add(key + " = " + (value.node.kind == json::Kind::string ? value.node.text : json::compact(value.node)));
  return *requirement.figure + (more.empty() ? "" : " (" + more + ")");
}

}  // namespace

std::optional<UnknownName> unknown_name(const Figure& figure, const Resolved& resolved) {
  const Lookup lookup = look_up(figure.steps);
  if (lookup.figures.empty()) return std::nullopt;
  const std::vector<std::string> pattern = steps_of(lookup.figures.front()->pattern);
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const std::string_view kind = placeholder_of(pattern[i]);
    if (kind.empty() || figure.steps[i] == "*") continue;
    const std::vector<std::string_view> names = names_of(resolved, kind);
    if (std::find(names.begin(), names.end(), figure.steps[i]) == names.end())
      return UnknownName{std::string(kind), figure.steps[i], json::suggest(figure.steps[i], names)};
  }
  return std::nullopt;
}

std::optional<FigureRequirement> read_figure_requirement(const Requirement& requirement, json::Diagnostics& diagnostics) {
  const auto figure =
      read_figure({requirement.where, "figure", *requirement.figure, requirement.only, requirement.take, requirement.unit.value_or(""), false}, diagnostics);
  const bool is_upper = requirement.at_most.has_value();
  const std::optional<json::Any>& bound = is_upper ? requirement.at_most : requirement.equal ? requirement.equal : requirement.at_least;
  if (!bound) {
    diagnostics.error(requirement.where.place(), "missing key", {"\"figure\" without a limit", "\"at_most\", \"at_least\" or \"equal\""});
    return std::nullopt;
  }
  if (requirement.within && !requirement.equal)
    diagnostics.error(requirement.where.at("within"), "does not belong to this requirement", {"\"within\" without \"equal\"", "\"within\" beside \"equal\""});
  if (!figure) return std::nullopt;
  const json::Place place = requirement.where.at(is_upper ? "at_most" : requirement.equal ? "equal" : "at_least");
  if (figure->is_time && !requirement.unit && bound->node.kind == json::Kind::number) {
    diagnostics.error(place, "a time without a unit", {json::excerpt(bound->node), "a duration such as \"7ms\", or \"unit\" beside it"});
    return std::nullopt;
  }
  auto limit = read_limit(*figure, is_upper ? Relation::at_most : requirement.equal ? Relation::equal : Relation::at_least, bound->node, place, diagnostics);
  if (!limit) return std::nullopt;
  if (requirement.within && requirement.equal) {
    if (figure->is_time && !requirement.unit && !requirement.within->time) {
      diagnostics.error(requirement.where.at("within"), "a time without a unit", {"a number", "a duration such as \"7ms\", or \"unit\" beside it"});
      return std::nullopt;
    }
    if (!read_tolerance(*figure, *requirement.within, *limit, requirement.where.at("within"), diagnostics)) return std::nullopt;
  }
  return FigureRequirement{*figure, *limit, name_of(requirement)};
}

namespace {

/// Whether the name may be that of something that was refused.
bool may_be_refused(const UnknownName& unknown, const Resolved& resolved, const json::Diagnostics& diagnostics) {
  if (!diagnostics.has_errors()) return false;
  const Scenario& scenario = resolved.scenario;
  const auto is_refused = [&](std::string_view list) { return diagnostics.is_refused(scenario.where.at(list)); };
  if (unknown.kind == "stream") return StreamNames(resolved, diagnostics).may_be(unknown.name);
  if (unknown.kind == "node") return !resolved.topology.has_all_nodes;
  if (unknown.kind == "program")
    return may_be_unread_program(scenario, diagnostics) || std::any_of(scenario.programs.begin(), scenario.programs.end(), [&](const Program& program) { return program.name == unknown.name; });
  return (unknown.kind == "application" || unknown.kind == "signal") && (is_refused("applications") || is_refused("gateways") || is_refused("persistence"));
}

}  // namespace

bool check_figure(const Resolved& resolved, const Requirement& requirement, json::Diagnostics& diagnostics) {
  const auto refuse = [&](bool is_there, std::string_view key, const char* expected) {
    if (is_there) diagnostics.error(requirement.where.at(key), "does not belong to this requirement", {json::quote(key), expected});
  };
  if (!requirement.figure) {
    const char* const other = "a requirement with \"figure\"";
    refuse(!requirement.only.empty(), "only", other);
    refuse(requirement.take.has_value(), "take", other);
    refuse(requirement.unit.has_value(), "unit", other);
    refuse(requirement.at_most.has_value(), "at_most", other);
    refuse(requirement.at_least.has_value(), "at_least", other);
    refuse(requirement.equal.has_value(), "equal", other);
    return true;
  }
  const auto asked = read_figure_requirement(requirement, diagnostics);
  const char* const expected = "\"only\", \"take\", \"unit\", \"at_most\", \"at_least\" or \"equal\" beside \"figure\"";
  for (const auto& [is_there, key] : {std::pair(requirement.program.has_value(), "program"),
                                      std::pair(requirement.tree, "tree"), std::pair(requirement.latency.has_value(), "latency"),
                                      std::pair(requirement.jitter.has_value(), "jitter"), std::pair(requirement.dropped.has_value(), "dropped"),
                                      std::pair(requirement.delivered.has_value(), "delivered"), std::pair(requirement.node.has_value(), "node"),
                                      std::pair(requirement.thread.has_value(), "thread"), std::pair(requirement.success.has_value(), "success"),
                                      std::pair(requirement.buffered.has_value(), "buffered"), std::pair(requirement.irregular.has_value(), "irregular")})
    refuse(is_there, key, expected);
  if (!asked) return false;
  const Duration from = counts_from(resolved.scenario, requirement);
  const Lookup lookup = look_up(asked->figure.steps);
  if (from > Duration() && std::any_of(lookup.figures.begin(), lookup.figures.end(), [](const KnownFigure* figure) { return figure->is_of_whole_run; }))
    diagnostics.error(requirement.where.at("figure"), "counts from the start of the run only",
                      {json::quote(*requirement.figure) + " from " + json::to_text(from) + " on" + (requirement.after ? "" : ", the scenario's \"warm_up\""), "\"after\": \"0s\" in this requirement"});
  if (const auto unknown = unknown_name(asked->figure, resolved))
    diagnostics.error_unless(may_be_refused(*unknown, resolved, diagnostics), requirement.where.at("figure"), "unknown " + unknown->kind, {json::quote(unknown->name), "the name of a " + unknown->kind, unknown->suggestion});
  return false;
}

}  // namespace takt::scenario
