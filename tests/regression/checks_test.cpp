// SPDX-License-Identifier: Apache-2.0
// What random scenarios once showed is checked as they are: digest in any order, bounds, verify. See
// tests/generator/check_scenario.hpp.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/generator/check_scenario.hpp"
#include "tests/regression/files.hpp"

namespace takt {
namespace {

TEST(Regression, EveryCheck) {
  ASSERT_FALSE(regression::files_of("checks").empty());
  for (const std::string& file : regression::files_of("checks")) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    const generator::Checked checked = generator::check_scenario(text.str(), file);
    EXPECT_TRUE(checked.is_sound) << file << "\n" << checked.refusal;
    for (const generator::Finding& finding : checked.findings)
      ADD_FAILURE() << file << ": " << finding.check << ": " << finding.message;
  }
}

}  // namespace
}  // namespace takt
