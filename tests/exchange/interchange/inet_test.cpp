// SPDX-License-Identifier: Apache-2.0
// Idioms of NED and ini as INET's own networks have them.
#include <gtest/gtest.h>

#include "interchange/inet/expression.hpp"
#include "round_trip.hpp"

namespace takt::interchange::test::inet_test {
namespace {

std::filesystem::path findings() { return std::filesystem::path(TAKT_SOURCE_DIR) / "tests/findings/import"; }

TEST(InetExpressions, HaveUnits) {
  const auto amount = [](const char* text) {
    const auto value = inet::evaluate(text);
    return value ? json::to_text(value->amount) : std::string("none");
  };
  EXPECT_EQ(amount("1500B - 58B"), "1442000000000000");
  EXPECT_EQ(amount("2 * 62.5us"), "125000000");
  EXPECT_EQ(amount("(1ms + 500 us) / 3"), "500000000");
  EXPECT_EQ(amount("8b"), "1000000000000");
  EXPECT_EQ(amount("1ms / 250us"), "4000000000000");
  EXPECT_EQ(amount("1ms + 1B"), "none");
  EXPECT_EQ(amount("f(1)"), "none");
  EXPECT_EQ(inet::evaluate("3 > 2 ? \"a\" : \"b\"")->text, "a");
}

TEST(InetFindings, TheIdiomsComeIn) {
  for (const auto& entry : std::filesystem::directory_iterator(findings() / "inet")) {
    if (entry.path().extension() != ".ned") continue;
    const Reading reading = read("inet", {input(entry.path()), input(findings() / "inet/omnetpp.ini")});
    ASSERT_TRUE(reading.imported.scenario) << entry.path() << reading.remarks();
    EXPECT_GE(reading.imported.scenario->network.links.size(), 2U);
    EXPECT_EQ(reading.imported.scenario->network.links.front().rate.bits_per_second, 1'000'000'000U);
  }
  const Reading trunk = read("inet", {input(findings() / "inet/chan.ned"), input(findings() / "inet/omnetpp.ini")});
  EXPECT_EQ(trunk.imported.scenario->network.links.front().length, sim::Length{5'000});
}

TEST(InetFindings, AsynchronousShapingOfTwoClasses) {
  const Reading reading = read("inet", {input(findings() / "net.ned"), input(findings() / "ats.ini")});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Scenario& made = *reading.imported.scenario;
  ASSERT_EQ(made.streams.size(), 2U);
  EXPECT_EQ(made.streams[1].name, "video");
  EXPECT_EQ(made.streams[1].payload, sim::Octets{946});  // 1000B - 54B
  EXPECT_EQ(made.streams[1].pcp, 4);
  const scenario::Relay* const relay = scenario::relay_of(made.network.nodes[0].second);
  ASSERT_TRUE(relay != nullptr && relay->ingress);
  ASSERT_EQ(relay->ingress->ats.size(), 2U);
  EXPECT_EQ(relay->ingress->ats[0].rate.bits_per_second, 40'000'000U);
  EXPECT_EQ(relay->ingress->ats[1].burst, sim::Octets{20'000});
}

const std::string apps =
    "*.dev[0].numApps = 1\n*.dev[0].app[0].typename = \"UdpSourceApp\"\n*.dev[0].app[0].io.destAddress = "
    "\"dev[1]\"\n*.dev[0].app[0].io.destPort = 1000\n"
    "*.dev[0].app[0].source.packetLength = ${length=100B, 200B, 300B}\n*.dev[0].app[0].source.productionInterval = "
    "${interval=1ms, 2ms}\n";

TEST(Inet, ArraysLoopsAndConditionsAreWrittenOut) {
  const std::string ned =
      "package p;\nnetwork Base extends TsnNetworkBase { parameters: int n = default(2); bool ring = default(false);\n "
      "submodules: sw[n + 1]: TsnSwitch; dev[n]: TsnDevice;\n"
      " connections: for i=0..n-1, if i < 100 { sw[i].ethg++ <--> Eth1G { length = 2m; } <--> sw[i+1].ethg++; }\n for "
      "i=0..n-1 { dev[i].ethg[0] <--> Eth100M <--> sw[i].ethg++; }\n"
      " sw[n].ethg++ <--> Eth1G <--> sw[0].ethg++ if ring; }\nnetwork Plant extends Base { submodules: probe: "
      "TsnDevice if ring { @display(\"p=1\"); } }\n";
  const Reading reading = read(
      "inet",
      {{"n.ned", "n", ned}, {"o.ini", "o", "[General]\nnetwork = p.Plant\nsim-time-limit = 10ms\n*.n = 3\n" + apps}},
      nullptr, {"run=3"});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Scenario& made = *reading.imported.scenario;
  EXPECT_EQ(made.network.nodes.size(), 7U);  // 4 switches, 3 devices, no probe
  EXPECT_EQ(made.network.links.size(), 6U);
  // Run 3 of 3 x 2: the second length, the second interval.
  EXPECT_EQ(made.streams.front().payload, sim::Octets{200});
  EXPECT_EQ(made.streams.front().every, sim::Duration::from_ps(2'000'000'000));
  EXPECT_NE(reading.remarks().find("one of 6 runs"), std::string::npos) << reading.remarks();
}

}  // namespace
}  // namespace takt::interchange::test::inet_test
