// SPDX-License-Identifier: Apache-2.0
// Paths: shortest, the same on every machine, trees for one sender or one receiver, and consistent with the filtering
// entries.
#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <tuple>

#include "support.hpp"

namespace takt::scenario::test::routing_test {
namespace {

std::string stream(const std::string& from, const std::string& to, const std::string& more = {}) {
  return R"({"name": "of-)" + from + R"(", "from": ")" + from + R"(", "to": )" + to +
         R"(, "payload": "100B", "every": "10ms")" + more + "}";
}

std::vector<std::string> names(const Resolved& r, const Path& path) {
  std::vector<std::string> result;
  for (const std::uint32_t n : path) result.push_back(r.topology.nodes[n].name);
  return result;
}

/// Number of links from `from` to every node; hosts do not forward.
std::vector<std::size_t> distances(const Topology& topology, std::uint32_t from) {
  std::vector<std::size_t> distance(topology.nodes.size(), SIZE_MAX);
  std::queue<std::uint32_t> open({from});
  distance[from] = 0;
  while (!open.empty()) {
    const std::uint32_t n = open.front();
    open.pop();
    if (n != from && !topology.nodes[n].forwards()) continue;
    for (const Neighbour& next : topology.neighbours[n]) {
      if (distance[next.node] != SIZE_MAX) continue;
      distance[next.node] = distance[n] + 1;
      open.push(next.node);
    }
  }
  return distance;
}

std::string grid(std::size_t rows, std::size_t columns) {
  return R"("topology": "mesh", "rows": )" + std::to_string(rows) + R"(, "columns": )" + std::to_string(columns);
}

TEST(Routing, PathsOfAGridAreShortest) {
  const auto r = sound(generated(grid(4, 5)));
  Router router(r->topology);
  for (std::uint32_t from = 20; from < 40; ++from) {
    ASSERT_TRUE(r->topology.nodes[from].is_end_station());
    const std::vector<std::size_t> distance = distances(r->topology, from);
    for (std::uint32_t to = 20; to < 40; ++to) {
      if (to == from) continue;
      for (const auto& path : {router.to_host(from, to), router.from_host(from, to)}) {
        ASSERT_TRUE(path);
        EXPECT_EQ(path->size(), distance[to] + 1);
        EXPECT_EQ(path->front(), from);
        EXPECT_EQ(path->back(), to);
        for (std::size_t i = 1; i < path->size(); ++i)
          EXPECT_TRUE(r->topology.port_towards((*path)[i - 1], (*path)[i]));
        for (std::size_t i = 1; i + 1 < path->size(); ++i) EXPECT_TRUE(r->topology.nodes[(*path)[i]].forwards());
      }
    }
  }
}

// For one receiver every switch has one way on; for one sender every switch is reached from one side.
TEST(Routing, PathsToOneAndFromOneAreTrees) {
  const auto r = sound(generated(grid(5, 5)));
  Router router(r->topology);
  std::map<std::uint32_t, std::uint32_t> next;
  std::map<std::uint32_t, std::uint32_t> previous;
  for (std::uint32_t other = 25; other < 50; ++other) {
    if (other == 30) continue;
    const Path to = *router.to_host(other, 30);
    for (std::size_t i = 0; i + 1 < to.size(); ++i)
      EXPECT_EQ(next.try_emplace(to[i], to[i + 1]).first->second, to[i + 1]);
    const Path from = *router.from_host(30, other);
    for (std::size_t i = 1; i < from.size(); ++i)
      EXPECT_EQ(previous.try_emplace(from[i], from[i - 1]).first->second, from[i - 1]);
  }
}

// Two ways round a ring of four: the one over the link that was written first, near the receiver.
TEST(Routing, AmongEqualPathsTheSameIsTakenEverywhere) {
  const auto r = sound(generated(R"("topology": "ring", "switches": 4)",
                                 R"(, "streams": [)" + stream("h1", "\"h3\"") + ", " + stream("h3", "\"h1\"") + "]"));
  EXPECT_EQ(names(*r, r->streams[0].paths[0]), (std::vector<std::string>{"h1", "sw1", "sw2", "sw3", "h3"}));
  EXPECT_EQ(names(*r, r->streams[1].paths[0]), (std::vector<std::string>{"h3", "sw3", "sw2", "sw1", "h1"}));
}

TEST(Routing, TheOrderOfTheLinksDecides) {
  const auto text = [](const char* first, const char* second) {
    return std::string(
               R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"},
 "s": {"kind": "switch"}, "t": {"kind": "switch"}, "x": {"kind": "switch"}, "y": {"kind": "switch"}},
 "links": [{"ends": ["a", "s"]}, {"ends": ["b", "t"]}, {"ends": ["t", ")") +
           first + R"("]}, {"ends": ["t", ")" + second +
           R"("]}, {"ends": ["s", "x"]}, {"ends": ["s", "y"]}]}, "streams": [)" + stream("a", "\"b\"") + "]}";
  };
  const auto x = sound(text("x", "y"));
  EXPECT_EQ(names(*x, x->streams[0].paths[0]), (std::vector<std::string>{"a", "s", "x", "t", "b"}));
  const auto y = sound(text("y", "x"));
  EXPECT_EQ(names(*y, y->streams[0].paths[0]), (std::vector<std::string>{"a", "s", "y", "t", "b"}));
}

