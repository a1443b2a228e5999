// SPDX-License-Identifier: Apache-2.0
// Where the time of a frame goes, by hand. Links of 1 Gbit/s: an octet lasts 8 ns. A frame with a payload of p octets
// has 14 of header, a VLAN tag of 4, 28 of IPv4 and UDP, p, and an FCS of 4: 50 + p octets, with 8 of preamble before
// them and a gap of 12 behind.
#include <gtest/gtest.h>

#include <algorithm>

#include "explain/ask.hpp"
#include "scenario/resolve.hpp"

namespace takt::explain {
namespace {

std::unique_ptr<scenario::Resolved> resolved(const std::string& text) {
  json::Diagnostics diagnostics;
  auto made = scenario::load_text(text, "test", {}, diagnostics);
  EXPECT_TRUE(made) << diagnostics.to_text();
  return made;
}

/// Two talkers, one switch with 1 us of forwarding delay, one listener; all cables 10 m, of 50 ns.
std::string two_talkers(const std::string& streams, const std::string& more = "") {
  return R"({"name": "two", "duration": "1ms", "network": {"nodes": {
    "a": {"kind": "host", "os": "none"}, "b": {"kind": "host", "os": "none"}, "c": {"kind": "host", "os": "none"}, "sw": {"kind": "switch", "forwarding_delay": "1us"}},
    "links": [{"ends": ["a", "sw"], "rate": "1Gbps", "length": "10m"}, {"ends": ["b", "sw"], "rate": "1Gbps", "length": "10m"}, {"ends": ["sw", "c"], "rate": "1Gbps", "length": "10m"}]},
    "streams": [)" +
         streams + "]" + more + "}";
}

std::vector<std::pair<std::string, std::int64_t>> parts_of(const ExplainedFrame& frame) {
  std::vector<std::pair<std::string, std::int64_t>> parts;
  for (const ExplainedHop& hop : frame.hops)
    for (const ExplainedPart& part : hop.parts) parts.emplace_back(part.cause, part.takes.ps());
  return parts;
}
using Parts = std::vector<std::pair<std::string, std::int64_t>>;

