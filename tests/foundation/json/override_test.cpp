// SPDX-License-Identifier: Apache-2.0
#include "json/override.hpp"

#include <gtest/gtest.h>

#include "sample.hpp"

namespace takt::json {
namespace {

constexpr std::string_view base = R"({"name": "x", "a.b": 1, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"]}]})";

Document document(std::string_view text = base) {
  Diagnostics diagnostics;
  return *parse(text, "s.json", diagnostics);
}

/// The document after the override, on one line; or the diagnostics, if the override is refused.
std::string after(std::string_view option) {
  Document changed = document();
  Diagnostics diagnostics;
  if (apply(changed, option, diagnostics)) {
    EXPECT_EQ(diagnostics.errors(), 0U);
    return compact(changed.root());
  }
  EXPECT_EQ(compact(changed.root()), compact(document().root()));
  return diagnostics.to_text();
}

TEST(Override, ReplacesAndMakes) {
  EXPECT_EQ(after("name=y"), R"({"name": "y", "a.b": 1, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"]}]})");
  EXPECT_EQ(after("/name=y"), after("name=y"));
  EXPECT_EQ(after("/a.b=2"), R"({"name": "x", "a.b": 2, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"]}]})");
  EXPECT_EQ(after("links.1.rate=100Mbps"),
            R"({"name": "x", "a.b": 1, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"], "rate": "100Mbps"}]})");
  EXPECT_EQ(after("/links/0/ends/1=z"),
            R"({"name": "x", "a.b": 1, "links": [{"ends": ["a", "z"]}, {"ends": ["b", "c"]}]})");
  EXPECT_EQ(after("links=[]"), R"({"name": "x", "a.b": 1, "links": []})");
  EXPECT_EQ(after("links.2={\"ends\": [1]}"),
            R"({"name": "x", "a.b": 1, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"]}, {"ends": [1]}]})");
  EXPECT_EQ(after("links.-.rate=1Gbps"),
            R"({"name": "x", "a.b": 1, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"]}, {"rate": "1Gbps"}]})");
  EXPECT_EQ(after("p.q.r=1"),
            R"({"name": "x", "a.b": 1, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"]}], "p": {"q": {"r": 1}}})");
  EXPECT_EQ(after("/x~1y~0=1"),
            R"({"name": "x", "a.b": 1, "links": [{"ends": ["a", "b"]}, {"ends": ["b", "c"]}], "x/y~": 1})");
}

TEST(Override, ValuesAreJsonOrStrings) {
  const auto value = [](std::string_view text) {
    Document changed = document("{}");
    Diagnostics diagnostics;
    EXPECT_TRUE(apply(changed, "v=" + std::string(text), diagnostics)) << diagnostics.to_text();
    return compact(*changed.root().find("v"));
  };
  EXPECT_EQ(value("1.50"), "1.50");
  EXPECT_EQ(value("true"), "true");
  EXPECT_EQ(value("null"), "null");
  EXPECT_EQ(value("\"1\""), "\"1\"");
  EXPECT_EQ(value("[1,2]"), "[1, 2]");
  EXPECT_EQ(value("10ms"), "\"10ms\"");
  EXPECT_EQ(value("007"), "\"007\"");
  EXPECT_EQ(value(""), "\"\"");
  EXPECT_EQ(value("a=b"), "\"a=b\"");
}

TEST(Override, RefusalsNameTheOption) {
  EXPECT_EQ(after("name"),
            "--set name: error: not an override: found no \"=\" in it, expected pointer=value, such as "
            "network.links.0.rate=100Mbps\n");
  EXPECT_EQ(after("=1"),
            "--set =1: error: not an override: found nothing before the \"=\", expected pointer=value, such as "
            "network.links.0.rate=100Mbps\n");
  EXPECT_EQ(after("a..b=1"),
            "--set a..b=1: error: not an override: found an empty step in the pointer, expected pointer=value, such as "
            "network.links.0.rate=100Mbps\n");
  EXPECT_EQ(after("/a~2=1"),
            "--set /a~2=1: error: not an override: found a ~ that is neither ~0 nor ~1, expected pointer=value, such "
            "as network.links.0.rate=100Mbps\n");
  EXPECT_EQ(after("links.3=1"),
            "--set links.3=1: error at /links: no such item: found \"3\", expected an index from 0 to 2 (2 appends)\n");
  EXPECT_EQ(
      after("links.01=1"),
      "--set links.01=1: error at /links: no such item: found \"01\", expected an index from 0 to 2 (2 appends)\n");
  EXPECT_EQ(after("links.first=1"),
            "--set links.first=1: error at /links: no such item: found \"first\", expected an index from 0 to 2 (2 "
            "appends)\n");
  EXPECT_EQ(after("name.x=1"),
            "--set name.x=1: error at /name: nothing can be set inside a value that is neither object nor array (step "
            "\"x\"): found the string \"x\", expected an object or an array\n");
  EXPECT_EQ(after("v={\"a\":}"),
            "--set v={\"a\":}: error: in the value: not valid JSON: found \"}\", expected a value\n");
  EXPECT_EQ(after("v={\"a\":1,\"a\":2}"),
            "--set v={\"a\":1,\"a\":2}: error at /a: in the value: the name \"a\" occurs twice: expected one value "
            "(the first is in line 1, column 2)\n");
  EXPECT_NE(after("v=\xFF").find("not UTF-8"), std::string::npos);
  EXPECT_NE(after("a.b=" + std::string(63, '[') + std::string(63, ']')).find("nested too deeply"), std::string::npos);
  std::string deep = "v";
  for (int i = 0; i < 100; ++i) deep += ".v";
  EXPECT_NE(after(deep + "=1").find("a pointer that is too long"), std::string::npos);
}

TEST(Override, MistakesInItsValueNameIt) {
  Document changed = document(R"({"name": "x"})");
  const Document original = changed;
  Diagnostics diagnostics;
  ASSERT_TRUE(apply(changed, "duration=10", diagnostics));
  ASSERT_TRUE(apply(changed, "links.rat=1Gbps", diagnostics));
  ASSERT_TRUE(apply(changed, "levle=1", diagnostics));
  sample::Sample s;
  EXPECT_FALSE(decode(changed, s, diagnostics));
  EXPECT_EQ(diagnostics.to_text(),
            "--set duration=10: error at /duration: wrong type: found the number 10, expected a duration such as the "
            "string \"200us\"\n"
            "--set links.rat=1Gbps: error at /links: wrong type: found an object, expected an array\n"
            "--set levle=1: error at /levle: unknown field \"levle\" (did you mean \"level\"?)\n");
  EXPECT_EQ(compact(original.root()), R"({"name": "x"})");  // a copy is not changed by overrides of another
}

}  // namespace
}  // namespace takt::json
