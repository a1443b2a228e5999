// SPDX-License-Identifier: Apache-2.0
// Scheduling problems as scenarios, and back.
#include "schedule_instances/instances.hpp"
#include "round_trip.hpp"

namespace takt::interchange::test {
namespace {

Exported written(const std::string& format, const scenario::Resolved& resolved) {
  return find_export_format(format)->write({resolved, {}, {}});
}

/// What a problem can say of a scenario: its network and its periodic streams.
scenario::Scenario plannable(const scenario::Scenario& whole) {
  scenario::Scenario bare;
  bare.name = whole.name;
  bare.seed = whole.seed;
  bare.duration = whole.duration;
  bare.network = whole.network;
  bare.allow_overload = false;
  for (auto& [name, node] : bare.network.nodes) {
    scenario::ports_of(node) = scenario::NodePorts{};
    if (scenario::EndStation* const station = scenario::end_station_of(node)) *station = scenario::EndStation{};
    if (scenario::Relay* const relay = scenario::relay_of(node)) {
      relay->forwarding_jitter.reset();
      relay->ingress.reset();
    }
    if (auto* const station = std::get_if<scenario::StationNode>(&node)) station->bypass = false;
  }
  for (scenario::Generator& generator : bare.network.generate) {
    generator.egress.clear();
    generator.ingress.reset();
    generator.traffic_classes = scenario::TrafficClasses::standard;
    generator.queues = {};
    generator.os = {};
    generator.forwarding_jitter.reset();
  }
  for (scenario::Stream stream : whole.streams) {
    if (stream.exponential || stream.normal || stream.trace || stream.redundancy) continue;
    stream.jitter = {};
    stream.launch.reset();
    stream.host_priority.reset();
    if (stream.burst) stream.burst->spacing = {};
    if (stream.offset && stream.offset->is_auto) stream.offset.reset();
    bare.streams.push_back(std::move(stream));
  }
  return bare;
}

/// How many shipped scenarios, cut down to what a problem can say, come back as they were.
std::size_t come_back(const std::string& format) {
  std::size_t count = 0;
  for (const std::filesystem::path& path : shipped()) {
    json::Diagnostics diagnostics;
    const auto whole = scenario::load_file(path, {}, diagnostics);
    EXPECT_TRUE(whole) << diagnostics.to_text();
    const scenario::Scenario bare = plannable(whole->scenario);
    if (bare.streams.empty()) continue;
    json::Diagnostics overloaded;
    const auto resolved = scenario::load_text(sparse_text(bare), path, {}, overloaded);
    if (!resolved) continue;  // too much for a link without its shapers
    const Exported exported = written(format, *resolved);
    if (!exported.losses.empty()) {
      EXPECT_EQ(format, "tsnkit") << path << ": " << exported.losses.front().where << ": "
                                  << exported.losses.front().what;
      continue;
    }
    const Reading reading = read(format, inputs(exported));
    EXPECT_TRUE(reading.imported.scenario) << path << "\n" << reading.remarks();
    if (!reading.imported.scenario) continue;
    const auto again = scenario::load_text(sparse_text(*reading.imported.scenario), path, {}, diagnostics);
    EXPECT_TRUE(again) << path << "\n" << diagnostics.to_text();
    if (!again) continue;
    const sim::Duration duration = std::min(resolved->scenario.duration, sim::Duration::from_ps(20'000'000'000));
    EXPECT_EQ(digest_of(*again, duration), digest_of(*resolved, duration)) << path << " by " << format;
    EXPECT_EQ(again->scenario.duration, resolved->scenario.duration);
    ++count;
  }
  return count;
}

TEST(Planning, ScenariosOfStreamsComeBackFromTheNeutralProblem) { EXPECT_GE(come_back("neutral"), 20u); }
TEST(Planning, ScenariosOfStreamsComeBackFromTsnkit) { EXPECT_GE(come_back("tsnkit"), 8u); }

TEST(Planning, WhatAPlannerCannotBeToldIsListed) {
  std::size_t refused = 0, whole = 0;
  for (const std::filesystem::path& path : shipped()) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(path, {}, diagnostics);
    const Exported exported = written("neutral", *resolved);
    ++(exported.losses.empty() ? whole : refused);
    if (!resolved->scenario.programs.empty() || !resolved->scenario.faults.empty()) {
      EXPECT_FALSE(exported.losses.empty()) << path;
    }
    if (!exported.losses.empty()) continue;
    const Reading reading = read("neutral", inputs(exported));
    ASSERT_TRUE(reading.imported.scenario) << path << "\n" << reading.remarks();
    const auto again = scenario::load_text(sparse_text(*reading.imported.scenario), path, {}, diagnostics);
    ASSERT_TRUE(again) << diagnostics.to_text();
    const sim::Duration duration = std::min(resolved->scenario.duration, sim::Duration::from_ps(20'000'000'000));
    if (!resolved->gates) {
      EXPECT_EQ(digest_of(*again, duration), digest_of(*resolved, duration)) << path;
    }
  }
  EXPECT_GE(whole, 2u);
  EXPECT_GE(refused, 50u);
}

const char* const two_hosts =
    R"({"format": "schedule-problem-1", "name": "two", "nodes": [{"name": "a", "bridge": false}, {"name": "b", "bridge": false}, {"name": "s", "bridge": true}],
 "links": [{"from": "a", "to": "s", "rate": 1000000000, "propagation": 50000, "forwarding": 1000000}, {"from": "s", "to": "a", "rate": 1000000000, "propagation": 50000},
           {"from": "s", "to": "b", "rate": 1000000000, "propagation": 50000}, {"from": "b", "to": "s", "rate": 1000000000, "propagation": 50000, "forwarding": 1000000}],
 "streams": [{"name": "x", "talker": "a", "listeners": ["b"], "octets": 1000, "period": 1000000000, "release": 7000000, "deadline": 57000000, "jitter": 3000000, "frames": 2, "class": 5}]})";

TEST(Planning, AProblemSaysWhatTheScenarioDoes) {
  const Reading reading = read("neutral", {{"two.json", "two", two_hosts}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  EXPECT_TRUE(reading.imported.remarks.empty()) << reading.remarks();
  const scenario::Scenario& made = *reading.imported.scenario;
  ASSERT_EQ(made.streams.size(), 1u);
  const scenario::Stream& x = made.streams.front();
  EXPECT_EQ(x.payload, sim::Octets{1000 - 22});  // MAC header 14, tag 4, FCS 4
  EXPECT_EQ(x.pcp, 5);
  EXPECT_EQ(x.burst->frames, 2u);
  EXPECT_EQ(x.offset->value, sim::Duration::from_ps(7'000'000));
  ASSERT_EQ(made.require.size(), 1u);
  EXPECT_EQ(made.require.front().latency->at_most, sim::Duration::from_ps(50'000'000));  // deadline - release
  EXPECT_EQ(made.require.front().jitter->at_most, sim::Duration::from_ps(3'000'000));
  EXPECT_EQ(scenario::relay_of(made.network.nodes[2].second)->forwarding_delay, sim::Duration::from_ps(1'000'000));
  ASSERT_EQ(made.network.links.size(), 2u);
  EXPECT_EQ(*made.network.links.front().delay, sim::Duration::from_ps(50'000));
}

TEST(Planning, AScheduleMovesTheStreamAndOpensGates) {
  std::string problem = two_hosts;
  const Reading reading = read(
      "neutral",
      {{"two.json", "two", problem},
       {"two.solution.json", "two",
        R"({"format": "schedule-solution-1", "streams": {"x": {"route": ["a>s", "s>b"], "start": [9000000, 30000000]}}})"}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Scenario& made = *reading.imported.scenario;
  EXPECT_EQ(made.streams.front().offset->value, sim::Duration::from_ps(9'000'000));
  EXPECT_EQ(*made.streams.front().path, (std::vector<std::string>{"a", "s", "b"}));
  const auto& egress = scenario::ports_of(made.network.nodes[2].second).egress;
  ASSERT_EQ(egress.size(), 1u);
  EXPECT_EQ(egress.front().to, "b");
  ASSERT_TRUE(egress.front().gates);
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(sparse_text(made), "two.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  scenario::Run run(*resolved);
  run.simulation().run(sim::TrueTime() + sim::Duration::from_ps(2'500'000'000));
  // From 9 us: the gate of s towards b opens at 30 us, two frames of 1,008 octets and a gap take 16.224 us, the cable
  // 0.05 us.
  const auto& accounts = run.network().traffic().stream(models::StreamIndex{0});
  EXPECT_EQ(accounts.delivered, 6u);
}

TEST(Planning, SchedulesThatAreNoneAreRefused) {
  for (const char* const wrong :
       {R"({"format": "schedule-solution-1", "streams": {"x": {"route": ["a>s"], "start": [9000000]}}})",  // ends at
                                                                                                           // the switch
        R"({"format": "schedule-solution-1", "streams": {"x": {"route": ["s>b"], "start": [9000000]}}})",  // begins
                                                                                                           // there
        R"({"format": "schedule-solution-1", "streams": {"x": {"route": ["b>s", "s>b"], "start": [1, 2]}}})",  // in a
                                                                                                               // circle
        R"({"format": "schedule-solution-1", "streams": {"x": {"route": [], "start": []}}})",
        R"({"format": "schedule-solution-1", "streams": {}})"}) {
    const Reading reading = read("neutral", {{"two.json", "two", two_hosts}, {"s.json", "s", wrong}});
    EXPECT_FALSE(reading.imported.scenario) << wrong;
    EXPECT_TRUE(reading.diagnostics.has_errors()) << wrong;
  }
}

TEST(Planning, WhatTaktDoesOtherwiseIsTold) {
  const std::string tasks =
      "stream,src,dst,size,period,deadline,jitter\n0,0,\"[1]\",50,1000000,1000000,1000000\n1,0,\"[1]\",4000,1000000,"
      "1000000,1000000\n";
  const std::string topology =
      "link,q_num,rate,t_proc,t_prop\n\"(0, 2)\",8,1,2000,0\n\"(2, 0)\",8,1,0,0\n\"(1, 2)\",8,1,1000,0\n\"(2, "
      "1)\",8,1,3000,0\n";
  const Reading reading = read("tsnkit", {{"t_task.csv", "t", tasks}, {"t_topo.csv", "t", topology}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  EXPECT_TRUE(reading.lost());
  const std::string told = reading.remarks();
  EXPECT_NE(told.find("t_task.csv:2:1: lost: frames shorter than Ethernet's (50 octets on the wire"), std::string::npos)
      << told;
  EXPECT_NE(told.find("t_task.csv:3:1: changed: frames longer than Ethernet's (4000"), std::string::npos) << told;
  EXPECT_NE(told.find("takt takes the longest, 2us"), std::string::npos) << told;
  const scenario::Scenario& made = *reading.imported.scenario;
  EXPECT_FALSE(made.streams[1].burst);
  EXPECT_EQ(made.streams[1].payload, sim::Octets{4000 - 42});  // one frame: the mtu is made as long
  EXPECT_EQ(made.network.mtu, sim::Octets{4000 - 42});
  EXPECT_EQ(scenario::end_station_of(made.network.nodes[1].second)->os.receive->fixed,
            sim::Duration::from_ps(3'000'000));  // what it takes at the listener counts
}

TEST(Planning, MistakesHaveTheirPlaces) {
  struct Case {
    std::string format, from, to, told;
  };
  const std::string takt =
      R"("format": "schedule-problem-1", "takt": {"streams": [{"stream": "x", "payload": "958B"}]},)";
  const Case cases[] = {
      {"neutral",
       R"("rate": 1000000000, "propagation": 50000, "forwarding": 1000000}, {"from": "s", "to": "a", "rate": 1000000000)",
       R"("rate": 1000000000}, {"from": "s", "to": "a", "rate": 100000000)", "two.json:2:58: error"},
      {"neutral", R"("format": "schedule-problem-1",)",
       R"("format": "schedule-problem-1", "takt": {"streams": [{"stream": "y", "payload": "1B"}]},)",
       "no such stream: found \"y\""},
      {"neutral", R"("format": "schedule-problem-1",)",
       R"("format": "schedule-problem-1", "takt": {"streams": [{"stream": "x", "payload": "1B"}]},)",
       "a payload that does not make the size"},
      {"neutral", R"("format": "schedule-problem-1",)", takt, "a priority that is not that of the class"},
      {"neutral", R"("format": "schedule-problem-1",)", R"("format": "schedule-problem-1", "takt": {"colour": 1},)",
       "unknown field"},
      {"tsnkit", "", "", "not of tsnkit"},
      {"neutral", R"("format": "schedule-problem-1",)", "", "not an instance"},
      {"neutral", "1000000000, \"release\"", "1000000000,, \"release\"", "two.json:4:"},
  };
  for (const Case& each : cases) {
    std::string text = two_hosts;
    if (!each.from.empty()) {
      ASSERT_NE(text.find(each.from), std::string::npos) << each.from;
      text.replace(text.find(each.from), each.from.size(), each.to);
    }
    const Reading reading = read(each.format, {{"two.json", "two", text}});
    EXPECT_FALSE(reading.imported.scenario) << each.to;
    EXPECT_NE(reading.diagnostics.to_text().find(each.told), std::string::npos) << each.told << "\n"
                                                                                << reading.diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::interchange::test
