#include "verify/shortened.hpp"

#include <algorithm>
#include <vector>

#include "plant/protocol.hpp"

namespace takt::verify {
namespace {

using scenario::Scenario;
using sim::Duration;

bool depends_on_its_times(const Scenario& scenario) {
  const scenario::Clocks& clocks = scenario.clocks;
  if (clocks.gptp || clocks.all || !clocks.nodes.empty() || !scenario.faults.empty() || scenario.rerouting) return true;
  if (std::any_of(scenario.require.begin(), scenario.require.end(), [&](const scenario::Requirement& each) { return each.after.value_or(scenario.warm_up) > Duration(); })) return true;
  if (std::any_of(scenario.script.begin(), scenario.script.end(), [](const scenario::ScriptEntry& entry) { return !entry.call; })) return true;
  return std::any_of(scenario.streams.begin(), scenario.streams.end(), [](const scenario::Stream& stream) { return stream.trace.has_value() || stream.until.has_value(); });
}

/// What may be left out of a pause: whole periods, so that what comes after it keeps its phase.
Duration to_skip(Duration pause, Duration enough, Duration period) {
  if (pause <= enough || period <= Duration()) return {};
  return period * ((pause - enough).ps() / period.ps());
}

}  // namespace

Scenario shortened(const Scenario& scenario, Duration longest_reaction) {
  if (depends_on_its_times(scenario) || scenario.programs.empty()) return scenario;
  Duration enough = longest_reaction;
  Duration period;
  for (const scenario::Program& program : scenario.programs) {
    enough = std::max(enough, program.cycle * 40 + program.initialisation * 2 + plant::receive_timeout_of(program));
    period = std::max(period, program.cycle);
  }
  for (const scenario::Stream& stream : scenario.streams)
    if (stream.offset) enough = std::max<Duration>(enough, *stream.offset);
  Scenario made = scenario;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < made.script.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scenario.script[a].at < scenario.script[b].at; });
  Duration before;
  Duration skipped;
  for (const std::size_t i : order) {
    skipped += to_skip(scenario.script[i].at - before, enough, period);
    before = scenario.script[i].at;
    made.script[i].at = before - skipped;
  }
  skipped += to_skip(scenario.duration - before, enough, period);
  made.duration = scenario.duration - skipped;
  return made;
}

}  // namespace takt::verify
