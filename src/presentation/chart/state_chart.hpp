// SPDX-License-Identifier: Apache-2.0
// States at given places and the transitions between them.
#pragma once

#include <string>
#include <vector>

namespace takt::chart {

struct StateBox {
  std::string name;
  double x = 0;  ///< of its centre, in pixels
  double y = 0;
};

struct TransitionArc {
  std::size_t from = 0;
  std::size_t to = 0;
  std::string text;
  bool dashed = false;
};

/// Arcs between the same two states bow away from each other.
std::string state_chart(const std::string& title, const std::vector<StateBox>& states,
                        const std::vector<TransitionArc>& arcs, double width, double height);

}  // namespace takt::chart
