// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/port_selection.hpp"

#include <gtest/gtest.h>

namespace takt::models::gptp::port_selection_test {
namespace {

ClockIdentity clock(std::uint64_t n) { return ClockIdentity::from_number(n); }
const SystemIdentity self{.clock = clock(50)};

PortInformation received(std::uint8_t priority1, std::uint64_t root, std::uint16_t steps, std::uint64_t source,
                         std::uint16_t source_port, std::uint16_t port) {
  return {InfoIs::received,
          {{.priority1 = priority1, .clock = clock(root)}, steps, {clock(source), source_port}, port}};
}
Selection select(const std::vector<PortInformation>& ports) {
  Selection selection;
  select_roles(self, ports, selection);
  return selection;
}
using Roles = std::vector<PortRole>;
constexpr PortRole transmitter = PortRole::time_transmitter, receiver = PortRole::time_receiver,
                   passive = PortRole::passive, disabled = PortRole::disabled;

// Each field decides only if all before it are equal.
TEST(PriorityVector, OrderOfTheFields) {
  const PriorityVector base{
      {.priority1 = 10, .quality = {6, 0x21, 100}, .priority2 = 20, .clock = clock(5)}, 3, {clock(7), 2}, 4};
  PriorityVector better = base;
  const auto expect_better = [&](auto&& change) {
    better = base;
    // the change makes it better although everything behind it gets worse
    better.port = 9;
    change(better);
    EXPECT_LT(better, base);
  };
  expect_better([](PriorityVector& v) {
    v.root = {.priority1 = 9, .quality = {7, 0x22, 101}, .priority2 = 21, .clock = clock(6)};
  });
  expect_better([](PriorityVector& v) { v.root.quality = {5, 0x22, 101}, v.root.priority2 = 21; });
  expect_better([](PriorityVector& v) { v.root.quality = {6, 0x20, 101}, v.root.priority2 = 21; });
  expect_better([](PriorityVector& v) { v.root.quality = {6, 0x21, 99}, v.root.priority2 = 21; });
  expect_better([](PriorityVector& v) { v.root.priority2 = 19, v.root.clock = clock(6); });
  expect_better([](PriorityVector& v) { v.root.clock = clock(4), v.steps_removed = 9; });
  expect_better([](PriorityVector& v) { v.steps_removed = 2, v.source = {clock(8), 1}; });
  expect_better([](PriorityVector& v) { v.source = {clock(6), 9}; });
  expect_better([](PriorityVector& v) { v.source.port = 1; });
  better = base;
  better.port = 3;
  EXPECT_LT(better, base);
}

TEST(SelectRoles, AloneItIsGrandmaster) {
  const Selection s = select({{InfoIs::aged}, {InfoIs::disabled}, {InfoIs::mine}});
  EXPECT_EQ(s.receiver, 0);
  EXPECT_EQ(s.grandmaster.root, self);
  EXPECT_EQ(s.roles, (Roles{transmitter, disabled, transmitter}));
}

TEST(SelectRoles, FollowsTheBestAndTellsTheOthers) {
  const Selection s = select({received(248, 3, 2, 30, 1, 1), {InfoIs::mine}, received(247, 9, 0, 9, 1, 3)});
  EXPECT_EQ(s.receiver, 3);
  EXPECT_EQ(s.grandmaster.root.clock, clock(9));
  EXPECT_EQ(s.grandmaster.steps_removed, 1);
  EXPECT_EQ(s.roles, (Roles{transmitter, transmitter, receiver}));
  EXPECT_EQ(s.announced_at(2, self.clock).source, (PortIdentity{self.clock, 2}));
}

TEST(SelectRoles, TheFewerStepsThenTheSmallerSource) {
  EXPECT_EQ(select({received(1, 9, 2, 10, 1, 1), received(1, 9, 1, 60, 1, 2)}).receiver, 2);
  EXPECT_EQ(select({received(1, 9, 1, 60, 1, 1), received(1, 9, 1, 10, 1, 2)}).receiver, 2);
  EXPECT_EQ(select({received(1, 9, 1, 10, 2, 1), received(1, 9, 1, 10, 1, 2)}).receiver, 2);
  EXPECT_EQ(select({received(1, 9, 1, 10, 1, 1), received(1, 9, 1, 10, 1, 2)}).receiver, 1);
}

// The same grandmaster over two ports: the other one is passive where the neighbour tells better than this instance
// could.
TEST(SelectRoles, PassiveWhereTheNeighbourIsNearer) {
  EXPECT_EQ(select({received(1, 9, 0, 9, 1, 1), received(1, 9, 0, 9, 2, 2)}).roles, (Roles{receiver, passive}));
  EXPECT_EQ(select({received(1, 9, 0, 9, 1, 1), received(1, 9, 1, 40, 1, 2)}).roles, (Roles{receiver, passive}))
      << "40 is smaller than 50";
  EXPECT_EQ(select({received(1, 9, 0, 9, 1, 1), received(1, 9, 1, 60, 1, 2)}).roles, (Roles{receiver, transmitter}));
}

TEST(SelectRoles, OwnInformationComingBackIsNoPath) { EXPECT_EQ(select({received(1, 9, 3, 50, 2, 1)}).receiver, 0); }

}  // namespace
}  // namespace takt::models::gptp::port_selection_test
