// SPDX-License-Identifier: Apache-2.0
// Scheduling problems, as planners and their public instances have them, from and to scenarios.
#pragma once

#include <span>

#include "interchange/export.hpp"
#include "interchange/import.hpp"
#include "interchange/planning/extras.hpp"
#include "schedule_instances/builder.hpp"
#include "schedule/solution.hpp"

namespace takt::interchange {

struct PlanningProblem {
  schedule::Problem problem;
  PlanningExtras extras;
};

/// The network and the streams of a scenario as a problem; what it cannot say is told. Gates that takt lays out and
/// offsets that it chooses are the planner's business.
PlanningProblem problem_of(const scenario::Resolved& resolved, Exported& exported);

struct ProblemToScenario {
  const schedule_instances::Instance& instance;
  const schedule::Solution* solution = nullptr;
  const PlanningExtras* extras = nullptr;
  bool has_classes = true;   ///< the format says the class of each stream; otherwise the extras do
  bool plans_gates = false;  ///< offsets and gates are takt's to choose
};

/// The scenario of a problem; with a solution its offsets, paths and gates, too. Mistakes and remarks stand at the
/// places of the instance.
void make_scenario(const ProblemToScenario& from, Imported& imported, json::Diagnostics& diagnostics);

Exported export_neutral(const ExportRequest& request);
Exported export_tsnkit(const ExportRequest& request);

Imported import_neutral(const ImportRequest& request, json::Diagnostics& diagnostics);
Imported import_tas_benchmark(const ImportRequest& request, json::Diagnostics& diagnostics);
Imported import_tsnbench(const ImportRequest& request, json::Diagnostics& diagnostics);
Imported import_tsnkit(const ImportRequest& request, json::Diagnostics& diagnostics);
Imported import_tsnsched(const ImportRequest& request, json::Diagnostics& diagnostics);
Imported import_ecrts(const ImportRequest& request, json::Diagnostics& diagnostics);
Imported import_applications(const ImportRequest& request, json::Diagnostics& diagnostics);
extern const std::span<const SettingInfo> planning_import_settings;
extern const std::span<const SettingInfo> applications_import_settings;

}  // namespace takt::interchange
