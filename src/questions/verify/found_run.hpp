// SPDX-License-Identifier: Apache-2.0
// A run that was found, as the choice that makes it: scenarios of a thousand nodes have megabytes, choices a few octets
// for each variable.
#pragma once

#include <memory>
#include <vector>

#include "verify/free_variable.hpp"

namespace takt::verify {

/// What a search chooses in: the scenario, the same with less waiting, and what is free in both.
struct Ground {
  scenario::Scenario whole;
  scenario::Scenario shorter;
  std::vector<FreeVariable> variables;
};

struct FoundRun {
  std::shared_ptr<const Ground> ground = {};  ///< none: there is no such run
  std::shared_ptr<const Choice> choice = {};  ///< requirements whose worst run is the same share it
  bool is_shorter = false;
  explicit operator bool() const { return ground != nullptr; }
  /// A file of it replays the run. Precondition: there is one.
  scenario::Scenario scenario() const {
    return scenario_of(is_shorter ? ground->shorter : ground->whole, ground->variables, *choice);
  }
};

}  // namespace takt::verify
