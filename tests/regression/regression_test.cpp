// Every scenario that once showed a bug: it runs now without one, or is refused with a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "scenario/resolve/resolve.hpp"
#include "tests/wire_checker/verify.hpp"

namespace takt {
namespace {

std::vector<std::string> scenario_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/tests/regression/scenarios"))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Files whose names begin so ask for what cannot be.
bool is_to_be_refused(const std::string& file) { return std::filesystem::path(file).filename().string().starts_with("refused-"); }

TEST(Regression, EveryScenario) {
  ASSERT_FALSE(scenario_files().empty());
  for (const std::string& file : scenario_files()) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(file, {}, diagnostics);
    EXPECT_EQ(resolved == nullptr, is_to_be_refused(file)) << file << "\n" << diagnostics.to_text();
    if (!resolved) continue;
    EXPECT_EQ(wire_checker::verify(*resolved), "") << file;
  }
}

}  // namespace
}  // namespace takt
