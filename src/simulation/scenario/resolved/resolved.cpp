// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

Resolved::Resolved() = default;
Resolved::~Resolved() = default;

void Resolved::give_back_room() {
  plan.nodes.shrink_to_fit();
  plan.links.shrink_to_fit();
  plan.streams.shrink_to_fit();
  plan.talkers.shrink_to_fit();
  plan.filtering.shrink_to_fit();
  streams.shrink_to_fit();
  ports.shrink_to_fit();
}

}  // namespace takt::scenario
