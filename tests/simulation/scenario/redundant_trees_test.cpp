// SPDX-License-Identifier: Apache-2.0
#include "scenario/topology/redundant_trees.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "sim/random.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario::redundant_trees_test {
namespace {

/// Nodes "a" .. are stations or, capital, hosts; links are two letters.
Topology topology_of(std::string_view nodes, const std::vector<std::string>& links) {
  NetworkSection network;
  for (const char name : nodes) {
    if (name >= 'a')
      network.nodes.emplace_back(std::string(1, name), StationNode());
    else
      network.nodes.emplace_back(std::string(1, name), HostNode());
  }
  for (const std::string& link : links) {
    network.links.emplace_back();
    network.links.back().ends = {link.substr(0, 1), link.substr(1, 1)};
  }
  json::Diagnostics diagnostics;
  Topology topology = build_topology(network, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_text();
  return topology;
}

std::string text(const Topology& topology, const Path& path) {
  std::string all;
  for (const std::uint32_t node : path) all += topology.nodes[node].name;
  return all;
}

std::vector<std::string> paths(const Topology& topology, char from, char to) {
  const auto found =
      RedundantTrees(topology, *topology.find(std::string(1, from))).to(*topology.find(std::string(1, to)));
  if (!found) return {};
  return {text(topology, (*found)[0]), text(topology, (*found)[1])};
}

using Two = std::vector<std::string>;

TEST(RedundantTrees, GoBothWaysAroundARing) {
  const Topology ring = topology_of("abcd", {"ab", "bc", "cd", "da"});
  EXPECT_EQ(paths(ring, 'a', 'b'), (Two{"ab", "adcb"}));
  EXPECT_EQ(paths(ring, 'a', 'c'), (Two{"abc", "adc"}));
  EXPECT_EQ(paths(ring, 'a', 'd'), (Two{"abcd", "ad"}));
}

// In a line there is one way only; both trees take it.
TEST(RedundantTrees, TakeTheOnlyWayTwice) {
  const Topology line = topology_of("abc", {"ab", "bc"});
  EXPECT_EQ(paths(line, 'a', 'c'), (Two{"abc", "abc"}));
  EXPECT_TRUE(paths(topology_of("abc", {"ab"}), 'a', 'c').empty());
}

// Two rings that hang together by one link: the trees part in each of them.
TEST(RedundantTrees, PartAgainBehindTheOnlyWay) {
  const Topology two = topology_of("abcdef", {"ab", "bc", "ca", "cd", "de", "ef", "fd"});
  EXPECT_EQ(paths(two, 'b', 'e'), (Two{"bacde", "bcdfe"}));
}

// A host between two switches is no way for others, but is reached by both.
TEST(RedundantTrees, ReachAHostByBothItsInterfaces) {
  const Topology attached = topology_of("abcH", {"ab", "ac", "bc", "bH", "cH"});
  EXPECT_EQ(paths(attached, 'a', 'H'), (Two{"abH", "acH"}));
  const Topology only = topology_of("abH", {"ab", "aH", "bH"});
  EXPECT_EQ(paths(only, 'a', 'H'), (Two{"aH", "abH"}));
  EXPECT_EQ(paths(only, 'a', 'b'), (Two{"ab", "ab"}));  // not through H
}

TEST(RedundantTrees, BeginAtAHostWithTwoInterfaces) {
  const Topology two = topology_of("abcH", {"Ha", "Hb", "ac", "bc"});
  EXPECT_EQ(paths(two, 'H', 'c'), (Two{"Hac", "Hbc"}));
}

/// Whether `to` is reached from `from` without that link.
bool reaches(const Topology& topology, std::uint32_t from, std::uint32_t to, std::uint32_t without) {
  std::set<std::uint32_t> reached{from};
  for (bool grows = true; grows;) {
    grows = false;
    for (std::uint32_t l = 0; l < topology.links.size(); ++l) {
      if (l == without) continue;
      for (const auto& [a, b] : {std::pair(topology.links[l].a.node.value, topology.links[l].b.node.value),
                                 std::pair(topology.links[l].b.node.value, topology.links[l].a.node.value)})
        if (reached.contains(a) && (a == from || topology.nodes[a].forwards()))
          grows = reached.insert(b).second || grows;
    }
  }
  return reached.contains(to);
}

bool takes(const Topology& topology, const Path& path, std::uint32_t link) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    if (std::minmax(path[i], path[i + 1]) ==
        std::minmax(topology.links[link].a.node.value, topology.links[link].b.node.value))
      return true;
  return false;
}

// Whatever single link fails, each node that can be reached is reached by one of its paths; each tree is one: a node
// has one parent in it.
TEST(RedundantTrees, SurviveEveryLinkThatCanBeSurvived) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    sim::RandomStream chance(seed, "trees", "test");
    std::string nodes;
    const std::size_t stations = 3 + chance.below(6);
    for (std::size_t i = 0; i < stations; ++i) nodes += static_cast<char>('a' + i);
    std::set<std::string> links;
    for (std::size_t i = 1; i < stations; ++i) links.insert({nodes[chance.below(i)], nodes[i]});
    for (std::size_t i = chance.below(stations + 2); i > 0; --i) {
      const char a = nodes[chance.below(stations)], b = nodes[chance.below(stations)];
      if (a < b) links.insert({a, b});
    }
    for (char host = 'A'; host < 'D'; ++host) {
      nodes += host;
      const std::size_t first = chance.below(stations);
      links.insert({host, nodes[first]});
      if (chance.below(2) == 0) links.insert({host, nodes[(first + 1) % stations]});
    }
    const Topology topology = topology_of(nodes, {links.begin(), links.end()});
    for (std::uint32_t from = 0; from < topology.nodes.size(); ++from) {
      const RedundantTrees trees(topology, from);
      std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> parents;
      for (std::uint32_t to = 0; to < topology.nodes.size(); ++to) {
        const auto both = trees.to(to);
        ASSERT_TRUE(both);
        if (to == from) continue;
        for (std::size_t tree = 0; tree < 2; ++tree)
          for (std::size_t i = 1; i < (*both)[tree].size(); ++i) {
            const auto [known, is_new] = parents.try_emplace({tree, (*both)[tree][i]}, (*both)[tree][i - 1]);
            EXPECT_EQ(known->second, (*both)[tree][i - 1]) << seed << ": " << text(topology, (*both)[tree]);
          }
        for (std::uint32_t link = 0; link < topology.links.size(); ++link) {
          if (!reaches(topology, from, to, link)) continue;
          EXPECT_FALSE(takes(topology, (*both)[0], link) && takes(topology, (*both)[1], link))
              << seed << ": " << text(topology, (*both)[0]) << " " << text(topology, (*both)[1]) << " without link "
              << link;
        }
      }
    }
  }
}

}  // namespace
}  // namespace takt::scenario::redundant_trees_test
