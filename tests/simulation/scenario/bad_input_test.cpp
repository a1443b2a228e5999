// SPDX-License-Identifier: Apache-2.0
// Every mistake is a diagnostic with place, pointer, what was found, what was expected and what to try; nothing is
// resolved. The cases stand in bad_*_test.cpp.
#include "bad_input.hpp"

#include <fmt/format.h>

#include <chrono>

namespace takt::scenario::test::bad_input_test {
namespace {

std::string without_file(std::string text) {
  const std::string prefix = "s.json:";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at))
    text.erase(at, prefix.size());
  if (text.ends_with('\n')) text.pop_back();
  return text;
}

double seconds(const auto& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST_P(BadInput, IsRefusedWithItsDiagnostics) {
  const Loaded loaded = load(GetParam().text);
  EXPECT_EQ(loaded.resolved, nullptr);
  EXPECT_TRUE(loaded.diagnostics.has_errors());
  EXPECT_EQ(without_file(loaded.diagnostics.to_text()), GetParam().diagnostics) << GetParam().text;
}

TEST(BadFile, Missing) {
  json::Diagnostics diagnostics;
  EXPECT_EQ(load_file("/nowhere/at/all.json", {}, diagnostics), nullptr);
  EXPECT_EQ(diagnostics.to_text(),
            "/nowhere/at/all.json: error: the file cannot be opened: found No such file or directory\n");
}

TEST(BadFile, Folder) {
  json::Diagnostics diagnostics;
  EXPECT_EQ(load_file(TAKT_SOURCE_DIR, {}, diagnostics), nullptr);
  EXPECT_EQ(diagnostics.errors(), 1u);
}

// 10,000 arrays in each other: refused where the limit is passed, not by the stack.
TEST(BadInputInDepth, Arrays) {
  const Loaded loaded = load(std::string(10'000, '[') + std::string(10'000, ']'));
  ASSERT_EQ(loaded.diagnostics.kept().size(), 1u);
  const json::Diagnostic& only = loaded.diagnostics.kept().front();
  EXPECT_EQ(only.place.column, 65u);
  EXPECT_EQ(only.message, "arrays and objects are nested too deeply");
  EXPECT_EQ(only.details.expected, "at most 64 levels");
}

TEST(BadInputInDepth, Objects) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += "{\"network\": ";
  const Loaded loaded = load(text + "1" + std::string(10'000, '}'));
  EXPECT_EQ(loaded.diagnostics.errors(), 1u);
  EXPECT_NE(loaded.diagnostics.to_text().find("nested too deeply"), std::string::npos);
}

// The mistakes of one file, from all stages, are told at once and in the order of the file; consequences are not: the
// host whose link leads nowhere, and the program whose name is another one, may be meant.
TEST(BadInputAtOnce, AllMistakesOfAFile) {
  const Loaded loaded = load(R"({
  "name": "t", "duration": "10 ms",
  "network": {
    "nodes": {"a": {"kind": "host"}, "b": {"kind": "host", "ox": "none"}, "sw": {"kind": "switch"}},
    "links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sv"]}, {"ends": ["sw", "sw"]}]
  },
  "streams": [{"name": "s", "from": "a", "to": "c", "payload": "100B", "every": "-1ms"}],
  "programs": [{"name": "s", "master": "a", "slaves": ["b"], "cycle": "1ms", "pcp": 9}],
  "script": [{"at": "1ms", "program": "x", "call": "Start"}]
})");
  std::string places;
  for (const json::Diagnostic& one : loaded.diagnostics.sorted())
    places += fmt::format("{}:{} {}\n", one.place.line, one.place.column, one.message);
  EXPECT_EQ(places,
            "2:28 a space in a quantity\n"
            "4:60 unknown field \"ox\"\n"
            "5:53 unknown node\n"
            "5:70 a link to itself\n"
            "7:48 unknown node\n"
            "7:81 negative\n"
            "8:25 duplicate name\n"
            "8:85 out of range\n");
}

// A hundred thousand mistakes are counted; those told stay readable, and working out suggestions does not take for
// ever.
TEST(BadInputInBulk, UnknownNodesAmongMany) {
  std::string links = R"({"ends": ["sw1", "swx"]})";
  for (int i = 0; i < 49'999; ++i) links += R"(,{"ends": ["swy", "swx"]})";
  const std::string text =
      head + R"("generate": [{"topology": "line", "switches": 90000}], "links": [)" + links + "]}}";
  std::unique_ptr<Loaded> loaded;
  EXPECT_LT(seconds([&] { loaded = std::make_unique<Loaded>(load(text)); }), 20);
  EXPECT_EQ(loaded->resolved, nullptr);
  EXPECT_EQ(loaded->diagnostics.errors(), 99'999u);
  EXPECT_EQ(loaded->diagnostics.kept().size(), 100u);
}

// The refusal of 10^9 nodes is arithmetic: no topology is begun.
TEST(BadInputInBulk, ManyGeneratorsOfTooManyNodes) {
  std::string text = head + "\"generate\": [";
  for (int i = 0; i < 64; ++i)
    text += std::string(i == 0 ? "" : ", ") + R"({"topology": "line", "switches": 1000000000, "switch_prefix": "s)" +
            std::to_string(i) + "_\"}";
  std::unique_ptr<Loaded> loaded;
  EXPECT_LT(seconds([&] { loaded = std::make_unique<Loaded>(load(text + "]}}")); }), 1);
  EXPECT_EQ(loaded->diagnostics.errors(), 64u);
}

}  // namespace
}  // namespace takt::scenario::test::bad_input_test
