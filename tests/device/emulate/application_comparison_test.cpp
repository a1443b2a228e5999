// SPDX-License-Identifier: Apache-2.0
// Threads of applications in both worlds, side by side, and the files that real nodes get.
#include "emulate/application_comparison.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "emulate/plan.hpp"
#include "node/applications/config.hpp"
#include "node/dds/participant.hpp"
#include "scenario/resolve.hpp"

namespace takt::emulate::application_comparison_test {
namespace {

/// Ten milliseconds for 2 s: 200 activations each.
std::unique_ptr<scenario::Resolved> plant_with(const std::string& topic) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(
      R"({"name": "s", "duration": "2s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "x": {"kind": "switch"}},
    "links": [{"ends": ["a", "x"]}, {"ends": ["b", "x"]}]}, "topics": [)" +
          topic + R"(], "applications": [
    {"name": "speaks", "on": "a", "threads": [{"name": "say", "publish": "t-1", "every": "10ms", "response": "100us", "payload": "alternate"}]},
    {"name": "hears", "on": "b", "threads": [{"name": "take", "subscribe": "t-1", "every": "10ms", "signal": "valve"}]},
    {"name": "also", "on": "b", "threads": [{"name": "idle", "subscribe": "t-1", "every": "20ms"}]}]})",
      "s.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}
std::unique_ptr<scenario::Resolved> opc_ua() {
  return plant_with(R"({"name": "t-1", "protocol": "opc-ua", "fields": {"x": "Int32"}, "pcp": 5})");
}

/// Activations, missed, published, received, lost.
const std::vector<std::vector<ThreadCounts>> as_simulated = {
    {{200, 0, 200, 0, 0}}, {{200, 3, 0, 200, 0}}, {{100, 0, 0, 200, 0}}};

std::vector<std::string> differences(const EmulatedThreads& emulated,
                                     const std::vector<bool>& is_whole = {true, true, true}) {
  std::vector<std::string> all;
  for (const ApplicationComparison& application : compare_applications(*opc_ua(), as_simulated, emulated, is_whole))
    for (const ThreadComparison& thread : application.threads)
      for (const std::string& each : thread.differs) all.push_back(thread.name + ": " + each);
  return all;
}

TEST(ApplicationComparison, BusyMachinesMissActivationsAndDoTheSame) {
  EXPECT_TRUE(differences({{{"speaks", "say"}, {198, 60, 138, 0, 0}},
                           {{"hears", "take"}, {201, 90, 0, 137, 1}},
                           {{"also", "idle"}, {99, 0, 0, 138, 0}}})
                  .empty());
}

// A quarter of 200 is 50: who begins and ends a little apart is the same, who has another period is not.
TEST(ApplicationComparison, AnotherPeriodAndSilenceAreSeen) {
  using Texts = std::vector<std::string>;
  const auto with = [](ThreadCounts say, ThreadCounts take, ThreadCounts idle) {
    return differences({{{"speaks", "say"}, say}, {{"hears", "take"}, take}, {{"also", "idle"}, idle}});
  };
  EXPECT_EQ(with({150, 0, 150, 0, 0}, {200, 0, 0, 150, 0}, {100, 0, 0, 150, 0}), Texts{});
  EXPECT_EQ(with({149, 0, 149, 0, 0}, {200, 0, 0, 149, 0}, {100, 0, 0, 149, 0}),
            Texts{"say: 149 activations, simulated 200"});
  EXPECT_EQ(with({200, 0, 0, 0, 0}, {200, 0, 0, 0, 0}, {100, 0, 0, 0, 0}),
            (Texts{"say: no values published", "take: no values received", "idle: no values received"}));
  EXPECT_EQ(with({200, 0, 200, 0, 0}, {200, 0, 0, 201, 0}, {100, 0, 0, 200, 0}),
            Texts{"take: 201 values received, of 200 that were published"});
  EXPECT_EQ(with({200, 0, 200, 0, 0}, {}, {100, 0, 0, 200, 0}),
            (Texts{"take: no activations", "take: no values received"}));
}

// Simulated: 199 edges of 200 values. A real node has any number that its values permit, if any; whether an output that
// hardly ever changes does so is a matter of luck.
TEST(ApplicationComparison, OutputsChangeWhereSimulatedOnesDo) {
  using Texts = std::vector<std::string>;
  const auto with = [](std::uint64_t simulated_edges, std::optional<SignalCounts> signal) {
    auto simulated = as_simulated;
    simulated[1][0].signal = SignalCounts{simulated_edges, 0};
    ThreadCounts take{200, 0, 0, 150, 0};
    take.signal = std::move(signal);
    Texts all;
    for (const ApplicationComparison& application : compare_applications(*opc_ua(), simulated,
                                                                         {{{"speaks", "say"}, {200, 0, 200, 0, 0}},
                                                                          {{"hears", "take"}, take},
                                                                          {{"also", "idle"}, {100, 0, 0, 150, 0}}},
                                                                         {true, true, true}))
      for (const ThreadComparison& thread : application.threads)
        for (const std::string& each : thread.differs) all.push_back(thread.name + ": " + each);
    return all;
  };
  EXPECT_EQ(with(199, SignalCounts{150, 99}), Texts{});
  EXPECT_EQ(with(199, SignalCounts{1, 0}), Texts{});
  EXPECT_EQ(with(199, SignalCounts{0, 0}), Texts{"take: no edges, simulated 199"});
  EXPECT_EQ(with(199, std::nullopt), Texts{"take: no edges, simulated 199"});
  EXPECT_EQ(with(9, SignalCounts{0, 0}), Texts{});
  EXPECT_EQ(with(10, SignalCounts{0, 0}), Texts{"take: no edges, simulated 10"});
  EXPECT_EQ(with(199, SignalCounts{151, 0}), Texts{"take: 151 edges, of 150 values received"});
}

