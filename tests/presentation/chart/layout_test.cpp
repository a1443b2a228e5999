// SPDX-License-Identifier: Apache-2.0
// Pictures of networks and of what happens by time.
#include <gtest/gtest.h>

#include <cmath>

#include "chart/gantt.hpp"
#include "chart/graph_layout.hpp"
#include "chart/limit_bars.hpp"
#include "chart/network_chart.hpp"
#include "chart/page.hpp"

namespace takt::chart {
namespace {

double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

Graph hubs(std::size_t count) { return {std::vector<bool>(count, true), {}}; }

TEST(GraphLayout, ALineIsStraight) {
  // Out of order: 2 - 0 - 3 - 1.
  Graph graph = hubs(4);
  graph.edges = {{0, 3}, {2, 0}, {3, 1}};
  const auto points = layout(graph);
  for (const Point& point : points) EXPECT_DOUBLE_EQ(point.y, points[0].y);
  for (const auto& [a, b] : graph.edges) EXPECT_DOUBLE_EQ(distance(points[a], points[b]), 1);
}

TEST(GraphLayout, ALongLineGoesToAndFro) {
  Graph graph = hubs(28);
  for (std::size_t i = 0; i + 1 < 28; ++i) graph.edges.emplace_back(i, i + 1);
  const auto points = layout(graph);
  EXPECT_LT(points[14].y - points[13].y, 2) << "the next row begins where the last one ended";
  EXPECT_DOUBLE_EQ(points[14].x, points[13].x);
  EXPECT_DOUBLE_EQ(points[27].x, points[0].x);
}

TEST(GraphLayout, ARingIsRound) {
  constexpr std::size_t count = 12;
  Graph graph = hubs(count);
  for (std::size_t i = 0; i < count; ++i) graph.edges.emplace_back(i, (i + 1) % count);
  const auto points = layout(graph);
  Point centre;
  for (const Point& point : points) centre = {centre.x + point.x / count, centre.y + point.y / count};
  for (const Point& point : points) EXPECT_NEAR(distance(point, centre), count / (2 * 3.14159265358979), 1e-9);
}

TEST(GraphLayout, LeavesOfATreeStandBelowTheirParents) {
  // 0 has the children 1 and 2, each of which has two leaves that are hubs as well.
  Graph graph = hubs(7);
  graph.edges = {{0, 1}, {0, 2}, {1, 3}, {1, 4}, {2, 5}, {2, 6}};
  const auto points = layout(graph);
  EXPECT_DOUBLE_EQ(points[1].y, points[2].y);
  EXPECT_LT(points[0].y, points[1].y);
  for (std::size_t leaf = 3; leaf < 7; ++leaf) EXPECT_DOUBLE_EQ(points[leaf].y, points[3].y);
  EXPECT_DOUBLE_EQ(points[1].x, (points[3].x + points[4].x) / 2);
  EXPECT_DOUBLE_EQ(points[0].x, (points[1].x + points[2].x) / 2);
}

TEST(GraphLayout, DistancesOfAMeshLookLikeNumbersOfLinks) {
  constexpr std::size_t side = 8;
  Graph graph = hubs(side * side);
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x) {
      if (x + 1 < side) graph.edges.emplace_back(y * side + x, y * side + x + 1);
      if (y + 1 < side) graph.edges.emplace_back(y * side + x, (y + 1) * side + x);
    }
  const auto points = layout(graph);
  for (const auto& [a, b] : graph.edges) {
    EXPECT_GT(distance(points[a], points[b]), 0.5);
    EXPECT_LT(distance(points[a], points[b]), 1.8);
  }
  const double corner_to_corner = distance(points[0], points[side * side - 1]);
  EXPECT_GT(corner_to_corner, 8) << "14 links apart";
  EXPECT_EQ(points[5].x, layout(graph)[5].x) << "the same each time";
}

TEST(GraphLayout, HostsStandAroundTheirSwitchWhereThereIsRoom) {
  // Switches 0 - 1 in a row, and three hosts at 0: they stand on the side away from 1.
  Graph graph{{true, true, false, false, false}, {{0, 1}, {0, 2}, {0, 3}, {0, 4}}};
  const auto points = layout(graph);
  for (std::size_t host = 2; host < 5; ++host) {
    EXPECT_NEAR(distance(points[host], points[0]), 0.5, 1e-9);
    EXPECT_GT(distance(points[host], points[1]), 0.9);
  }
  EXPECT_NEAR(distance(points[3], points[1]), 1.5, 1e-9) << "the middle one of three straight away from it";
}

TEST(GraphLayout, TwoHostsOnOneCableAndNothingAtAll) {
  const auto pair = layout(Graph{{false, false}, {{0, 1}}});
  EXPECT_DOUBLE_EQ(distance(pair[0], pair[1]), 1);
  EXPECT_TRUE(layout(Graph{}).empty());
}

TEST(NetworkChart, FailedLinksAreCrossedOutAndLoadsHaveColours) {
  NetworkChart chart{"n",
                     {{"a", NetworkNode::Kind::host, false, "a"},
                      {"s", NetworkNode::Kind::bridge, false, "s"},
                      {"b", NetworkNode::Kind::host, true, "b"}},
                     {{0, 1, 0.6, false, "busy"}, {1, 2, 0, true, "cut"}}};
  const std::string drawn = draw(chart);
  EXPECT_NE(drawn.find("stroke=\"#e69f00\" stroke-width=\"3\" fill=\"none\" class=\"mark\"><title>busy"),
            std::string::npos)
      << "60 %: to 75 %";
  std::size_t strokes = 0;
  for (std::size_t at = drawn.find("class=\"failed\""); at != std::string::npos;
       at = drawn.find("class=\"failed\"", at + 1))
    ++strokes;
  EXPECT_EQ(strokes, 2u);
  EXPECT_NE(drawn.find("red: failed in this run"), std::string::npos);
}

TEST(Gantt, ABarStandsWhereItsTimesSay) {
  // The plot is 1080 - 190 - 14 = 876 pixels wide: 250 to 500 of 1000 us are 409 to 628.
  const std::string drawn =
      draw(Gantt{"g", "us", 0, 1000, {{"row", {{0, 500}}, {{250, 500, 0, "frame"}}, {}}}, {"stream"}});
  EXPECT_NE(
      drawn.find(
          "<rect x=\"409\" y=\"39\" width=\"219\" height=\"10\" fill=\"#0072b2\" class=\"mark\"><title>frame</title>"),
      std::string::npos)
      << drawn;
  EXPECT_NE(drawn.find("<rect x=\"190\" y=\"36\" width=\"438\" height=\"16\" rx=\"0\" class=\"stretch\"/>"),
            std::string::npos)
      << drawn;
}

TEST(LimitBars, WhatIsBeyondTheAxisIsSaid) {
  LimitBar bar;
  bar.name = "latency";
  bar.verdict = "fail";
  bar.look = "fail";
  bar.simulated = 12.5;
  const std::string drawn = draw(LimitBars{"b", {bar}});
  EXPECT_NE(drawn.find("1250 %"), std::string::npos);
  EXPECT_NE(drawn.find("class=\"fail\""), std::string::npos);
}

TEST(Page, TextsAreEscapedAndRowsBeyondTheMostAreCounted) {
  Table table({"<name>"}, 1);
  table.row({{"a & b"}});
  table.row({{"unseen"}});
  const std::string text = table.take();
  EXPECT_NE(text.find("<th>&lt;name&gt;</th>"), std::string::npos);
  EXPECT_NE(text.find("a &amp; b"), std::string::npos);
  EXPECT_EQ(text.find("unseen"), std::string::npos);
  EXPECT_NE(text.find("and 1 more"), std::string::npos);
  EXPECT_TRUE(Table({"x"}).take().empty());
}

}  // namespace
}  // namespace takt::chart
