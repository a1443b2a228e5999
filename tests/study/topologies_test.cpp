// Networks as levels: their sizes by hand, their measures, GraphML.
#include "study/topologies.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenario/resolve.hpp"
#include "study/point.hpp"
#include "study/topology_measures.hpp"
#include "support.hpp"

namespace takt::study {
namespace {

std::string study_with(const std::string& topologies) {
  return R"({"name": "t", "scenario": {"name": "n", "duration": "1ms", "network": {"nodes": {}},
      "streams": [{"name": "x", "from": "h1", "to": "h3", "payload": "100B", "every": "100us"}]},
    "factors": [{"name": "network", "topologies": )" + topologies + R"(}], "measures": [{"name": "d", "of": "topology.diameter"}, {"name": "b", "of": "topology.bridges"}]})";
}

struct Size {
  std::int64_t switches, links, bridges;
  bool operator==(const Size&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Size& size) { return out << size.switches << " switches, " << size.links << " links, " << size.bridges << " bridges"; }

Size size_of(const Plan& plan, std::size_t variant) {
  json::Diagnostics diagnostics;
  auto scenario = scenario_of(plan, plan.variants[variant], 1, diagnostics);
  const auto resolved = scenario ? scenario::resolve(std::move(*scenario), diagnostics) : nullptr;
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  if (!resolved) return {};
  const json::Node node = topology_node(*resolved);
  const auto number = [&](const char* key) { return static_cast<std::int64_t>(*json::integer_of(*node.find(key))); };
  return {number("switches"), number("links"), number("bridges")};
}

TEST(Topologies, SizesByHand) {
  const Folder folder;
  json::Diagnostics diagnostics;
  const auto plan = load_plan(folder.write("study.json", study_with(R"({
      "comb": {"topology": "comb", "switches": 3, "teeth": 2},
      "random": {"topology": "random", "switches": 10, "degree": 3, "seed": 5},
      "tree": {"topology": "random", "switches": 10, "degree": 1.8},
      "dual": {"topology": "dual-star", "switches": 4}})")), diagnostics);
  ASSERT_TRUE(plan) << diagnostics.to_text();
  // A comb of 3 x (1 + 2) switches is a tree: all its 8 links are bridges.
  EXPECT_EQ(size_of(*plan, 0), (Size{9, 8, 8}));
  const Size random = size_of(*plan, 1);
  EXPECT_EQ(random.switches, 10);
  EXPECT_EQ(random.links, 15) << "10 x 3 / 2";
  EXPECT_EQ(size_of(*plan, 2), (Size{10, 9, 9}));
  EXPECT_EQ(size_of(*plan, 3), (Size{6, 8, 0})) << "each of 4 leaves at both cores";
  const Outcome outcome = run_point(*plan, 3);
  EXPECT_EQ(outcome.status, Status::done) << outcome.error;
  EXPECT_EQ(outcome.values[0], 2.0) << "leaf, core, leaf";
}

// Every random graph is connected and has the links that its degree says, whatever the seed.
TEST(Topologies, RandomGraphsAreConnected) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    TopologyLevel level;
    level.shape = Shape::random;
    level.switches = 12;
    level.degree = 2.5;
    level.seed = seed;
    level.hosts_per_switch = 0;
    json::Diagnostics diagnostics;
    const json::Node network = network_of(level, "", diagnostics);
    const auto& links = network.find("links")->items;
    EXPECT_EQ(links.size(), 15u);
    std::vector<std::string> reached = {"sw1"};
    const auto has = [&](const std::string& name) { return std::find(reached.begin(), reached.end(), name) != reached.end(); };
    for (bool grows = true; grows;) {
      grows = false;
      for (const json::Node& link : links) {
        const std::string& a = link.find("ends")->items[0].text;
        const std::string& b = link.find("ends")->items[1].text;
        if (has(a) == has(b)) continue;
        reached.push_back(has(a) ? b : a);
        grows = true;
      }
    }
    EXPECT_EQ(reached.size(), 12u) << seed;
  }
}

TEST(Topologies, GraphmlBecomesANetwork) {
  const Folder folder;
  folder.write("plant.graphml", R"(<?xml version="1.0"?><graphml xmlns="http://graphml.graphdrawing.org/xmlns">
    <key id="n" for="node" attr.name="name" attr.type="string"/><key id="k" for="node" attr.name="kind" attr.type="string"/>
    <key id="r" for="edge" attr.name="rate" attr.type="string"/>
    <graph edgedefault="undirected"><node id="0"><data key="n">left</data></node><node id="1"/><node id="2"><data key="n">h1</data><data key="k">host</data></node>
      <edge source="0" target="1"><data key="r">100Mbps</data></edge><edge source="1" target="0"/><edge source="0" target="2"/></graph></graphml>)");
  TopologyLevel level;
  level.graphml = "plant.graphml";
  json::Diagnostics diagnostics;
  const json::Node network = network_of(level, std::filesystem::path(folder.file("x")).parent_path().string(), diagnostics);
  ASSERT_FALSE(diagnostics.has_errors()) << diagnostics.to_text();
  std::vector<std::string> nodes;
  for (const json::Member& member : network.find("nodes")->members) nodes.push_back(member.key);
  EXPECT_EQ(nodes, (std::vector<std::string>{"left", "sw2", "h1", "h2", "h3"})) << "one more host at each switch";
  EXPECT_EQ(network.find("links")->items.size(), 4u) << "both directions of an edge are one cable";
  EXPECT_EQ(network.find("links")->items[0].find("rate")->text, "100Mbps");
}

TEST(Topologies, MistakesAreTold) {
  const Folder folder;
  folder.write("bad.graphml", "<graphml><graph></oops>");
  const std::pair<const char*, const char*> cases[] = {
      {R"({"a": {"topology": "comb", "switches": 3}})", "\"teeth\""},
      {R"({"a": {"topology": "dual-star", "switches": 3, "degree": 2}})", "no such parameter"},
      {R"({"a": {"topology": "random", "switches": 10, "degree": 1}})", "no connected graph has this degree"},
      {R"({"a": {"topology": "random", "switches": 4, "degree": 4}})", "no connected graph has this degree"},
      {R"({"a": {"topology": "comb", "switches": 10000, "teeth": 10000}})", "too many nodes"},
      {R"({"a": {"topology": "ring", "switches": 3}})", "expected \"comb\""},
      {R"({"a": {"graphml": "none.graphml"}})", "cannot be opened"},
      {R"({"a": {"graphml": "bad.graphml"}})", "cannot read this GraphML file"},
  };
  for (const auto& [topologies, expected] : cases) {
    json::Diagnostics diagnostics;
    EXPECT_FALSE(load_plan(folder.write("study.json", study_with(topologies)), diagnostics));
    EXPECT_NE(diagnostics.to_text().find(expected), std::string::npos) << topologies << "\n" << diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::study
