// SPDX-License-Identifier: Apache-2.0
// Every frame of the shipped scenarios is explained; together they know every cause.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "scenario/resolve.hpp"
#include "tests/simulation/explain/checked_ways.hpp"

namespace takt::explain {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> shipped() {
  std::vector<fs::path> files;
  for (const char* const folder : {"tsn", "validation", "applications", "."})
    for (const auto& entry : fs::directory_iterator(fs::path(TAKT_SOURCE_DIR) / "scenarios" / folder))
      if (entry.path().extension() == ".json" && !entry.path().filename().string().starts_with("takt.") &&
          entry.path().filename() != "ring-1000.json")
        files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

TEST(ShippedWays, AddUpAndNameFramesThatWereThere) {
  std::map<Cause, std::uint64_t> causes;
  std::size_t scenarios = 0;
  for (const fs::path& file : shipped()) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(file.string(), {"/duration=20ms"}, diagnostics);
    if (!resolved) continue;  // its script or its requirements are later than that
    ++scenarios;
    scenario::Run plain(*resolved);
    plain.advance();
    scenario::Run run(*resolved);
    CheckedWays ways(run);
    run.advance();
    EXPECT_EQ(run.simulation().digest().value(), plain.simulation().digest().value()) << file;
    EXPECT_EQ(run.simulation().event_count(), plain.simulation().event_count()) << file;
    EXPECT_EQ(ways.finish(), "") << file;
    for (const auto& [cause, count] : ways.causes()) causes[cause] += count;
  }
  EXPECT_GE(scenarios, 20u);
  for (std::size_t c = 0; c < static_cast<std::size_t>(Cause::count); ++c) {
    const auto cause = static_cast<Cause>(c);
    if (cause == Cause::precedence)
      continue;  // express before preemptable of a higher class, or shares of bandwidth: random scenarios
    EXPECT_GT(causes[cause], 0u) << name_of(cause);
  }
}

}  // namespace
}  // namespace takt::explain