TEST(Ways, FrameBehindALowerOneThatIsOnTheWireAlready) {
  // b's frame has 1050 octets: with its preamble 1058 octets, 8464 ns; it is at sw's port at 8464 + 50 + 1000 = 9514
  // ns, and has the medium until 9514 + 8 * 1070 = 18074 ns. a's frame has 150 octets: 158 octets, 1264 ns; sent at
  // 9000 ns it is at the port at 9000 + 1264 + 50 + 1000 = 11314 ns, and waits 6760 ns.
  const auto scenario = resolved(two_talkers(
      R"({"name": "urgent", "from": "a", "to": "c", "payload": "100B", "every": "1ms", "offset": "9us", "pcp": 6},
    {"name": "bulk", "from": "b", "to": "c", "payload": "1000B", "every": "1ms", "pcp": 1})"));
  const auto frames =
      explain_frame(*scenario, {.stream = models::StreamIndex{0}, .which = FrameQuestion::Which::number});
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].end, "delivered");
  EXPECT_EQ(frames[0].node, "c");
  EXPECT_EQ(parts_of(frames[0]), (Parts{{"transmission", 1'264'000},
                                        {"cable", 50'000},
                                        {"forwarding", 1'000'000},
                                        {"lower_class", 6'760'000},
                                        {"transmission", 1'264'000},
                                        {"cable", 50'000}}));
  const ExplainedPart& wait = frames[0].hops[1].parts[0];
  EXPECT_EQ(wait.stream, "bulk");
  EXPECT_EQ(wait.sequence, 0u);
  EXPECT_EQ(frames[0].takes, Duration::from_ps(10'388'000));
}

TEST(Ways, FrameBehindItsOwnClassAndAHigherOne) {
  // Both frames of 150 octets come to sw's port at 2314 ns, by ports 0 and 1: b's waits until a's frame and its gap are
  // over, 8 * 170 = 1360 ns.
  const std::string same =
      R"({"name": "first", "from": "a", "to": "c", "payload": "100B", "every": "1ms", "pcp": 3}, {"name": "second", "from": "b", "to": "c", "payload": "100B", "every": "1ms", "pcp": )";
  for (const auto& [pcp, cause] : {std::pair("3", "own_class"), std::pair("2", "higher_class")}) {
    const auto scenario = resolved(two_talkers(same + pcp + "}"));
    const auto frames = explain_frame(*scenario, {.stream = models::StreamIndex{1}});
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(parts_of(frames[0]), (Parts{{"transmission", 1'264'000},
                                          {"cable", 50'000},
                                          {"forwarding", 1'000'000},
                                          {cause, 1'360'000},
                                          {"transmission", 1'264'000},
                                          {"cable", 50'000}}))
        << cause;
    EXPECT_EQ(frames[0].hops[1].parts[0].stream, "first");
  }
}

TEST(Ways, LostFrameSaysWhereAndWhy) {
  const auto scenario = resolved(
      two_talkers(R"({"name": "s", "from": "a", "to": "c", "payload": "100B", "every": "1ms"})",
                  R"(, "faults": [{"kind": "link-down", "link": ["sw", "c"], "at": "1500ns", "for": "100us"}])"));
  const auto frames = explain_frame(*scenario, {.stream = models::StreamIndex{0}, .which = FrameQuestion::Which::lost});
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].end, "dropped");
  EXPECT_EQ(frames[0].node, "sw");
  EXPECT_EQ(frames[0].reason, "link_down");
  EXPECT_EQ(frames[0].takes,
            Duration::from_ps(
                2'282'000));  // no tag: 154 octets, 1232 ns, then 1050 ns: when it came to the port whose link was down
}

// Why a frame of a class that is cut through was stored: another header came first; its gate; a link of another rate.
TEST(Ways, AStoredFrameSaysWhy) {
  const auto stored = [](const std::string& streams, const std::string& of_links, const std::string& egress) {
    const auto scenario = resolved(R"({"name": "two", "duration": "1ms", "network": {"nodes": {
      "a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"},
      "sw": {"kind": "switch", "egress": [{"to": "c", "cut_through": [6])" +
                                   egress + R"(}]}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}, {"ends": ["sw", "c"])" +
                                   of_links + R"(}]},
      "streams": [)" + streams + "]}");
    const auto frames = explain_frame(*scenario, {.stream = models::StreamIndex{0}});
    EXPECT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames.front().hops.size(), 2u);
    return frames.front().hops.back().stored.value_or("cut through");
  };
  const std::string one =
      R"({"name": "one", "from": "b", "to": "c", "payload": "500B", "every": "1ms", "offset": "5us", "pcp": 6})";
  const std::string other =
      R"(, {"name": "other", "from": "a", "to": "c", "payload": "500B", "every": "1ms", "pcp": 6, "offset": ")";
  EXPECT_EQ(stored(one, "", ""), "cut through");
  EXPECT_EQ(stored(one + other + "5us\"}", "", ""), "first comes other frame 0");
  EXPECT_EQ(stored(one + other + "3us\"}", "", ""), "on the medium is other frame 0");
  EXPECT_EQ(stored(one, R"(, "rate": "100Mbps")", ""), "it comes from a link of another rate");
  EXPECT_EQ(stored(one, "", R"(, "gates": {"entries": [{"open": [0], "for": "7us"}, {"open": [6], "for": "43us"}]})"),
            "its gate is closed, entry 0");
  EXPECT_EQ(stored(one, "", R"(, "max_sdu": [{"class": 6, "size": "528B"}])"), "cut through");
}

// A frame of which a copy came by another way is not lost. Frame 91 is: both copies end at the link that is down, the
// second one as it comes to the switch behind the first.
TEST(Ways, LostIsOfWhichNoCopyCame) {
  json::Diagnostics diagnostics;
  const auto scenario =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/multicast-ring-cut.json", {}, diagnostics);
  ASSERT_TRUE(scenario) << diagnostics.to_text();
  const auto frames = explain_frame(*scenario, {.which = FrameQuestion::Which::lost});
  ASSERT_FALSE(frames.empty());
  for (const ExplainedFrame& frame : frames) {
    EXPECT_EQ(frame.sequence, 91u);
    EXPECT_EQ(frame.end, "dropped");
    EXPECT_EQ(frame.reason, "link_down");
  }
  EXPECT_TRUE(std::ranges::any_of(
      frames, [](const ExplainedFrame& frame) { return frame.node == "SW_4" || frame.node == "ES_2"; }));
  // With the ring alone cut, none is.
  const auto whole = scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/multicast-ring-cut.json",
                                         {"/faults/1/at=99.9ms"}, diagnostics);
  ASSERT_TRUE(whole) << diagnostics.to_text();
  EXPECT_TRUE(explain_frame(*whole, {.which = FrameQuestion::Which::lost}).empty());
}

TEST(Ways, ThereIsNoFrameOfThatNumber) {
  const auto scenario =
      resolved(two_talkers(R"({"name": "s", "from": "a", "to": "c", "payload": "100B", "every": "1ms"})"));
  EXPECT_TRUE(
      explain_frame(*scenario, {.stream = models::StreamIndex{0}, .which = FrameQuestion::Which::number, .number = 7})
          .empty());
  EXPECT_TRUE(explain_frame(*scenario, {.which = FrameQuestion::Which::lost}).empty());
}

}  // namespace
}  // namespace takt::explain
