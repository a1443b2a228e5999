// SPDX-License-Identifier: Apache-2.0
// What is left of a scenario is what was asked for, and no more.
#include "tests/generator/shrink.hpp"

#include <gtest/gtest.h>

#include "json/document.hpp"

namespace takt::generator {
namespace {

std::string compact(const std::string& text) {
  json::Diagnostics diagnostics;
  return json::compact(json::parse(text, "s.json", diagnostics)->root());
}

TEST(Shrink, LeavesWhatIsNeeded) {
  const std::string text =
      R"({"duration": "6400us", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch"}},
                               "links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}]}, "streams": [{"name": "x"}, {"name": "y", "every": "1ms"}, {"name": "z"}]})";
  const auto still = [](const std::string& each) {
    return each.find("\"y\"") != std::string::npos && each.find("\"duration\"") != std::string::npos &&
           each.find("\"a\"") != std::string::npos;
  };
  EXPECT_EQ(compact(shrink(text, still)),
            R"({"duration": "12us", "network": {"nodes": {"a": {}}}, "streams": [{"name": "y"}]})");
}

TEST(Shrink, AsksNoMoreThanItMay) {
  unsigned questions = 0;
  shrink(R"({"a": [1, 2, 3, 4, 5, 6, 7, 8]})", [&](const std::string&) { return ++questions > 1000; }, 5);
  EXPECT_LE(questions, 5u);
}

}  // namespace
}  // namespace takt::generator