TEST(Routing, AnExplicitPathIsHonoured) {
  const auto r = sound(
      generated(R"("topology": "ring", "switches": 5)",
                R"(, "streams": [)" +
                    stream("h1", "\"h2\"", R"(, "path": ["h1", "sw1", "sw5", "sw4", "sw3", "sw2", "h2"])") + "]"));
  EXPECT_EQ(names(*r, r->streams[0].paths[0]),
            (std::vector<std::string>{"h1", "sw1", "sw5", "sw4", "sw3", "sw2", "h2"}));
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(run.network().traffic().streams()[0].delivered, 1u);  // the filtering entries lead there, too
}

TEST(Routing, AHostDoesNotForward) {
  const Loaded loaded =
      load(R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"},
 "s": {"kind": "switch"}, "t": {"kind": "switch"}}, "links": [{"ends": ["a", "s"]}, {"ends": ["b", "t"]}]}, "streams": [)" +
           stream("a", "\"b\"") + "]}");
  EXPECT_EQ(loaded.resolved, nullptr);
  EXPECT_NE(loaded.diagnostics.to_text().find("no path"), std::string::npos);
}

TEST(Routing, TwoHostsOnOneCable) {
  const auto r =
      sound(R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}},
 "links": [{"ends": ["a", "b"]}]}, "streams": [)" +
            stream("a", "\"b\"") + "]}");
  EXPECT_EQ(names(*r, r->streams[0].paths[0]), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(r->plan.filtering.empty());
}

// One address and VLAN at one bridge: one port for unicast, several for a group only where its tree branches.
TEST(Routing, FilteringEntriesAreConsistent) {
  std::string streams;
  for (int i = 1; i <= 16; ++i)
    for (int k = 1; k <= 16; ++k)
      if (i != k)
        streams += std::string(streams.empty() ? "" : ", ") + R"({"name": "s)" + std::to_string(i) + "-" +
                   std::to_string(k) + R"(", "from": "h)" + std::to_string(i) + R"(", "to": "h)" + std::to_string(k) +
                   R"(", "payload": "50B", "every": "1s"})";
  const auto r = sound(generated(
      grid(4, 4), R"(, "streams": [)" + streams + R"(, {"name": "group", "from": "h1", "to": ["h4", "h13", "h16", "h6"],
 "payload": "50B", "every": "1s"}])"));
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::set<std::uint16_t>> ports;
  for (const models::FilteringPlan& entry : r->plan.filtering)
    ports[{entry.node.value, entry.vlan, entry.address.value}].insert(entry.port);
  for (const auto& [key, out] : ports) {
    const bool is_unicast = std::get<2>(key) < r->plan.nodes.size();
    if (!is_unicast) continue;
    EXPECT_EQ(out.size(), 1u) << "bridge " << std::get<0>(key) << " address " << std::get<2>(key);
  }
  LiveRun run(*r);
  run.advance();
  for (const models::Stream& s : run.network().traffic().streams())
    EXPECT_EQ(s.delivered, s.name == "group" ? 4u : 1u) << s.name;
}

}  // namespace
}  // namespace takt::scenario::test::routing_test
