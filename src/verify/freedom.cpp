#include "verify/freedom.hpp"

#include <algorithm>

#include "scenario/description/promises.hpp"
#include "sim/check.hpp"

namespace takt::verify {
namespace {

using scenario::Program;
using scenario::Scenario;
using sim::Duration;

const std::string& participant_name(const Program& program, std::size_t participant) {
  return participant == 0 ? program.master : program.slaves[participant - 1];
}

void add_talkers(const Scenario& scenario, std::vector<Freedom>& found) {
  for (std::size_t s = 0; s < scenario.streams.size(); ++s) {
    const scenario::Stream& stream = scenario.streams[s];
    const Duration period = stream.every ? *stream.every : stream.burst ? stream.burst->every : Duration();
    if (!scenario::promises_phase(stream) && period > Duration()) found.push_back({Freedom::Kind::talker, s, 0, period, "phase of " + stream.name});
  }
}

void add_publishers(const Scenario& scenario, std::vector<Freedom>& found) {
  for (std::size_t p = 0; p < scenario.programs.size(); ++p) {
    const Program& program = scenario.programs[p];
    if (!program.roles.empty()) continue;   // who takes part, and since when, is settled in the run
    for (std::size_t participant = 0; participant <= program.slaves.size(); ++participant) {
      const std::string& name = participant_name(program, participant);
      if (!scenario::promises_phase(program, name)) found.push_back({Freedom::Kind::publisher, p, participant, program.cycle, "phase of " + program.name + " on " + name});
    }
  }
}

void add_calls(const Scenario& scenario, std::vector<Freedom>& found) {
  std::vector<Duration> times;
  for (const scenario::ScriptEntry& entry : scenario.script) times.push_back(entry.at);
  std::sort(times.begin(), times.end());
  for (std::size_t i = 0; i < scenario.script.size(); ++i) {
    const scenario::ScriptEntry& entry = scenario.script[i];
    if (!entry.call) continue;
    const auto program = std::find_if(scenario.programs.begin(), scenario.programs.end(), [&](const Program& p) { return !entry.program || p.name == *entry.program; });
    if (program == scenario.programs.end()) continue;
    const auto next = std::upper_bound(times.begin(), times.end(), entry.at);
    const Duration room = (next == times.end() ? scenario.duration : *next) - entry.at;
    const Duration range = std::min(program->cycle, room);
    if (range > Duration()) found.push_back({Freedom::Kind::call, i, 0, range, "instant of call " + std::to_string(i + 1)});
  }
}

}  // namespace

std::vector<Freedom> freedoms_of(const scenario::Resolved& resolved) {
  std::vector<Freedom> found;
  add_publishers(resolved.scenario, found);
  add_calls(resolved.scenario, found);
  add_talkers(resolved.scenario, found);
  return found;
}

Scenario scenario_of(const Scenario& scenario, std::span<const Freedom> freedoms, const Choice& choice) {
  TAKT_CHECK(freedoms.size() == choice.values.size(), "a value for each freedom");
  Scenario made = scenario;
  made.seed = choice.seed;
  for (std::size_t i = 0; i < freedoms.size(); ++i) {
    const Freedom& freedom = freedoms[i];
    const Duration value = choice.values[i];
    TAKT_CHECK(value >= Duration() && value < freedom.range, "a value within its range");
    if (value == Duration()) continue;
    switch (freedom.kind) {
      case Freedom::Kind::talker: made.streams[freedom.item].offset = value; break;
      case Freedom::Kind::publisher:
        made.programs[freedom.item].phases.emplace_back(participant_name(made.programs[freedom.item], freedom.participant), value);
        break;
      case Freedom::Kind::call: made.script[freedom.item].at += value; break;
    }
  }
  return made;
}

}  // namespace takt::verify
