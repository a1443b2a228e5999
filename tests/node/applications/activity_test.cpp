#include "node/applications/activity.hpp"

#include <gtest/gtest.h>

#include "node/applications/deadlines.hpp"

namespace takt::node {
namespace {

TEST(ActivityLog, CountsWhatBelongsToAWindowAndForgetsWhatIsBefore) {
  ActivityLog log;
  for (std::int64_t due = 1; due <= 6; ++due) log.add(due, 2);
  EXPECT_EQ(log.take(2, 5), (ActivityLog::Sum{3, 6}));
  EXPECT_EQ(log.take(0, 5), (ActivityLog::Sum{}));
  EXPECT_EQ(log.take(5, 9), (ActivityLog::Sum{2, 4}));
}

TEST(ActivityLog, WhatFindsNoRoomIsNotNoted) {
  ActivityLog log(3);
  for (std::int64_t due = 0; due < 5; ++due) log.add(due, 1);
  EXPECT_EQ(log.take(0, 10), (ActivityLog::Sum{3, 3}));
  log.add(11, 1);
  EXPECT_EQ(log.take(10, 20), (ActivityLog::Sum{1, 1}));
}

TEST(Deadlines, WhatWasOverBeforeItWasAnsweredIsMissed) {
  Deadlines deadlines(10, 3, 27);  // due at 3, 13, 23, 33 ...
  EXPECT_EQ(deadlines.due(), 33);
  EXPECT_EQ(deadlines.number(), 3);
  deadlines.awake(42);
  EXPECT_EQ(deadlines.missed(), 0u);
  deadlines.next();
  EXPECT_EQ(deadlines.due(), 43);
  deadlines.awake(65);  // 53 and 63 are due too; the call at 65 answers the last
  EXPECT_EQ(deadlines.missed(), 2u);
  EXPECT_EQ(deadlines.due(), 63);
  deadlines.next();
  EXPECT_EQ(deadlines.due(), 73);
}

}  // namespace
}  // namespace takt::node
