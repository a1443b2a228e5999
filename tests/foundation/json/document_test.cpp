// SPDX-License-Identifier: Apache-2.0
// Places of values, and what is said about texts that are not JSON. Lines and columns are counted by hand.
#include "json/document.hpp"

#include <gtest/gtest.h>

#include <string>

namespace takt::json {
namespace {

Document must_parse(std::string_view text) {
  Diagnostics diagnostics;
  auto document = parse(text, "a.json", diagnostics);
  EXPECT_EQ(diagnostics.to_text(), "");
  if (!document) throw std::runtime_error("not parsed");
  return *document;
}

/// The one diagnostic of a text that is refused.
std::string refusal(std::string_view text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parse(text, "a.json", diagnostics).has_value()) << text.substr(0, 100);
  EXPECT_EQ(diagnostics.errors(), 1U);
  return diagnostics.to_text();
}

Position at(std::uint32_t line, std::uint32_t column) { return {0, line, column}; }

TEST(Positions, EveryTokenHasItsOwn) {
  const Document document = must_parse(
      "{ \"a\" : 1,\n"                        // 1: { at 1, "a" at 3, 1 at 9
      "  /* b, : \"x\" */ \"b\":[true,\n"     // 2: "b" at 18, [ at 22, true at 23
      "    null , -1.5e+3 // last, really\n"  // 3: null at 5, the number at 12
      "  ], \"c\": {\"d\": \"x\\\"y\"}\n"     // 4: "c" at 6, { at 11, "d" at 12, the string at 17
      "}");
  const Node& root = document.root();
  EXPECT_EQ(root.position, at(1, 1));
  ASSERT_EQ(root.members.size(), 3U);
  EXPECT_EQ(root.members[0].key_position, at(1, 3));
  EXPECT_EQ(root.members[0].value.position, at(1, 9));
  EXPECT_EQ(root.members[1].key_position, at(2, 18));
  EXPECT_EQ(root.members[1].value.position, at(2, 22));
  const auto& items = root.members[1].value.items;
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(items[0].position, at(2, 23));
  EXPECT_EQ(items[1].position, at(3, 5));
  EXPECT_EQ(items[2].position, at(3, 12));
  EXPECT_EQ(items[2].text, "-1.5e+3");
  EXPECT_EQ(root.members[2].key_position, at(4, 6));
  EXPECT_EQ(root.members[2].value.position, at(4, 11));
  const Member& inner = root.members[2].value.members.at(0);
  EXPECT_EQ(inner.key_position, at(4, 12));
  EXPECT_EQ(inner.value.position, at(4, 17));
  EXPECT_EQ(inner.value.text, "x\"y");
}

TEST(Positions, ColumnsCountCharactersAndLinesEndWithLineFeed) {
  // Before "b" stand {"ä€😀": 1, and a space: 11 characters, but 17 octets.
  const Document document = must_parse("{\"\u00e4\u20ac\U0001F600\": 1, \"b\": 2,\r\n\t\"c\": 3}");
  EXPECT_EQ(document.root().members[1].key_position, at(1, 12));
  EXPECT_EQ(document.root().members[2].key_position, at(2, 2));
}

TEST(Positions, EmptyArraysAndObjects) {
  const Document document = must_parse("[[],{},[ ] , {\n} ,1]");
  const auto& items = document.root().items;
  EXPECT_EQ(items[0].position, at(1, 2));
  EXPECT_EQ(items[1].position, at(1, 5));
  EXPECT_EQ(items[2].position, at(1, 8));
  EXPECT_EQ(items[3].position, at(1, 14));
  EXPECT_EQ(items[4].position, at(2, 4));
}

TEST(Pointers, AreEscaped) {
  const Document document = must_parse(R"({"a/b": {"m~n": [0, {"": 1}]}})");
  const Node& list = *document.root().find("a/b")->find("m~n");
  EXPECT_EQ(pointer_of(document.root()), "");
  EXPECT_EQ(pointer_of(list.items[0]), "/a~1b/m~0n/0");
  EXPECT_EQ(pointer_of(*list.items[1].find("")), "/a~1b/m~0n/1/");
}

TEST(Numbers, KeepTheirLiterals) {
  const Document document = must_parse("[18446744073709551616, -0, 1.0, 1e2, 4.9e-324]");
  const auto& items = document.root().items;
  EXPECT_EQ(to_text(*integer_of(items[0])), "18446744073709551616");  // 2^64 does not fit into the library's integers
  EXPECT_EQ(integer_of(items[1]), sim::int128{0});
  EXPECT_EQ(integer_of(items[2]), std::nullopt);
  EXPECT_EQ(double_of(items[3]), 100.0);
  EXPECT_EQ(double_of(items[4]), 4.9e-324);
}

TEST(Syntax, SaysWhereWhatAndWhatElse) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "a.json:1:1: error: the text is empty: found the end of the text, expected a JSON value\n"},
      {" \n ", "a.json:2:2: error: the text is empty: found the end of the text, expected a JSON value\n"},
      {"{} x", "a.json:1:4: error: text after the JSON value: found \"x\", expected the end of the text\n"},
      {"1 2", "a.json:1:3: error: text after the JSON value: found \"2\", expected the end of the text\n"},
      {"[1, 2", "a.json:1:6: error: the text ends too early: found the end of the text, expected \",\" or \"]\"\n"},
      {"[1,,]", "a.json:1:4: error: not valid JSON: found \",\", expected a value\n"},
      {"[1,,2]", "a.json:1:4: error: not valid JSON: found \",\", expected a value\n"},
      {"[,1]", "a.json:1:2: error: not valid JSON: found \",\", expected a value or \"]\"\n"},
      {"[1}", "a.json:1:3: error: a missing comma: found \"}\", expected \",\" or \"]\"\n"},
      {"[1\n 2]", "a.json:2:2: error: a missing comma: found \"2\", expected \",\" or \"]\"\n"},
      {"{\"a\" 1}", "a.json:1:6: error: not valid JSON: found \"1\", expected \":\" after the name\n"},
      {"{\"a\":}", "a.json:1:6: error: not valid JSON: found \"}\", expected a value\n"},
      {"{\"a\":1 \"b\":2}", "a.json:1:8: error: a missing comma: found the string \"b\", expected \",\" or \"}\"\n"},
      {"{1:2}", "a.json:1:2: error: not valid JSON: found \"1\", expected a name in double quotes or \"}\"\n"},
      {"{a:1}",
       "a.json:1:2: error: a word without quotes: found \"a\", expected a name in double quotes or \"}\" (texts stand "
       "in double quotes)\n"},
      {"]", "a.json:1:1: error: not valid JSON: found \"]\", expected a JSON value\n"},
      {"[NaN]", "a.json:1:2: error: not a JSON number: found NaN, expected a finite number\n"},
      {"{\"a\": -Infinity}", "a.json:1:7: error: not a JSON number: found -Infinity, expected a finite number\n"},
      {"[True]",
       "a.json:1:2: error: a word that JSON does not have: found \"True\", expected true, false or null in small "
       "letters\n"},
      {"['a']", "a.json:1:2: error: a string in single quotes: found ', expected double quotes, \"...\"\n"},
      {"[1, 01]",
       "a.json:1:5: error: not a JSON number: found \"01\", expected a number such as 12, -0.5 or 1e6 (a quantity with "
       "a unit is a string: \"10ms\")\n"},
      {"{\"a\": 10ms}",
       "a.json:1:7: error: not a JSON number: found \"10ms\", expected a number such as 12, -0.5 or 1e6 (a quantity "
       "with a unit is a string: \"10ms\")\n"},
      {"[1e999]",
       "a.json:1:2: error: a number that is too large: found \"1e999\", expected a number of at most about 1.8e308\n"},
      {"[\"abc",
       "a.json:1:2: error: a string that is not closed: found the end of the text, expected \" at the end of the "
       "string\n"},
      {"[\"a\nb\"]",
       "a.json:1:2: error: a string that is not closed on its line: found the end of the line, expected \" at the end "
       "of the string (a line break in a text is \\n)\n"},
      {"[\"a\tb\"]", "a.json:1:4: error: a control character in a string: found U+0009, expected \\u0009\n"},
      {"[\"C:\\dir\"]",
       "a.json:1:5: error: an unknown escape in a string: found \"\\\\d\", expected one of \\\" \\\\ \\/ \\b \\f \\n "
       "\\r \\t \\uXXXX (a backslash itself is \\\\)\n"},
      {"[\"\\u12g4\"]",
       "a.json:1:3: error: an incomplete escape in a string: found \"\\\\u12g4\", expected \\u and four hexadecimal "
       "digits\n"},
      {"[\"\\ud800x\"]",
       "a.json:1:3: error: half of a surrogate pair in a string: found \"\\\\ud800\", expected both halves, "
       "\\ud800-\\udbff and \\udc00-\\udfff, or the character itself\n"},
      {"[\"\\u00e\u0320x\"]",
       "a.json:1:3: error: an incomplete escape in a string: found \"\\\\u00e\", expected \\u and four hexadecimal "
       "digits\n"},
      {"[\"\\\u00e4\"]",
       "a.json:1:3: error: an unknown escape in a string: found \"\\\\\u00e4\", expected one of \\\" \\\\ \\/ \\b \\f "
       "\\n \\r \\t \\uXXXX (a backslash itself is \\\\)\n"},
      {"[1, /* open",
       "a.json:1:5: error: a comment that is not closed: found the end of the text, expected */ at the end of the "
       "comment\n"},
      {"# no\n1", "a.json:1:1: error: not a comment: found \"#\", expected // or /* */ around a comment\n"},
      {"\xEF\xBB\xBF{]", "a.json:1:2: error: not valid JSON: found \"]\", expected a name in double quotes or \"}\"\n"},
      {"\xFE\xFF{}", "a.json:1:1: error: a text in UTF-16: found the octet 0xFE, expected UTF-8\n"},
      {"[1,],", "a.json:1:5: error: text after the JSON value: found \",\", expected the end of the text\n"},
      {"{\"a\":1,,}", "a.json:1:8: error: not valid JSON: found \",\", expected a name in double quotes\n"},
      {"[\"a\",\n\"b\xC0\xAF\"]", "a.json:2:3: error: not UTF-8: found the octet 0xC0, expected text in UTF-8\n"},
      {"[\"\xED\xA0\x80\"]", "a.json:1:3: error: not UTF-8: found the octet 0xED, expected text in UTF-8\n"},
      {std::string("{}\0{", 4),
       "a.json:1:3: error: a NUL in the text: found the octet 0x00, expected text without NUL\n"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(refusal(text), expected) << text;
}

