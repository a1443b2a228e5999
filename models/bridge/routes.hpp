// SPDX-License-Identifier: Apache-2.0
// By which ports the frames of each stream leave, hop by hop: what bridges have found in their filtering databases,
// where it is found again at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "models/ethernet/frame.hpp"

namespace takt::models {

/// In a large network each look-up in a filtering database is a cache miss; here the ports of a stream lie side by
/// side. A bridge asks by stream and hop and believes an answer that is a port of its own: for frames on_route the port
/// depends on bridge and stream alone. Otherwise it looks the port up and notes it.
class Routes {
 public:
  static constexpr std::size_t most_hops = 64;  ///< what goes farther is looked up there
  static constexpr std::uint32_t unknown = 0xFFFF'FFFF;

  Routes(std::size_t streams) : ports_(streams * most_hops, unknown) {}

  /// The number of the port in the network, or unknown. Preconditions: hop < most_hops; the frame is on_route.
  std::uint32_t& at(const Frame& frame) { return ports_[frame.stream.value * most_hops + frame.hop]; }
  void prefetch(const Frame& frame) const { __builtin_prefetch(&ports_[frame.stream.value * most_hops + frame.hop]); }
  const std::uint32_t& at(const Frame& frame) const { return ports_[frame.stream.value * most_hops + frame.hop]; }
  /// Filtering databases have changed.
  void forget() { ports_.assign(ports_.size(), unknown); }

 private:
  std::vector<std::uint32_t> ports_;  // by stream, then by hop
};

}  // namespace takt::models
