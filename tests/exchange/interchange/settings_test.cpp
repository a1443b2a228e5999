// SPDX-License-Identifier: Apache-2.0
#include "interchange/settings.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "interchange/format.hpp"

namespace takt::interchange {
namespace {

constexpr SettingInfo table[] = {{"way", "up|down", "up", "a choice"}, {"count", "a whole number", "3", "a number"}};

TEST(Settings, HaveTheirFallbacks) {
  std::string mistake;
  const std::vector<std::string> set = {"count=12"};
  const auto settings = Settings::read(set, table, mistake);
  ASSERT_TRUE(settings);
  EXPECT_EQ((*settings)["way"], "up");
  EXPECT_EQ(settings->number("count", 12), 12u);
  EXPECT_EQ(settings->number("count", 11), std::nullopt);
  EXPECT_EQ(settings->number("way", 11), std::nullopt);
}

TEST(Settings, RefuseWhatTheTableDoesNotHave) {
  for (const char* const wrong : {"way=left", "weight=1", "count", ""}) {
    std::string mistake;
    const std::vector<std::string> set = {wrong};
    EXPECT_FALSE(Settings::read(set, table, mistake)) << wrong;
    EXPECT_NE(mistake.find("expected"), std::string::npos) << mistake;
  }
}

TEST(Formats, AreFoundByTheirNames) {
  for (const ExportFormat& format : export_formats()) EXPECT_EQ(find_export_format(format.name), &format);
  for (const ImportFormat& format : import_formats()) EXPECT_EQ(find_import_format(format.name), &format);
  EXPECT_EQ(find_export_format("nothing"), nullptr);
}

// To renew the page: RENEW=1 takt_interchange_test --gtest_filter='Formats.*'
TEST(Formats, StandInTheDocs) {
  const std::string path = std::string(TAKT_SOURCE_DIR) + "/docs/interchange.md";
  std::ifstream stream(path);
  std::string page{std::istreambuf_iterator<char>(stream), {}};
  const std::string begin = "Made from the tables of `src/exchange/interchange/format.cpp`.\n\n", end = "\n## Times\n";
  const std::size_t from = page.find(begin), until = page.find(end);
  ASSERT_TRUE(from != std::string::npos && until != std::string::npos);
  const std::string formats = page.substr(from + begin.size(), until - from - begin.size());
  if (std::getenv("RENEW") != nullptr) {
    page.replace(from + begin.size(), formats.size(), formats_reference());
    std::ofstream(path) << page;
  } else {
    EXPECT_EQ(formats, formats_reference());
  }
}

}  // namespace
}  // namespace takt::interchange
