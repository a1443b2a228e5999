// SPDX-License-Identifier: Apache-2.0
// Every shipped scenario under the wire checker: nothing is wrong.
#include <gtest/gtest.h>

#include "tests/simulation/scenario/support.hpp"
#include "tests/wire_checker/checked_run.hpp"

namespace takt::wire_checker {
namespace {

using scenario::test::shipped;
using scenario::test::shipped_names;

/// Long enough for everything that a scenario shows to happen once, short enough for a test.
std::string duration_for(const std::string& name) {
  if (name == "ring-1000") return "3ms";
  if (name == "robot-arm" || name == "three-slaves-star" || name == "line-of-switches" || name == "direct-link")
    return "100ms";
  if (name == "tsn/link-down-and-rerouting") return {};
  return "100ms";
}

TEST(WireChecker, FindsNothingInTheShippedScenarios) {
  for (const std::string& name : shipped_names()) {
    if (name.starts_with("clocks/") || name == "validation/servo" || name.starts_with("papers/programs/round-trip-"))
      continue;  // the checker's clocks are ideal, see README.md
    const auto resolved = shipped(name, duration_for(name));
    CheckedRun checked(*resolved);
    const Violations& violations = checked.to_the_end();
    EXPECT_EQ(violations.count(), 0u) << name << "\n" << violations.all();
    EXPECT_GT(checked.checker.transmissions(), 50u) << name;
  }
}

}  // namespace
}  // namespace takt::wire_checker
