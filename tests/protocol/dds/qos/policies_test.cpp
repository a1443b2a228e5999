// SPDX-License-Identifier: Apache-2.0
// The standard's defaults, and what contradicts itself.
#include "dds/qos/policies.hpp"

#include <gtest/gtest.h>

namespace takt::dds {
namespace {

using namespace sim::literals;
using Problems = std::vector<std::string>;

TEST(Policies, HaveTheStandardsDefaults) {
  const DataWriterQos writer;
  const DataReaderQos reader;
  EXPECT_EQ(writer.reliability.kind, ReliabilityKind::reliable);
  EXPECT_EQ(reader.reliability.kind, ReliabilityKind::best_effort);
  EXPECT_EQ(writer.reliability.max_blocking_time, 100_ms);
  EXPECT_EQ(writer.history, (History{HistoryKind::keep_last, 1}));
  EXPECT_EQ(reader.durability.kind, DurabilityKind::volatile_);
  EXPECT_EQ(writer.resource_limits.max_samples, unlimited);
  EXPECT_EQ(writer.deadline.period, infinite);
  EXPECT_EQ(writer.latency_budget.duration, 0_ns);
  EXPECT_EQ(writer.lifespan.duration, infinite);
  EXPECT_EQ(reader.time_based_filter.minimum_separation, 0_ns);
  EXPECT_EQ(writer.liveliness, (Liveliness{LivelinessKind::automatic, infinite}));
  EXPECT_EQ(writer.ownership_strength.value, 0);
  EXPECT_TRUE(writer.data_lifecycle.autodispose_unregistered_instances);
  EXPECT_EQ(problems_of(writer), Problems());
  EXPECT_EQ(problems_of(reader), Problems());
  EXPECT_EQ(problems_of(TopicQos{}), Problems());
}

TEST(Policies, DepthStaysWithinTheLimits) {
  DataWriterQos qos;
  qos.history.depth = 5;
  qos.resource_limits.max_samples_per_instance = 4;
  qos.resource_limits.max_samples = 3;
  EXPECT_EQ(problems_of(qos), (Problems{"history.depth: 5 is above resource_limits.max_samples_per_instance 4",
                                        "resource_limits.max_samples_per_instance: 4 is above max_samples 3"}));
  qos.resource_limits.max_samples_per_instance = unlimited;
  EXPECT_EQ(problems_of(qos), (Problems{"history.depth: 5 is above resource_limits.max_samples 3"}));
  qos.history.kind = HistoryKind::keep_all;
  EXPECT_EQ(problems_of(qos), Problems()) << "KEEP_ALL has no depth";
}

TEST(Policies, NumbersAreInTheirRanges) {
  DataWriterQos qos;
  qos.history.depth = 0;
  qos.resource_limits.max_instances = 0;
  qos.resource_limits.max_samples = -2;
  qos.deadline.period = 0_ns;
  qos.lifespan.duration = -(1_ns);
  qos.durability_service.history.depth = -1;
  EXPECT_EQ(problems_of(qos),
            (Problems{"history.depth: 0 is not positive",
                      "resource_limits.max_samples: -2 is neither positive nor unlimited (-1)",
                      "resource_limits.max_instances: 0 is neither positive nor unlimited (-1)",
                      "deadline.period: 0 ps is not positive", "lifespan.duration: -1000 ps is not positive",
                      "durability_service.history.depth: -1 is not positive"}));
}

TEST(Policies, AFilterIsNotSlowerThanTheDeadline) {
  DataReaderQos qos;
  qos.deadline.period = 10_ms;
  qos.time_based_filter.minimum_separation = 10_ms;
  EXPECT_EQ(problems_of(qos), Problems());
  qos.time_based_filter.minimum_separation = 11_ms;
  EXPECT_EQ(problems_of(qos),
            (Problems{"deadline.period: 10000000000 ps is below time_based_filter.minimum_separation 11000000000 ps"}));
}

}  // namespace
}  // namespace takt::dds
