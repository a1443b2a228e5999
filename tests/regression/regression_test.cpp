// Every scenario that once showed a bug: it runs now without one, or is refused with a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "scenario/resolve/resolve.hpp"
#include "scenario/run/run.hpp"
#include "tests/wire_checker/verify.hpp"

namespace takt {
namespace {

std::vector<std::string> scenario_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/tests/regression/" + folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Files whose names begin so ask for what cannot be.
bool is_to_be_refused(const std::string& file) { return std::filesystem::path(file).filename().string().starts_with("refused-"); }

TEST(Regression, EveryScenario) {
  ASSERT_FALSE(scenario_files("scenarios").empty());
  for (const std::string& file : scenario_files("scenarios")) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(file, {}, diagnostics);
    EXPECT_EQ(resolved == nullptr, is_to_be_refused(file)) << file << "\n" << diagnostics.to_text();
    if (!resolved) continue;
    EXPECT_EQ(wire_checker::verify(*resolved), "") << file;
  }
}

/// The wire checker asks for clocks that are right. Of the others the order of equal events must not show.
TEST(Regression, EveryScenarioOfClocks) {
  ASSERT_FALSE(scenario_files("clocks").empty());
  for (const std::string& file : scenario_files("clocks")) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(file, {}, diagnostics);
    ASSERT_TRUE(resolved) << file << "\n" << diagnostics.to_text();
    const auto digest = [&](std::uint64_t tie_shuffle) {
      scenario::Run run(*resolved, tie_shuffle);
      run.advance();
      return run.simulation().digest().value();
    };
    const std::uint64_t in_order = digest(0);
    for (const std::uint64_t shuffle : {1ULL, 2ULL, 0xDEAD'BEEFULL}) EXPECT_EQ(digest(shuffle), in_order) << file;
  }
}

}  // namespace
}  // namespace takt
