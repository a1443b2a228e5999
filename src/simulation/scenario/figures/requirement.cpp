// SPDX-License-Identifier: Apache-2.0
#include "scenario/figures/requirement.hpp"

#include <algorithm>

#include "json/suggest.hpp"
#include "models/ethernet/frame.hpp"
#include "results/run_result.hpp"
#include "scenario/figures/known_figures.hpp"
#include "scenario/resolved/resolved.hpp"

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
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(models::DropReason::count); ++i)
    reasons.emplace_back(models::name_of(static_cast<models::DropReason>(i)));
  return reasons;
}

/// The value that the figure's "only" gives the member.
template <class E>
std::optional<E> value_in(const Figure& figure, std::string_view key) {
  for (const auto& [name, value] : figure.only)
    for (const json::EnumName& known : describe(json::Type<E>{}).names)
      if (name == key && value.kind == json::Kind::string && known.name == value.text)
        return static_cast<E>(known.value);
  return std::nullopt;
}

/// Whether the limit says how many frames of the stream may be lost, or must come.
bool limits_losses(const RequiredFigure& required, const std::string& stream) {
  const std::vector<std::string>& steps = required.figure.steps;
  const Take take = required.figure.take;
  const bool bounds_above = required.limit.relation != Relation::at_least;
  if (steps.size() == 2 && steps[0] == "dropped") return bounds_above && steps[1] == "*";
  if (steps.size() < 3 || steps[0] != "streams" || (steps[1] != stream && steps[1] != "*")) return false;
  // Of all streams together, much of one may make up for little of another.
  const bool is_of_each = steps[1] != "*" || take == Take::min;
  if (steps[2] == "misses") return true;
  if (steps[2] == "delivered") return is_of_each && required.limit.relation != Relation::at_most;
  if (!bounds_above || take == Take::min || take == Take::mean || take == Take::count) return false;
  return steps[2] == "lost" || (steps[2] == "dropped" && steps.size() == 4 && steps[3] == "*");
}

}  // namespace

std::string invariants_text(const std::string& program, bool violations_are_allowed) {
  return "program " + program + " keeps S1 to S5" + (violations_are_allowed ? " (reported only)" : "");
}

std::vector<RequirementLine> requirement_lines(const Resolved& resolved) {
  std::vector<RequirementLine> lines;
  for (const RequiredFigure& required : resolved.requirements) lines.push_back({required.name, required.text});
  for (const ResolvedProgram& program : resolved.programs)
    lines.push_back({"", invariants_text(program.name, program.description->violations == Violations::reported)});
  return lines;
}

std::string misses_name(const RequiredFigure& required) {
  using results::RequirementKind;
  if (required.kind == RequirementKind::met) return "met of any " + std::to_string(required.of);
  return required.kind == RequirementKind::lost_in_a_row ? "lost in a row" : "late in a row";
}

std::optional<AskedReaction> reaction_of(const Figure& figure) {
  const std::vector<std::string>& steps = figure.steps;
  if (steps.size() != 5 || steps[0] != "programs" || (steps[2] != "reactions" && steps[2] != "tree_reactions") ||
      steps[4] != "duration_ps")
    return std::nullopt;
  const std::optional<Reaction> kind = value_in<Reaction>(figure, "kind");
  if (!kind || figure.take == Take::count || figure.take == Take::sum) return std::nullopt;
  return AskedReaction{*kind, value_in<handshake::Cause>(figure, "cause"), steps[2] == "tree_reactions",
                       steps[1] == "*" ? std::nullopt : std::optional(steps[1])};
}

std::optional<std::string> latency_of(const Figure& figure) {
  const std::vector<std::string>& steps = figure.steps;
  const bool is_latency =
      steps.size() == 4 && steps[0] == "streams" && steps[2] == "latency_ps" && steps[3] != "stddev";
  return is_latency ? std::optional(steps[1]) : std::nullopt;
}

bool requires_losses_separately(const Resolved& resolved, const std::string& stream, std::optional<Duration> from) {
  return std::any_of(resolved.requirements.begin(), resolved.requirements.end(), [&](const RequiredFigure& required) {
    return (!from || required.from <= *from) && limits_losses(required, stream);
  });
}

std::optional<UnknownName> unknown_name(const Figure& figure, const Resolved& resolved) {
  const Lookup lookup = look_up(figure.steps);
  if (lookup.figures.empty()) return std::nullopt;
  const std::vector<std::string>& pattern = lookup.figures.front()->steps;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const std::string_view kind = placeholder_of(pattern[i]);
    if (kind.empty() || figure.steps[i] == "*") continue;
    const std::vector<std::string_view> names = names_of(resolved, kind);
    if (std::find(names.begin(), names.end(), figure.steps[i]) == names.end())
      return UnknownName{std::string(kind), figure.steps[i], json::suggest(figure.steps[i], names)};
  }
  return std::nullopt;
}

}  // namespace takt::scenario
