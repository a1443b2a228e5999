// SPDX-License-Identifier: Apache-2.0
// Redundant streams: paths that are disjoint, members with addresses of their own, where they part and meet, and what
// the run makes of it.
#include <map>
#include <set>

#include "scenario/topology/disjoint_paths.hpp"
#include "support.hpp"

namespace takt::scenario::test {
namespace {

std::vector<std::string> names(const Resolved& r, const Path& path) {
  std::vector<std::string> found;
  for (const std::uint32_t node : path) found.push_back(r.topology.nodes[node].name);
  return found;
}
using Names = std::vector<std::string>;

std::string mistakes(const std::string& text) { return load(text).diagnostics.to_text(); }

/// source - s1 - {s2a, s2b} - s3 - destination, with that redundancy.
std::string diamond(const std::string& redundancy, const std::string& more_links = {}) {
  return R"({"name": "t", "duration": "20ms", "network": {"nodes": {"source": {"kind": "host"}, "destination": {"kind": "host"},
 "s1": {"kind": "switch"}, "s2a": {"kind": "switch"}, "s2b": {"kind": "switch"}, "s3": {"kind": "switch"}},
 "links": [{"ends": ["source", "s1"]}, {"ends": ["s1", "s2a"]}, {"ends": ["s1", "s2b"]}, {"ends": ["s2a", "s3"]}, {"ends": ["s2b", "s3"]},
           {"ends": ["s3", "destination"]})" +
         more_links + R"(]},
 "streams": [{"name": "s", "from": "source", "to": "destination", "payload": "200B", "every": "1ms", "pcp": 4, "redundancy": )" +
         redundancy + "}]}";
}

TEST(Redundancy, ANumberIsEnough) {
  const auto r = sound(diamond("2"));
  ASSERT_EQ(r->redundancies.size(), 1u);
  const ResolvedRedundancy& redundancy = r->redundancies[0];
  EXPECT_EQ(redundancy.split, node(*r, "s1"));
  EXPECT_EQ(redundancy.merge, node(*r, "s3"));
  EXPECT_EQ(names(*r, r->streams[0].paths[0]), (Names{"source", "s1", "s2a", "s3", "destination"}));
  EXPECT_EQ(names(*r, r->streams[0].paths[1]), (Names{"source", "s1", "s2b", "s3", "destination"}));
  EXPECT_NE(redundancy.members[0].destination, redundancy.members[1].destination);
  EXPECT_NE(redundancy.members[0].destination, r->plan.streams[0].destination);
  EXPECT_TRUE(r->plan.host_splits.empty());
  EXPECT_TRUE(r->plan.host_recoveries.empty());
  EXPECT_TRUE(r->plan.nodes[node(*r, "s1")].ingress.has_value());
  EXPECT_FALSE(r->plan.nodes[node(*r, "s2a")].ingress.has_value());
  EXPECT_TRUE(r->plan.nodes[node(*r, "s3")].ingress.has_value());
}

/// What a run of 20 ms leaves: each of the 20 frames once, and its copy taken out.
void expect_each_frame_once(const std::string& text) {
  const auto r = sound(text);
  LiveRun run(*r);
  run.advance();
  const models::Stream& stream = run.network().traffic().streams()[0];
  EXPECT_EQ(stream.delivered, 20u);
  EXPECT_EQ(stream.dropped[static_cast<std::size_t>(models::DropReason::duplicate)], 20u);
  EXPECT_EQ(stream.dropped_in_all(), 20u);
  EXPECT_EQ(digest_of(*r, 5), digest_of(*r));
}

TEST(Redundancy, SwitchesSplitAndMerge) { expect_each_frame_once(diamond("2")); }
TEST(Redundancy, HostsSplitAndMerge) {
  expect_each_frame_once(diamond(R"({"split": "source", "merge": "destination"})"));
}
TEST(Redundancy, AHostSplitsAndASwitchMerges) { expect_each_frame_once(diamond(R"({"split": "source"})")); }
TEST(Redundancy, ASwitchSplitsAndAHostMerges) {
  expect_each_frame_once(diamond(R"({"merge": "destination", "individual": true, "algorithm": "match"})"));
}
TEST(Redundancy, MembersMayHaveVlansOfTheirOwn) {
  expect_each_frame_once(diamond(R"({"count": 2, "vlans": [11, 12], "keep_tag": true})"));
}

/// Hosts that are attached to two switches each, or stations in a ring.
std::string attached_twice(const std::string& kind, const std::string& redundancy) {
  return R"({"name": "t", "duration": "20ms", "network": {"nodes": {"source": {"kind": ")" + kind +
         R"("}, "destination": {"kind": ")" + kind + R"("},
 "a": {"kind": "switch"}, "b": {"kind": "switch"}},
 "links": [{"ends": ["source", "a"]}, {"ends": ["source", "b"]}, {"ends": ["a", "destination"]}, {"ends": ["b", "destination"]}]},
 "streams": [{"name": "s", "from": "source", "to": "destination", "payload": "200B", "every": "1ms", "pcp": 4, "redundancy": )" +
         redundancy + "}]}";
}

