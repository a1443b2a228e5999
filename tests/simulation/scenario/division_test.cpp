// SPDX-License-Identifier: Apache-2.0
// Runs on several threads: how networks are divided, and that nobody can tell from the results.
#include "scenario/division/division.hpp"

#include <set>

#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/division/bisection.hpp"
#include "scenario/division/divided_run.hpp"
#include "tests/simulation/scenario/support.hpp"
#include "tests/support/case_count.hpp"

namespace takt::scenario {
namespace {

using namespace test;

WeightedGraph grid(std::uint32_t side) {
  WeightedGraph graph{std::vector<double>(side * side, 1), std::vector<std::vector<WeightedGraph::Edge>>(side * side)};
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    graph.edges[a].push_back({b, 1});
    graph.edges[b].push_back({a, 1});
  };
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      if (x + 1 < side) join(y * side + x, y * side + x + 1);
      if (y + 1 < side) join(y * side + x, (y + 1) * side + x);
    }
  return graph;
}

double cut_of(const WeightedGraph& graph, const std::vector<bool>& is_second) {
  double cut = 0;
  for (std::uint32_t v = 0; v < is_second.size(); ++v)
    for (const WeightedGraph::Edge& edge : graph.edges[v])
      if (v < edge.to && is_second[v] != is_second[edge.to]) cut += edge.weight;
  return cut;
}

TEST(Bisection, FindsTheBridgeBetweenTwoClusters) {
  WeightedGraph graph{std::vector<double>(10, 1), std::vector<std::vector<WeightedGraph::Edge>>(10)};
  for (std::uint32_t a = 0; a < 10; ++a)
    for (std::uint32_t b = 0; b < 10; ++b)
      if (a != b && (a % 2 == b % 2 || (a == 3 && b == 4) || (a == 4 && b == 3))) graph.edges[a].push_back({b, 1});
  const std::vector<bool> parts = bisect(graph, 0.5);
  EXPECT_EQ(cut_of(graph, parts), 1);
  EXPECT_NE(parts[0], parts[1]);
}

TEST(Bisection, CutsAGridAboutStraight) {
  const WeightedGraph graph = grid(16);
  const std::vector<bool> parts = bisect(graph, 0.5, 17);
  EXPECT_LE(cut_of(graph, parts), 20) << "16 is the least of halves";
  EXPECT_NEAR(static_cast<double>(std::count(parts.begin(), parts.end(), true)), 128, 8);
  EXPECT_FALSE(parts[17]);
  const std::vector<bool> quarter = bisect(graph, 0.25);
  EXPECT_NEAR(static_cast<double>(std::count(quarter.begin(), quarter.end(), false)), 64, 8);
}

TEST(Bisection, OfNothingAndOfOne) {
  EXPECT_TRUE(bisect({}, 0.5).empty());
  EXPECT_EQ(bisect({{1}, {{}}}, 0.5).size(), 1u);
}

// A plant: a grid of switches with hosts, one stream a host.
std::string plant(unsigned side, const std::string& more = {}) {
  const unsigned hosts = side * side * 4;
  std::string text =
      R"({"name": "plant", "duration": "3ms", "network": {"generate": [{"topology": "mesh", "rows": )" +
      std::to_string(side) + R"(, "columns": )" + std::to_string(side) +
      R"(, "hosts_per_switch": 4, "rate": "1Gbps", "length": "10m", "forwarding_delay": "5us"}]}, "streams": [)";
  for (unsigned h = 0; h < hosts; ++h)
    text += (h > 0 ? "," : "") + std::string(R"({"name": "s)") + std::to_string(h + 1) + R"(", "from": "h)" +
            std::to_string(h + 1) + R"(", "to": "h)" + std::to_string((h * 37 + 11) % hosts + 1) +
            R"(", "payload": "200B", "every": "100us", "offset": ")" + std::to_string(h * 791 % 100000) + R"(ns"})";
  return text + "]" + more + "}";
}

