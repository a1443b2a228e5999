// SPDX-License-Identifier: Apache-2.0
// Bad input as a table: a text and everything that is said about it, one diagnostic a line.
//
// The interesting part of a text always begins in column 1 of line 2 (or is the whole text), so that places are easy to
// count: "2:7" is the seventh character of what the case shows.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "support.hpp"

namespace takt::scenario::test {

struct BadCase {
  const char* name;
  std::string text;
  std::string diagnostics;  ///< without the file's name
};
inline void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.name; }
inline std::string name_of_case(const testing::TestParamInfo<BadCase>& info) { return info.param.name; }

class BadInput : public testing::TestWithParam<BadCase> {};

inline const std::string head = R"({"name": "t", "duration": "1ms", "network": {)";
inline const std::string two_hosts = R"("a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch"})";
inline const std::string two_links = R"({"ends": ["a", "sw"]}, {"ends": ["b", "sw"]})";
inline const std::string small_network = "\"nodes\": {" + two_hosts + "}, \"links\": [" + two_links + "]";
inline const std::string one_program = R"("programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"}])";

inline std::string with_duration(const std::string& text) {
  return "{\"name\": \"t\", \"network\": {\"nodes\": {\"a\": {\"kind\": \"switch\"}}},\n\"duration\": " + text + "}";
}
inline std::string scenario_with(const std::string& members) { return head + small_network + "},\n" + members + "}"; }
inline std::string with_network(const std::string& members) { return head + "\n" + members + "}}"; }
/// `text` is the node "a".
inline std::string with_node(const std::string& text) {
  return head + "\"links\": [" + two_links +
         "], \"nodes\": {\"b\": {\"kind\": \"host\"}, \"sw\": {\"kind\": \"switch\"},\n\"a\": " + text + "}}}";
}
inline std::string with_links(const std::string& links) {
  return head + "\"nodes\": {" + two_hosts + "}, \"links\": [\n" + links + "]}}";
}
inline std::string generated_text(const std::string& members) { return head + "\"generate\": [\n{" + members + "}]}}"; }
inline std::string with_streams(const std::string& streams) {
  return head + small_network + "}, \"streams\": [\n" + streams + "]}";
}
inline std::string with_programs(const std::string& programs) {
  return head + small_network + "}, \"programs\": [\n" + programs + "]}";
}
inline std::string with_script(const std::string& entry) {
  return head + small_network + "}, " + one_program + ", \"script\": [\n" + entry + "]}";
}
inline std::string with_requirement(const std::string& text) {
  return head + small_network + "}, " + one_program + ", \"require\": [\n" + text + "]}";
}

}  // namespace takt::scenario::test
