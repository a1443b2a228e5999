// SPDX-License-Identifier: Apache-2.0
// Each format by a small instance of our own: what it becomes, and where mistakes are told.
#include "schedule_instances/instances.hpp"

#include <gtest/gtest.h>

#include "schedule_instances/report.hpp"
#include "schedule_instances/solutions.hpp"
#include "schedule_instances/write.hpp"
#include "json/document.hpp"
#include "schedule/gate_lists.hpp"
#include "schedule/refute.hpp"
#include "schedule_check/instance_check.hpp"

namespace takt::schedule_instances {
namespace {

using schedule::Problem;

std::optional<Problem> read(std::vector<TextFile> files, std::string* told = nullptr) {
  json::Diagnostics diagnostics;
  InstanceReader reader(std::move(files));
  auto problem = reader.next(diagnostics);
  if (told != nullptr)
    *told = diagnostics.to_text();
  else
    EXPECT_EQ(diagnostics.to_text(), "");
  return problem;
}

const char* const neutral = R"({"format": "schedule-problem-1", "name": "n", "model": {"strict": true, "gap": 12},
 "nodes": [{"name": "a", "bridge": false}, {"name": "sw", "bridge": true}, {"name": "b", "bridge": false}],
 "links": [{"from": "a", "to": "sw", "rate": 100000000, "forwarding": 1000000}, {"from": "sw", "to": "b", "rate": 1000000000, "propagation": 50000, "cut_through": 24, "entries": 8}],
 "streams": [{"name": "s", "talker": "a", "listeners": ["b"], "octets": 80, "period": 500000000, "frames": 2, "release": 1000, "latency": 100000000, "route": ["a>sw", "sw>b"], "class": 6}]})";

TEST(Instances, Neutral) {
  const auto problem = read({{"n.json", neutral}});
  ASSERT_TRUE(problem);
  EXPECT_TRUE(problem->model.is_strict);
  EXPECT_EQ(problem->links[0].octet, 80'000);
  EXPECT_EQ(problem->links[1].cut_through, 24u);
  EXPECT_EQ(problem->links[1].entries, 8u);
  EXPECT_EQ(problem->streams[0].route, (std::vector<schedule::LinkIndex>{0, 1}));
  EXPECT_EQ(problem->streams[0].frames, 2u);
  // Written and read again it is the same.
  const auto again = read({{"again.json", json::pretty(write_problem(*problem))}});
  ASSERT_TRUE(again);
  EXPECT_EQ(json::pretty(write_problem(*again)), json::pretty(write_problem(*problem)));
}

TEST(Instances, MistakesAreAllToldWithTheirPlaces) {
  std::string text = neutral, told;
  text.replace(text.find("\"octets\": 80"), 12, "\"octets\": -1");
  text.replace(text.find("[\"b\"]"), 5, "[\"x\"]");
  EXPECT_FALSE(read({{"n.json", text}}, &told));
  EXPECT_EQ(told,
            "n.json:4:57: error at /streams/0/listeners/0: there is no node \"x\"\nn.json:4:73: error at "
            "/streams/0/octets: not in range: found the number -1, expected a whole number from 1 to 1000000\n");
}

TEST(Instances, TasBenchmark) {
  const auto problem = read(
      {{"t.json",
        R"({"name": "T", "nodes": [{"name": "B", "isBridge": true, "processingDelay": 1000}, {"name": "E", "isBridge": false, "processingDelay": 7}, {"name": "F", "isBridge": false}],
 "links/ports": [{"name": "l0", "source": "E", "destination": "B", "propagationDelay": 100, "transmissionRate": 0.125, "gclEntries": 16}, {"name": "l1", "source": "B", "destination": "F", "transmissionRate": 0.125}],
 "streams": [{"name": "S", "type": "TT", "period": 500000, "framesPerPeriod": 2, "maxFrameSize": 84, "maxLatency": 250000.0, "deadline": 400000, "talker": "E", "listeners": ["F"], "path": ["l0", "l1"], "priority": 5, "earliestOffset": 0}]})"}});
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->links[0].octet, 8'000);  // 0.125 octets a ns
  EXPECT_EQ(problem->links[0].forwarding, 1'000'000);
  EXPECT_EQ(problem->links[0].entries, 16u);
  EXPECT_EQ(problem->links[1].forwarding, 0);
  EXPECT_EQ(problem->model.preamble + problem->model.gap, 0u);
  EXPECT_EQ(problem->streams[0].latency, 250'000'000);
  EXPECT_EQ(problem->streams[0].deadline, 400'000'000);
}

const char* const topology =
    R"({"directed": true, "nodes": [{"id": "h0", "is_switch": false, "processing_delay_ns": 4000}, {"id": "s0", "is_switch": true, "processing_delay_ns": 4000, "fwd_header_b": 24}, {"id": "h1", "is_switch": false}],
 "links": [{"key": "a", "source": "h0", "target": "s0", "link_speed_mbps": 1000, "propagation_delay_ns": 0}, {"key": "b", "source": "s0", "target": "h1", "link_speed_mbps": 1000, "propagation_delay_ns": 0}]})";
