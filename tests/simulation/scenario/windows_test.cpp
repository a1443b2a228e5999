// SPDX-License-Identifier: Apache-2.0
// The class and the length of a stream at a port are what switches have made of it there: of checks of gate windows, of
// cycles, of loads.
#include <gtest/gtest.h>

#include "scenario/resolve/stream_at_port.hpp"
#include "support.hpp"

namespace takt::scenario::test {
namespace {

/// A talker and a listener at one switch, 100 Mb/s; 100 B of UDP make 150 octets with C-tag, 146 without.
std::string gated(const std::string& switch_members, const std::string& entries,
                  const std::string& stream = R"("pcp": 7)", const std::string& more = "",
                  const std::string& port = "") {
  return R"({"name": "t", "duration": "10ms", "network": {"nodes": {"talker": {"kind": "host"}, "listener": {"kind": "host"}, "sw": {"kind": "switch", )" +
         switch_members + R"("egress": [{"to": "listener", )" + port + R"("gates": {"entries": [)" + entries +
         R"(]}}]}},
"links": [{"ends": ["talker", "sw"], "rate": "100Mbps", "delay": "0s"}, {"ends": ["sw", "listener"], "rate": "100Mbps", "delay": "0s"}]},
"streams": [{"name": "s", "from": "talker", "to": "listener", "payload": "100B", "every": "100us", )" +
         stream + "}]" + more + "}";
}
std::string window(const std::string& length, int q = 7) {
  return R"({"open": [)" + std::to_string(q) + R"(], "for": ")" + length + R"("}, {"open": [0], "for": "80us"})";
}
std::string with_ipv(const std::string& gate) {
  return R"("ingress": {"filters": [{"stream": "s", "gate": "g"}], "gates": [{"name": "g", )" + gate + "}]}, ";
}

std::string told(const std::string& text) { return load(text).diagnostics.to_text(); }
bool is_sound(const std::string& text) { return load(text).resolved != nullptr; }

// 150 + 8 octets last 12.64 us, 146 + 8 without the tag 12.32 us.
TEST(Windows, AreAsLongAsTheFrameOnThatWire) {
  EXPECT_TRUE(is_sound(gated("", window("12.64us"))));
  EXPECT_NE(told(gated("", window("12.63us")))
                .find("a frame that no gate window lets pass: found 12.64us for a frame of class 7 at \"sw\", whose "
                      "longest window is 12.63us"),
            std::string::npos)
      << told(gated("", window("12.63us")));
  EXPECT_TRUE(is_sound(gated("", window("12.32us"), R"("pcp": 7)", "", R"("untagged": true, )")));
  EXPECT_FALSE(is_sound(gated("", window("12.31us"), R"("pcp": 7)", "", R"("untagged": true, )")));
}

// The stream has no tag, so class 1; its stream gate puts it into class 4.
TEST(Windows, AreThoseOfTheClassThatAStreamGateGives) {
  EXPECT_TRUE(is_sound(gated(with_ipv(R"("ipv": 4)"), window("20us", 4), R"("offset": "0s")")));
  EXPECT_FALSE(is_sound(gated(with_ipv(R"("ipv": 4)"), window("20us", 5), R"("offset": "0s")")));
  EXPECT_FALSE(is_sound(gated(with_ipv(R"("ipv": 4)"), window("20us", 1), R"("offset": "0s")")));
}

TEST(Windows, OfOneOfSeveralClassesAreTold) {
  const std::string text =
      gated(with_ipv(R"("entries": [{"open": true, "ipv": 4, "for": "1ms"}, {"open": true, "ipv": 5, "for": "1ms"}])"),
            window("20us", 4), R"("offset": "0s")");
  EXPECT_TRUE(is_sound(text)) << told(text);
  EXPECT_NE(told(text).find("warning at /streams/0: frames that no gate window lets pass, when their stream gate puts "
                            "them into that class"),
            std::string::npos);
}

TEST(Windows, MayComeWithAnotherList) {
  const std::string later =
      R"(, "script": [{"at": "1ms", "set_gates": {"node": "sw", "to": "listener", "gates": {"entries": [{"open": [7], "for": "50us"}, {"open": [0], "for": "50us"}]}}}])";
  EXPECT_FALSE(is_sound(gated("", window("5us"))));
  EXPECT_TRUE(is_sound(gated("", window("5us"), R"("pcp": 7)", later)));
}

// Published and by hand; see the scenarios. Both were refused once.
TEST(Windows, OfShippedScenariosGiveTheirLatencies) {
  for (const auto& [name, latency] : {std::pair("validation/gates-behind-stream-gates", 20'646'000),
                                      std::pair("validation/window-of-untagged-frame", 24'960'000)}) {
    const auto r = shipped(name);
    LiveRun run(*r);
    run.advance();
    for (const models::Stream& stream : run.network().traffic().streams()) {
      EXPECT_EQ(stream.latency.minimum(), Duration::from_ps(latency)) << name;
      EXPECT_EQ(stream.latency.maximum(), Duration::from_ps(latency)) << name;
      EXPECT_GT(stream.delivered, 0u);
    }
  }
}

// Of a redundant stream without priority frames have an R-TAG and no C-tag between split and merge: 100 + 28 + 18 + 6
// octets.
TEST(StreamAtPort, LengthsOfMembers) {
  const auto r = sound(
      R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s1": {"kind": "switch"}, "s2": {"kind": "switch"}, "s3": {"kind": "switch"}, "s4": {"kind": "switch"}},
"links": [{"ends": ["a", "s1"]}, {"ends": ["s1", "s2"]}, {"ends": ["s1", "s3"]}, {"ends": ["s2", "s4"]}, {"ends": ["s3", "s4"]}, {"ends": ["s4", "b"]}]},
"streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "redundancy": 2}]})");
  for (const StreamAtPort& at : streams_at_ports(*r)) {
    const bool is_member = r->topology.nodes[at.node].name != "a" && r->topology.nodes[at.node].name != "s4";
    EXPECT_EQ(at.frame.count, is_member ? 152u : 146u) << r->topology.nodes[at.node].name;
    EXPECT_EQ(at.msdu.count, is_member ? 134u : 128u);
    EXPECT_EQ(at.member.has_value(), is_member);
    EXPECT_EQ(at.policed_frame.count, at.node == node(*r, "s2") || at.node == node(*r, "s3") ? 152u : 146u);
  }
  EXPECT_EQ(streams_at_ports(*r).size(), 6u);
}

// 170 octets of the wire with the tag, 10,000 times a second: 13.6 Mb/s; from the port without tags 166: 13.28 Mb/s, in
// class 4.
TEST(StreamAtPort, LoadsAreInTheClassThatAStreamGateGives) {
  const auto r = sound(gated(with_ipv(R"("ipv": 4)"), window("20us", 4), R"("pcp": 7)", "", R"("untagged": true, )"));
  for (const PortDemand& port : r->ports)
    EXPECT_DOUBLE_EQ(port.class_bits_per_second[port.node.value == node(*r, "sw") ? 4 : 7],
                     port.node.value == node(*r, "sw") ? 13.28e6 : 13.6e6);
}

// A link that the stream does not take is no reason to refuse its cycle: 126 us at 10 Mb/s, 1.26 us at 1 Gb/s.
TEST(StreamAtPort, CyclesAreCheckedWhereTheStreamGoes) {
  const std::string text =
      R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "slow": {"kind": "host"}, "sw": {"kind": "switch", "ingress": {"cqf": {"cycle": "50us", "classes": [5, 6], "pcp": [6]}}}},
"links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}, {"ends": ["slow", "sw"], "rate": "10Mbps"}]},
"streams": [{"name": "s", "from": "a", "to": ")";
  const std::string rest = R"(", "payload": "100B", "every": "1ms", "pcp": 6}]})";
  EXPECT_TRUE(is_sound(text + "b" + rest));
  EXPECT_NE(told(text + "slow" + rest).find("a cycle shorter than a frame"), std::string::npos);
}

}  // namespace
}  // namespace takt::scenario::test
