// SPDX-License-Identifier: Apache-2.0
// What a bridge does with a frame between its two ports: ATS and the forwarding delay, cut-through; parallel links,
// jumbo frames.
#include "evaluation/evaluate.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario::test::forwarding_test {
namespace {

using sim::Duration;
using namespace sim::literals;

results::RunResult judged(const Resolved& resolved) {
  LiveRun live(resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}

void expect_pass(const std::string& finding, const std::vector<std::string>& overrides = {}) {
  json::Diagnostics diagnostics;
  const auto resolved =
      load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + finding + ".json", overrides, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  for (const results::RequirementResult& requirement : judged(*resolved).requirements)
    EXPECT_EQ(requirement.verdict, results::Verdict::pass) << requirement.text << ": " << requirement.remark;
}

std::map<std::string, Duration> longest(const std::string& text) {
  std::map<std::string, Duration> made;
  for (const results::StreamResult& stream : judged(*sound(text)).streams) made[stream.name] = stream.latency->max;
  return made;
}

// Best effort waits behind its closed gate while the medium is idle: no reason to store the frame of class 7.
TEST(CutThrough, StartsBesideWhatWaitsForItsGate) { expect_pass("cut-through-backlog"); }

// The port is idle and two headers come at once: the one by the first port is cut through. The other one is stored at
// the first switch, starts a gap behind, and is cut through at the second.
TEST(CutThrough, TheFirstOfTwoHeadersStarts) { expect_pass("two-cut-through"); }

/// d1 and d2 to z over one switch that cuts through classes 5 and 6; 1 Gb/s, no delays on cables. A frame of 1,200
/// octets of payload with a tag is 1250 + 8 octets, 10.064 us; its header 26 octets, 208 ns.
std::string one_switch(const std::string& egress, const std::string& streams, const std::string& rate_of_d1 = "1Gbps") {
  return R"({"name": "one", "duration": "2ms", "network": {"nodes": {"d1": {"kind": "host"}, "d2": {"kind": "host"}, "z": {"kind": "host"},
    "sw": {"kind": "switch", "egress": [{"to": "z", "cut_through": [5, 6])" +
         egress + R"(}]}},
    "links": [{"ends": ["d1", "sw"], "delay": "0ns", "rate": ")" +
         rate_of_d1 +
         R"("}, {"ends": ["d2", "sw"], "delay": "0ns"}, {"ends": ["sw", "z"], "delay": "0ns"}]}, "streams": [)" +
         streams + "]}";
}
std::string stream(const std::string& name, const std::string& from, int pcp, const std::string& offset,
                   const std::string& payload = "1200B") {
  return R"({"name": ")" + name + R"(", "from": ")" + from + R"(", "to": "z", "payload": ")" + payload +
         R"(", "pcp": )" + std::to_string(pcp) + R"(, "every": "1ms", "offset": ")" + offset + R"("})";
}