TEST(Redundancy, HostsSendAndTakeByBothTheirInterfaces) {
  const auto r = sound(attached_twice("host", "2"));
  EXPECT_EQ(names(*r, r->streams[0].paths[0]), (Names{"source", "a", "destination"}));
  EXPECT_EQ(names(*r, r->streams[0].paths[1]), (Names{"source", "b", "destination"}));
  EXPECT_EQ(r->plan.host_splits.size(), 1u);
  EXPECT_EQ(r->plan.host_recoveries.size(), 1u);
  expect_each_frame_once(attached_twice("host", "2"));
}
TEST(Redundancy, StationsSendAndTakeByBothTheirPorts) { expect_each_frame_once(attached_twice("station", "2")); }

/// Five stations in a ring; what the first sends goes to the others.
std::string ring_of_stations(const std::string& more) {
  return R"({"name": "t", "duration": "20ms", "network": {"generate": [{"topology": "ring", "stations": 5, "forwarding_delay": "1us"}]},
 "streams": [{"name": "s", "from": "st1", "to": ["st2", "st3", "st4", "st5"], "payload": "200B", "every": "1ms", "pcp": 4, "redundancy": 2)" +
         more + "}]}";
}

// Both ways around: each station gets each frame twice, and once is enough.
TEST(Redundancy, GoesToSeveralReceiversOverTwoTrees) {
  const auto r = sound(ring_of_stations(""));
  ASSERT_EQ(r->streams[0].paths.size(), 8u);
  EXPECT_EQ(names(*r, r->streams[0].paths[2]), (Names{"st1", "st2", "st3"}));
  EXPECT_EQ(names(*r, r->streams[0].paths[3]), (Names{"st1", "st5", "st4", "st3"}));
  LiveRun run(*r);
  run.advance();
  const models::Stream& stream = run.network().traffic().streams()[0];
  EXPECT_EQ(stream.delivered, 80u);
  EXPECT_EQ(stream.dropped[static_cast<std::size_t>(models::DropReason::duplicate)], 80u);
  EXPECT_EQ(stream.dropped_in_all(), 80u);
  EXPECT_EQ(digest_of(*r, 5), digest_of(*r));
}

// Whichever cable is cut from 5 to 10 ms, each station gets each of the 20 frames.
TEST(Redundancy, ACutCableCostsNoReceiverAFrame) {
  for (int cut = 1; cut <= 5; ++cut) {
    std::string text = ring_of_stations("");
    text.pop_back();
    text += R"(, "faults": [{"kind": "link-down", "link": ["st)" + std::to_string(cut) + R"(", "st)" +
            std::to_string(cut % 5 + 1) + R"("], "at": "5ms", "for": "5ms"}]})";
    const auto r = sound(text);
    LiveRun run(*r);
    run.advance();
    EXPECT_EQ(run.network().traffic().streams()[0].delivered, 80u) << cut;
  }
}

// A line has no second way.
TEST(Redundancy, SeveralReceiversNeedTwoWaysToEach) {
  const std::string text =
      R"({"name": "t", "duration": "20ms", "network": {"generate": [{"topology": "line", "stations": 3}]},
 "streams": [{"name": "s", "from": "st1", "to": ["st2", "st3"], "payload": "200B", "every": "1ms", "pcp": 4, "redundancy": {"count": 3}}]})";
  EXPECT_NE(mistakes(text).find("redundancy for several receivers: found \"count\" of a stream to 2, expected 2"),
            std::string::npos)
      << mistakes(text);
  std::string two = text;
  two.replace(two.find("{\"count\": 3}"), 12, "2");
  EXPECT_NE(mistakes(two).find("not enough disjoint paths: found 1 between \"st1\" and \"st2\", expected 2 paths that "
                               "share no link between switches"),
            std::string::npos)
      << mistakes(two);
}

/// A Program on a ring of stations.
std::string program(const std::string& more) {
  return R"({"name": "t", "duration": "20ms", "network": {"generate": [{"topology": "ring", "stations": 4}]},
 "programs": [{"name": "p", "master": "st1", "slaves": ["st2", "st3"], "cycle": "1ms")" +
         more + R"(}],
 "script": [{"at": "2ms", "program": "p", "call": "Start"}]})";
}

