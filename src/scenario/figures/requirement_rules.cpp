#include "scenario/figures/requirement_rules.hpp"

#include <algorithm>
#include <vector>

#include "json/quantity.hpp"
#include "scenario/figures/known_figures.hpp"

namespace takt::scenario {
namespace {

/// Whether the figure, which is limited, says how many frames of the stream may be lost.
bool limits_losses(const Requirement& requirement, const std::string& stream) {
  const std::string& figure = *requirement.figure;
  const bool bounds_above = requirement.at_most || requirement.equal;
  if (figure == "dropped" || figure == "lost") return bounds_above;
  const std::vector<std::string> steps = steps_of(figure);
  if (steps.size() == 2 && steps[0] == "dropped") return bounds_above && steps[1] == "*";
  if (steps.size() < 3 || steps[0] != "streams" || (steps[1] != stream && steps[1] != "*")) return false;
  // Of all streams together, much of one may make up for little of another.
  const bool is_of_each = steps[1] != "*" || requirement.take == Take::min;
  if (steps[2] == "delivered") return is_of_each && (requirement.at_least || requirement.equal);
  if (!bounds_above || requirement.take == Take::min || requirement.take == Take::mean || requirement.take == Take::count) return false;
  return steps[2] == "lost" || (steps[2] == "dropped" && steps.size() == 4 && steps[3] == "*");
}

}  // namespace

Duration counts_from(const Scenario& scenario, const Requirement& requirement) { return requirement.after.value_or(scenario.warm_up); }

bool requires_losses_separately(const Scenario& scenario, const std::string& stream, std::optional<Duration> from) {
  return std::any_of(scenario.require.begin(), scenario.require.end(), [&](const Requirement& requirement) {
    if (from && counts_from(scenario, requirement) > *from) return false;
    if (requirement.stream == stream) return requirement.dropped.has_value() || requirement.delivered.has_value();
    return requirement.figure && limits_losses(requirement, stream);
  });
}

std::string text_of(const DurationLimit& limit) {
  if (!limit.equal) return "at most " + json::to_text(limit.greatest());
  return json::to_text(*limit.equal) + (limit.within ? " within " + json::to_text(*limit.within) : "");
}

}  // namespace takt::scenario
