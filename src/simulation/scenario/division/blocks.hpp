// SPDX-License-Identifier: Apache-2.0
// What of a network must be simulated by one thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

struct Blocks {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> of_node;  ///< by node
  std::uint32_t home = 0;              ///< with Programs and applications, if there are any
};

/// Nodes that one thread must see are in one block.
Blocks blocks_of(const Resolved& resolved);

/// Why the run cannot be divided at all; empty: it can.
std::string why_whole(const Resolved& resolved);

}  // namespace takt::scenario
