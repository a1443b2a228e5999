// SPDX-License-Identifier: Apache-2.0
// What of a redundant stream is left when cables are cut. A ring of four stations at 1 Gbit/s; frames of 268 octets
// with R-TAG go from the first to the third, by the second and by the fourth: three hops of 2144 ns and less than 20 us
// in all.
#include <gtest/gtest.h>

#include <string>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::surviving_copies_test {
namespace {

struct Found {
  bool loses_nothing = false;
  bool reaches_all = false;
  std::string reason;
};

std::string cut(const std::string& a, const std::string& b, const std::string& at, const std::string& lasts) {
  return R"({"kind": "link-down", "link": [")" + a + R"(", ")" + b + R"("], "at": ")" + at + R"(", "for": ")" + lasts +
         R"("})";
}

Found look(const std::string& faults, const std::string& redundancy = "2") {
  const std::string text =
      R"({"name": "t", "duration": "100ms", "network": {"generate": [{"topology": "ring", "stations": 4}]},
 "streams": [{"name": "s", "from": "st1", "to": "st3", "payload": "200B", "every": "1ms", "pcp": 4, "redundancy": )" +
      redundancy + R"(}],
 "faults": [)" +
      faults + "]}";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text();
  if (!resolved) return {};
  const Bounds bounds = bound(*resolved);
  return {bounds.streams[0].loses_nothing, bounds.streams[0].reaches_all, bounds.streams[0].loss_reason};
}

TEST(SurvivingCopies, ACutTakesCopiesAndNoFrame) {
  const Found found = look(cut("st1", "st2", "10ms", "20ms"));
  EXPECT_FALSE(found.loses_nothing);
  EXPECT_TRUE(found.reaches_all) << found.reason;
}

TEST(SurvivingCopies, CutsOneAfterTheOtherTakeNoFrame) {
  const Found found = look(cut("st1", "st2", "10ms", "20ms") + ", " + cut("st3", "st4", "31ms", "20ms"));
  EXPECT_TRUE(found.reaches_all) << found.reason;
}

// A frame that is on the first way when it is cut no more, and on the second when that is cut: its copies may both be
// lost.
TEST(SurvivingCopies, CutsWithLessBetweenThanAFrameTakesMayTakeOne) {
  EXPECT_FALSE(look(cut("st1", "st2", "10ms", "20ms") + ", " + cut("st3", "st4", "30001us", "20ms")).reaches_all);
}

TEST(SurvivingCopies, CutsTogetherTakeFrames) {
  const Found found = look(cut("st1", "st2", "10ms", "20ms") + ", " + cut("st3", "st4", "20ms", "1ms"));
  EXPECT_FALSE(found.reaches_all);
  EXPECT_NE(found.reason.find("on every way at a time"), std::string::npos) << found.reason;
}

// Two cuts of one cable overlap: it is whole when the second ends.
TEST(SurvivingCopies, CutsOfOneCableOverlap) {
  const std::string twice = cut("st1", "st2", "10ms", "20ms") + ", " + cut("st1", "st2", "20ms", "20ms") + ", ";
  EXPECT_FALSE(look(twice + cut("st3", "st4", "35ms", "1ms")).reaches_all);
  EXPECT_TRUE(look(twice + cut("st3", "st4", "41ms", "1ms")).reaches_all);
}

TEST(SurvivingCopies, ACrashOnOneWayTakesNoFrame) {
  EXPECT_TRUE(look(R"({"kind": "crash", "node": "st4", "at": "10ms"})").reaches_all);
  EXPECT_FALSE(look(R"({"kind": "crash", "node": "st3", "at": "10ms"})").reaches_all);
}

// Chance counts as always: where it takes copies on one way, the other must never be cut.
TEST(SurvivingCopies, ChanceOnOneWayLeavesTheOther) {
  const std::string errors = R"({"kind": "frame-errors", "link": ["st1", "st2"], "at": "0s", "loss": 0.5})";
  EXPECT_TRUE(look(errors).reaches_all);
  EXPECT_FALSE(look(errors + ", " + cut("st3", "st4", "20ms", "1ms")).reaches_all);
}

// Members that are recovered one by one are out of order after an outage, until the reset.
TEST(SurvivingCopies, IndividualRecoveryIsNotTrustedBehindAnOutage) {
  EXPECT_FALSE(look(cut("st1", "st2", "10ms", "20ms"), R"({"individual": true})").reaches_all);
}

// The copies of h5 leave one behind the other, so the second one comes into its own window and not into the first one's.
TEST(SurvivingCopies, CopiesOfOneTalkerComeInTheirOrder) {
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/frer-multicast.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const Bounds bounds = bound(*resolved);
  EXPECT_EQ(bounds.streams[0].latency, sim::Duration::from_ps(17'876'000));  // what a run shows
  // The longest path: behind the other copy at the talker, then by six switches the other way round.
  EXPECT_EQ(bounds.streams[1].latency, sim::Duration::from_ps(36'142'000));
}

}  // namespace
}  // namespace takt::analysis::surviving_copies_test
