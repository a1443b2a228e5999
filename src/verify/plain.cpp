#include "verify/plain.hpp"

#include "analysis/figure_bound.hpp"
#include "scenario/figures/requirement.hpp"
#include "sim/check.hpp"

namespace takt::verify {

results::RequirementResult plain(const scenario::Scenario& scenario, const results::RequirementResult& requirement) {
  results::RequirementResult made = requirement;
  if (requirement.kind != results::RequirementKind::figure || !requirement.requirement) return made;
  json::Diagnostics diagnostics;
  const auto asked = scenario::read_figure_requirement(scenario.require[*requirement.requirement], diagnostics);
  TAKT_CHECK(asked, "a requirement that was resolved has a figure");
  const bool is_greatest = asked->figure.take == scenario::Take::max && asked->limit.is_upper();
  if (const std::optional<std::string> stream = analysis::latency_of(asked->figure)) {
    made.subject = *stream;
    if (is_greatest && asked->figure.steps.back() == "max") made.kind = results::RequirementKind::latency;
  } else if (const std::optional<scenario::Requirement> reaction = analysis::reaction_of(asked->figure)) {
    made.subject = reaction->program.value_or("");
    made.reaction = scenario::spelling(*reaction->reaction);
    made.of_tree = reaction->tree;
    if (is_greatest) made.kind = results::RequirementKind::reaction;
  }
  return made;
}

}  // namespace takt::verify