const char* const pattern =
    R"({"f0": {"sources": ["h0"], "destinations": ["h1"], "cycle_time_ns": 100000, "frame_size_b": 1500, "max_latency_ns": 60000, "deadline_ns": null, "redundancy": 1}})";

TEST(Instances, TsnBenchScenarios) {
  for (const auto& files : {std::vector<TextFile>{{"t.top", topology}, {"p.pat", pattern}},
                            std::vector<TextFile>{{"p.pat", pattern}, {"t.top", topology}}}) {
    const auto problem = read(files);
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->name, "p");
    EXPECT_EQ(problem->links[0].forwarding, 4'000'000);
    EXPECT_EQ(problem->links[0].cut_through, 24u);
    EXPECT_EQ(problem->links[1].forwarding, 0);  // a host is listened to without delay
    EXPECT_FALSE(problem->streams[0].route);
  }
  std::string told;
  EXPECT_FALSE(read({{"p.pat", pattern}}, &told));
  EXPECT_NE(told.find("streams without their network"), std::string::npos) << told;
}

TEST(Instances, OneNetworkForManySets) {
  json::Diagnostics diagnostics;
  InstanceReader reader(std::vector<TextFile>{{"t.top", topology}, {"p.pat", pattern}, {"q.pat", pattern}});
  EXPECT_EQ(reader.next(diagnostics)->name, "p");
  EXPECT_EQ(reader.next(diagnostics)->name, "q");
  EXPECT_TRUE(reader.is_at_end());
}

