// SPDX-License-Identifier: Apache-2.0
#include "report/verify_page.hpp"

#include <gtest/gtest.h>

#include "scenario/resolve.hpp"

namespace takt::report {
namespace {

TEST(VerifyPage, ShowsWhatIsProvedAndWhatItRestsOn) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_file(TAKT_SOURCE_DIR "/scenarios/tsn/gates-on-a-line.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  verify::Options options;
  options.search.events = 1'000'000;
  const verify::Verification verification = verify::verify(*resolved, options);
  const std::string page =
      verify_page(*resolved, verification, std::vector<std::string>(verification.lines.size(), "out/worst.json"));
  EXPECT_NE(page.find(std::string("gates-on-a-line: ") + verify::name_of(verification.verdict())), std::string::npos);
  for (const verify::Line& line : verification.lines) EXPECT_NE(page.find(line.requirement.text), std::string::npos);
  EXPECT_NE(page.find("takt run out/worst.json"), std::string::npos);
  EXPECT_NE(page.find("What this rests on"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

}  // namespace
}  // namespace takt::report