// Of two headers of one instant that of the higher class goes first, although it comes by the second port.
TEST(CutThrough, TheMoreUrgentOfTwoHeadersStarts) {
  const auto latencies = longest(one_switch("", stream("low", "d1", 5, "0us") + "," + stream("high", "d2", 6, "0us")));
  EXPECT_EQ(latencies.at("high"), 10'064_ns + 208_ns);
  EXPECT_EQ(latencies.at("low"), 208_ns + 10'064_ns + 96_ns + 10'064_ns);
}

// Class 3 has no credit left and waits: a frame of class 5 is cut through meanwhile. A frame of class 3 has the medium
// for 170 octets, 1.36 us, in which its credit falls by 1292 bits; at 50 Mb/s it is back 25.84 us later.
TEST(CutThrough, StartsBesideWhatWaitsForCredit) {
  const std::string shaper = R"(, "shapers": [{"class": 3, "idle_slope": "50Mbps"}])";
  const auto latencies =
      longest(one_switch(shaper, stream("a", "d1", 3, "0us", "100B") + "," + stream("b", "d1", 3, "0us", "100B") + "," +
                                     stream("c", "d2", 5, "5us")));
  EXPECT_EQ(latencies.at("c"), 10'064_ns + 208_ns);
  EXPECT_GT(latencies.at("b"), 20_us);
}

// A frame of the same class that waits for the next window has come before: none overtakes it, although a short one
// would fit. The long one comes from a link of 100 Mb/s and is whole at 110.64 us; from then on it takes 10.064 us, and
// the window closes at 120 us.
TEST(CutThrough, NobodyOvertakesWithinAClass) {
  const std::string gates = R"(, "gates": {"entries": [{"open": [5], "for": "20us"}, {"open": [6], "for": "80us"}]})";
  const auto latencies = longest(
      one_switch(gates, stream("long", "d1", 5, "10us") + "," + stream("short", "d2", 5, "112us", "100B"), "100Mbps"));
  EXPECT_EQ(latencies.at("long"), 200_us - 10_us + 10'064_ns);
  EXPECT_EQ(latencies.at("short"), 200_us - 112_us + 10'064_ns + 96_ns + 1'264_ns);
}

// What may start now goes first, whatever its class: the frame of class 0 is whole when the header of class 6 comes.
TEST(CutThrough, IsNotDoneWhereAWholeFrameMayStart) {
  // 100 octets of payload with tag are whole after 158 octets, 1.264 us.
  const auto latencies =
      longest(one_switch("", stream("whole", "d1", 0, "0us", "100B") + "," + stream("header", "d2", 6, "1056ns")));
  EXPECT_EQ(latencies.at("whole"), 1'264_ns + 1'264_ns);
  EXPECT_EQ(latencies.at("header"), 10'064_ns + 10'064_ns);
}

// A burst of four before ATS: 100 octets of payload with tag are 150 octets on the medium with gap and preamble 170, a
// bucket of 170 octets at 10 Mb/s: 136 us apart, however long the bridge takes.
TEST(Ats, DistancesAreThoseOfTheBucketWhateverTheForwardingDelay) {
  for (const std::string delay : {"0us", "3us", "100us", "500us"}) {
    json::Diagnostics diagnostics;
    const auto resolved = load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/ats-forwarding-delay.json",
                                    {"/network/nodes/s/forwarding_delay=" + delay, "/duration=3ms"}, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    const results::RunResult result = judged(*resolved);
    const auto burst = std::ranges::find(result.streams, "burst", &results::StreamResult::name);
    EXPECT_EQ(burst->latency->max - burst->latency->min, 3 * 136_us) << delay;
  }
}

/// a and b at s1, z and c at s2, two links between the switches: ports 2 and 3 of s1, 0 and 1 of s2.
std::unique_ptr<Resolved> two_links(const std::vector<std::string>& overrides) {
  json::Diagnostics diagnostics;
  auto resolved = load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/lag.json", overrides, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}
std::uint64_t frames_at(const results::RunResult& result, std::string_view node, std::uint16_t port) {
  const auto found = std::ranges::find_if(
      result.ports, [&](const results::PortResult& each) { return each.node == node && each.port == port; });
  return found == result.ports.end() ? 0 : found->frames;
}

// 1000 octets of payload without a tag are 1046 + 20 octets, 8.528 us, on the medium: over one link y waits behind x,
// over two it does not.
TEST(ParallelLinks, AStreamChoosesItsLink) {
  const auto latency = [](const results::RunResult& result, std::string_view name) {
    return std::ranges::find(result.streams, name, &results::StreamResult::name)->latency->max;
  };
  const results::RunResult shared = judged(*two_links({}));
  EXPECT_EQ(latency(shared, "y") - latency(shared, "x"), 8'528_ns);
  EXPECT_EQ(frames_at(shared, "s1", 3), 0u);
  const results::RunResult apart = judged(*two_links({R"(streams.1.path=["b", "s1:3", "s2", "c"])"}));
  EXPECT_EQ(latency(apart, "y"), latency(apart, "x"));
  EXPECT_EQ(frames_at(apart, "s1", 2), frames_at(apart, "s1", 3));
}

// One of them fails: the copies over the other one come.
TEST(ParallelLinks, RedundantCopiesTakeBoth) {
  const auto resolved = two_links({"streams.0.redundancy=2", "streams.1.until=1ns",
                                   R"(faults=[{"kind": "link-down", "link": ["s1:2", "s2:0"], "at": "5ms"}])"});
  ASSERT_EQ(resolved->redundancies.size(), 1u);
  EXPECT_EQ(resolved->topology.nodes[resolved->redundancies[0].split].name, "s1");
  EXPECT_EQ(resolved->topology.nodes[resolved->redundancies[0].merge].name, "s2");
  const results::RunResult result = judged(*resolved);
  const auto x = std::ranges::find(result.streams, "x", &results::StreamResult::name);
  EXPECT_GT(x->sent, 400u);
  EXPECT_EQ(x->delivered + x->in_flight, x->sent);
  EXPECT_EQ(x->lost, 0u);
  EXPECT_GT(frames_at(result, "s1", 3), 400u);
}

TEST(ParallelLinks, APathNamesAPortThatLeadsOn) {
  const auto refused = [](const std::string& path) {
    json::Diagnostics diagnostics;
    EXPECT_EQ(
        load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/lag.json", {"streams.1.path=" + path}, diagnostics),
        nullptr);
    return diagnostics.to_text();
  };
  EXPECT_NE(refused(R"(["b", "s1:1", "s2", "c"])")
                .find(R"(not a port that leads on: found "s1:1", expected a port of "s1" to "s2")"),
            std::string::npos);
  EXPECT_NE(refused(R"(["b", "s1:2", "s2", "c:0"])").find("a port at the end of a path"), std::string::npos);
  EXPECT_NE(refused(R"(["b", "s3:2", "s2", "c"])").find("unknown node"), std::string::npos);
}

// 8,972 octets of payload with UDP and IP are 9,000; with Ethernet 9,018 and 20 more on the medium, 7.2304 us at 10
// Gb/s but for the gap.
TEST(JumboFrames, PassWhereEachNodeLetsThem) {
  const std::string file = std::string(TAKT_SOURCE_DIR) + "/tests/findings/jumbo.json";
  const auto text_of = [&](const std::vector<std::string>& overrides) {
    json::Diagnostics diagnostics;
    EXPECT_EQ(load_file(file, overrides, diagnostics), nullptr);
    return diagnostics.to_text();
  };
  EXPECT_NE(text_of({}).find("expected at most 1500 with all headers, or jumbo frames, by \"mtu\""), std::string::npos)
      << text_of({});
  EXPECT_NE(
      text_of({"network.nodes.a.mtu=9000B"})
          .find("longer than the MTU of a node on its path: found 9000 octets after the EtherType; \"z\" passes 1500"),
      std::string::npos)
      << text_of({"network.nodes.a.mtu=9000B"});
  for (const std::vector<std::string>& mtu :
       {std::vector<std::string>{"network.mtu=9000B"},
        std::vector<std::string>{"network.nodes.a.mtu=9000B", "network.nodes.z.mtu=9000B"}}) {
    json::Diagnostics diagnostics;
    const auto resolved = load_file(file, mtu, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    EXPECT_EQ(judged(*resolved).streams.at(0).latency->max, Duration::from_ps(9'026 * 800 + 50'000));
  }
}

// A burst of three is a train: its frames follow each other by 1070 octets, 8.56 us, at every port, and the windows are
// laid for it. The other stream finds an offset at which it meets none of them. A frame alone takes three times 1058
// octets, and three cables of 50 ns.
TEST(Trains, BurstsHaveWindows) {
  json::Diagnostics diagnostics;
  for (const auto& [overrides, apart] : {std::pair(std::vector<std::string>{}, 8'560_ns),
                                         std::pair(std::vector<std::string>{"streams.0.burst.spacing=100us"}, 0_ns)}) {
    const auto resolved =
        load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/train.json", overrides, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    ASSERT_TRUE(resolved->gates);
    EXPECT_EQ(resolved->gates->problem.streams.size(), 4u);
    const results::RunResult result = judged(*resolved);
    EXPECT_EQ(result.verdict, results::Verdict::pass);
    for (const results::StreamResult& stream : result.streams) {
      EXPECT_EQ(stream.latency->min, 25'542_ns) << stream.name;
      EXPECT_EQ(stream.latency->max, 25'542_ns + (stream.name == "flow0" ? 2 * apart : 0_ns)) << stream.name;
    }
  }
}

}  // namespace
}  // namespace takt::scenario::test::forwarding_test
