// SPDX-License-Identifier: Apache-2.0
#include "papers/charts.hpp"

#include <fmt/format.h>

#include "chart/bar_chart.hpp"
#include "chart/state_chart.hpp"
#include "program/table.hpp"

namespace takt::papers {

std::string state_machine_chart() {
  using program::State;
  std::vector<chart::StateBox> boxes = {
      {"Halted", 120, 90}, {"Ready", 480, 90}, {"Running", 480, 330}, {"Suspended", 120, 330}};
  const auto box_of = [](State state) -> std::size_t {
    switch (state) {
      case State::Halted:
        return 0;
      case State::Ready:
        return 1;
      case State::Running:
        return 2;
      case State::Suspended:
        return 3;
    }
    return 0;
  };
  std::vector<chart::TransitionArc> arcs;
  for (const program::Transition& transition : program::transitions) {
    std::string methods;
    for (const program::Method method : {program::Method::Start, program::Method::Suspend, program::Method::Resume,
                                         program::Method::Halt, program::Method::Reset})
      if (transition.causes.contains(method)) methods += " " + std::string(program::name_of(method));
    arcs.push_back({box_of(transition.from), box_of(transition.to), fmt::format("{}{}", transition.number, methods),
                    methods.empty()});
  }
  return chart::state_chart("Fig. 1: OPC UA Program, four states and nine transitions", boxes, arcs, 620, 420);
}

std::string reactions_chart(const BeyondTable& table) {
  std::vector<chart::BarGroup> groups;
  for (const BeyondRow& row : table.rows) {
    chart::BarGroup group;
    group.name = row.variant;
    for (const ReactionCell& cell : row.reactions)
      group.bars.push_back({cell.simulated ? static_cast<double>(cell.simulated->ps()) * 1e-9 : 0,
                            cell.bound ? std::optional(static_cast<double>(cell.bound->ps()) * 1e-9) : std::nullopt});
    groups.push_back(std::move(group));
  }
  return chart::bar_chart(table.question, "reaction time (ms): bar simulated maximum, line analytic bound",
                          {reaction_names.begin(), reaction_names.end()}, groups);
}

}  // namespace takt::papers
