// SPDX-License-Identifier: Apache-2.0
// Gates as INET has them: for each class durations in a circle, at each end of which the gate takes its other state.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scenario/description/description.hpp"

namespace takt::interchange::inet {

struct ClassGate {
  bool initially = true;                ///< open at the beginning of the circle
  std::vector<std::int64_t> durations;  ///< ps, an even number; none: it stays as it is
  std::int64_t sum = 0;                 ///< of the durations
  std::int64_t offset = 0;              ///< where in the circle the run begins
  bool is_open(std::int64_t at) const;
};

/// The gates of a port as one list that is in force from 0 on: an entry at each change within `cycle` ps, of which each
/// circle is a part.
scenario::Gates one_list(const std::array<ClassGate, 8>& gates, std::int64_t cycle);

}  // namespace takt::interchange::inet
