// SPDX-License-Identifier: Apache-2.0
// Response times of threads that wait for one another in more ways than one: jitter, several sources, ends that nobody
// interrupts, slices, deadlines, several cores. Derived by hand. Times in microseconds.
#include <gtest/gtest.h>

#include "analysis/response_times.hpp"

namespace takt::analysis::busy_windows_test {
namespace {

using models::CpuPlan;
using models::CpuThreadPlan;
using models::SchedulingPolicy;
using namespace sim::literals;

constexpr Ps us = 1'000'000;
using Sources = std::vector<std::vector<JobSource>>;

JobSource every(Ps period, Ps execution, Ps jitter = 0) {
  return {FrameArrivals(ArrivalPattern{period * us, 1, 0, jitter * us}), execution * us, "jobs"};
}

CpuThreadPlan fifo(int priority, std::optional<std::uint16_t> core = {}, sim::Duration non_preemptive = {}) {
  CpuThreadPlan thread;
  thread.name = "p" + std::to_string(priority);
  thread.priority = static_cast<std::uint8_t>(priority);
  thread.core = core;
  thread.non_preemptive = non_preemptive;
  return thread;
}
CpuThreadPlan fair(std::optional<std::uint16_t> core = {}) {
  CpuThreadPlan thread;
  thread.name = "fair";
  thread.policy = SchedulingPolicy::fair;
  thread.core = core;
  return thread;
}
CpuThreadPlan deadline(sim::Duration after, sim::Duration non_preemptive = {}) {
  CpuThreadPlan thread;
  thread.name = "deadline";
  thread.policy = SchedulingPolicy::deadline;
  thread.deadline = after;
  thread.non_preemptive = non_preemptive;
  return thread;
}

/// In microseconds; -1: undecided.
std::vector<double> responses(const CpuPlan& plan, const Sources& sources) {
  std::vector<double> found;
  for (const ThreadTime& thread : response_times(plan, sources)) {
    EXPECT_EQ(is_bounded(thread.worst), thread.reason.empty()) << thread.reason;
    found.push_back(is_bounded(thread.worst) ? static_cast<double>(thread.worst) / 1e6 : -1);
  }
  return found;
}
using Us = std::vector<double>;

TEST(BusyWindows, WithJitter) {
  // With 4 us of jitter a second job of the first does not come before 6, when the second thread is done. With 5 us it
  // comes at 5.
  EXPECT_EQ(responses({.threads = {fifo(2), fifo(1)}}, {{every(10, 2, 4)}, {every(20, 4)}}), (Us{2, 6}));
  EXPECT_EQ(responses({.threads = {fifo(2), fifo(1)}}, {{every(10, 2, 5)}, {every(20, 4)}}), (Us{2, 8}));
  // Two jobs at once, and the third at 20 - 12 = 8: the second thread is done at 2 * 2 + 3.
  EXPECT_EQ(responses({.threads = {fifo(2), fifo(1)}}, {{every(10, 2, 12)}, {every(20, 3)}}), (Us{4, 7}));
}

TEST(BusyWindows, WithSeveralSourcesOfAThread) {
  // Both at once: 1 + 2. At 4, when the second source's next may come, all is done.
  EXPECT_EQ(responses({.threads = {fifo(1)}}, {{every(10, 1), every(4, 2)}}), (Us{3}));
}

TEST(BusyWindows, WithBlockingByALessUrgentThread) {
  EXPECT_EQ(responses({.threads = {fifo(2), fifo(1, {}, 3_us)}}, {{every(10, 2)}, {every(20, 5)}})[0], 5);
  // No longer than its job, which has begun.
  EXPECT_EQ(response_times({.threads = {fifo(2), fifo(1, {}, 9_us)}}, {{every(10, 2)}, {every(20, 5)}})[0].worst,
            7 * us - 1);
  // Nor does it block where it does not run.
  EXPECT_EQ(responses({.cores = 2, .threads = {fifo(2, 0), fifo(1, 1, 3_us)}}, {{every(10, 2)}, {every(20, 5)}}),
            (Us{2, 5}));
}

TEST(BusyWindows, ItsOwnEndIsNotInterrupted) {
  // 0..1 the first, 1..4 three of the second; at 4 the next of the first waits until 6.
  EXPECT_EQ(responses({.threads = {fifo(2), fifo(1)}}, {{every(4, 1)}, {every(20, 5)}})[1], 7);
  EXPECT_EQ(responses({.threads = {fifo(2), fifo(1, {}, 2_us)}}, {{every(4, 1)}, {every(20, 5)}}), (Us{3, 6}));
}

TEST(BusyWindows, WithSwitching) {
  // To the first and 1; to the first, 1, to the second, 2: and what it takes to come back from the first.
  EXPECT_EQ(responses({.switching = 1_us, .threads = {fifo(2), fifo(1)}}, {{every(10, 1)}, {every(100, 2)}}),
            (Us{2, 6}));
}

TEST(BusyWindows, FairThreadsWaitForAll) {
  // 2 + 3 + 4 = 9. With switching, and slices of 2: its own 1 + 3, the first's 2 + 2 * 1, the other's 4 + 2 * 1, and in
  // 3 + 4 of fair work 3 slices end: 17.
  const CpuPlan plan{.slice = 2_us, .threads = {fifo(1), fair(), fair()}};
  EXPECT_EQ(responses(plan, {{every(20, 2)}, {every(50, 3)}, {every(50, 4)}}), (Us{2, 9, 9}));
  CpuPlan switching = plan;
  switching.switching = 1_us;
  EXPECT_EQ(responses(switching, {{every(20, 2)}, {every(50, 3)}, {every(50, 4)}}), (Us{3, 17, 17}));
}

TEST(BusyWindows, ByDeadlines) {
  // The second's job at 0 is due at 8; the first's at 2 as well and comes after it: it ends at 6. Were it earlier, it
  // would go first.
  EXPECT_EQ(responses({.threads = {deadline(6_us), deadline(8_us)}}, {{every(6, 2)}, {every(8, 4)}}), (Us{4, 6}));
  // What is due later blocks with its end: 2 us of the second, which has begun.
  EXPECT_EQ(responses({.threads = {deadline(1_us), deadline(100_us, 2_us)}}, {{every(10, 1)}, {every(100, 4)}}),
            (Us{3, 5}));
}

TEST(BusyWindows, ACoreThatIsFullHasOneAsLongAsTheHyperperiod) {
  EXPECT_EQ(responses({.threads = {fifo(2), fifo(1)}}, {{every(4, 2)}, {every(8, 4)}}), (Us{2, 8}));
}

TEST(BusyWindows, AQueueHoldsWhatComesWithinTheLongestResponse) {
  // Three come at once (22 / 10 + 1) and are done at 4, 8 and 12; the fourth comes at 30 - 22 = 8 and is done at 16.
  // Within 12 us less a picosecond four come.
  CpuPlan plan{.threads = {fifo(1)}};
  plan.threads[0].most_waiting = 4;
  EXPECT_EQ(responses(plan, {{every(10, 4, 22)}}), (Us{12}));
  plan.threads[0].most_waiting = 3;
  EXPECT_EQ(response_times(plan, {{every(10, 4, 22)}})[0].reason, "4 jobs may be there at a time, and 3 have room");
}

TEST(BusyWindows, OfThreadsThatRunAnywhere) {
  // Both cores are taken for 2.
  EXPECT_EQ(
      responses({.cores = 2, .threads = {fifo(3), fifo(2), fifo(1)}}, {{every(10, 2)}, {every(10, 2)}, {every(20, 3)}}),
      (Us{2, 2, 5}));
  // One other thread takes one core, however long.
  EXPECT_EQ(responses({.cores = 2, .threads = {fifo(3), fifo(1)}}, {{every(10, 9)}, {every(20, 3)}}), (Us{9, 3}));
  // A job of the least urgent one that has begun keeps its core: whenever the first comes, and when its own job does,
  // the second may wait for it. 3 + (2 + 2 * (4 - 1 ps)) / 2.
  EXPECT_EQ(response_times({.cores = 2, .threads = {fifo(3), fifo(2), fifo(1, {}, 9_us)}},
                           {{every(50, 2)}, {every(50, 3)}, {every(100, 4)}})[1]
                .worst,
            3 * us + 5 * us - 1);
  // One that is bound meets the one that runs anywhere with what it has left: released before, done within 4, so at
  // most 4 of one job.
  EXPECT_EQ(responses({.cores = 2, .threads = {fifo(3), fifo(1, 0)}}, {{every(50, 4)}, {every(20, 3)}}), (Us{4, 7}));
}

}  // namespace
}  // namespace takt::analysis::busy_windows_test
