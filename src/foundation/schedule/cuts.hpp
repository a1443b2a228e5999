// SPDX-License-Identifier: Apache-2.0
// Where two cables are all that joins one part of a network to the rest, as in a ring.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "schedule/problem.hpp"

namespace takt::schedule {

/// All that goes from nodes in front to nodes behind crosses one of the links.
struct Cut {
  std::vector<LinkIndex> links;
  std::vector<std::uint8_t> is_behind;  ///< by node
};

/// Calls see(cut) for each way to cut two cables that splits the network (but neither alone does), in both directions;
/// false from it: no more.
void for_each_double_cut(const Problem& problem, const std::function<bool(const Cut&)>& see);

}  // namespace takt::schedule
