// SPDX-License-Identifier: Apache-2.0
// Instance data, right and wrong: data/instances/expected.csv has what the modules say of each file, and what an
// importer should warn of.
#include <gtest/gtest.h>

#include <set>

#include "files.hpp"

namespace takt::interchange::test {
namespace {

/// Valid by the modules, and refused by takt: what they mean is unsaid, or takt does not have it.
const std::set<std::string> refused_by_takt = {
    "own/2018-odd-fraction-of-a-second-as-a-fraction.json",  // 2147483648 ns of a second
    "own/2018-odd-params-left-out.json",                     // an entry without interval
    "own/odd-entry-without-interval.json",
    "own/odd-cycle-no-whole-nanoseconds.json",  // 1/3000 s
    "own/odd-nanoseconds-beyond-a-second.json",
    "own/odd-half-a-class-preemptable.json",  // priorities of one class differ
    "own/switch-that-merges-two-paths.json",
    "own/switch-that-merges-two-paths.xml",
    "own/switch-that-splits-in-two.json",  // redundancy
    "own/request-one-stream.json",
    "own/request-one-stream.xml",
    "own/request-redundant-multicast.json",  // requests are no settings of a device
};

TEST(YangInstances, AreTakenOrRefusedAsTheModulesSay) {
  std::size_t valid = 0, invalid = 0;
  for (const auto& row : rows_of(data() / "instances/expected.csv")) {
    const std::string& file = row.at("file");
    const Reading reading = read("yang", {input(data() / "instances" / file)});
    const bool should_refuse = row.at("yanglint") == "invalid" || refused_by_takt.contains(file);
    EXPECT_EQ(reading.diagnostics.has_errors(), should_refuse) << file << "\n"
                                                               << reading.remarks() << row.at("first_error");
    EXPECT_EQ(reading.imported.scenario.has_value(), !should_refuse) << file;
    ++(should_refuse ? invalid : valid);
    if (!should_refuse && !row.at("remark").empty()) {
      EXPECT_FALSE(reading.imported.remarks.empty()) << file << ": " << row.at("remark");
    }
    for (const json::Diagnostic& each : reading.diagnostics.kept())
      EXPECT_FALSE(each.details.expected.empty()) << json::to_text(each);
  }
  EXPECT_GE(valid, 25u);
  EXPECT_GE(invalid, 25u);
}

TEST(YangInstances, MeanTheseNodes) {
  std::size_t ports = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data() / "instances/takt")) {
    const std::string name = entry.path().filename().string();
    const Reading reading = read("yang", {input(data() / "instances/own" / name)});
    ASSERT_TRUE(reading.imported.scenario) << name << reading.remarks();
    const scenario::Node& found = reading.imported.scenario->network.nodes.front().second;
    scenario::Node expected = node_of(entry.path());
    if (scenario::relay_of(expected)->ingress) {
      // The stream with handle 7 is "s" there; here it is identified by its address, as no table of names says more.
      scenario::Ingress a = *scenario::relay_of(found)->ingress, b = *scenario::relay_of(expected)->ingress;
      ASSERT_EQ(a.streams.size(), 1u) << name;
      for (scenario::StreamFilterEntry& filter : b.filters)
        if (filter.stream) filter.stream = a.streams.front().name;
      b.streams = a.streams;
      EXPECT_EQ(json::compact(json::encode_value(a)), json::compact(json::encode_value(b))) << name;
    } else {
      expect_same_ports(found, expected, name);
      ++ports;
    }
  }
  EXPECT_EQ(ports, 8u);
}

TEST(YangInstances, AreTheSameInXmlAndJson) {
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data() / "instances/own")) {
    if (entry.path().extension() != ".xml") continue;
    std::filesystem::path twin = entry.path();
    twin.replace_extension(".json");
    const Reading xml = read("yang", {input(entry.path())}), json = read("yang", {input(twin)});
    ASSERT_EQ(xml.imported.scenario.has_value(), json.imported.scenario.has_value())
        << entry.path() << xml.remarks() << json.remarks();
    if (!xml.imported.scenario) continue;
    EXPECT_EQ(sparse_text(*xml.imported.scenario), sparse_text(*json.imported.scenario)) << entry.path();
    ++seen;
  }
  EXPECT_GE(seen, 5u);
}

TEST(YangInstances, PlacesAreThoseOfTheText) {
  const Reading reading =
      read("yang", {{"sw1.xml", "sw1",
                     "<?xml version=\"1.0\"?>\n<interfaces xmlns=\"urn:ietf:params:xml:ns:yang:ietf-interfaces\">\n  "
                     "<interface>\n    <name>swp0</name>\n    <speed>fast</speed>\n    <colour>red</colour>\n"
                     "  </interface>\n</interfaces>\n"}});
  ASSERT_EQ(reading.diagnostics.errors(), 2u) << reading.diagnostics.to_text();
  const auto sorted = reading.diagnostics.sorted();
  EXPECT_EQ(sorted[0].place.line, 5u);
  EXPECT_EQ(sorted[0].place.column, 5u);
  EXPECT_EQ(sorted[1].place.line, 6u);
}

TEST(Xml, DoesNotExpandEntities) {
  json::Diagnostics diagnostics;
  const Reading reading = read("yang", {{"a.xml", "a", "<!DOCTYPE a [<!ENTITY b \"cc\">]><a>&b;</a>"}});
  ASSERT_TRUE(reading.diagnostics.has_errors());
}

}  // namespace
}  // namespace takt::interchange::test
