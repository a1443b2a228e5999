// SPDX-License-Identifier: Apache-2.0
// Networks as levels: their sizes by hand, their measures, GraphML.
#include "study/topologies.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenario/resolve.hpp"
#include "scenario/figures/graph_figures.hpp"
#include "study/point.hpp"
#include "support.hpp"

namespace takt::study {
namespace {

std::string study_with(const std::string& topologies) {
  return R"({"name": "t", "scenario": {"name": "n", "duration": "1ms", "network": {"nodes": {}},
      "streams": [{"name": "x", "from": "h1", "to": "h3", "payload": "100B", "every": "100us"}]},
    "factors": [{"name": "network", "topologies": )" +
         topologies +
         R"(}], "measures": [{"name": "d", "of": "topology.diameter"}, {"name": "b", "of": "topology.bridges"}]})";
}

struct Size {
  std::int64_t switches, links, bridges;
  bool operator==(const Size&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Size& size) {
  return out << size.switches << " switches, " << size.links << " links, " << size.bridges << " bridges";
}

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
      "dual": {"topology": "dual-star", "switches": 4}})")),
                              diagnostics);
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

// A level is what the scenario's own generator makes of the same words.
TEST(Topologies, LevelsAreGenerators) {
  const Folder folder;
  json::Diagnostics diagnostics;
  const auto plan = load_plan(folder.write("study.json", study_with(R"({
      "ring": {"topology": "ring", "switches": 5, "hosts_per_switch": 2, "os": "preempt-rt", "length": "7m"},
      "tree": {"topology": "tree", "depth": 2, "fanout": 2, "host_prefix": "h", "rate": "100Mbps"}})")),
                              diagnostics);
  ASSERT_TRUE(plan) << diagnostics.to_text();
  const auto ring = scenario_of(*plan, plan->variants[0], 1, diagnostics);
  ASSERT_TRUE(ring) << diagnostics.to_text();
  scenario::Generator expected;
  expected.shape = scenario::Shape::ring;
  expected.switches = 5;
  expected.hosts_per_switch = 2;
  expected.os.profile = scenario::OsProfile::preempt_rt;
  expected.length = sim::Length{7'000};
  EXPECT_EQ(ring->network.generate, std::vector{expected});
  EXPECT_EQ(size_of(*plan, 0), (Size{5, 5, 0}));
  EXPECT_EQ(size_of(*plan, 1), (Size{7, 6, 6}));
}

TEST(Topologies, GraphmlBecomesANetwork) {
  const Folder folder;
  folder.write("plant.graphml", R"(<?xml version="1.0"?><graphml xmlns="http://graphml.graphdrawing.org/xmlns">
    <key id="n" for="node" attr.name="name" attr.type="string"/><key id="k" for="node" attr.name="kind" attr.type="string"/>
    <key id="r" for="edge" attr.name="rate" attr.type="string"/>
    <graph edgedefault="undirected"><node id="0"><data key="n">left</data></node><node id="1"/><node id="2"><data key="n">h1</data><data key="k">host</data></node>
      <edge source="0" target="1"><data key="r">100Mbps</data></edge><edge source="1" target="0"/><edge source="0" target="2"/></graph></graphml>)");
  GraphmlLevel drawn;
  drawn.graphml = "plant.graphml";
  const TopologyLevel level{drawn};
  json::Diagnostics diagnostics;
  const json::Node network =
      network_of(level, std::filesystem::path(folder.file("x")).parent_path().string(), diagnostics);
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
  folder.write(
      "end.graphml",
      R"(<graphml><graph edgedefault="undirected"><node id="1"/><node id='2'/><edge id="e" source="1" target="3"/></graph></graphml>)");
  const std::pair<const char*, const char*> cases[] = {
      {R"({"a": {"topology": "comb", "switches": 3}})", "\"teeth\""},
      {R"({"a": {"topology": "dual-star", "switches": 3, "degree": 2}})", "no such parameter"},
      {R"({"a": {"topology": "random", "switches": 10, "degree": 1}})", "no connected graph has this degree"},
      {R"({"a": {"topology": "random", "switches": 4, "degree": 4}})", "no connected graph has this degree"},
      {R"({"a": {"topology": "comb", "switches": 10000, "teeth": 10000}})", "too many nodes"},
      {R"({"a": {"topology": "circle", "switches": 3}})", "unknown name for a topology"},
      {R"({"a": {"graphml": "none.graphml", "switches": 3}})", "unknown field \"switches\""},
      {R"({"a": {"graphml": "none.graphml"}})", "cannot be opened"},
      {R"({"a": {"graphml": "bad.graphml"}})", "cannot read this GraphML file"},
      {R"({"a": {"graphml": "end.graphml"}})", "an edge ends at \"3\", which is the id of no node"},
  };
  for (const auto& [topologies, expected] : cases) {
    json::Diagnostics diagnostics;
    EXPECT_FALSE(load_plan(folder.write("study.json", study_with(topologies)), diagnostics));
    EXPECT_NE(diagnostics.to_text().find(expected), std::string::npos) << topologies << "\n" << diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::study
