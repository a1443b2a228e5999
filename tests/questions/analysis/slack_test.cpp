// SPDX-License-Identifier: Apache-2.0
// What bounds once gave away, in scenarios small enough for a derivation by hand.
#include <gtest/gtest.h>

#include <stdexcept>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::analysis::slack_test {
namespace {

std::unique_ptr<scenario::Resolved> load(const std::string& text) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "slack.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}

double latency_us(const Bounds& bounds, std::size_t stream) {
  EXPECT_TRUE(bounds.streams[stream].latency) << bounds.streams[stream].reason;
  return bounds.streams[stream].latency ? static_cast<double>(bounds.streams[stream].latency->ps()) / 1e6 : 0;
}

// The scenarios derive their worst cases by hand, and the simulation reaches them.
TEST(Slack, ShapersAreExact) {
  EXPECT_NEAR(latency_us(bound(*scenario::test::shipped("validation/credit-based-shaper")), 0), 121.44, 1e-4);
  EXPECT_NEAR(latency_us(bound(*scenario::test::shipped("validation/ats")), 0), 161.28, 1e-4);
}

/// Four talkers at 100 Mb/s by one switch to the next; what that one does there is asked.
std::string funnel(const std::string& second_switch) {
  std::string nodes, links, streams;
  for (const char* const host : {"a", "b", "c", "d"}) {
    nodes += std::string("\"") + host + R"(": {"kind": "host"}, )";
    links += std::string(R"({"ends": [")") + host + R"(", "s1"], "rate": "100Mbps", "delay": "0s"}, )";
    streams += std::string(streams.empty() ? "" : ", ") + R"({"name": ")" + host + R"(", "from": ")" + host +
               R"(", "to": "z", "payload": "1000B", "every": "1ms", "pcp": 5})";
  }
  return R"({"name": "funnel", "duration": "20ms", "network": {"nodes": {)" + nodes +
         R"("z": {"kind": "host"}, "s1": {"kind": "switch"}, "s2": {"kind": "switch")" + second_switch +
         R"(}}, "links": [)" + links +
         R"({"ends": ["s1", "s2"], "rate": "100Mbps", "delay": "0s"}, {"ends": ["s2", "z"], "rate": "100Mbps", "delay": "0s"}]}, "streams": [)" +
         streams + "]}";
}

std::string schedulers(const std::string& rate, const std::string& burst) {
  std::string filters, ats;
  for (const char* const stream : {"a", "b", "c", "d"}) {
    filters +=
        std::string(filters.empty() ? "" : ", ") + R"({"stream": ")" + stream + R"(", "ats": ")" + stream + "\"}";
    ats += std::string(ats.empty() ? "" : ", ") + R"({"name": ")" + stream + R"(", "rate": ")" + rate +
           R"(", "burst": ")" + burst + "\"}";
  }
  return R"(, "egress": [{"to": "z", "ats": [5]}], "ingress": {"filters": [)" + filters + R"(], "ats": [)" + ats + "]}";
}

// Frames of 1050 octets, 1058 to the last bit (84.64 us) and 1070 with the gap (85.6 us). At s1 four of them may meet:
// 3 * 85.6 + 84.64. They come to s2 one after the other and wait for nothing: 84.64 us there, and at the talker's own
// link. A scheduler that has tokens for all that comes changes nothing of that: after s1 two frames of a stream are at
// least 1000 - 256.8 us apart, and two of them are the burst.
TEST(Slack, AtsThatNeedNotShapeAddsNothing) {
  const double without = latency_us(bound(*load(funnel(""))), 0);
  EXPECT_NEAR(without, 3 * 84.64 + 3 * 85.6, 1e-3);
  EXPECT_NEAR(latency_us(bound(*load(funnel(schedulers("10Mbps", "2140B")))), 0), without, 1e-3);
  // A burst of one frame, and the rate at which it was sent: held by up to what the queue has spread it, so that all
  // four may be let go at once. The theorem: no more than the longest delay before s2, and the queue of s2.
  EXPECT_NEAR(latency_us(bound(*load(funnel(schedulers("8560kbps", "1070B")))), 0), without + 3 * 85.6, 1e-3);
}

std::string policed(const std::string& rules) {
  return R"({"name": "policed", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "z": {"kind": "host"}, "s": {"kind": "switch", "ingress": {)" +
         rules + R"(}}},
   "links": [{"ends": ["a", "s"], "rate": "100Mbps"}, {"ends": ["b", "s"], "rate": "100Mbps"}, {"ends": ["s", "z"], "rate": "100Mbps"}]},
   "streams": [{"name": "x", "from": "a", "to": "z", "payload": "200B", "every": "1ms", "pcp": 5}, {"name": "y", "from": "b", "to": "z", "payload": "1000B", "every": "1ms", "pcp": 5}]})";
}

