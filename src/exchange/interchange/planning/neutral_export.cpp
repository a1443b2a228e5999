// SPDX-License-Identifier: Apache-2.0
// The neutral problem, times in ps. What it does not say and a run needs stands under a key of its own, which other
// readers pass over.
#include "interchange/planning/planning.hpp"
#include "schedule_instances/write.hpp"
#include "json/fields.hpp"

namespace takt::interchange {

Exported export_neutral(const ExportRequest& request) {
  Exported exported;
  const PlanningProblem made = problem_of(request.resolved, exported);
  json::Node node = schedule_instances::write_problem(made.problem);
  node.add("takt", json::encode_value(made.extras));
  if (!exported.losses.empty()) {
    json::Node& losses = node.add("cannot_be_said", json::Node::array());
    for (const Loss& loss : exported.losses)
      losses.items.push_back(json::Node::of_string(loss.where + ": " + loss.what));
  }
  exported.files.push_back({request.resolved.scenario.name + ".problem.json", json::pretty(node)});
  return exported;
}

}  // namespace takt::interchange
