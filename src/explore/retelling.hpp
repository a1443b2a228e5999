// A run once more with the model that it was found with, as a chart: for models whose values replay.hpp does not know.
#pragma once

#include <string>

#include "explore/chart.hpp"
#include "explore/model.hpp"
#include "sim/check.hpp"

namespace takt::explore {

/// `told(state, action)` is a step before it is taken, `states(state)` are the cells of the columns.
template <class M, class States, class Told>
Chart retold(M& model, Chart chart, const Beginning& beginning, const Trace& trace, States&& states, Told&& told) {
  State state = model.switched_on();
  // Numbers of states belong to one model, so the beginning is gone through again.
  state.set_commands_left(most_commands);
  Next next;
  for (const Action action : beginning.actions)
    if (model.act(state, action, next)) state = next.state;
  state.set_commands_left(model.question().commands);
  state.set_faults_left(model.question().fault_budget);
  chart.beginning = beginning.name;
  chart.states = states(state);
  chart.cycle = trace.cycle;
  for (const Action action : trace.actions) {
    ChartStep& step = chart.steps.emplace_back(told(state, action));
    step.mark = mark_of(action.kind);
    try {
      model.act(state, action, next);
    } catch (const sim::InvariantBroken& broken) {
      step.states = states(state);
      step.findings.push_back(std::string("breaks ") + broken.what());
      break;
    }
    for (std::size_t p = 0; p < property_count; ++p) {
      const auto property = static_cast<Property>(p);
      if (must_always_hold(property) && next.properties.contains(property)) step.findings.push_back("violates " + std::string(name_of(property)));
    }
    state = next.state;
    step.states = states(state);
  }
  return chart;
}

}  // namespace takt::explore
