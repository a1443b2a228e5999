// SPDX-License-Identifier: Apache-2.0
// CSV as spreadsheets write it: streams, cables, devices, Programs.
#include <gtest/gtest.h>

#include "round_trip.hpp"

namespace takt::interchange::test::tables_test {
namespace {

bool is_told(const Reading& reading, const std::string& text) {
  return reading.remarks().find(text) != std::string::npos;
}

InputFile finding(const std::string& name) {
  return input(std::filesystem::path(TAKT_SOURCE_DIR) / "tests/findings/import" / name);
}

TEST(Tables, TheFindingsComeInAsOnePlant) {
  const Reading reading = read("csv", {finding("cables.csv"), finding("streams.csv")});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Scenario& plant = *reading.imported.scenario;
  const auto kind_of = [&](const std::string& name) {
    for (const auto& [node, description] : plant.network.nodes)
      if (node == name) return std::holds_alternative<scenario::SwitchNode>(description) ? "switch" : "host";
    return "none";
  };
  EXPECT_STREQ(kind_of("sw1"), "switch");
  EXPECT_STREQ(kind_of("plc"), "host");
  EXPECT_EQ(plant.network.links.front().length, sim::Length{20'000});
  EXPECT_EQ(plant.streams.front().name, "set1");
  EXPECT_EQ(plant.streams.front().payload, sim::Octets{64});
}

TEST(Tables, AByteOrderMarkIsNoPartOfAName) {
  InputFile file = finding("bom.csv");
  // Its row ends in the fourth cell, which is told at the row and not of a column "name" that is not there.
  EXPECT_TRUE(is_told(read("csv", {file}), "bom.csv:2:1: error: a row of another length"));
  file.text = file.text.substr(0, file.text.find('\n') + 1) + "set1,plc,drive1,64,1ms,5,500us\r\n";
  const Reading reading = read("csv", {file});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  EXPECT_EQ(reading.imported.scenario->streams.front().name, "set1");
}

TEST(Tables, SemicolonsComeWithDecimalCommas) {
  const Reading reading = read(
      "csv",
      {{"s.csv", "s",
        "\xEF\xBB\xBFName;From;To;Payload;Every;Latency\r\nset;plc;drive, hmi;64 B;0,5 ms;\"200 "
        "\xC2\xB5s\"\r\n;;;;;\r\n"},
       {"c.csv", "c", "From;To;Rate;Length\r\nplc;sw;1 Gbit/s;2,5\r\ndrive;sw;100;10 m\r\nhmi;sw;100 Mbit/s;\r\n"}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Scenario& plant = *reading.imported.scenario;
  EXPECT_EQ(plant.streams.front().every, sim::Duration::from_ps(500'000'000));
  EXPECT_EQ(plant.streams.front().to.names, (std::vector<std::string>{"drive", "hmi"}));
  EXPECT_EQ(plant.require.front().latency->at_most, sim::Duration::from_ps(200'000'000));
  EXPECT_EQ(plant.network.links[0].rate.bits_per_second, 1'000'000'000U);
  EXPECT_EQ(plant.network.links[0].length, sim::Length{2'500});
  EXPECT_EQ(plant.network.links[1].rate.bits_per_second, 100'000'000U);
}

TEST(Tables, DevicesAndProgramsHaveTheKeysOfTheSchema) {
  const Reading reading =
      read("csv",
           {{"c.csv", "c", "from,to,ports\nplc,sw,0-3\ndrive,sw,0-1\n"},
            {"d.csv", "d",
             "name,kind,os,forwarding_delay,queues.frames\nplc,host,preempt-rt,,\ndrive,host,,,\nsw,switch,,1us,64\n"},
            {"p.csv", "p", "name,master,slaves,cycle\ncell,plc,drive,1ms\n"}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Scenario& plant = *reading.imported.scenario;
  EXPECT_EQ(plant.network.links[0].ends, (std::vector<std::string>{"plc:0", "sw:3"}));
  EXPECT_EQ(scenario::relay_of(plant.network.nodes[2].second)->forwarding_delay, sim::Duration::from_ps(1'000'000));
  EXPECT_EQ(plant.programs.front().master, "plc");
  EXPECT_EQ(plant.programs.front().slaves, std::vector<std::string>{"drive"});
}

TEST(Tables, MistakesStandInTheirCells) {
  const Reading reading =
      read("csv", {{"d.csv", "d", "name,kind,forwarding_delay\nsw,swich,1us\ns2,switch,fast\n,host,\n"},
                   {"x.csv", "x", "a,b\n1,2\n"},
                   {"u.csv", "u", "\xFF\xFEn"}});
  std::vector<std::string> places;
  for (const json::Diagnostic& each : reading.diagnostics.sorted())
    places.push_back(each.place.file + ":" + std::to_string(each.place.line) + ":" + std::to_string(each.place.column));
  EXPECT_EQ(places, (std::vector<std::string>{"d.csv:2:4", "d.csv:3:11", "d.csv:4:1", "x.csv:1:1", "u.csv:1:1"}))
      << reading.diagnostics.to_text();
}

// What a device is told of priorities and VLANs is no state of it.
TEST(YangFindings, PrioritiesAndVlansOfPortsAreTold) {
  const Reading reading = read("yang", {finding("pcp-decoding.json")});
  EXPECT_FALSE(reading.diagnostics.has_errors()) << reading.remarks();
  for (const char* const name : {"pvid", "default-priority", "priority-regeneration", "pcp-selection",
                                 "pcp-decoding-table", "acceptable-frame", "filtering-database"})
    EXPECT_NE(reading.remarks().find(name), std::string::npos) << name << "\n" << reading.remarks();
}

TEST(TsnkitFindings, LongFramesMayHaveGatesLaidOut) {
  const Reading reading =
      read("tsnkit", {finding("tsnkit-4500-task.csv"), finding("tsnkit-4500-topo.csv")}, nullptr, {"gates=auto"});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  EXPECT_FALSE(reading.imported.scenario->streams.front().burst);
  EXPECT_EQ(reading.imported.scenario->streams.front().payload,
            sim::Octets{4500 - 8 - 12 - 14 - 4 - 4});  // preamble, gap, header, tag, check sequence
  EXPECT_EQ(reading.imported.scenario->network.mtu, sim::Octets{4458});
  EXPECT_TRUE(load(sparse_text(*reading.imported.scenario), "long"));
}

}  // namespace
}  // namespace takt::interchange::test::tables_test