std::string result_of(const Run& run) { return results::run_json(evaluation::evaluate(run, false)); }

std::string whole(const Resolved& resolved) {
  Run run(resolved);
  run.advance();
  return result_of(run);
}

std::string divided(const Resolved& resolved, const Division& division, std::uint64_t tie_shuffle = 0, int slices = 1) {
  DividedRun run(resolved, division, tie_shuffle);
  for (int slice = 1; slice <= slices; ++slice) run.advance(sim::TrueTime::from_ps(run.end().ps() / slices * slice));
  run.advance(run.end());
  return result_of(run.gathered());
}

TEST(Division, SharesTheWorkAndPromisesWhatLinksAllow) {
  const auto resolved = sound(plant(8));
  const Division division = divide(*resolved, 2);
  ASSERT_EQ(division.parts, 2u) << division.why_fewer;
  EXPECT_EQ(division.why_fewer, "");
  EXPECT_NEAR(division.frame_hops_per_second[0] / division.frame_hops_per_second[1], 1, 0.25);
  EXPECT_LT(division.crossing_share(), 0.15);
  // 72 octets of 8 ns, 10 m of 5 ns and the forwarding delay.
  EXPECT_NEAR(static_cast<double>(division.promise().ps()), (72 * 8 + 50 + 5000) * 1e3, 10e3);
  for (std::uint32_t h = 0; h < resolved->plan.links.size(); ++h) {
    const models::LinkPlan& link = resolved->plan.links[h];
    const bool is_of_host =
        !resolved->plan.nodes[link.a.node.value].forwards() || !resolved->plan.nodes[link.b.node.value].forwards();
    EXPECT_TRUE(!is_of_host || division.part_of_node[link.a.node.value] == division.part_of_node[link.b.node.value]);
  }
}

TEST(Division, KeepsTogetherWhatOneThreadMustSee) {
  const auto resolved =
      sound(plant(6, R"(, "faults": [{"kind": "link-down", "link": ["sw8", "sw9"], "at": "1ms", "for": "1ms"}])"));
  const auto number = [&](const std::string& name) {
    for (std::uint32_t n = 0; n < resolved->plan.nodes.size(); ++n)
      if (resolved->plan.nodes[n].name == name) return n;
    return 0u;
  };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Division division = divide_at_random(*resolved, 8, seed);
    EXPECT_EQ(division.part_of_node[number("sw8")], division.part_of_node[number("sw9")]);
  }
  const auto robot = shipped("line-of-switches", "100ms");
  const Division division = divide_at_random(*robot, 4, 3);
  for (const ResolvedProgram& program : robot->programs)
    for (const ResolvedMember& member : program.members) EXPECT_EQ(division.part_of_node[member.node.value], 0u);
}

TEST(Division, SaysWhyThereAreFewerParts) {
  EXPECT_NE(divide(*sound(plant(2)), 64).why_fewer, "");
  EXPECT_EQ(divide(*shipped("direct-link"), 2).parts, 1u);
  EXPECT_NE(divide(*shipped("direct-link"), 2).why_fewer, "");
  std::string text = plant(
      6, R"(, "clocks": {"all": {"offset": {"from": "-50ppm", "to": "50ppm"}}, "gptp": {"report_every": "1us"}})");
  text.replace(text.find("3ms"), 3, "60s");
  const Division looked_at = divide(*sound(text), 2);
  EXPECT_EQ(looked_at.parts, 1u);
  EXPECT_NE(looked_at.why_fewer.find("report_every"), std::string::npos) << looked_at.why_fewer;
}

