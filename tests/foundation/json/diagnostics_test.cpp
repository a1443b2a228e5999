// SPDX-License-Identifier: Apache-2.0
#include "json/diagnostics.hpp"

#include <gtest/gtest.h>

#include <array>

#include "json/suggest.hpp"

namespace takt::json {
namespace {

TEST(Diagnostic, ReadsAsOneLine) {
  EXPECT_EQ(to_text(Diagnostic{Severity::error, {"a.json", 3, 7, "/x/0"}, "unknown unit", {"\"5 m\"", "ms", "5m"}}),
            "a.json:3:7: error at /x/0: unknown unit: found \"5 m\", expected ms (did you mean \"5m\"?)");
  EXPECT_EQ(to_text(Diagnostic{Severity::warning, {"a.json", 0, 0, ""}, "empty", {}}), "a.json: warning: empty");
  EXPECT_EQ(to_text(Diagnostic{Severity::error, {"a.json", 1, 1, ""}, "m", {"", "e", ""}}),
            "a.json:1:1: error: m: expected e");
  EXPECT_EQ(to_text(Diagnostic{Severity::error, {}, "m", {"f", "", ""}}), "error: m: found f");
}

TEST(Diagnostic, IsHarmlessForTerminals) {
  EXPECT_EQ(to_text(Diagnostic{Severity::error, {"a\n.json", 1, 1, "/\x1b[2J"}, "m", {}}),
            "a\\u000a.json:1:1: error at /\\u001b[2J: m");
}

TEST(Diagnostics, AreSortedByPlaceButFilesStayInOrder) {
  Diagnostics diagnostics;
  diagnostics.error({"b.json", 2, 1, ""}, "second");
  diagnostics.warning({"a.json", 1, 1, ""}, "other file");
  diagnostics.error({"b.json", 1, 9, ""}, "first");
  EXPECT_EQ(diagnostics.to_text(),
            "b.json:1:9: error: first\nb.json:2:1: error: second\na.json:1:1: warning: other file\n");
  EXPECT_EQ(diagnostics.errors(), 2U);
  EXPECT_EQ(diagnostics.warnings(), 1U);
}

TEST(Diagnostics, CountAllButKeepFew) {
  Diagnostics diagnostics(2);
  for (std::uint32_t i = 1; i <= 5; ++i) diagnostics.error({"a", i, 1, ""}, "m");
  EXPECT_TRUE(diagnostics.full());
  EXPECT_EQ(diagnostics.errors(), 5U);
  EXPECT_EQ(diagnostics.to_text(), "a:1:1: error: m\na:2:1: error: m\n... and 3 more\n");
}

TEST(Diagnostics, TheSameOfManyPlacesIsToldOnce) {
  Diagnostics diagnostics;
  for (std::uint32_t line = 1; line <= 6; ++line)
    diagnostics.error({"a", line, 2, "/x/" + std::to_string(line)}, "m", {"f", "e", ""});
  diagnostics.error({"a", 3, 1, ""}, "n");
  diagnostics.error({"a", 4, 1, ""}, "n");
  EXPECT_EQ(diagnostics.to_text(),
            "a:1:2: error at /x/1: m: found f, expected e\n"
            "  the same at 2:2 (/x/2), 3:2 (/x/3), 4:2 (/x/4) and 2 more places\n"
            "a:3:1: error: n\na:4:1: error: n\n");
}

TEST(Diagnostics, AsJson) {
  Diagnostics diagnostics;
  diagnostics.error({"a.json", 3, 7, "/x"}, "m", {"f", "", "s"});
  EXPECT_EQ(compact(diagnostics.to_json()),
            R"({"errors": 1, "warnings": 0, "diagnostics": [{"severity": "error", "file": "a.json", "line": 3, )"
            R"("column": 7, "pointer": "/x", "message": "m", "found": "f", "suggestion": "s"}]})");
}

TEST(Quote, CutsAndEscapes) {
  EXPECT_EQ(quote("a\n\"\x1b"), R"("a\n\"\u001b")");
  EXPECT_EQ(quote(std::string(41, 'x')), "\"" + std::string(40, 'x') + "...\"");
  EXPECT_EQ(quote("a\xC3"), "\"a\uFFFD\"");  // not UTF-8, as in the name of a file
  // The 40th octet is the first half of a character, which is left out as a whole.
  EXPECT_EQ(quote(std::string(39, 'x') + "\u00e4y"), "\"" + std::string(39, 'x') + "...\"");
}

TEST(EditDistance, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", "", 3), 0U);
  EXPECT_EQ(edit_distance("rate", "rate", 3), 0U);
  EXPECT_EQ(edit_distance("rate", "rtae", 3), 1U);       // a swap of neighbours
  EXPECT_EQ(edit_distance("kitten", "sitting", 3), 3U);  // the textbook's example
  EXPECT_EQ(edit_distance("ca", "abc", 3), 3U);          // optimal string alignment: no edit between the swapped
  EXPECT_EQ(edit_distance("abcdef", "uvwxyz", 3), 4U);   // more than the limit
  EXPECT_EQ(edit_distance(std::string(65, 'a'), std::string(65, 'a'), 3), 4U);  // too long to look at
}

TEST(Suggest, FindsTheNearest) {
  constexpr std::array<std::string_view, 5> names = {"rate", "length", "ends", "Gbps", "us"};
  EXPECT_EQ(suggest("lenght", names), "length");
  EXPECT_EQ(suggest("rates", names), "rate");
  EXPECT_EQ(suggest("LENGTH", names), "length");
  EXPECT_EQ(suggest("gbps", names), "Gbps");
  EXPECT_EQ(suggest("uss", names), "us");
  EXPECT_EQ(suggest("len", names), "length");
  EXPECT_EQ(suggest("le", names), "");
  EXPECT_EQ(suggest("colour", names), "");
  EXPECT_EQ(suggest("x", names), "");
  EXPECT_EQ(suggest("", names), "");
  EXPECT_EQ(suggest(std::string(1000, 'r'), names), "");
}

}  // namespace
}  // namespace takt::json