TEST(Syntax, WhatEditorsAndPeopleLeaveBehindIsAllowed) {
  EXPECT_EQ(compact(must_parse("\xEF\xBB\xBF{\"a\": [1, 2,], // last\n \"b\": {\"c\": \",]\", /* , */ }, }").root()),
            "{\"a\": [1, 2], \"b\": {\"c\": \",]\"}}");
  const auto document = must_parse("[1, ]");
  EXPECT_EQ(document.root().items.size(), 1u);
}

TEST(Syntax, CommentsAreAllowedEverywhere) {
  must_parse("// first\n{ /**/ \"a\" /* : */ : // x\n 1 /* , */ }\n// end");
}

TEST(Duplicates, AreAllReportedAndTheFirstIsKept) {
  Diagnostics diagnostics;
  const auto document = parse("{\"x\": {\"a\": 1, \"b\": 2,\n \"a\": 3, \"a\": 4}}", "a.json", diagnostics);
  EXPECT_EQ(
      diagnostics.to_text(),
      "a.json:2:2: error at /x/a: the name \"a\" occurs twice: expected one value (the first is in line 1, column 8)\n"
      "a.json:2:10: error at /x/a: the name \"a\" occurs twice: expected one value (the first is in line 1, column "
      "8)\n");
  ASSERT_TRUE(document.has_value());
  EXPECT_EQ(compact(document->root()), R"({"x": {"a": 1, "b": 2}})");
}

