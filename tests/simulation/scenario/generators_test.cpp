// SPDX-License-Identifier: Apache-2.0
// The generated topologies: counts, names, degrees and connectivity over many sizes.
#include "scenario/topology/generators.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "support.hpp"

namespace takt::scenario::test::generators_test {
namespace {

Generator of(Shape shape, std::uint64_t hosts_per_switch = 1) {
  Generator generator;
  generator.shape = shape;
  generator.hosts_per_switch = hosts_per_switch;
  return generator;
}
Generator sized(Shape shape, std::uint64_t switches, std::uint64_t hosts_per_switch = 1) {
  Generator generator = of(shape, hosts_per_switch);
  generator.switches = switches;
  return generator;
}

struct Facts {
  std::size_t switches = 0;
  std::size_t hosts = 0;
  std::size_t links = 0;
  std::vector<std::uint32_t> degree;  ///< of each switch, links to hosts not counted
  bool is_connected = false;
};

Facts facts_of(const Generator& generator) {
  json::Diagnostics diagnostics;
  const Generated made = generate(generator, 200'000, diagnostics);
  EXPECT_EQ(diagnostics.to_text(), "");
  Facts facts;
  for (const Generated::Node& node : made.nodes) {
    std::size_t& count = node.kind == models::NodeKind::host ? facts.hosts : facts.switches;
    EXPECT_EQ(node.name, (node.kind == models::NodeKind::host ? "h" : "sw") + std::to_string(++count));
  }
  facts.links = made.links.size();
  facts.degree.resize(facts.switches);
  std::vector<std::uint32_t> set(made.nodes.size());  // which nodes hang together
  std::iota(set.begin(), set.end(), 0u);
  const auto root = [&](std::uint32_t n) {
    while (set[n] != n) n = set[n] = set[set[n]];
    return n;
  };
  std::vector<std::uint32_t> links_of_host(made.nodes.size());
  for (const Generated::Link& link : made.links) {
    EXPECT_NE(link.a, link.b);
    EXPECT_EQ(made.nodes[link.a].kind, models::NodeKind::bridge);
    EXPECT_EQ(link.to_host, made.nodes[link.b].kind == models::NodeKind::host);
    set[root(link.a)] = root(link.b);
    if (link.to_host) {
      ++links_of_host[link.b];
    } else {
      ++facts.degree[link.a];
      ++facts.degree[link.b];
    }
  }
  facts.is_connected = true;
  for (std::uint32_t n = 0; n < made.nodes.size(); ++n) {
    facts.is_connected = facts.is_connected && root(n) == root(0);
    EXPECT_EQ(links_of_host[n], made.nodes[n].kind == models::NodeKind::host ? 1u : 0u);
  }
  return facts;
}

TEST(Generators, Line) {
  for (const std::uint64_t n : {1u, 2u, 3u, 7u, 1000u}) {
    for (const std::uint64_t hosts : {0u, 1u, 3u}) {
      const Facts facts = facts_of(sized(Shape::line, n, hosts));
      EXPECT_EQ(facts.switches, n);
      EXPECT_EQ(facts.hosts, n * hosts);
      EXPECT_EQ(facts.links, n - 1 + n * hosts);
      EXPECT_TRUE(facts.is_connected);
      for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(facts.degree[i], (i > 0 ? 1u : 0u) + (i + 1 < n ? 1u : 0u));
    }
  }
}

TEST(Generators, Ring) {
  for (const std::uint64_t n : {3u, 4u, 1000u}) {
    const Facts facts = facts_of(sized(Shape::ring, n, 2));
    EXPECT_EQ(facts.hosts, 2 * n);
    EXPECT_EQ(facts.links, 3 * n);
    EXPECT_TRUE(facts.is_connected);
    EXPECT_EQ(facts.degree, std::vector<std::uint32_t>(n, 2));
  }
}

// The centre carries no hosts, unless it is alone.
TEST(Generators, Star) {
  const Facts alone = facts_of(sized(Shape::star, 1, 2));
  EXPECT_EQ(alone.hosts, 2u);
  for (const std::uint64_t n : {2u, 3u, 100u}) {
    const Facts facts = facts_of(sized(Shape::star, n));
    EXPECT_EQ(facts.hosts, n - 1);
    EXPECT_EQ(facts.links, 2 * (n - 1));
    EXPECT_TRUE(facts.is_connected);
    EXPECT_EQ(facts.degree[0], n - 1);
    for (std::size_t i = 1; i < n; ++i) EXPECT_EQ(facts.degree[i], 1u);
  }
}

// depth levels below the root: 1 + f + f^2 + ... + f^depth switches, hosts at the f^depth leaves.
TEST(Generators, Tree) {
  for (const std::uint64_t fanout : {1u, 2u, 3u, 10u}) {
    std::uint64_t leaves = 1;
    std::uint64_t switches = 1;
    for (std::uint64_t depth = 0; depth <= 4; ++depth) {
      Generator generator = of(Shape::tree, 2);
      generator.depth = depth;
      generator.fanout = fanout;
      const Facts facts = facts_of(generator);
      EXPECT_EQ(facts.switches, switches);
      EXPECT_EQ(facts.hosts, 2 * leaves);
      EXPECT_EQ(facts.links, switches - 1 + 2 * leaves);
      EXPECT_TRUE(facts.is_connected);
      for (std::size_t i = 0; i < switches; ++i)
        EXPECT_EQ(facts.degree[i],
                  (i > 0 ? 1u : 0u) + (i < switches - leaves ? static_cast<std::uint32_t>(fanout) : 0u))
            << i;
      leaves *= fanout;
      switches += leaves;
    }
  }
}

// A spine of n switches, from each of which hangs a line of t more: a tree.
TEST(Generators, Comb) {
  for (const std::uint64_t n : {1u, 2u, 5u})
    for (const std::uint64_t t : {0u, 1u, 3u}) {
      Generator generator = sized(Shape::comb, n, 2);
      generator.teeth = t;
      const Facts facts = facts_of(generator);
      EXPECT_EQ(facts.switches, n * (1 + t));
      EXPECT_EQ(facts.hosts, 2 * facts.switches);
      EXPECT_EQ(facts.links, facts.switches - 1 + facts.hosts);
      EXPECT_TRUE(facts.is_connected);
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_EQ(facts.degree[i], (i > 0 ? 1u : 0u) + (i + 1 < n ? 1u : 0u) + (t > 0 ? 1u : 0u));
      for (std::size_t i = n; i < facts.switches; ++i)
        EXPECT_EQ(facts.degree[i], (i - n) % t == t - 1 ? 1u : 2u) << "the end of a tooth";
    }
}

// Two cores without hosts, each joined to every other switch.
TEST(Generators, DualStar) {
  for (const std::uint64_t n : {1u, 2u, 50u}) {
    const Facts facts = facts_of(sized(Shape::dual_star, n, 3));
    EXPECT_EQ(facts.switches, n + 2);
    EXPECT_EQ(facts.hosts, 3 * n);
    EXPECT_EQ(facts.links, 2 * n + 3 * n);
    EXPECT_TRUE(facts.is_connected);
    for (std::size_t i = 0; i < n + 2; ++i) EXPECT_EQ(facts.degree[i], i < 2 ? n : 2u);
  }
}

// Connected, with the links that its degree says, whatever the seed; another seed is another graph, the same one the
// same.
TEST(Generators, Random) {
  std::set<std::vector<std::uint32_t>> graphs;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Generator generator = sized(Shape::random, 12, 0);
    generator.degree = 2.5;
    generator.seed = seed;
    const Facts facts = facts_of(generator);
    EXPECT_EQ(facts.links, 15u) << "12 x 2.5 / 2";
    EXPECT_TRUE(facts.is_connected) << seed;
    EXPECT_EQ(facts_of(generator).degree, facts.degree);
    graphs.insert(facts.degree);
  }
  EXPECT_GT(graphs.size(), 40u);
  Generator tree = sized(Shape::random, 10);
  tree.degree = 1.8;
  EXPECT_EQ(facts_of(tree).links, 9u + 10u);
  Generator full = sized(Shape::random, 10, 0);
  full.degree = 9;
  EXPECT_EQ(facts_of(full).degree, std::vector<std::uint32_t>(10, 9)) << "as many as there can be";
}

TEST(Generators, FullMesh) {
  for (const std::uint64_t n : {1u, 2u, 5u, 60u}) {
    const Facts facts = facts_of(sized(Shape::mesh, n));
    EXPECT_EQ(facts.links, n * (n - 1) / 2 + n);
    EXPECT_TRUE(facts.is_connected);
    EXPECT_EQ(facts.degree, std::vector<std::uint32_t>(n, static_cast<std::uint32_t>(n - 1)));
  }
}

TEST(Generators, Grid) {
  for (const std::uint64_t rows : {1u, 2u, 5u}) {
    for (const std::uint64_t columns : {1u, 3u, 8u}) {
      Generator generator = of(Shape::mesh, 1);
      generator.rows = rows;
      generator.columns = columns;
      const Facts facts = facts_of(generator);
      EXPECT_EQ(facts.switches, rows * columns);
      EXPECT_EQ(facts.links, rows * (columns - 1) + columns * (rows - 1) + rows * columns);
      EXPECT_TRUE(facts.is_connected);
      for (std::uint64_t i = 0; i < rows * columns; ++i) {
        const std::uint64_t row = i / columns;
        const std::uint64_t column = i % columns;
        EXPECT_EQ(facts.degree[i], (row > 0) + (row + 1 < rows) + (column > 0) + (column + 1 < columns));
      }
    }
  }
}

TEST(Generators, PrefixesRatesAndLengths) {
  const auto resolved = sound(generated(
      R"("topology": "line", "switches": 2, "switch_prefix": "bridge-", "host_prefix": "io", "rate": "10Gbps", "host_rate": "100Mbps", "length": "7m")"));
  EXPECT_TRUE(resolved->topology.find("bridge-2"));
  EXPECT_TRUE(resolved->topology.find("io2"));
  for (const models::LinkPlan& link : resolved->topology.links) {
    const bool to_host = resolved->topology.nodes[link.b.node.value].is_end_station();
    EXPECT_EQ(link.rate.bits_per_second, to_host ? 100'000'000u : 10'000'000'000u);
    EXPECT_EQ(link.delay.ps(), 35'000);  // 7 m at 5 ns/m
  }
}

// The promise of the issue: a thousand switches are one line.
TEST(Generators, ThousandSwitchesInOneLine) {
  const auto resolved = sound(generated(R"("topology": "line", "switches": 1000)"));
  EXPECT_EQ(resolved->plan.nodes.size(), 2000u);
  EXPECT_EQ(resolved->plan.links.size(), 1999u);
}

}  // namespace
}  // namespace takt::scenario::test::generators_test
