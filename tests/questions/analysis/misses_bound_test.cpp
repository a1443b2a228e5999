// SPDX-License-Identifier: Apache-2.0
// How many frames may be lost or late in a row. Frames of one cable every 1 ms, each 1.x us under way: an outage of 3
// ms meets those of 3 ms and a little, four at most.
#include <gtest/gtest.h>

#include <string>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::misses_bound_test {
namespace {

RequirementBound bound_of(const std::string& requirement, const std::string& faults, const std::string& more = {}) {
  const std::string text =
      R"({"name": "t", "duration": "100ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
  "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}], "require": [)" +
      requirement + R"(], "faults": [)" + faults + "]" + more + "}";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text();
  return resolved ? bound(*resolved).requirements.at(0) : RequirementBound();
}

std::string down(const std::string& at, const std::string& lasts) {
  return R"({"kind": "link-down", "link": ["a", "b"], "at": ")" + at + R"(", "for": ")" + lasts + R"("})";
}

constexpr const char* lost = R"({"stream": "s", "lost_in_a_row": 3})";
constexpr const char* met = R"({"stream": "s", "met": 5, "of": 100})";

TEST(MissesBound, NoneWhereEachFrameComes) {
  EXPECT_EQ(bound_of(lost, "").count, 0u);
  EXPECT_EQ(bound_of(R"({"stream": "s", "deadline": "1ms", "late_in_a_row": 3})", "").count, 0u);
}

TEST(MissesBound, AnOutageTakesWhatIsProducedInIt) {
  EXPECT_EQ(bound_of(lost, down("2500us", "3ms")).count, 4u);
  EXPECT_EQ(bound_of(met, down("2500us", "3ms")).count, 4u);
}

// From 5.5 ms to 6.6 ms no frame need come; from 5.5 ms to 8.6 ms one does.
TEST(MissesBound, OutagesBetweenWhichAFrameComesAreApart) {
  EXPECT_EQ(bound_of(lost, down("2500us", "3ms") + ", " + down("6600us", "1ms")).count, 6u);
  EXPECT_EQ(bound_of(lost, down("2500us", "3ms") + ", " + down("8600us", "1ms")).count, 4u);
  EXPECT_EQ(bound_of(met, down("2500us", "3ms") + ", " + down("8600us", "1ms")).count, 6u) << "4 and 2";
}

TEST(MissesBound, CountsFromWhenItIsAsked) {
  EXPECT_EQ(bound_of(R"({"stream": "s", "lost_in_a_row": 3, "after": "6ms"})", down("2500us", "3ms")).count, 0u);
}

TEST(MissesBound, ChanceThatEndsIsAnOutage) {
  const std::string chance = R"({"kind": "frame-errors", "link": ["a", "b"], "loss": 0.1, "at": "2500us")";
  EXPECT_EQ(bound_of(lost, chance + R"(, "for": "3ms"})").count, 4u);
  const RequirementBound endless = bound_of(lost, chance + "}");
  EXPECT_FALSE(endless.count);
  EXPECT_EQ(endless.reason, "losses have no end: chance loses frames on the link of a:0");
}

TEST(MissesBound, LateIsUnknownBeyondTheDeadline) {
  const RequirementBound late = bound_of(R"({"stream": "s", "deadline": "1us", "late_in_a_row": 3})", "");
  EXPECT_FALSE(late.count);
  EXPECT_NE(late.reason.find("beyond the deadline"), std::string::npos) << late.reason;
}

TEST(MissesBound, ReactionsWithinTheirDeadline) {
  const std::string program =
      R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"}], "script": [{"at": "0ms", "program": "p", "call": "Start"}])";
  EXPECT_EQ(bound_of(R"({"reaction": "halt", "deadline": "10ms", "late_in_a_row": 0})", "", program).count, 0u);
  EXPECT_FALSE(bound_of(R"({"reaction": "halt", "deadline": "10us", "late_in_a_row": 0})", "", program).count);
}

}  // namespace
}  // namespace takt::analysis::misses_bound_test
