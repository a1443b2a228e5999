// SPDX-License-Identifier: Apache-2.0
// Every scenario that once showed a bug: it runs now without one, or is refused with a reason.
#include <gtest/gtest.h>

#include <filesystem>

#include "scenario/resolve.hpp"
#include "tests/regression/files.hpp"
#include "tests/wire_checker/verify.hpp"

namespace takt {
namespace {

/// Files whose names begin so ask for what cannot be.
bool is_to_be_refused(const std::string& file) {
  return std::filesystem::path(file).filename().string().starts_with("refused-");
}

TEST(Regression, EveryScenario) {
  ASSERT_FALSE(regression::files_of("scenarios").empty());
  for (const std::string& file : regression::files_of("scenarios")) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(file, {}, diagnostics);
    EXPECT_EQ(resolved == nullptr, is_to_be_refused(file)) << file << "\n" << diagnostics.to_text();
    if (!resolved) continue;
    EXPECT_EQ(wire_checker::verify(*resolved), "") << file;
  }
}

}  // namespace
}  // namespace takt
