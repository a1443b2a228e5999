// SPDX-License-Identifier: Apache-2.0
#include "sim/check.hpp"

namespace takt::sim {

void check_failed(const char* condition, const char* meaning, const char* file, int line) {
  throw InvariantBroken(std::string(file) + ":" + std::to_string(line) + ": CHECK(" + condition +
                        ") failed: " + meaning);
}

}  // namespace takt::sim
