// SPDX-License-Identifier: Apache-2.0
// What a way takes, by hand.
#include "schedule/way.hpp"

#include <gtest/gtest.h>

#include "small_problem.hpp"

namespace takt::schedule::way_test {
namespace {

TEST(Way, StoreAndForward) {
  Problem problem = line(2, 50'000, us);
  // 10 us with preamble and gap: 9.904 us from preamble to FCS.
  Stream& stream = add_stream(problem, "h0", "h1", 10, 1000 * us);
  const Timing timing(problem, GateTiming::held);
  const std::vector<LinkIndex> links{link_of(problem, "h0>b0"), link_of(problem, "b0>b1"), link_of(problem, "b1>h1")};
  const auto way = make_way(timing, stream, links);
  ASSERT_TRUE(way);
  EXPECT_EQ(way->lags, (std::vector<Ps>{0, 10'954'000, 21'908'000}));  // 9.904 + 0.05 + 1 each
  EXPECT_EQ(way->arrival, 31'862'000);                                 // + 9.904 + 0.05
  EXPECT_EQ(way->tails, (std::vector<Ps>{31'862'000, 20'908'000, 9'954'000}));
  EXPECT_EQ(way->occupied.front(), 10 * us);
}

TEST(Way, CutsThroughOnlyToLinksAsFast) {
  Problem problem = line(2, 0, us);
  Stream& stream = add_stream(problem, "h0", "h1", 10, 1000 * us);
  for (Link& link : problem.links)
    if (problem.nodes[link.to].is_bridge) link.cut_through = 24;
  problem.links[link_of(problem, "b1>h1")].octet = 4'000;
  const std::vector<LinkIndex> links{link_of(problem, "h0>b0"), link_of(problem, "b0>b1"), link_of(problem, "b1>h1")};
  const auto way = make_way(Timing(problem, GateTiming::held), stream, links);
  ASSERT_TRUE(way);
  EXPECT_EQ(way->lags, (std::vector<Ps>{0, 1'192'000, 12'096'000}));  // 24 octets are 0.192 us; then the whole frame
}

TEST(Way, TrainsWaitForTheirLastFrame) {
  Problem problem = line(1, 0, 0);
  problem.nodes.push_back({"fast", false});
  problem.links.push_back({"b0>fast", node_of(problem, "b0"), node_of(problem, "fast"), 800, 0, 0, std::nullopt, 1024});
  Stream& stream = add_stream(problem, "h0", "fast", 10, 1000 * us);
  stream.frames = 3;
  const std::vector<LinkIndex> links{link_of(problem, "h0>b0"), link_of(problem, "b0>fast")};
  const auto way = make_way(Timing(problem, GateTiming::held), stream, links);
  ASSERT_TRUE(way);
  EXPECT_EQ(way->lags[1], 9'904'000 + 2 * (10 * us - us));  // two frames come each 10 us and go each 1 us
  problem.model.no_wait = true;
  EXPECT_FALSE(make_way(Timing(problem, GateTiming::held), stream, links)) << "a train cannot but wait";
}

TEST(Way, MarginDelaysWhatIsHeldAndWidensWhatFlows) {
  Problem problem = line(1, 0, 0);
  problem.nodes.push_back({"g", false});
  problem.links.push_back({"b0>g", node_of(problem, "b0"), node_of(problem, "g"), 8'000, 0, 0, std::nullopt, 1024});
  Stream& stream = add_stream(problem, "h0", "g", 2, 1000 * us);
  problem.model.margin = 500'000;
  const std::vector<LinkIndex> links{link_of(problem, "h0>b0"), link_of(problem, "b0>g")};
  const auto held = make_way(Timing(problem, GateTiming::held), stream, links);
  const auto flowing = make_way(Timing(problem, GateTiming::flowing), stream, links);
  ASSERT_TRUE(held && flowing);
  EXPECT_EQ(held->lags[1] - flowing->lags[1], 500'000);
  EXPECT_EQ(flowing->occupied[0] - held->occupied[0], us);
}

TEST(Way, IsATreeOfBridges) {
  Problem problem = line(3);
  Stream& stream = add_stream(problem, "h0", "h2", 1, 1000 * us);
  const Timing timing(problem, GateTiming::held);
  const auto of = [&](std::initializer_list<const char*> names) {
    std::vector<LinkIndex> links;
    for (const char* name : names) links.push_back(link_of(problem, name));
    return make_way(timing, stream, links).has_value();
  };
  EXPECT_TRUE(of({"h0>b0", "b0>b1", "b1>b2", "b2>h2"}));
  EXPECT_FALSE(of({"h0>b0", "b1>b2", "b0>b1", "b2>h2"})) << "out of order";
  EXPECT_FALSE(of({"h0>b0", "b0>b1", "b1>b2"})) << "does not come to the listener";
  EXPECT_FALSE(of({"h0>b0", "b0>b1", "b1>h1", "b1>b2", "b2>h2"})) << "ends at no listener";
  stream.latency = us;
  EXPECT_FALSE(of({"h0>b0", "b0>b1", "b1>b2", "b2>h2"})) << "takes too long";
}

}  // namespace
}  // namespace takt::schedule::way_test
