// SPDX-License-Identifier: Apache-2.0
// Known answers. All servers R = 20, T = 20, all flows r = 5, b = 25 unless said otherwise.
#include "analysis/server_network.hpp"

#include <gtest/gtest.h>

#include "analysis/server_network_file.hpp"

namespace takt::analysis::server_network_test {
namespace {

using Paths = std::vector<std::vector<std::size_t>>;

ServerNetwork network(std::size_t servers, const Paths& paths, Multiplexing multiplexing = Multiplexing::fifo) {
  ServerNetwork made;
  for (std::size_t s = 0; s < servers; ++s) made.servers.push_back({"s" + std::to_string(s), {20, 20}});
  for (const auto& path : paths) made.flows.push_back({"f" + std::to_string(made.flows.size()), {5, 25}, path});
  made.multiplexing = multiplexing;
  return made;
}

std::vector<Rational> delays(const std::vector<FlowBound>& bounds) {
  std::vector<Rational> all;
  for (const FlowBound& bound : bounds) all.push_back(bound.delay.value());
  return all;
}

// One server: 20 + 25 / 20 = 21.25 alone. Two flows: TFA 20 + 50 / 20 = 22.5; SFA: left-over rate 15 after 20 + 25 /
// 20, so 21.25 + 25 / 15.
TEST(ServerNetwork, OneServer) {
  EXPECT_EQ(delays(total_flow_analysis(network(1, {{0}}))), std::vector{Rational(85, 4)});
  EXPECT_EQ(delays(separated_flow_analysis(network(1, {{0}}))), std::vector{Rational(85, 4)});
  EXPECT_EQ(delays(total_flow_analysis(network(1, {{0}, {0}}))), std::vector(2, Rational(45, 2)));
  EXPECT_EQ(delays(separated_flow_analysis(network(1, {{0}, {0}}))), std::vector(2, Rational(275, 12)));
}

TEST(ServerNetwork, TwoFlowsThatMeet) {
  const ServerNetwork meeting = network(3, {{0, 2}, {1, 2}});
  EXPECT_EQ(delays(total_flow_analysis(meeting)), std::vector(2, Rational(215, 4)));  // 53.75
  EXPECT_EQ(delays(separated_flow_analysis(meeting)), std::vector(2, Rational(575, 12)));
}

TEST(ServerNetwork, ThreeFlowsInATandem) {
  const ServerNetwork tandem = network(3, {{0, 1}, {2}, {0, 1, 2}});
  EXPECT_EQ(delays(total_flow_analysis(tandem)), (std::vector{Rational(55), Rational(2205, 64), Rational(5725, 64)}));
  EXPECT_EQ(delays(separated_flow_analysis(tandem)),
            (std::vector{Rational(295, 6), Rational(6695, 192), Rational(845, 12)}));
}

// Backlogs: 50 + 10 * 20 = 250 at the first server of two flows; SFA: one flow through two left-overs of latency 21.25
// and 26.25.
TEST(ServerNetwork, Backlogs) {
  const ServerNetwork tandem = network(3, {{0, 1}, {2}, {0, 1, 2}});
  const std::vector<FlowBound> tfa = total_flow_analysis(tandem);
  EXPECT_EQ(tfa[0].servers[0].backlog, Rational(250));
  EXPECT_EQ(tfa[0].backlog, Rational(450));  // the second server: 250 + 10 * 20
  EXPECT_EQ(separated_flow_analysis(tandem)[0].backlog, Rational(25) + Rational(5) * Rational(95, 2));
}

// Arbitrary order, two flows at one server: TFA the busy period (20 * 20 + 50) / 10 = 45. SFA: left-over rate 15,
// latency (400 + 25) / 15 = 85 / 3, and 25 / 15: 30.
TEST(ServerNetwork, ArbitraryOrder) {
  EXPECT_EQ(delays(total_flow_analysis(network(1, {{0}, {0}}, Multiplexing::arbitrary))), std::vector(2, Rational(45)));
  EXPECT_EQ(delays(separated_flow_analysis(network(1, {{0}, {0}}, Multiplexing::arbitrary))),
            std::vector(2, Rational(30)));
  EXPECT_EQ(delays(total_flow_analysis(network(1, {{0}}, Multiplexing::arbitrary))), std::vector{Rational(85, 4)});
}

// Different servers and flows, by hand: s0 (R 10, T 1), s1 (R 4, T 2); f0 (r 1, b 3) through both, f1 (r 2, b 4)
// through s1 only. TFA: s0 1 + 3 / 10; f0 leaves with 3 + 1 * 1 = 4; s1 2 + 8 / 4 = 4; f0 5.3, f1 4. SFA f0: s1 leaves
// rate 2 after 2 + 4 / 4 = 3; all: rate 2, latency 4: 5.5.
TEST(ServerNetwork, DifferentServersAndFlows) {
  ServerNetwork mixed;
  mixed.servers = {{"s0", {10, 1}}, {"s1", {4, 2}}};
  mixed.flows = {{"f0", {1, 3}, {0, 1}}, {"f1", {2, 4}, {1}}};
  EXPECT_EQ(delays(total_flow_analysis(mixed)), (std::vector{Rational(53, 10), Rational(4)}));
  EXPECT_EQ(delays(separated_flow_analysis(mixed)), (std::vector{Rational(11, 2), Rational(3) + Rational(4, 3)}));
}

TEST(ServerNetwork, TooMuchIsUnbounded) {
  const ServerNetwork full = network(2, {{0, 1}, {0}, {0}, {0}, {0}});  // 25 of 20
  for (const FlowBound& bound : total_flow_analysis(full)) EXPECT_FALSE(bound.delay);
  for (const FlowBound& bound : separated_flow_analysis(full)) EXPECT_FALSE(bound.delay);
  // Exactly full: FIFO is bounded, a left-over is not.
  const ServerNetwork just = network(1, Paths(4, {0}));
  EXPECT_EQ(total_flow_analysis(just)[0].delay, Rational(25));
  EXPECT_TRUE(separated_flow_analysis(just)[0].delay);
}

TEST(ServerNetwork, KnowsCircles) {
  EXPECT_TRUE(network(3, {{0, 1, 2}, {0, 2}}).is_feed_forward());
  EXPECT_FALSE(network(3, {{0, 1}, {1, 2}, {2, 0}}).is_feed_forward());
}

std::optional<ServerNetworkFile> read(const std::string& text, json::Diagnostics& diagnostics) {
  const auto document = json::parse(text, "n.json", diagnostics);
  EXPECT_TRUE(document && is_server_network(*document));
  return read_server_network(*document, diagnostics);
}

TEST(ServerNetworkFile, ReadsAndAnswers) {
  json::Diagnostics diagnostics;
  const auto file = read(R"({"servers": {"a": {"rate": 20, "latency": "20"}, "b": {"rate": "40/2", "latency": 2e1}},
                            "flows": {"x": {"path": ["a", "b"], "rate": 5.0, "burst": 25}}})",
                         diagnostics);
  ASSERT_TRUE(file) << diagnostics.to_text();
  EXPECT_NE(server_network_report(*file, false).find("x: delay 95/2 = 47.5"), std::string::npos)
      << server_network_report(*file, false);
  EXPECT_NE(server_network_report(*file, true).find("\"delay\": \"165/4\""), std::string::npos)
      << server_network_report(*file, true);
}

TEST(ServerNetworkFile, TellsAllMistakes) {
  json::Diagnostics diagnostics;
  EXPECT_FALSE(read(
      R"({"servers": {"a": {"rate": 0, "latency": -1}}, "flows": {"x": {"path": ["b", "a", "a"], "rate": 5}}, "more": 1})",
      diagnostics));
  const std::string text = diagnostics.to_text();
  for (const char* const expected :
       {"/servers/a/rate", "/servers/a/latency", "unknown server", "a server twice", "burst", "more"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << " in\n" << text;
}

TEST(ServerNetworkFile, RefusesCircles) {
  json::Diagnostics diagnostics;
  EXPECT_FALSE(read(R"({"servers": {"a": {"rate": 2, "latency": 1}, "b": {"rate": 2, "latency": 1}},
                       "flows": {"x": {"path": ["a", "b"], "rate": 1, "burst": 1}, "y": {"path": ["b", "a"], "rate": 1, "burst": 1}}})",
                    diagnostics));
  EXPECT_NE(diagnostics.to_text().find("circle"), std::string::npos);
}

}  // namespace
}  // namespace takt::analysis::server_network_test
