// SPDX-License-Identifier: Apache-2.0
// Two examples of properties of scenarios, and one that is false: it must be refuted by the least that refutes it.
#include <gtest/gtest.h>

#include <filesystem>

#include "property/holds.hpp"
#include "sim/time.hpp"

namespace takt::property {
namespace {

using namespace sim::literals;  // NOLINT

std::string shipped(const std::string& name) { return std::string(TAKT_SOURCE_DIR) + "/scenarios/" + name; }

// A cycle is 200 us: fifteen messages in a row would have to be lost.
TEST(RobotArm, HaltsWithin3MillisecondsWhateverIsLostBelow10Percent) {
  EXPECT_TRUE(holds(shipped("robot-arm.json"), {.highest_loss = 0.1},
                    [](const Outcome& run) { return run.reacted_within("halt", 3_ms) && run.all_end_in("Halted"); }));
}

TEST(DirectLink, KeepsItsInvariantsThroughOutagesAndCrashes) {
  EXPECT_TRUE(holds(shipped("direct-link.json"),
                    {.highest_loss = 0.3, .link_downs = true, .crashes = true, .longest = 5_ms},
                    [](const Outcome& run) { return run.keeps_invariants(); }));
}

TEST(Holds, RefutesAFalsePropertyByTheLeastThatDoes) {
  const std::string file = detail::file_of("robot-arm");
  std::filesystem::remove(file);
  // A link that is down for longer than the time-out halts the group: it does not run on until the script halts it.
  const auto never_silent = [](const Outcome& run) {
    for (const results::ReactionResult& reaction : run.result().programs[0].reactions)
      if (reaction.cause == "cut" || reaction.cause == "silence") return false;
    return true;
  };
  EXPECT_FALSE(
      holds(shipped("robot-arm.json"), {.highest_loss = 0.01, .link_downs = true, .longest = 20_ms}, never_silent));
  json::Diagnostics diagnostics;
  const auto least = scenario::load_file(file, {}, diagnostics);
  ASSERT_TRUE(least) << diagnostics.to_text();
  EXPECT_EQ(least->scenario.faults.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<scenario::LinkDown>(least->scenario.faults.at(0)));
  EXPECT_TRUE(least->scenario.programs.at(0).phases.empty());
  EXPECT_FALSE(never_silent(run(least->scenario)));
}

}  // namespace
}  // namespace takt::property
