// SPDX-License-Identifier: Apache-2.0
// The board: who meets whom, and when one fits again. Times in plain numbers.
#include "schedule/board.hpp"

#include <gtest/gtest.h>

namespace takt::schedule::board_test {
namespace {

Problem with_periods(std::vector<Ps> periods) {
  Problem problem;
  for (const Ps period : periods) {
    problem.streams.emplace_back();
    problem.streams.back().period = period;
  }
  return problem;
}

TEST(Board, SamePeriod) {
  const Periods periods(with_periods({100}));
  Board board(periods, 1);
  board.add(0, 0, 10, 5, 0);
  EXPECT_EQ(board.push(0, 0, 0, 10), 0);   // ends where the other begins
  EXPECT_EQ(board.push(0, 0, 1, 10), 14);  // to 15
  EXPECT_EQ(board.push(0, 0, 12, 3), 3);
  EXPECT_EQ(board.push(0, 0, 15, 3), 0);
  EXPECT_EQ(board.push(0, 0, 95, 15), 0);   // round the end, up to 10
  EXPECT_EQ(board.push(0, 0, 95, 16), 20);  // round the end, beyond it: to 115
  EXPECT_EQ(board.push(0, 0, 212, 3), 3);   // a later period
}

TEST(Board, WhatReachesRoundTheEnd) {
  const Periods periods(with_periods({100}));
  Board board(periods, 1);
  board.add(0, 0, 96, 10, 0);  // to 106
  EXPECT_EQ(board.push(0, 0, 0, 5), 6);
  EXPECT_EQ(board.push(0, 0, 6, 5), 0);
}

TEST(Board, GapsThatAreTooShortArePassed) {
  const Periods periods(with_periods({100}));
  Board board(periods, 1);
  board.add(0, 0, 10, 10, 0);
  board.add(0, 0, 23, 10, 1);  // 3 between
  EXPECT_EQ(board.push(0, 0, 12, 4), 21);
  EXPECT_EQ(board.push(0, 0, 12, 3), 8);
}

// 40 and 60 have 20 in common: a slot at 5 blocks 5, 25, 45.
TEST(Board, OtherPeriodsMeetModuloWhatTheyHaveInCommon) {
  const Periods periods(with_periods({40, 60}));
  Board board(periods, 1);
  board.add(0, 1, 5, 4, 0);  // period 60
  EXPECT_EQ(board.push(0, 0, 5, 3), 4);
  EXPECT_EQ(board.push(0, 0, 25, 3), 4);
  EXPECT_EQ(board.push(0, 0, 22, 4), 7);
  EXPECT_EQ(board.push(0, 0, 29, 16), 0);
  EXPECT_EQ(board.push(0, 0, 29, 17), 20);
}

TEST(Board, WhatIsRemovedIsGone) {
  const Periods periods(with_periods({40}));
  Board board(periods, 1);
  board.add(0, 0, 5, 4, 0);
  board.add(0, 0, 9, 4, 1);
  board.remove(0, 0, 5, 0);
  EXPECT_EQ(board.push(0, 0, 5, 4), 0);
  EXPECT_EQ(board.push(0, 0, 6, 4), 7);
}

TEST(Board, ManyRepetitionsCostNoMoreThanSlots) {
  const Periods periods(with_periods({7, 7'000'000'000'001}));  // 7 * 1000000000000 + 1: nothing in common but 1
  Board board(periods, 1);
  board.add(0, 1, 3, 1, 0);
  EXPECT_GT(board.push(0, 0, 0, 1), 0);  // every instant is blocked modulo 1
}

}  // namespace
}  // namespace takt::schedule::board_test