// What a node did before it was killed is not known: neither of it nor of who hears it.
TEST(ApplicationComparison, AKilledNodeIsNotCompared) {
  const EmulatedThreads heard = {{{"hears", "take"}, {200, 0, 0, 20, 0}}, {{"also", "idle"}, {100, 0, 0, 20, 0}}};
  EXPECT_TRUE(differences(heard, {false, true, true}).empty());
  EXPECT_EQ(differences(heard, {true, true, true}).size(), 4u) << "two of who speaks, and more heard than said twice";
}

TEST(ApplicationComparison, StatisticsOfANodeAreRead) {
  EmulatedThreads threads;
  EXPECT_FALSE(add_threads(R"({"event": "start", "node": "a"})", threads));
  EXPECT_FALSE(add_threads(R"({"event": "end", "node)", threads));
  ASSERT_TRUE(add_threads(
      R"({"event": "end", "node": "a", "applications": [{"name": "n", "threads": [{"name": "t", "calls": 190, "missed": 10, "sent": 188, "taken": 0, "lost": 0, "response": {"count": 190, "min_ns": 1, "mean_ns": 20, "max_ns": 300},
    "signal": {"name": "valve", "edges": 7, "irregular_pulses": 2, "latency": {"count": 7, "min_ns": 4, "mean_ns": 50, "max_ns": 600}}}]}],
    "gateways": [{"name": "g", "threads": [{"name": "receive", "calls": 5, "missed": 0, "sent": 0, "taken": 4, "lost": 1}]}]})",
      threads));
  const ThreadCounts& thread = threads.at({"n", "t"});
  EXPECT_EQ(thread.activations, 200u);
  EXPECT_EQ(thread.missed, 10u);
  EXPECT_EQ(thread.published, 188u);
  EXPECT_EQ(thread.response, (Times{190, 1, 20, 300}));
  ASSERT_TRUE(thread.signal);
  EXPECT_EQ(thread.signal->edges, 7u);
  EXPECT_EQ(thread.signal->irregular_pulses, 2u);
  EXPECT_EQ(thread.signal->latency, (Times{7, 4, 50, 600}));
  EXPECT_EQ(thread.signal->pulses, Times());
  EXPECT_FALSE(threads.at({"g", "receive"}).signal);
  EXPECT_EQ(threads.at({"g", "receive"}).received, 4u);
  EXPECT_EQ(threads.at({"g", "receive"}).lost, 1u);
}

// Each host has the whole list, and runs what is on it; responses and signals with it; what a real node cannot do is
// left out and named.
TEST(ApplicationFiles, AreSoundAndTheSameButForTheirNode) {
  const auto resolved = opc_ua();
  const Plan plan = plan_of(*resolved);
  EXPECT_TRUE(plan.refusals.empty());
  ASSERT_EQ(plan.applications.size(), 2u);
  EXPECT_EQ(plan.applications[0].address, "10.75.0.1/16");
  EXPECT_EQ(plan.applications[1].address, "10.75.0.2/16");
  EXPECT_NE(plan.notes.front().find("priorities and VLANs of topics"), std::string::npos) << plan.notes.front();
  for (const PlannedApplications& planned : plan.applications) {
    json::Diagnostics diagnostics;
    const auto loaded = node::load_applications_text(planned.config, "file", diagnostics);
    ASSERT_TRUE(loaded) << diagnostics.to_text();
    EXPECT_EQ(loaded->config.applications.size(), planned.host == 0 ? 1u : 2u);
    for (const plant::Application& each : loaded->config.applications)
      EXPECT_EQ(each.on, resolved->topology.nodes[planned.host].name);
    EXPECT_EQ(loaded->config.topics[0].publisher_id, resolved->topics[0].publisher_id);
    EXPECT_EQ(loaded->config.seed, resolved->scenario.seed);
    const plant::Thread& thread = loaded->config.applications[0].threads[0];
    EXPECT_EQ(thread.response.has_value(), planned.host == 0);
    EXPECT_EQ(thread.signal.has_value(), planned.host == 1);
  }
}

// Names of DDS have no '-': the topic has another one in the files, wherever it is named.
TEST(ApplicationFiles, TopicsOfDdsHaveNamesThatDdsKnows) {
  if (!node::has_dds()) GTEST_SKIP() << "DDS is not in this build";
  const Plan plan = plan_of(*plant_with(
      R"({"name": "t-1", "protocol": "dds", "fields": {"x": "Int32"}}, {"name": "t_1", "protocol": "dds", "fields": {"x": "Int32"}})"));
  EXPECT_TRUE(plan.refusals.empty()) << plan.refusals.front();
  json::Diagnostics diagnostics;
  const auto loaded = node::load_applications_text(plan.applications[0].config, "file", diagnostics);
  ASSERT_TRUE(loaded) << diagnostics.to_text();
  EXPECT_EQ(loaded->config.topics[0].name, "t_1");
  EXPECT_EQ(loaded->config.topics[1].name, "t_1_");
  EXPECT_EQ(loaded->config.applications[0].threads[0].publish, "t_1");
}

TEST(ApplicationFiles, WhatRealNodesCannotDoIsRefused) {
  const Plan plan = plan_of(*plant_with(
      R"({"name": "t-1", "protocol": "dds", "fields": {"x": "Int32"}, "qos": {"durability": "transient", "reliability": "reliable"}})"));
  ASSERT_FALSE(plan.refusals.empty());
  EXPECT_NE(plan.refusals[0].find("the node on a cannot: "), std::string::npos) << plan.refusals[0];
}

}  // namespace
}  // namespace takt::emulate::application_comparison_test
