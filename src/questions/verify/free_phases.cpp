// SPDX-License-Identifier: Apache-2.0
#include "verify/free_phases.hpp"

#include <algorithm>

#include "scenario/description/promises.hpp"

namespace takt::verify {

using scenario::Program;
using scenario::Scenario;
using sim::Duration;

const std::string& participant_name(const Program& program, std::size_t participant) {
  return participant == 0 ? program.master : program.slaves[participant - 1];
}

void add_free_talkers(const Scenario& scenario, std::vector<FreeVariable>& found) {
  for (std::size_t s = 0; s < scenario.streams.size(); ++s) {
    const scenario::Stream& stream = scenario.streams[s];
    const Duration period = stream.every ? *stream.every : stream.burst ? stream.burst->every : Duration();
    // A phase behind the end of the stream would be a stream without frames.
    const Duration range = std::min(period, stream.until.value_or(period));
    if (!scenario::promises_phase(stream) && range > Duration())
      found.push_back({FreeVariable::Kind::talker, s, 0, range, "phase of " + stream.name, {}, {}, {}});
  }
}

void add_free_publishers(const Scenario& scenario, std::vector<FreeVariable>& found) {
  for (std::size_t p = 0; p < scenario.programs.size(); ++p) {
    const Program& program = scenario.programs[p];
    if (!program.roles.empty()) continue;  // who takes part, and since when, is settled in the run
    for (std::size_t participant = 0; participant <= program.slaves.size(); ++participant) {
      const std::string& name = participant_name(program, participant);
      if (!scenario::promises_phase(program, name))
        found.push_back({FreeVariable::Kind::publisher,
                         p,
                         participant,
                         program.cycle,
                         "phase of " + program.name + " on " + name,
                         {},
                         {},
                         {}});
    }
  }
}

}  // namespace takt::verify