TEST(Instances, Tsnkit) {
  const TextFile tasks{"x_task.csv",
                       "stream,src,dst,size,period,deadline,jitter\n0,2,[3],50,2000000,1500000,2000000\n1,3,\"[2]\","
                       "100,500000,500000,100\n"};
  const TextFile net{"x_topo.csv",
                     "link,q_num,rate,t_proc,t_prop\n\"(0, 1)\",8,1,2000,0\n\"(1, 0)\",8,1,2000,0\n\"(0, "
                     "2)\",8,1,2000,0\n\"(2, 0)\",8,1,2000,5\n\"(1, 3)\",8,1,2000,0\n\"(3, 1)\",8,1,2000,0\n"};
  const auto problem = read({tasks, net});
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->name, "x");
  EXPECT_TRUE(problem->nodes[0].is_bridge);
  EXPECT_FALSE(problem->nodes[2].is_bridge);
  EXPECT_EQ(problem->links[3].propagation, 5'000);
  EXPECT_FALSE(problem->streams[0].jitter);  // as long as the deadline: no limit
  EXPECT_EQ(problem->streams[1].jitter, 100'000);
  std::string told;
  TextFile bad = tasks;
  bad.text.replace(bad.text.find("100,500000"), 3, "big");
  EXPECT_FALSE(read({bad, net}, &told));
  EXPECT_EQ(told, "x_task.csv:3:11: error: not in range: found \"big\", expected a whole number from 1 to 1000000\n");
}

TEST(Instances, Tsnsched) {
  const auto problem = read(
      {{"n.json",
        R"({"switches": [{"name": "w", "defaultTimeToTravel": 1, "defaultPortSpeed": 125, "ports": [{"name": "p0", "connectsTo": "d0"}, {"name": "p1", "connectsTo": "d1"}, {"name": "p2", "connectsTo": "w"}]}],
 "devices": [{"name": "d0", "defaultPacketPeriodicity": 2000, "defaultHardConstraintTime": 1000, "defaultPacketSize": 1500}, {"name": "d1"}],
 "flows": [{"name": "f", "sourceDevice": "d0", "endDevices": ["d1"], "hops": [{"currentNodeName": "d0", "nextNodeName": "w"}, {"currentNodeName": "w", "nextNodeName": "d1"}]}]})"}});
  ASSERT_TRUE(problem);
  ASSERT_EQ(problem->links.size(), 4u);
  const auto at = [&](const char* name) {
    return *std::find_if(problem->links.begin(), problem->links.end(),
                         [&](const auto& link) { return link.name == name; });
  };
  EXPECT_EQ(at("d0>w").propagation, 1'000'000);
  EXPECT_EQ(at("w>d1").propagation, 0);  // ends with the last bit that the last switch sends
  EXPECT_EQ(at("w>d1").octet, 8'000);
  EXPECT_EQ(problem->streams[0].octets, 1500u);
  EXPECT_EQ(problem->streams[0].latency, 1'000'000'000);
}

TEST(Instances, Ecrts) {
  const auto problem = read(
      {{"c.txt",
        "TSN_Stream a\na.source = ES1\na.period = 200000\na.maxFrameSize = 200\na.trafficClass = TC7\na.path = ES1 SW1 "
        "ES2\nTSN_Stream b\nb.period = 100000\nb.maxFrameSize = 64\nb.trafficClass = TC3\nb.path = ES2 SW1 ES1\n"}});
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->links.size(), 4u);
  ASSERT_EQ(problem->streams.size(), 1u);  // TC7 only
  EXPECT_EQ(problem->streams[0].period, 2'000'000'000);
  EXPECT_EQ(problem->streams[0].latency, 1'000'000'000);
}

TEST(Instances, WhatIsNoInstanceIsTold) {
  std::string told;
  EXPECT_FALSE(read({{"x.json", "{\"network\": {}}"}}, &told));
  EXPECT_NE(told.find("not an instance"), std::string::npos);
  EXPECT_FALSE(read({{"x.json", "{\"format\": \"schedule-problem-1\", "}}, &told));
  EXPECT_NE(told.find("x.json:1:"), std::string::npos) << told;
}

TEST(Solutions, SurviveARoundTrip) {
  const auto problem = read({{"n.json", neutral}});
  const schedule::Decision decision = schedule::decide(*problem, {});
  ASSERT_TRUE(decision.found.is_complete());
  const std::string written = json::pretty(write_solution(*problem, decision.found.solution));
  json::Diagnostics diagnostics;
  const auto document = json::parse(written, "s.json", diagnostics);
  const schedule::Solution again = read_solution(*document, *problem, diagnostics);
  EXPECT_EQ(diagnostics.to_text(), "");
  EXPECT_EQ(json::pretty(write_solution(*problem, again)), written);
}

TEST(Solutions, NameWhatIsThere) {
  const auto problem = read({{"n.json", neutral}});
  json::Diagnostics diagnostics;
  const auto document =
      json::parse(R"({"streams": {"s": {"route": ["a>sw", "sw>c"], "start": [0]}, "t": {}}})", "s.json", diagnostics);
  read_solution(*document, *problem, diagnostics);
  EXPECT_EQ(diagnostics.to_text(),
            "s.json:1:38: error at /streams/s/route/1: there is no link \"sw>c\"\ns.json:1:62: error at /streams/t: "
            "there is no stream \"t\"\n");
  json::Diagnostics more;
  const auto streams = json::parse(
      R"({"streams": [{"name": "s", "talker": "a", "listeners": ["b"], "octets": 64, "period": 1000000}, {"name": "u", "talker": "a", "listeners": ["b"], "octets": 64, "period": 1000000}]})",
      "add.json", more);
  EXPECT_EQ(read_streams(*streams, *problem, more).size(), 1u);
  EXPECT_EQ(more.to_text(), "add.json:1:14: error at /streams/0: stream \"s\" is there twice\n");
}

TEST(Report, SaysWhyInWords) {
  auto problem = read({{"n.json", neutral}});
  problem->streams[0].latency = 1'000'000;
  const schedule::Decision decision = schedule::decide(*problem, {});
  // 88 octets at 100 Mbit/s are 7.04 us, then 1 us, and the second frame comes 8 - 0.8 us later than it could go; 1.504
  // us for both at 1 Gbit/s, and 0.05 us.
  EXPECT_EQ(text_of(report(*problem, decision, std::nullopt)),
            "n: infeasible (latency)\n  \"s\" takes at least 16.794 us to \"b\" and has 1 us\n");
}

}  // namespace
}  // namespace takt::schedule_instances
