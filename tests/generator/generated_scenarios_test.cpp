// SPDX-License-Identifier: Apache-2.0
// Some hundreds of random scenarios under all checks, and every scenario that once showed a bug. tools/soak makes more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "tests/generator/check_scenario.hpp"
#include "tests/generator/generated.hpp"
#include "tests/support/case_count.hpp"

namespace takt::generator {
namespace {

std::string lines(const std::vector<Finding>& findings) {
  std::string all;
  for (const Finding& each : findings) all += each.check + ": " + each.message + "\n";
  return all;
}

// Numbers that are far from each other, so that few scenarios have many pairs of features.
TEST(GeneratedScenarios, NothingIsWrong) {
  const std::uint64_t count = support::case_count("TAKT_GENERATED", 300);
  std::map<std::string, int> done;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t number = i * 7;
    const Generated made = generate(number);
    ASSERT_TRUE(made.resolved) << number << ": " << made.problem;
    const Checked checked =
        check_scenario(made.text, file_name(), {.verify_events = 100'000, .most_states = 5'000, .only = {}});
    ASSERT_TRUE(checked.is_sound) << number << ": " << checked.refusal;
    EXPECT_EQ(lines(checked.findings), "") << "takt_soak --show " << number;
    for (const std::string& check : checked.done) ++done[check];
  }
  // A check that applies to nothing would find nothing.
  for (const char* check : {"run", "load", "digest", "wire", "frames", "bound", "phases", "verify"})
    EXPECT_GT(done[check], static_cast<int>(count / 4)) << check;
  for (const char* check : {"threads", "order"}) EXPECT_GT(done[check], static_cast<int>(count / 8)) << check;
}

TEST(GeneratedScenarios, NorWithWhatWasFound) {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/tests/regression/scenarios")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" || name.starts_with("refused-")) continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    const Checked checked = check_scenario(text.str(), entry.path().string());
    EXPECT_TRUE(checked.is_sound) << name << checked.refusal;
    EXPECT_EQ(lines(checked.findings), "") << name;
  }
}

// The checks can fail: a scenario with a mistake in each.
TEST(GeneratedScenarios, ARefusalIsNoFinding) {
  const Checked checked = check_scenario(R"({"name": "t", "duration": "1ms"})", "t.json");
  EXPECT_FALSE(checked.is_sound);
  EXPECT_NE(checked.refusal.find("network"), std::string::npos);
  EXPECT_TRUE(checked.findings.empty());
}

}  // namespace
}  // namespace takt::generator
