// SPDX-License-Identifier: Apache-2.0
#include "papers/beyond.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/bounds.hpp"
#include "evaluation/evaluate.hpp"
#include "papers/charts.hpp"
#include "papers/plants.hpp"
#include "scenario/resolve.hpp"

namespace takt::papers {
namespace {

BeyondRow row_of(const Plant& plant, const scenario::Resolved& resolved, Reproduction& made) {
  scenario::Run run(resolved);
  run.advance();
  const results::RunResult result = evaluation::evaluate(run, false);
  const analysis::Bounds bounds = analysis::bound(resolved);
  BeyondRow row;
  row.variant = plant.variant;
  const results::ProgramResult& program = result.programs.front();
  const bool is_tree = resolved.programs.size() > 1;
  for (std::size_t k = 0; k < reaction_kinds; ++k) {
    ReactionCell& cell = row.reactions[k];
    for (const results::ReactionResult& reaction : is_tree ? program.tree_reactions : program.reactions) {
      if (reaction.kind != reaction_names[k] || !reaction.completed) continue;
      ++cell.reactions;
      cell.simulated = std::max(cell.simulated.value_or(sim::Duration()), *reaction.duration());
    }
    for (const analysis::ReactionBound& bound : bounds.reactions)
      if (bound.program == 0 && bound.cause == handshake::Cause::command && bound.of_tree == is_tree &&
          scenario::spelling(bound.kind) == reaction_names[k])
        cell.bound = bound.bound;
  }
  if (result.verdict != results::Verdict::pass) {
    Comparison broken;
    broken.what = "invariants in " + plant.scenario.name;
    broken.published = "hold";
    broken.reproduced = "do not";
    broken.standing = Standing::claim;
    broken.holds = false;
    made.comparisons.push_back(std::move(broken));
  }
  return row;
}

bool add(const ProgramsOptions& options, BeyondTable table, const std::vector<Plant>& plants, Reproduction& made,
         json::Diagnostics& diagnostics) {
  for (const Plant& plant : plants) {
    if (options.progress) options.progress(plant.scenario.name);
    const auto resolved = scenario::resolve(plant.scenario, diagnostics);
    if (!resolved) return false;
    table.rows.push_back(row_of(plant, *resolved, made));
    made.scenarios.emplace_back(plant.scenario.name, json::encode(plant.scenario));
  }
  made.figures.push_back({table.name, reactions_chart(table)});
  made.beyond.push_back(std::move(table));
  return true;
}

}  // namespace

bool go_beyond(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics) {
  const int rounds = options.is_short ? 40 : 400;
  return add(options, {"beyond-slaves", "Reaction time by number of slaves (one switch, cycle 200 us)", "slaves", {}},
             plants_by_slaves(rounds), made, diagnostics) &&
         add(options,
             {"beyond-topology",
              "Reaction time by topology and switches to the farthest slave (three slaves, cycle 200 us)",
              "topology",
              {}},
             plants_by_topology(rounds), made, diagnostics) &&
         add(options,
             {"beyond-nesting", "Reaction time of nested groups (one switch; all of both groups)", "groups", {}},
             plants_by_nesting(rounds), made, diagnostics) &&
         add(options,
             {"beyond-load",
              "Reaction time by best-effort load (line of three switches, three slaves, cycle 1 ms)",
              "load",
              {}},
             plants_by_load(rounds), made, diagnostics);
}

}  // namespace takt::papers
