// SPDX-License-Identifier: Apache-2.0
// Misses one after another: frames and reactions that came too late or not at all, in the order in which they began.
#pragma once

#include <cstdint>
#include <vector>

#include "scenario/run/run.hpp"

namespace takt::evaluation {

struct Misses {
  std::uint64_t in_a_row = 0;   ///< the longest row
  std::uint64_t in_window = 0;  ///< the most among any so many one after another
  std::uint64_t missed = 0;     ///< in all
  std::uint64_t counted = 0;    ///< of so many
  /// That which has more.
  void take(const Misses& other);
};

/// Of a sequence in which true is a miss; `window` 0: none is asked for.
Misses misses_of(const std::vector<bool>& missed, std::uint64_t window);

/// Of the last `sent` frames of the stream, at the listener with the most. What is under way and may still come in time
/// is no miss. Precondition: the run keeps which frames of the stream come within `deadline` (keep_accounts).
Misses misses_of(const scenario::Run& run, models::StreamIndex stream, std::uint64_t sent, sim::Duration deadline,
                 std::uint64_t window);

}  // namespace takt::evaluation
