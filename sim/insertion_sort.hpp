// SPDX-License-Identifier: Apache-2.0
// A stable sort that asks for no memory, for the few things of one instant.
#pragma once

#include <algorithm>

namespace takt::sim {

/// std::stable_sort allocates, even for one element. Quadratic, and linear for what is in order.
template <class Range, class Less>
void insertion_sort(Range& range, Less less) {
  for (auto next = range.begin(); next != range.end(); ++next)
    std::rotate(std::upper_bound(range.begin(), next, *next, less), next, next + 1);
}

}  // namespace takt::sim
