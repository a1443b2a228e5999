// SPDX-License-Identifier: Apache-2.0
// Signaling with the gPTP-capable TLV: who has not heard of it takes no time from the neighbour.
#include <gtest/gtest.h>

#include "gptp_fixture.hpp"

namespace takt::models::gptp::capability_test {
namespace {

const sim::Duration cable = sim::Duration::from_ps(100'000);

Harness::NodeSetUp speaks(std::optional<std::int8_t> log_interval) {
  Harness::NodeSetUp set_up;
  set_up.log_gptp_capable_interval = log_interval;
  return set_up;
}

TEST(GptpCapable, WhoSaysNothingIsNotCapable) {
  Harness harness;
  harness.add(speaks(0));
  harness.add(speaks(std::nullopt));
  harness.connect(0, 1, cable);
  harness.start();
  harness.run(20_s);
  EXPECT_TRUE(harness.station(0).machine.link(1).as_capable());
  EXPECT_FALSE(harness.station(0).machine.is_capable(0, 1));
  EXPECT_TRUE(harness.station(1).machine.is_capable(0, 1)) << "it takes its neighbour at its word";
  EXPECT_EQ(harness.station(1).samples, 0) << "nothing is sent to who is not capable";
}

// At intervals of 1 s: after the last word that is heard, between 19 and 20 s, nine of them.
TEST(GptpCapable, EndsNineIntervalsAfterTheLastWord) {
  Harness harness;
  harness.add(speaks(0));
  harness.add(speaks(0));
  harness.connect(0, 1, cable);
  harness.start();
  harness.run(20_s);
  EXPECT_TRUE(harness.station(0).machine.is_capable(0, 1));
  EXPECT_TRUE(harness.station(1).machine.is_capable(0, 1));
  harness.is_lost = [](const Message& message) {
    return std::holds_alternative<Signaling>(message) && header_of(message).source.clock == Harness::identity(1);
  };
  harness.run(7'900_ms);
  EXPECT_TRUE(harness.station(0).machine.is_capable(0, 1));
  harness.run(1'200_ms);
  EXPECT_FALSE(harness.station(0).machine.is_capable(0, 1));
  EXPECT_TRUE(harness.station(0).machine.link(1).as_capable());
  EXPECT_TRUE(harness.station(1).machine.is_capable(0, 1));
  harness.is_lost = [](const Message&) { return false; };
  harness.run(1'100_ms);
  EXPECT_TRUE(harness.station(0).machine.is_capable(0, 1)) << "again, with the first word";
}

TEST(GptpCapable, EachDomainForItself) {
  Harness harness;
  Harness::NodeSetUp both = speaks(0), one = speaks(0);
  both.instances = {InstanceConfig{}, InstanceConfig{}};
  both.instances[1].domain = 1;
  harness.add(both);
  harness.add(one);
  harness.connect(0, 1, cable);
  harness.start();
  harness.run(10_s);
  EXPECT_TRUE(harness.station(0).machine.is_capable(0, 1));
  EXPECT_FALSE(harness.station(0).machine.is_capable(1, 1));
}

TEST(GptpCapable, AnIntervalThatCannotBeIsNotBelieved) {
  Capability capability(std::int8_t{0}, {Harness::identity(0), 1}, 0, 0);
  Outputs outputs;
  capability.link_up({}, outputs);
  Signaling message;
  message.header.source = {Harness::identity(1), 1};
  for (const std::int8_t interval : {std::int8_t{127}, std::int8_t{-128}, std::int8_t{25}}) {
    message.capable = GptpCapable{interval};
    capability.received(message, {}, outputs);
    EXPECT_FALSE(capability.is_neighbor_capable()) << int{interval};
  }
  message.capable = GptpCapable{24};
  capability.received(message, {}, outputs);
  EXPECT_TRUE(capability.is_neighbor_capable());
}

TEST(GptpCapable, IsMeant) {
  const Capability capability(std::int8_t{0}, {Harness::identity(0), 1}, 0, 0);
  Signaling message;
  message.header.source = {Harness::identity(1), 1};
  EXPECT_TRUE(capability.is_meant(message)) << "all are";
  message.target = {Harness::identity(0), 2};
  EXPECT_FALSE(capability.is_meant(message)) << "another port";
  message.target = {Harness::identity(0), 1};
  EXPECT_TRUE(capability.is_meant(message));
  message.header.source = {Harness::identity(0), 2};
  EXPECT_FALSE(capability.is_meant(message)) << "its own word";
}

}  // namespace
}  // namespace takt::models::gptp::capability_test