// Each stream for itself: x has 250 octets each ms, 2 Mb/s; y 1050, 8.4 Mb/s.
TEST(Slack, FiltersDropWhatMeetsThem) {
  const auto loses_nothing = [](const std::string& rules, std::size_t stream) {
    return bound(*load(policed(rules))).streams[stream].loses_nothing;
  };
  EXPECT_TRUE(loses_nothing(
      R"("filters": [{"stream": "y", "meter": "m"}], "meters": [{"name": "m", "cir": "1Mbps", "cbs": "1500B", "drop_on_yellow": true}])",
      0));
  EXPECT_FALSE(loses_nothing(
      R"("filters": [{"stream": "y", "meter": "m"}], "meters": [{"name": "m", "cir": "1Mbps", "cbs": "1500B", "drop_on_yellow": true}])",
      1));
  EXPECT_TRUE(loses_nothing(
      R"("filters": [{"stream": "y", "meter": "m"}], "meters": [{"name": "m", "cir": "10Mbps", "cbs": "1500B", "drop_on_yellow": true}])",
      1));
  EXPECT_FALSE(loses_nothing(
      R"("filters": [{"stream": "y", "meter": "m"}], "meters": [{"name": "m", "cir": "8Mbps", "cbs": "1500B", "drop_on_yellow": true}])",
      1));
  EXPECT_FALSE(loses_nothing(
      R"("filters": [{"stream": "x", "meter": "m"}, {"stream": "y", "meter": "m"}], "meters": [{"name": "m", "cir": "10Mbps", "cbs": "3000B", "drop_on_yellow": true}])",
      0));
  EXPECT_TRUE(loses_nothing(R"("filters": [{"stream": "x", "max_sdu": "300B"}])", 0));
  EXPECT_FALSE(loses_nothing(R"("filters": [{"stream": "x", "max_sdu": "200B"}])", 0));
  EXPECT_FALSE(loses_nothing(
      R"("filters": [{"stream": "x", "gate": "g"}], "gates": [{"name": "g", "entries": [{"open": true, "for": "500us"}, {"open": false, "for": "500us"}]}])",
      0));
  EXPECT_TRUE(loses_nothing(
      R"("filters": [{"stream": "x", "gate": "g"}], "gates": [{"name": "g", "entries": [{"open": true, "ipv": 6, "for": "1ms"}]}])",
      0));
  EXPECT_TRUE(loses_nothing(
      R"("filters": [{"stream": "x", "gate": "g"}], "gates": [{"name": "g", "entries": [{"open": true, "for": "500us"}, {"open": false, "for": "500us"}]}])",
      1));
}

// A source at -400 ppm and a switch at +300 ppm that has a window for one frame each 20 us: 90 octets at 100 Mb/s, 7.84
// us to the last bit. It comes when it just does not fit any more, 7.84 us before the end of the 10 us, and waits 20 -
// (10 - 7.84) us and the gap of 0.96 us, by a clock that is 300 ppm fast; before that 98 octets at 1 Gb/s. The source
// at +500 ppm sends more than there are windows.
TEST(Slack, ConstantClocksAreKnown) {
  const Bounds bounds = bound(*scenario::test::shipped("clocks/two-sources-and-a-gate"));
  EXPECT_FALSE(bounds.streams[0].latency);
  const double propagation = latency_us(bounds, 1) - (0.784 + (20 - 2.16 + 0.96) / 1.0003 + 7.84);
  EXPECT_NEAR(propagation, 0.1, 1e-4);  // of two cables of 10 m
}

// A queue of four frames under traffic at random instants: three frames, one on the medium.
TEST(Slack, RandomGapsBehindAFullQueue) {
  const auto resolved = load(
      R"({"name": "full", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host", "queues": {"frames": 4}}, "z": {"kind": "host"}}, "links": [{"ends": ["a", "z"], "rate": "100Mbps", "delay": "0s"}]},
   "streams": [{"name": "x", "from": "a", "to": "z", "payload": "1000B", "exponential": "200us", "pcp": 5}]})");
  const Bounds bounds = bound(*resolved);
  EXPECT_NEAR(latency_us(bounds, 0), 4 * 85.6 + 84.64, 1e-3);
  EXPECT_FALSE(bounds.streams[0].loses_nothing);
}

}  // namespace
}  // namespace takt::analysis::slack_test
