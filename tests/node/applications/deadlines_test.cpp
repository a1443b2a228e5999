#include "node/applications/deadlines.hpp"

#include <gtest/gtest.h>

namespace takt::node {
namespace {

TEST(Deadlines, WhatWasOverBeforeItWasAnsweredIsMissed) {
  Deadlines deadlines({10, 3}, 27);  // due at 3, 13, 23, 33 ...
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