TEST(Redundancy, OfAProgramIsThatOfAllItsMessages) {
  const auto r =
      sound(program(R"(, "redundancy": 2, "process_data": [{"name": "d", "from": "st3", "fields": {"x": "Double"}}])"));
  ASSERT_EQ(r->redundancies.size(), 4u);
  for (const ResolvedRedundancy& each : r->redundancies) {
    EXPECT_TRUE(each.splits_in_host);
    EXPECT_TRUE(each.merges_in_host);
  }
}

TEST(Redundancy, ProgramsTakeTheWaysThatTheyAreGiven) {
  const auto r = sound(program(R"(, "paths": [["st3", "st4", "st1"]])"));
  const auto way = [&](std::size_t stream, std::size_t path) { return names(*r, r->streams[stream].paths[path]); };
  EXPECT_EQ(way(0, 0), (Names{"st1", "st2"}));
  EXPECT_EQ(way(0, 1), (Names{"st1", "st4", "st3"}));  // the other way round
  EXPECT_EQ(way(2, 0), (Names{"st3", "st4", "st1"}));
  EXPECT_NE(mistakes(program(R"(, "paths": [["st2", "st3", "st4", "st1"], ["st3", "st2", "st1"]])"))
                .find("ways that meet again"),
            std::string::npos);
  EXPECT_NE(mistakes(program(R"(, "paths": [["st4", "st1"]])")).find("not a member: found \"st4\""), std::string::npos);
  EXPECT_NE(mistakes(program(R"(, "paths": [["st3", "st1"]])")).find("no link"), std::string::npos);
  EXPECT_NE(
      mistakes(program(R"(, "redundancy": 2, "paths": [["st3", "st4", "st1"]])")).find("paths of redundant messages"),
      std::string::npos);
}

// One path is longer by a switch: its copies come later and are the ones that are taken out.
TEST(Redundancy, GivenPathsAreTaken) {
  const std::string text = diamond(
      R"({"paths": [["source", "s1", "s2a", "s3", "destination"], ["source", "s1", "s2b", "s2a2", "s3", "destination"]]})");
  std::string with_switch = text;
  with_switch.replace(with_switch.find(R"("s3": {"kind": "switch"})"), 0, R"("s2a2": {"kind": "switch"}, )");
  with_switch.replace(with_switch.find(R"({"ends": ["s3", "destination"]})"), 0,
                      R"({"ends": ["s2b", "s2a2"]}, {"ends": ["s2a2", "s3"]}, )");
  expect_each_frame_once(with_switch);
}

TEST(Redundancy, ThreePathsWhereThereAreThree) {
  std::string text = diamond("3", R"(, {"ends": ["s1", "s3"]})");
  const auto r = sound(text);
  ASSERT_EQ(r->streams[0].paths.size(), 3u);
  EXPECT_EQ(names(*r, r->streams[0].paths[0]), (Names{"source", "s1", "s3", "destination"}));
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(run.network().traffic().streams()[0].delivered, 20u);
  EXPECT_EQ(run.network().traffic().streams()[0].dropped_in_all(), 40u);
}

// Every pair in a ring: two ways round, which share nothing but the switches at the ends.
TEST(DisjointPaths, InARingTheyAreTheTwoWaysRound) {
  const auto r = sound(generated(R"("topology": "ring", "switches": 7)"));
  for (std::uint32_t a = 7; a < 14; ++a) {
    for (std::uint32_t b = 7; b < 14; ++b) {
      if (a == b) continue;
      const DisjointPaths found = disjoint_paths(r->topology, a, b, 2);
      ASSERT_EQ(found.paths.size(), 2u);
      EXPECT_EQ(found.paths[0].size() + found.paths[1].size(),
                2u + 2u + 7u + 2u);  // hosts, ends twice, all others once
      EXPECT_LE(found.paths[0].size(), found.paths[1].size());
      EXPECT_TRUE(found.shared_switches.empty());
    }
  }
}

// In a grid the paths share no inner switch and no link, are neighbours step by step and as short as two disjoint ones
// can be.
TEST(DisjointPaths, InAGridTheyShareNothing) {
  const auto r = sound(generated(R"("topology": "mesh", "rows": 4, "columns": 5)"));
  for (std::uint32_t b = 21; b < 40; ++b) {
    const DisjointPaths found = disjoint_paths(r->topology, 20, b, 2);
    ASSERT_EQ(found.paths.size(), 2u);
    std::set<std::uint32_t> inner;
    for (const Path& path : found.paths) {
      EXPECT_EQ(path.front(), 20u);
      EXPECT_EQ(path.back(), b);
      for (std::size_t i = 0; i + 1 < path.size(); ++i) EXPECT_TRUE(r->topology.port_towards(path[i], path[i + 1]));
      for (std::size_t i = 2; i + 2 < path.size(); ++i) EXPECT_TRUE(inner.insert(path[i]).second);
    }
  }
}

