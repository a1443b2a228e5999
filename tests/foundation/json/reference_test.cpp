// SPDX-License-Identifier: Apache-2.0
// The page for people says what the schema says.
#include "json/reference.hpp"

#include <gtest/gtest.h>

#include <string>

#include "json/fields.hpp"
#include "sample.hpp"

namespace takt::sample {
namespace {

std::string page() {
  static const std::string text = json::reference(json::schema_tree<Sample>("A sample"), "How to renew it.");
  return text;
}

bool says(const std::string& line) { return page().find("\n" + line + "\n") != std::string::npos; }

TEST(Reference, BeginsWithTitleAndOpening) {
  EXPECT_TRUE(page().starts_with("# A sample\n\nHow to renew it.\n\n")) << page();
}

TEST(Reference, HasARowForEachKey) {
  const json::Node schema = json::schema_tree<Sample>("A sample");
  for (const auto& member : schema.find("properties")->members)
    EXPECT_NE(page().find("| `" + member.key + "` | "), std::string::npos) << member.key;
}

TEST(Reference, TellsValueDefaultAndMeaning) {
  for (const char* const row : {
           R"(| `name` | string | **required** | Of the sample. |)",
           R"(| `level` | integer, -5 to 5 | `0` | Any integer will do. |)",
           R"(| `weight` | number above 0, at most 1 | `0.5` | A share. |)",
           R"(| `duration` | a duration above 0s and up to 1h | `"10s"` | How long it runs. |)",
           R"(| `nodes` | object: a name, and [node](#node) for each | `{}` | By name. |)",
           R"(| `ports` | list of integer, 1024 to 65535, at most 3 | `[4840]` | The UDP ports that are open. |)",
           R"(| `captured` | `"all"` or list of string | `[]` | The links that are captured. |)",
       })
    EXPECT_TRUE(says(row)) << row << "\n" << page();
}

TEST(Reference, TellsKindsShorthandsAndRules) {
  for (const char* const line : {"## oscillator", R"(**`"kind": "switch"`** A bridge.)", "Either a frequency offset.",
                                 "Exactly one of `link_down`, `crash`."})
    EXPECT_TRUE(says(line)) << line << "\n" << page();
}

}  // namespace
}  // namespace takt::sample
