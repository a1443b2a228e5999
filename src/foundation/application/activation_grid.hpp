// SPDX-License-Identifier: Apache-2.0
// When the activations of a thread are due.
#pragma once

#include <algorithm>
#include <cstdint>

namespace takt::application {

/// Activation n is due at offset + n * every of the clock of the host. All times in one unit: ps in a simulation, ns on
/// a real node. every > 0.
struct ActivationGrid {
  std::int64_t every = 1;
  std::int64_t offset = 0;

  std::int64_t due(std::int64_t activation) const { return offset + activation * every; }
  /// The number of the last one that is due by then; below 0 before the first.
  std::int64_t latest_at(std::int64_t now) const {
    const std::int64_t since = now - offset;
    return since >= 0 ? since / every : -((-since + every - 1) / every);
  }
  /// So many of the activations from `first` on were done or missed by then. The latest one that is due is open until
  /// it is done; what is done stays so where the clock was set back.
  std::int64_t decided(std::int64_t first, std::int64_t last_done, std::int64_t now) const {
    return std::max(std::max(latest_at(now), last_done + 1) - first, std::int64_t{0});
  }
};

}  // namespace takt::application