// Two diamonds in a row: all paths cross the switch in the middle, but no link is shared.
TEST(DisjointPaths, SharedSwitchesAreNamed) {
  const Loaded loaded =
      load(R"({"name": "t", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"},
 "s1": {"kind": "switch"}, "x": {"kind": "switch"}, "y": {"kind": "switch"}, "m": {"kind": "switch"}, "u": {"kind": "switch"}, "v": {"kind": "switch"}, "s2": {"kind": "switch"}},
 "links": [{"ends": ["a", "s1"]}, {"ends": ["s1", "x"]}, {"ends": ["s1", "y"]}, {"ends": ["x", "m"]}, {"ends": ["y", "m"]},
           {"ends": ["m", "u"]}, {"ends": ["m", "v"]}, {"ends": ["u", "s2"]}, {"ends": ["v", "s2"]}, {"ends": ["s2", "b"]}]},
 "streams": [{"name": "s", "from": "a", "to": "b", "payload": "200B", "every": "1ms", "redundancy": 2}]})");
  ASSERT_NE(loaded.resolved, nullptr) << loaded.diagnostics.to_text();
  EXPECT_NE(loaded.diagnostics.to_text().find(R"(redundant paths that meet in a switch: found "m")"),
            std::string::npos);
  LiveRun run(*loaded.resolved);
  run.advance();
  EXPECT_EQ(run.network().traffic().streams()[0].delivered, 20u);
}

// Copies and their R-TAG are on the links between: 250 octets of MAC frame, 270 of the medium, with R-TAG 276.
TEST(Redundancy, TheDemandCountsEveryMember) {
  const auto demand = [](const std::string& redundancy) {
    const auto r = sound(diamond(redundancy));
    std::map<std::string, double> bits;
    for (const PortDemand& port : r->ports)
      bits[r->plan.nodes[port.node.value].name + " " + r->plan.nodes[port.peer.value].name] =
          port.share() * port.link_bits_per_second;
    return bits;
  };
  auto at_switches = demand("2");
  EXPECT_DOUBLE_EQ(at_switches["source s1"], 270 * 8 * 1000.0);
  EXPECT_DOUBLE_EQ(at_switches["s1 s2a"], 276 * 8 * 1000.0);
  EXPECT_DOUBLE_EQ(at_switches["s2b s3"], 276 * 8 * 1000.0);
  EXPECT_DOUBLE_EQ(at_switches["s3 destination"], 270 * 8 * 1000.0);
  auto at_hosts = demand(R"({"split": "source", "merge": "destination"})");
  EXPECT_DOUBLE_EQ(at_hosts["source s1"], 2 * 276 * 8 * 1000.0);
  EXPECT_DOUBLE_EQ(at_hosts["s3 destination"], 2 * 276 * 8 * 1000.0);
}

// A filter on the way knows the members by the name of their stream.
TEST(Redundancy, MembersAreThePolicedStream) {
  std::string text = diamond("2");
  text.replace(
      text.find(R"("s2a": {"kind": "switch"})"), std::string(R"("s2a": {"kind": "switch"})").size(),
      R"("s2a": {"kind": "switch", "ingress": {"filters": [{"stream": "s", "gate": "shut"}], "gates": [{"name": "shut", "open": false}]}})");
  const auto r = sound(text);
  LiveRun run(*r);
  run.advance();
  const models::Stream& stream = run.network().traffic().streams()[0];
  EXPECT_EQ(stream.delivered, 20u);  // over s2b
  EXPECT_EQ(stream.dropped[static_cast<std::size_t>(models::DropReason::stream_gate)], 20u);
}

TEST(Redundancy, TheValidationScenarioGivesItsFigures) {
  const auto r = shipped("validation/frer");
  LiveRun run(*r);
  run.advance();
  const models::Stream& stream = run.network().traffic().streams()[0];
  EXPECT_EQ(stream.delivered, 100u);
  EXPECT_EQ(stream.latency.minimum(), Duration::from_ps(402'440'000));
  EXPECT_EQ(stream.latency.maximum(), Duration::from_ps(402'440'000));
}

}  // namespace
}  // namespace takt::scenario::test
