// SPDX-License-Identifier: Apache-2.0
// Which phases a plant promises. A run takes what is not said as 0; whoever asks for the worst case may not.
#pragma once

#include <algorithm>
#include <string>

#include "scenario/description/description.hpp"

namespace takt::scenario {

/// When the stream's talker begins is part of the design.
inline bool promises_phase(const Stream& stream) { return stream.offset.has_value(); }

/// When the participant publishes within the cycle is part of the design.
inline bool promises_phase(const Program& program, const std::string& participant) {
  return program.offset || std::any_of(program.phases.begin(), program.phases.end(),
                                       [&](const auto& phase) { return phase.first == participant; });
}

}  // namespace takt::scenario
