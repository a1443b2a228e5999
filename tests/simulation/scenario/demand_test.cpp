// SPDX-License-Identifier: Apache-2.0
// What streams ask of links, against figures by hand.
#include <cmath>
#include <map>

#include "support.hpp"

namespace takt::scenario::test::demand_test {
namespace {

const PortDemand& port(const Resolved& r, const char* from, const char* to) {
  for (const PortDemand& one : r.ports)
    if (one.node.value == node(r, from) && one.peer.value == node(r, to)) return one;
  throw std::runtime_error("carries nothing");
}

// 100 B + UDP/IPv4 28 B + Ethernet 14 B + FCS 4 B + tag 4 B = 150 B; with preamble and SFD 8 B and gap 12 B 170 B =
// 1360 bit. Once in 10 us: 136 Mb/s, 13.6 % of 1 Gb/s. Priority 5 is class 5.
TEST(Demand, OneTaggedStream) {
  const auto r = sound(over_one_switch(
      R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "10us", "pcp": 5}])"));
  EXPECT_EQ(r->ports.size(), 2u);
  EXPECT_DOUBLE_EQ(port(*r, "a", "sw").share(), 0.136);
  EXPECT_DOUBLE_EQ(port(*r, "sw", "b").class_bits_per_second[5], 136e6);
  EXPECT_DOUBLE_EQ(r->streams[0].demand.frames_per_second, 100'000);
}

// Untagged, 1 B of payload after the EtherType: 64 B at least, 84 B on the wire = 672 bit; in 1 ms 5 frames: 3.36 Mb/s.
// Priority 0 is traffic class 1 (IEEE 802.1Q Table 8-5), or class 0 with the identity.
TEST(Demand, ABurstOfSmallFrames) {
  const std::string burst =
      R"({"name": "s", "from": "a", "to": "b", "payload": "1B", "encapsulation": "ethernet", "burst": {"frames": 5, "every": "1ms"}})";
  const auto r = sound(over_one_switch(R"(, "streams": [)" + burst + "]"));
  EXPECT_DOUBLE_EQ(port(*r, "a", "sw").class_bits_per_second[1], 3.36e6);
  EXPECT_DOUBLE_EQ(port(*r, "a", "sw").share(), 0.00336);
  const auto identity =
      sound(over_one_switch(R"(, "streams": [)" + burst + "]"), {"network.nodes.a.traffic_classes=identity"});
  EXPECT_DOUBLE_EQ(port(*identity, "a", "sw").class_bits_per_second[0], 3.36e6);
}

// A multicast asks each link once, whatever the number of its listeners.
TEST(Demand, MulticastCountsOncePerLink) {
  const auto r = sound(generated(
      R"("topology": "line", "switches": 3)",
      R"(, "streams": [{"name": "s", "from": "h1", "to": ["h2", "h3"], "payload": "100B", "exponential": "1ms"}])"));
  const double bits = 8 * (100 + 28 + 18 + 20) * 1000.0;  // untagged
  for (const auto& [from, to] : {std::pair{"h1", "sw1"}, {"sw1", "sw2"}, {"sw2", "h2"}, {"sw2", "sw3"}, {"sw3", "h3"}})
    EXPECT_DOUBLE_EQ(port(*r, from, to).share(), bits / 1e9) << from;
  EXPECT_EQ(r->ports.size(), 5u);
}

// Ports may have any numbers: those between that have no link carry nothing and are not told of.
TEST(Demand, PortsWithoutALinkAreNone) {
  const auto r = sound(
      R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch"}},
 "links": [{"ends": ["a", "sw:9"]}, {"ends": ["sw:3", "b"]}]},
 "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "10us"}]})");
  EXPECT_EQ(r->ports.size(), 2u);
  EXPECT_EQ(port(*r, "sw", "b").port, 3);
  EXPECT_DOUBLE_EQ(port(*r, "sw", "b").share(), 0.1328);
}

// Gaps cut off at their mean, 1 ms, have the mean of half a normal distribution: sqrt(2 / pi) deviations of 1 ms above
// it. 166 octets on the wire each.
TEST(Demand, RandomGapsOnAverage) {
  const auto r = sound(over_one_switch(
      R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "normal": {"mean": "1ms", "deviation": "1ms", "min": "1ms"}}])"));
  EXPECT_NEAR(port(*r, "a", "sw").class_bits_per_second[1],
              8 * (100 + 28 + 18 + 20) * 1000 / (1 + std::sqrt(2 / 3.14159265358979)), 0.1);
}

// State: 42 B + 14 + 4 + 4 = 64 B, which is what a frame has at least: 84 B on the wire each cycle.
// Data: 24 B before 6 Doubles of 48 B = 72 B + 22 = 94 B, 114 B on the wire. 672 + 912 bit in 1 ms: 1.584 Mb/s from the
// master.
TEST(Demand, AProgramAsksForItsCycle) {
  const auto r = sound(over_one_switch(R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms",
 "process_data": [{"name": "d", "from": "a", "fields": {"q": {"type": "Double", "count": 6}}}]}])"));
  EXPECT_DOUBLE_EQ(port(*r, "b", "sw").class_bits_per_second[6], 672e3);
  EXPECT_DOUBLE_EQ(port(*r, "a", "sw").class_bits_per_second[6], 1584e3);
}

std::string camera(const std::string& every, const std::string& more = {}) {
  return over_one_switch(R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "1472B", "every": ")" +
                         every + "\"}]" + more);
}

// 1538 B on the wire take 12.304 us at 1 Gb/s.
TEST(Demand, FullNearlyFullAndOverfullLinks) {
  EXPECT_EQ(load(camera("14us")).diagnostics.to_text(), "");  // 87.9 %
  const Loaded nearly = load(camera("13us"));
  EXPECT_NE(nearly.resolved, nullptr);
  EXPECT_EQ(nearly.diagnostics.warnings(), 2u);
  EXPECT_NE(nearly.diagnostics.to_text().find("a link that is nearly full: found 94.6 % from \"a\" to \"sw\""),
            std::string::npos);
  EXPECT_NE(load(camera("12304ns")).resolved, nullptr);  // exactly 100 %
  EXPECT_EQ(load(camera("12303ns")).resolved, nullptr);
}

TEST(Demand, OverloadMayBeAllowed) {
  const Loaded loaded = load(camera("6152ns", R"(, "allow_overload": true)"));
  ASSERT_NE(loaded.resolved, nullptr);
  EXPECT_EQ(loaded.diagnostics.warnings(), 2u);
  EXPECT_NE(
      loaded.diagnostics.to_text().find("warning at /network: an overloaded link: found 200.0 % from \"a\" to \"sw\""),
      std::string::npos);
}

}  // namespace
}  // namespace takt::scenario::test::demand_test