TEST(DividedRun, HasTheResultOfOneThread) {
  const auto resolved = sound(plant(6));
  const std::string expected = whole(*resolved);
  for (const unsigned parts : {2u, 3u, 4u, 8u}) {
    EXPECT_EQ(divided(*resolved, divide_at_random(*resolved, parts, parts)), expected) << parts;
    const Division division = divide(*resolved, parts);
    EXPECT_EQ(divided(*resolved, division, 0, 7), expected) << division.parts;
  }
  EXPECT_EQ(divided(*resolved, divide_at_random(*resolved, 3, 5), 0xDEAD'BEEF), expected) << "tie shuffle";
}

TEST(DividedRun, DoesWhatTheScriptSaysWhereItBelongs) {
  const auto resolved =
      sound(plant(4, R"(, "faults": [{"kind": "link-down", "link": ["sw6", "sw7"], "at": "500us", "for": "500us"},
      {"kind": "crash", "node": "sw11", "at": "700us", "for": "500us"}, {"kind": "frame-errors", "link": ["sw2", "sw3"], "loss": 0.1}])"));
  const std::string expected = whole(*resolved);
  EXPECT_NE(expected.find("link_down"), std::string::npos);
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    EXPECT_EQ(divided(*resolved, divide_at_random(*resolved, 4, seed)), expected) << seed;
}

// Grandmaster and slaves in different parts, a grandmaster that crashes, looks at clocks from two instants on.
TEST(DividedRun, HasTheClocksOfOneThread) {
  std::string text = plant(
      4,
      R"(, "warm_up": "10ms", "clocks": {"all": {"offset": {"from": "-100ppm", "to": "100ppm"}}, "gptp": {"report_every": "700us", "log_sync_interval": -7, "log_pdelay_interval": -7, "log_announce_interval": -7}},
      "faults": [{"kind": "crash", "node": "sw1", "at": "20ms", "for": "20ms"}])");
  text.replace(text.find("3ms"), 3, "60ms");
  const auto resolved = sound(text);
  const std::string expected = whole(*resolved);
  EXPECT_NE(expected.find("grandmaster"), std::string::npos);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Division division = divide_at_random(*resolved, 2, seed);
    EXPECT_TRUE(division.is_divided());
    EXPECT_EQ(divided(*resolved, division), expected) << seed;
  }
}

// Every shipped scenario, in its beginning, with parts as they come.
TEST(DividedRun, HasTheResultOfOneThreadForWhatIsShipped) {
  std::size_t really_divided = 0;
  const std::vector<std::string> names = shipped_names();
  const std::size_t count =
      std::min<std::size_t>(support::case_count("TAKT_SHIPPED_DIVISIONS", names.size()), names.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = names[i * names.size() / count];
    if (name == "ring-1000") continue;  // by itself below: it has a thousand nodes
    const auto resolved = shipped(name, "60ms");
    const std::string expected = whole(*resolved);
    for (const unsigned parts : {2u, 3u, 8u}) {
      const Division division = divide_at_random(*resolved, parts, parts * 100);
      if (!division.is_divided()) continue;
      ++really_divided;
      ASSERT_EQ(divided(*resolved, division), expected) << name << " in " << division.parts << " parts";
    }
  }
  EXPECT_GT(really_divided, count / 5);
}

TEST(DividedRun, HasTheResultOfOneThreadForAThousandSwitches) {
  const auto resolved = shipped("ring-1000", "20ms");
  const Division division = divide_at_random(*resolved, 4, 1);
  EXPECT_EQ(divided(*resolved, division), whole(*resolved)) << division.why_fewer;
}

// A promise that is not kept is found, and ends all threads.
TEST(DividedRun, AWrongPromiseEndsTheRun) {
  const auto resolved = sound(plant(4));
  Division division = divide_at_random(*resolved, 2, 1);
  ASSERT_EQ(division.parts, 2u);
  for (Boundary& boundary : division.boundaries) boundary.promise = boundary.promise * 100;
  DividedRun run(*resolved, division);
  EXPECT_THROW(run.advance(run.end()), sim::InvariantBroken);
}

}  // namespace
}  // namespace takt::scenario
