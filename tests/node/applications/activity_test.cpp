#include "node/applications/activity.hpp"

#include <gtest/gtest.h>

#include "node/applications/deadlines.hpp"

namespace takt::node {
namespace {

constexpr std::int64_t ms = 1'000'000;

TEST(ActivityLog, CountsWhatBelongsToAWindowAndForgetsWhatIsBefore) {
  ActivityLog log;
  for (std::int64_t activation = 1; activation <= 6; ++activation) log.add(activation, 2);
  EXPECT_EQ(log.take(2, 5), (ActivityLog::Sum{3, 6}));
  EXPECT_EQ(log.take(0, 5), (ActivityLog::Sum{}));
  EXPECT_EQ(log.take(5, 9), (ActivityLog::Sum{2, 4}));
}

TEST(ActivityLog, WhatFindsNoRoomIsNotNoted) {
  ActivityLog log(3);
  for (std::int64_t activation = 0; activation < 5; ++activation) log.add(activation, 1);
  EXPECT_EQ(log.take(0, 10), (ActivityLog::Sum{3, 3}));
  log.add(11, 1);
  EXPECT_EQ(log.take(10, 20), (ActivityLog::Sum{1, 1}));
}

WindowCheck::Settings five_in_ten() {
  WindowCheck::Settings settings;
  settings.window = 10 * ms;
  settings.every = 5 * ms;
  settings.tolerance = ms;
  settings.has_values = true;
  return settings;
}

// By hand: windows of 10 ms hold activations 0 and 1, 2 and 3, 4 and 5. Activation 3 is missed, 4 takes two values for one that was expected.
TEST(WindowCheck, CountsAgainstWhatWasExpected) {
  WindowCheck check(five_in_ten());
  ActivityLog log;
  EXPECT_EQ(check.next(), 10 * ms);
  log.add(0, 1);
  log.add(1, 1);
  check.look(10 * ms + 3, log);
  log.add(2, 1);
  check.look(20 * ms, log);
  log.add(4, 3);
  log.add(5, 0);
  check.look(30 * ms + ms, log);
  EXPECT_EQ(check.calls(), (WindowFigures{.tests = 3, .expected = 6, .counted = 5, .beyond = 0, .windows_below = 1, .discarded = 0}));
  EXPECT_EQ(check.values(), (WindowFigures{.tests = 3, .expected = 6, .counted = 5, .beyond = 1, .windows_below = 1, .discarded = 0}));
  EXPECT_NEAR(*check.calls().percent(), 83.3333, 1e-3);
}

// The scheduler sees activation 2 as done already when it looks at the window before, and still counts it where it belongs.
TEST(WindowCheck, AnEarlyCallOfTheNextWindowStaysThere) {
  WindowCheck check(five_in_ten());
  ActivityLog log;
  for (std::int64_t activation = 0; activation <= 2; ++activation) log.add(activation, 1);
  check.look(10 * ms + ms, log);
  EXPECT_EQ(check.calls().counted, 2u);
  EXPECT_EQ(check.calls().beyond, 0u);
  log.add(3, 1);
  check.look(20 * ms, log);
  EXPECT_EQ(check.calls(), (WindowFigures{.tests = 2, .expected = 4, .counted = 4, .beyond = 0, .windows_below = 0, .discarded = 0}));
}

// The scheduler slept from before 10 ms to 34 ms: three windows were over or had begun; those of 0, 10 and 20 ms are no tests, that of 30 ms is.
TEST(WindowCheck, WhatTheSchedulerSleptThroughIsDiscarded) {
  WindowCheck check(five_in_ten());
  ActivityLog log;
  for (std::int64_t activation = 0; activation <= 6; ++activation) log.add(activation, 1);
  check.look(34 * ms, log);
  EXPECT_EQ(check.calls(), (WindowFigures{.discarded = 3}));
  EXPECT_EQ(check.next(), 40 * ms);
  log.add(7, 1);
  check.look(40 * ms, log);
  EXPECT_EQ(check.calls(), (WindowFigures{.tests = 1, .expected = 2, .counted = 2, .beyond = 0, .windows_below = 0, .discarded = 3}));
}

TEST(WindowCheck, WindowsAreWholeIntervalsBeginAfterAndEnd) {
  WindowCheck::Settings settings = five_in_ten();
  settings.every = 4 * ms;  // 12 ms is the least multiple that is not below 10
  settings.offset = ms;
  settings.begin = 13 * ms;
  settings.most_tests = 1;
  WindowCheck check(settings);
  EXPECT_EQ(check.window(), 12 * ms);
  // Window 2 is from 24 to 36 ms, with activations 6 to 8 at 25, 29 and 33 ms; that of 37 ms ends the last of them.
  EXPECT_EQ(check.next(), 37 * ms);
  ActivityLog log;
  for (std::int64_t activation = 0; activation < 9; ++activation) log.add(activation, 1);
  check.look(37 * ms, log);
  EXPECT_EQ(check.calls().expected, 3u);
  EXPECT_EQ(check.calls().counted, 3u);
  EXPECT_EQ(check.next(), std::nullopt);
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
