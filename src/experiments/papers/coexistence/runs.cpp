// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/runs.hpp"

#include <algorithm>
#include <ctime>

#include "evaluation/evaluate.hpp"
#include "papers/coexistence/output_log.hpp"
#include "scenario/run/run.hpp"

namespace takt::papers::coexistence {
namespace {

ThreadFigures figures_of(const scenario::Run& run, std::size_t application, std::size_t thread) {
  const scenario::ResolvedApplication& resolved = run.resolved().applications[application];
  const scenario::ThreadFigures seen = run.thread(application, thread, sim::Duration());
  ThreadFigures made;
  made.application = resolved.name;
  made.thread = resolved.threads[thread].name;
  made.tests = seen.calls.tests;
  made.activations = seen.calls.expected;
  made.success = seen.calls.percent().value_or(0);
  if (seen.values) made.buffered = seen.values->percent().value_or(0);
  return made;
}

}  // namespace

const ThreadFigures* RunFigures::find(std::string_view application, std::string_view thread) const {
  const auto found = std::find_if(threads.begin(), threads.end(), [&](const ThreadFigures& figures) {
    return figures.application == application && figures.thread == thread;
  });
  return found == threads.end() ? nullptr : &*found;
}

RunFigures run(const scenario::Resolved& resolved, std::string_view commands_of) {
  RunFigures made;
  made.scenario = resolved.scenario.name;
  const std::clock_t began = std::clock();
  scenario::Run live(resolved);
  OutputLog log(resolved, commands_of);
  if (!resolved.signals.empty()) live.simulation().set_trace(&log);
  live.advance();
  made.cpu_seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  for (std::size_t application = 0; application < resolved.applications.size(); ++application)
    for (std::size_t thread = 0; thread < resolved.applications[application].threads.size(); ++thread)
      made.threads.push_back(figures_of(live, application, thread));
  made.edges = log.edges();
  made.commands = log.commands();
  if (!resolved.scenario.applications.empty())
    made.begin = sim::TrueTime() + resolved.scenario.applications.front().scheduler.after;
  made.end = live.end();
  const results::RunResult result = evaluation::evaluate(live, false);
  made.passed = result.verdict == results::Verdict::pass;
  made.simulated_seconds = static_cast<double>(result.simulated.ps()) * 1e-12;
  made.events = result.events;
  made.digest = result.digest;
  return made;
}

}  // namespace takt::papers::coexistence
