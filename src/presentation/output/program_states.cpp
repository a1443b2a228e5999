// SPDX-License-Identifier: Apache-2.0
#include "output/program_states.hpp"

#include <algorithm>

namespace takt::output {

std::vector<std::pair<sim::TrueTime, std::string_view>> states_of(const scenario::ProgramMonitor& monitor,
                                                                  std::size_t participant) {
  std::vector<std::pair<sim::TrueTime, std::string_view>> states = {
      {sim::TrueTime(), handshake::name_of(handshake::PublishedState::Halted)}};
  for (const scenario::StateRecord& record : monitor.history())
    if (record.participant == participant) states.emplace_back(record.time, handshake::name_of(record.change.to));
  for (const scenario::LifeRecord& life : monitor.lives())
    if (life.participant == participant)
      states.emplace_back(life.time, life.is_back ? handshake::name_of(handshake::PublishedState::Halted) : dead_state);
  std::stable_sort(states.begin(), states.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return states;
}

}  // namespace takt::output
