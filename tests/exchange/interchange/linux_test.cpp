// SPDX-License-Identifier: Apache-2.0
// Sets of Linux commands, right and wrong: data/tc/expected.csv has what a kernel says of them and what they mean in
// takt.
#include <gtest/gtest.h>

#include "round_trip.hpp"
#include "scenario/resolve.hpp"

namespace takt::interchange::test {
namespace {

std::string verdict_of(const Reading& reading) {
  if (reading.diagnostics.has_errors()) return "refuse";
  const scenario::Node& node = reading.imported.scenario->network.nodes.front().second;
  const scenario::Relay* const relay = scenario::relay_of(node);
  const bool sets_something = !scenario::ports_of(node).egress.empty() || (relay != nullptr && relay->ingress);
  if (reading.lost()) return "lossy";
  return sets_something ? "exact" : "none";
}

TEST(LinuxSets, MeanWhatTheTableSays) {
  std::size_t accepted_by_kernel = 0;
  for (const auto& row : rows_of(data() / "tc/expected.csv")) {
    const Reading reading = read("linux", {input(data() / "tc" / row.at("file"))});
    EXPECT_EQ(verdict_of(reading), row.at("takt")) << row.at("file") << "\n" << reading.remarks();
    if (row.at("kind") == "wrong" && row.at("iproute2 7.1 on Linux 6.12") == "accepted") ++accepted_by_kernel;
    for (const json::Diagnostic& each : reading.diagnostics.kept()) {
      EXPECT_GE(each.place.line, 1u) << json::to_text(each);
      EXPECT_FALSE(each.details.expected.empty()) << json::to_text(each);
    }
  }
  EXPECT_GE(accepted_by_kernel, 10u) << "sets that only takt refuses";
}

TEST(LinuxSets, MeanTheseNodes) {
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data() / "tc/takt")) {
    const Reading reading = read("linux", {input(data() / "tc/correct" / (entry.path().stem().string() + ".sh"))});
    ASSERT_TRUE(reading.imported.scenario) << entry.path() << reading.remarks();
    scenario::Node expected = node_of(entry.path());
    // Where a set says nothing of classes, the node beside it has a map that nobody asked for.
    if (text_of(data() / "tc/correct" / (entry.path().stem().string() + ".sh")).find(" map ") == std::string::npos)
      scenario::ports_of(expected).traffic_classes = scenario::TrafficClasses::standard;
    expect_same_ports(reading.imported.scenario->network.nodes.front().second, expected,
                      entry.path().filename().string());
    ++seen;
  }
  EXPECT_EQ(seen, 10u);
}

TEST(LinuxSets, AllMistakesAreToldAtOnceWithTheirPlaces) {
  InputFile file{
      "sw1.sh", "sw1",
      "tc qdisc replace dev eth0 parent root handle 100 taprio num_tc 2 map 0 2 queues 1@0 1@0 base-time -1 \\\n"
      "    sched-entry S 4 1000 flags 0x2\n"
      "ethtool --set-mm eth0 tx-min-frag-size 61\n"};
  const Reading reading = read("linux", {file});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  for (const json::Diagnostic& each : reading.diagnostics.sorted())
    places.emplace_back(each.place.line, each.place.column);
  // The class of priority 1, the second range of queues, the base time; the entry's mask; the size.
  EXPECT_EQ(places, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, 72}, {1, 85}, {1, 99}, {2, 17}, {3, 40}}))
      << reading.diagnostics.to_text();
}

TEST(LinuxDumps, MeanWhatTheCommandsMean) {
  const std::string dump =
      R"([{"kind":"taprio","handle":"100:","dev":"eth0","root":true,"refcnt":9,"options":{"tc":8,"map":[0,1,2,3,4,5,6,7,7,7,7,7,7,7,7,7],
    "queues":[{"offset":0,"count":1},{"offset":1,"count":1},{"offset":2,"count":1},{"offset":3,"count":1},{"offset":4,"count":1},{"offset":5,"count":1},{"offset":6,"count":1},{"offset":7,"count":1}],
    "clockid":"invalid","flags":"0x2","base_time":0,"cycle_time":1000000,"cycle_time_extension":0,
    "schedule":[{"index":0,"cmd":"S","gatemask":"0x80","interval":200000},{"index":1,"cmd":"S","gatemask":"0x7f","interval":800000}]}},
    {"kind":"cbs","handle":"8001:","dev":"eth0","parent":"100:6","options":{"hicredit":47,"locredit":-311,"sendslope":-970000,"idleslope":30000,"offload":1}}])";
  const Reading reading = read("linux", {{"host.qdisc.json", "host", dump}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  expect_same_ports(reading.imported.scenario->network.nodes.front().second,
                    node_of(data() / "tc/takt/18-taprio-cbs.json"), "a dump");
}

TEST(Ptp4l, FilesMeanWhatTheTableSays) {
  for (const auto& row : rows_of(data() / "tc/ptp4l/expected.csv")) {
    const Reading reading = read("linux", {input(data() / "tc/ptp4l" / row.at("file"))});
    EXPECT_EQ(reading.diagnostics.has_errors(), row.at("ptp4l 3.1.1") == "refuses") << row.at("file") << "\n"
                                                                                    << reading.remarks();
  }
  const auto gptp_of = [](const char* file) {
    return *read("linux", {input(data() / "tc/ptp4l" / file)}).imported.scenario->clocks.gptp;
  };
  const scenario::Gptp bridge = gptp_of("ok-gptp-bridge.conf");
  EXPECT_EQ(bridge.log_sync_interval, -3);
  EXPECT_EQ(bridge.link_delay_threshold, sim::Duration::from_ps(800'000));
  EXPECT_EQ(bridge.nodes.front().second.priority1, 246);
  const scenario::Clocks clocks =
      read("linux", {input(data() / "tc/ptp4l/ok-gptp-bridge.conf")}).imported.scenario->clocks;
  EXPECT_EQ(clocks.nodes.front().second.tx_correction, sim::Duration::from_ps(250'000));
  EXPECT_EQ(gptp_of("ok-grandmaster.conf").nodes.front().second.clock_accuracy, 0x21);
  const scenario::Gptp station = gptp_of("ok-station-with-servo.conf");
  EXPECT_EQ(station.nodes.front().second.priority1, 255);
  EXPECT_EQ(station.log_sync_interval, -5);
  EXPECT_EQ(station.servo.first_step_threshold, sim::Duration::from_ps(20'000'000));
  EXPECT_EQ(station.servo.max_frequency.parts_per_trillion, 500'000'000);  // 500000 ppb
}

TEST(LinuxClocks, HaveAFileForEachDomain) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_file(
      std::filesystem::path(TAKT_SOURCE_DIR) / "scenarios/clocks/hot-standby.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const std::uint8_t second = resolved->scenario.clocks.gptp->domains.front().domain;
  const std::string node = resolved->plan.nodes.front().name;
  std::string mistake;
  const ExportFormat* const format = find_export_format("linux");
  const Exported exported = format->write({*resolved, {}, *Settings::read({}, format->settings, mistake)});
  for (const int domain : {0, static_cast<int>(second)})
    EXPECT_TRUE(std::ranges::any_of(exported.files, [&](const OutputFile& file) {
      return file.name == node + ".domain" + std::to_string(domain) + ".ptp4l.conf";
    })) << domain;
}

}  // namespace
}  // namespace takt::interchange::test
