// SPDX-License-Identifier: Apache-2.0
// S1, S2, S4 and S5 of what real nodes have done, Program by Program and for trees of nested Programs as a whole.
//
// The observers are those of the simulator, and are told the steps in the order of their time. S3 is about single
// messages of process data, which logs do not have.
#pragma once

#include <string>
#include <vector>

#include "emulate/log_reader.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::emulate {

struct InvariantCheck {
  std::size_t steps = 0;
  std::vector<std::string> violated;
};

/// `steps` of all nodes; those of one node in its order. A step is logged before others can hear of it, so the order of
/// their times is one in which they may have happened.
InvariantCheck check_invariants(const scenario::Resolved& resolved, std::vector<LoggedStep> steps);

}  // namespace takt::emulate