TEST(Limits, DepthIsLimited) {
  must_parse(std::string(max_depth, '[') + std::string(max_depth, ']'));
  const std::string hostile(10'000, '[');
  std::string expected_pointer;
  for (std::size_t i = 0; i < max_depth; ++i) expected_pointer += "/0";
  EXPECT_EQ(refusal(hostile), "a.json:1:65: error at " + expected_pointer +
                                  ": arrays and objects are nested too deeply: expected at most 64 levels\n");
  std::string objects;
  for (int i = 0; i < 10'000; ++i) objects += "{\"a\":";
  EXPECT_NE(refusal(objects).find("a.json:1:321: error at /a/a/"),
            std::string::npos);  // 64 levels of 5 octets before it
}

TEST(Limits, SizeIsLimited) {
  const std::string large(max_text_size + 1, ' ');
  EXPECT_EQ(refusal(large), "a.json: error: the text is too large: found 67108865 octets, expected at most 67108864\n");
}

// The limit is one of memory: so many values, each of which takes a Node, and the array around them.
TEST(Limits, MemoryOfValuesIsLimited) {
  const std::size_t most = max_memory / sizeof(Node) - 1;
  std::string text = "[0";
  for (std::size_t i = 0; i < most; ++i) text += ",0";
  EXPECT_EQ(refusal(text + "]"), "a.json:1:" + std::to_string(2 * most + 2) + ": error at /" + std::to_string(most) +
                                     ": values that take too much memory: expected at most 1024 MiB\n");
}

TEST(Limits, NamesAreLimited) {
  const std::string text = "{\"" + std::string(max_key_length + 1, 'k') + "\": 1}";
  EXPECT_NE(refusal(text).find("a.json:1:2: error: a name that is too long: found \"kkk"), std::string::npos);
}

TEST(Files, ThatCannotBeReadAreDiagnostics) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parse_file("/nowhere/a.json", diagnostics).has_value());
  EXPECT_FALSE(parse_file("/tmp", diagnostics).has_value());
  EXPECT_EQ(diagnostics.to_text(),
            "/nowhere/a.json: error: the file cannot be opened: found No such file or directory\n"
            "/tmp: error: the file cannot be read: found Is a directory\n");
}

TEST(Writing, PrettyTextReadsBack) {
  const Document document = must_parse(R"({"a":[1,2],"b":{"c":[],"d":{}},"e":[{"f":"\u0001\"\\ä"},null,true]})");
  EXPECT_EQ(pretty(document.root()),
            "{\n  \"a\": [1, 2],\n  \"b\": {\n    \"c\": [],\n    \"d\": {}\n  },\n  \"e\": [\n    {\n"
            "      \"f\": \"\\u0001\\\"\\\\ä\"\n    },\n    null,\n    true\n  ]\n}\n");
  EXPECT_TRUE(equal(must_parse(pretty(document.root())).root(), document.root()));
}

}  // namespace
}  // namespace takt::json
