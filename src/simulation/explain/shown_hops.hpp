// SPDX-License-Identifier: Apache-2.0
// What of a long way is shown: hops in a row at which nothing remarkable happened are one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "explain/explanation.hpp"

namespace takt::explain {

/// A hop of a way, or several in a row, whose parts are the sums by cause then.
struct ShownHop {
  ExplainedHop hop;  ///< of several: from the first one's port to where the last one leads
  std::size_t count = 1;
  /// place_of() the part; of several hops from where to where, and how many.
  std::string place_of(const ExplainedPart& part) const;
};

/// All hops of a way that has at most `most_hops`. Of a longer one those at which the frame waited longest, at most
/// `most_waits`, each by itself, with the hops between them summed.
constexpr std::size_t most_hops = 24;
constexpr std::size_t most_waits = 12;
std::vector<ShownHop> shown_hops(const ExplainedFrame& frame);

}  // namespace takt::explain
