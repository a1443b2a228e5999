// SPDX-License-Identifier: Apache-2.0
// Ports and links of written and generated nodes.
#include "support.hpp"

namespace takt::scenario::test::topology_test {
namespace {

std::string network(const std::string& links) {
  return R"({"name": "t", "duration": "1ms", "network": {"nodes": {
 "a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "d": {"kind": "host"}, "sw": {"kind": "switch"}},
 "links": [)" +
         links + "]}}";
}

std::uint16_t port(const Resolved& r, const char* from, const char* to) {
  return r.topology.port_towards(node(r, from), node(r, to)).value();
}

TEST(Topology, PortsAreNumberedInTheOrderOfTheLinks) {
  const auto r =
      sound(network(R"({"ends": ["b", "sw"]}, {"ends": ["sw", "a"]}, {"ends": ["c", "sw"]}, {"ends": ["d", "sw"]})"));
  EXPECT_EQ(port(*r, "sw", "b"), 0);
  EXPECT_EQ(port(*r, "sw", "a"), 1);
  EXPECT_EQ(port(*r, "sw", "c"), 2);
  EXPECT_EQ(port(*r, "sw", "d"), 3);
  EXPECT_EQ(port(*r, "a", "sw"), 0);
}

TEST(Topology, NamedPortsKeepTheirNumbersAndOthersFindTheFreeOnes) {
  const auto r = sound(
      network(R"({"ends": ["a", "sw"]}, {"ends": ["b", "sw:0"]}, {"ends": ["c", "sw"]}, {"ends": ["d:0", "sw:2"]})"));
  EXPECT_EQ(port(*r, "sw", "a"), 1);
  EXPECT_EQ(port(*r, "sw", "b"), 0);
  EXPECT_EQ(port(*r, "sw", "c"), 3);
  EXPECT_EQ(port(*r, "sw", "d"), 2);
}

TEST(Topology, APortMayBeLeftOut) {
  const auto r =
      sound(network(R"({"ends": ["a", "sw:7"]}, {"ends": ["b", "sw"]}, {"ends": ["c", "sw"]}, {"ends": ["d", "sw"]})"));
  EXPECT_EQ(port(*r, "sw", "a"), 7);
  EXPECT_EQ(port(*r, "sw", "b"), 0);
  LiveRun run(*r);
  EXPECT_TRUE(run.advance());
}

TEST(Topology, WrittenNodesJoinGeneratedOnes) {
  const auto r =
      sound(R"({"name": "t", "duration": "1ms", "network": {"generate": [{"topology": "line", "switches": 2}],
 "nodes": {"plc": {"kind": "host"}}, "links": [{"ends": ["plc", "sw1"]}]}})");
  EXPECT_EQ(r->topology.nodes.size(), 5u);
  EXPECT_EQ(port(*r, "sw1", "sw2"), 0);
  EXPECT_EQ(port(*r, "sw1", "h1"), 1);
  EXPECT_EQ(port(*r, "sw1", "plc"), 2);
}

TEST(Topology, DelayComesFromLengthOrIsGiven) {
  const auto r = sound(
      network(R"({"ends": ["a", "sw"]}, {"ends": ["b", "sw"], "length": "1km"}, {"ends": ["c", "sw"], "length": "1mm"},
 {"ends": ["d", "sw"], "delay": "50ns"})"));
  EXPECT_EQ(r->topology.links[0].delay.ps(), 50'000);     // 10 m if nothing is said
  EXPECT_EQ(r->topology.links[1].delay.ps(), 5'000'000);  // 5 ns/m
  EXPECT_EQ(r->topology.links[2].delay.ps(), 5);
  EXPECT_EQ(r->topology.links[3].delay.ps(), 50'000);
  EXPECT_EQ(r->topology.links[0].rate.bits_per_second, 1'000'000'000u);
}

TEST(Topology, SwitchesMayBeJoinedTwice) {
  const auto r =
      sound(R"({"name": "t", "duration": "1ms", "network": {"nodes": {"x": {"kind": "switch"}, "y": {"kind": "switch"}},
 "links": [{"ends": ["x", "y"]}, {"ends": ["x", "y"]}]}})");
  EXPECT_EQ(port(*r, "x", "y"), 0);  // the first link
  EXPECT_EQ(r->topology.neighbours[0].size(), 2u);
}

TEST(Topology, AHostWithoutALinkIsAWarning) {
  const Loaded loaded = load(network(R"({"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}, {"ends": ["c", "sw"]})"));
  EXPECT_NE(loaded.resolved, nullptr);
  EXPECT_EQ(loaded.diagnostics.to_text(),
            "s.json:2:76: warning at /network/nodes/d: a host without a link: found \"d\"\n");
}

// A switch has 4096 ports at most: a star with as many is sound.
TEST(Topology, AsManyLinksAsPorts) {
  EXPECT_EQ(sound(generated(R"("topology": "line", "switches": 1, "hosts_per_switch": 4096)"))->plan.links.size(),
            4096u);
}

}  // namespace
}  // namespace takt::scenario::test::topology_test
