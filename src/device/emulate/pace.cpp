// SPDX-License-Identifier: Apache-2.0
#include "emulate/pace.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace takt::emulate {
namespace {

using Counts = std::array<std::size_t, std::numeric_limits<std::uint8_t>::max() + 1>;

/// Changes of each participant before a time.
Counts changes_before(const History& history, std::int64_t time) {
  Counts counts{};
  for (const Change& each : history.changes) {
    const bool may_be_crash = each.change.transition == 0 && each.change.to == handshake::PublishedState::Halted;
    if (each.time < time && !may_be_crash) ++counts[each.participant];
  }
  return counts;
}

}  // namespace

bool Pace::is_reached(const std::vector<History>& emulated, sim::Duration at) const {
  for (std::size_t program = 0; program < simulated_.size(); ++program) {
    const Counts wanted = changes_before(simulated_[program], at.ps());
    const Counts made = changes_before(emulated[program], std::numeric_limits<std::int64_t>::max());
    for (std::size_t p = 0; p < wanted.size(); ++p)
      if (made[p] < wanted[p]) return false;
  }
  return true;
}

bool Pace::is_good(std::uint32_t program, std::uint8_t participant, program::Method method, sim::Duration at) const {
  const std::vector<Call>& calls = simulated_[program].calls;
  return std::any_of(calls.begin(), calls.end(), [&](const Call& call) {
    return call.participant == participant && call.method == method && call.time == at.ps();
  });
}

}  // namespace takt::emulate
