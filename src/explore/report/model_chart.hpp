// A run once more with the model that it was found with, as a chart: for models whose values replay.hpp does not know.
#pragma once

#include <string>

#include "explore/model/model.hpp"
#include "explore/report/chart.hpp"
#include "sim/check.hpp"

namespace takt::explore {

/// What there is to say of a model's states and actions: a class made from a Query, with
///   M model                                    whose runs are told
///   width                                      of a column
///   names()                                    of the columns
///   states(state)                              the cells of the columns
///   step(state, action)                        a step before it is taken
template <class W>
Chart chart_with(const Query& query, const Beginning& beginning, const Trace& trace) {
  W words(query);
  auto& model = words.model;
  Chart chart;
  chart.names = words.names();
  chart.width = W::width;
  State state = model.switched_on();
  // Numbers of states belong to one model, so the beginning is gone through again.
  state.set_commands_left(most_commands);
  Next next;
  for (const Action action : beginning.actions)
    if (model.act(state, action, next)) state = next.state;
  state.set_commands_left(model.query().commands);
  state.set_faults_left(model.query().fault_budget);
  chart.beginning = beginning.name;
  chart.states = words.states(state);
  chart.cycle = trace.cycle;
  for (const Action action : trace.actions) {
    ChartStep& step = chart.steps.emplace_back(words.step(state, action));
    step.mark = mark_of(action.kind);
    try {
      model.act(state, action, next);
    } catch (const sim::InvariantBroken& broken) {
      step.states = words.states(state);
      step.findings.push_back(std::string("breaks ") + broken.what());
      break;
    }
    for (std::size_t p = 0; p < property_count; ++p) {
      const auto property = static_cast<Property>(p);
      if (must_always_hold(property) && next.properties.contains(property)) step.findings.push_back("violates " + std::string(name_of(property)));
    }
    state = next.state;
    step.states = words.states(state);
  }
  return chart;
}

}  // namespace takt::explore
