// SPDX-License-Identifier: Apache-2.0
// The two criteria, counted by hand. Milliseconds here; a criterion does not care.
#include "plant/criterion.hpp"

#include <gtest/gtest.h>

namespace takt::plant {
namespace {

Criterion five_in_ten() { return Criterion({.length = 10, .expected = 2, .tolerance = 1}); }

// Windows hold the activations due at 0 and 5, 10 and 15, 20 and 25. That of 15 is missed; that of 20 takes three
// values, that of 25 none.
TEST(Criterion, CountsAgainstWhatWasExpected) {
  Criterion calls = five_in_ten();
  Criterion values = five_in_ten();
  calls.begin(0);
  values.begin(0);
  EXPECT_EQ(calls.open(), (Criterion::Window{0, 10}));
  const auto call = [&](std::int64_t due, std::uint64_t taken) {
    calls.add(due);
    values.add(due, taken);
  };
  const auto look = [&](std::int64_t now) {
    calls.look(now);
    values.look(now);
  };
  call(0, 1);
  call(5, 1);
  look(9);  // too early to say
  look(10);
  call(10, 1);
  look(20);
  call(20, 3);
  call(25, 0);
  look(31);
  EXPECT_EQ(calls.figures(), (CriterionFigures{.tests = 3, .expected = 6, .counted = 5, .windows_below = 1}));
  EXPECT_EQ(
      values.figures(),
      (CriterionFigures{.tests = 3, .expected = 6, .counted = 5, .beyond = 1, .windows_below = 1, .windows_above = 1}));
  EXPECT_NEAR(*calls.figures().percent(), 83.3333, 1e-3);
}

// The scheduler looks late, but in time: what was due in the next window by then counts there, and what was due before
// the open one nowhere.
TEST(Criterion, CallsOfLaterWindowsAreKept) {
  Criterion criterion({.length = 10, .expected = 2, .tolerance = 15});
  criterion.begin(0);
  for (const std::int64_t due : {0, 5, 10, 15, 20}) criterion.add(due);
  criterion.look(25);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.tests = 1, .expected = 2, .counted = 2}));
  criterion.add(5);
  criterion.look(25);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.tests = 2, .expected = 4, .counted = 4}));
  criterion.look(30);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.tests = 3, .expected = 6, .counted = 5, .windows_below = 1}));
}

// So many windows have begun since that nothing is known of the open one: it is no test.
TEST(Criterion, WhatIsForgottenIsNoTest) {
  constexpr std::int64_t windows = 10'000;
  Criterion criterion({.length = 1, .expected = 1, .tolerance = 100'000});
  criterion.begin(0);
  for (std::int64_t due = 0; due <= windows; ++due) criterion.add(due);
  criterion.look(windows);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.discarded = windows}));
  criterion.look(windows + 1);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.tests = 1, .expected = 1, .counted = 1, .discarded = windows}));
}

// The scheduler slept until 34: the windows of 0, 10 and 20 are no tests, that of 30 is.
TEST(Criterion, WhatTheSchedulerSleptThroughIsDiscarded) {
  Criterion criterion = five_in_ten();
  criterion.begin(0);
  criterion.add(0);
  criterion.look(34);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.discarded = 3}));
  EXPECT_EQ(criterion.open(), (Criterion::Window{30, 40}));
  criterion.add(25);  // of a window that is no test
  criterion.add(30);
  criterion.add(35);
  criterion.look(40);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.tests = 1, .expected = 2, .counted = 2, .discarded = 3}));
}

// The first window that begins at 13 or later is that from 13 to 25: an activation of the thread, due at 1 + 4 n,
// begins each.
TEST(Criterion, WindowsBeginWithActivationsAfterAndEnd) {
  Criterion criterion({.length = 12, .phase = 1, .expected = 3, .after = 13, .most_tests = 1});
  EXPECT_EQ(criterion.open(), std::nullopt);
  criterion.begin(0);
  EXPECT_EQ(criterion.open(), (Criterion::Window{13, 25}));
  for (const std::int64_t due : {9, 13, 17, 21}) criterion.add(due);
  criterion.look(25);
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.tests = 1, .expected = 3, .counted = 3}));
  EXPECT_EQ(criterion.open(), std::nullopt);
}

TEST(Criterion, AnEndDiscardsTheOpenWindow) {
  Criterion criterion = five_in_ten();
  criterion.begin(0);
  criterion.add(0);
  criterion.end();
  criterion.end();
  EXPECT_EQ(criterion.figures(), (CriterionFigures{.discarded = 1}));
  criterion.begin(42);
  EXPECT_EQ(criterion.open(), (Criterion::Window{50, 60}));
}

}  // namespace
}  // namespace takt::plant
