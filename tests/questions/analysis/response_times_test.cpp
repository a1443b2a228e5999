// SPDX-License-Identifier: Apache-2.0
// Response times of threads, derived by hand. Times in microseconds.
#include "analysis/response_times.hpp"

#include <gtest/gtest.h>

namespace takt::analysis::response_times_test {
namespace {

using models::CpuThreadPlan;
using models::SchedulingPolicy;
using sim::Duration;

constexpr Ps us = 1'000'000;

/// A thread with jobs of one length in each period.
struct Task {
  int priority = 1;
  Ps work = 0;
  Ps period = 0;
  Ps jitter = 0;
  Ps non_preemptive = 0;
  SchedulingPolicy policy = SchedulingPolicy::fifo;
  std::optional<std::uint16_t> core = {};
};

std::vector<ThreadTime> times_of(const std::vector<Task>& tasks, std::uint16_t cores = 1, Ps switching = 0) {
  models::CpuPlan plan;
  plan.cores = cores;
  plan.switching = Duration::from_ps(switching * us);
  plan.slice = Duration::from_ps(100 * us);
  std::vector<std::vector<JobSource>> jobs;
  for (const Task& task : tasks) {
    CpuThreadPlan thread;
    thread.name = "t" + std::to_string(jobs.size());
    thread.policy = task.policy;
    thread.priority = static_cast<std::uint8_t>(task.priority);
    thread.core = task.core;
    thread.execution = sim::Distribution::constant(Duration::from_ps(task.work * us));
    thread.non_preemptive = Duration::from_ps(task.non_preemptive * us);
    plan.threads.push_back(thread);
    jobs.push_back({{FrameArrivals({task.period * us, 1, 0, task.jitter * us}), task.work * us, thread.name}});
  }
  return response_times(plan, jobs);
}
std::vector<Ps> of(const std::vector<Task>& tasks, std::uint16_t cores = 1, Ps switching = 0) {
  std::vector<Ps> all;
  for (const ThreadTime& time : times_of(tasks, cores, switching))
    all.push_back(is_bounded(time.worst) ? time.worst / us : -1);
  return all;
}

// The third job runs in 6..7, 10..12, 13..14 and 19..20 between those before it, beginning with all three at once.
TEST(ResponseTimes, JobsBehindThoseOfGreaterPriority) {
  EXPECT_EQ(of({{3, 3, 7}, {2, 3, 12}, {1, 5, 20}}), (std::vector<Ps>{3, 6, 20}));
}

// Two of the first come at once if one is late by a whole period: 2 * 3 + 2.
TEST(ResponseTimes, WhatIsLateComesTwice) {
  EXPECT_EQ(of({{2, 3, 10}, {1, 2, 30}}), (std::vector<Ps>{3, 5}));
  EXPECT_EQ(of({{2, 3, 10, 10}, {1, 2, 30}}), (std::vector<Ps>{6, 8}));
}

// 26 of every 70 and 62 of every 100: the fifth job of the second thread answers the slowest, of the seven in the
// window from 0 to 694 (Lehoczky 1990).
TEST(ResponseTimes, LaterJobsOfAWindowMayBeSlower) {
  EXPECT_EQ(of({{2, 26, 70}, {1, 62, 100}}), (std::vector<Ps>{26, 118}));
}

// The least urgent one holds the core for 4 when the others come.
TEST(ResponseTimes, WhoHoldsTheCoreBlocks) {
  EXPECT_EQ(of({{3, 3, 20}, {2, 3, 20}, {1, 10, 100, 0, 4}}), (std::vector<Ps>{7, 10, 16}));
  EXPECT_EQ(times_of({{3, 3, 20}, {1, 2, 100, 0, 4}})[0].worst, 5 * us - 1)
      << "no longer than a job lasts, which has begun";
}

// Each interruption costs two changes of thread: 1 to begin with, then 3 + 2 for the first, 2 for itself.
TEST(ResponseTimes, ChangesOfThreadCost) { EXPECT_EQ(of({{2, 3, 20}, {1, 2, 50}}, 1, 1), (std::vector<Ps>{4, 8})); }

TEST(ResponseTimes, EqualsAndDeadlinesAndSharesMayAllComeFirst) {
  EXPECT_EQ(of({{1, 3, 20}, {1, 4, 20}}), (std::vector<Ps>{7, 7}));
  EXPECT_EQ(of({{1, 3, 20, 0, 0, SchedulingPolicy::deadline}, {9, 4, 20}, {1, 2, 20, 0, 0, SchedulingPolicy::fair}}),
            (std::vector<Ps>{3, 7, 9}));
}

TEST(ResponseTimes, MoreThanACoreCanDo) {
  const std::vector<ThreadTime> times = times_of({{2, 5, 10}, {1, 6, 10}});
  EXPECT_EQ(times[0].worst, 5 * us);
  EXPECT_EQ(times[1].reason, "its core has more to do than it can");
}

TEST(ResponseTimes, NothingIsKnownBehindWhatMayComeAtAnyTime) {
  models::CpuPlan plan;
  plan.threads = {{"network", SchedulingPolicy::fifo, 2}, {"control", SchedulingPolicy::fifo, 1}};
  const std::vector<ThreadTime> times =
      response_times(plan, {{{FrameArrivals(), us, "camera"}}, {{FrameArrivals({10 * us, 1, 0, 0}), us, "cell"}}});
  EXPECT_EQ(times[0].reason, "camera may have any number of jobs at any time");
  EXPECT_EQ(times[1].reason, "thread network before it: camera may have any number of jobs at any time");
  EXPECT_FALSE(is_bounded(times[1].worst));
}

// 300 jobs that come at once: the queue has room for 256.
TEST(ResponseTimes, WhatFindsNoRoomHasNoBound) {
  models::CpuPlan plan;
  plan.threads = {{"network", SchedulingPolicy::fifo, 1}};
  EXPECT_EQ(response_times(plan, {{{FrameArrivals({1'000'000 * us, 256, 0, 0}), us, "burst"}}})[0].worst, 256 * us);
  EXPECT_EQ(response_times(plan, {{{FrameArrivals({1'000'000 * us, 300, 0, 0}), us, "burst"}}})[0].reason,
            "300 jobs may be there at a time, and 256 have room");
}

TEST(ResponseTimes, CoresToWhichAllAreBoundAreOneByOne) {
  EXPECT_EQ(of({{2, 5, 10, 0, 0, SchedulingPolicy::fifo, 0},
                {1, 4, 20, 0, 0, SchedulingPolicy::fifo, 0},
                {1, 8, 10, 0, 0, SchedulingPolicy::fifo, 1}},
               2),
            (std::vector<Ps>{5, 9, 8}));
}

// Two cores, nobody bound. The first and second never wait, since one other thread takes one core only. While the third
// waits both are busy: 3 + (2 + 2) / 2.
TEST(ResponseTimes, WhoMovesWaitsForAllCores) {
  EXPECT_EQ(of({{3, 2, 100}, {3, 2, 100}, {1, 3, 100}}, 2), (std::vector<Ps>{2, 2, 5}));
}

// The first and second take 4 of every 6, both at once, and leave 4..6 and 10..12: the third is done at 11. What was
// released just before it does not add to that: of two jobs in less than 10 one is never whole.
TEST(ResponseTimes, WhatWasThereBeforeCounts) {
  EXPECT_EQ(of({{3, 4, 6}, {3, 4, 6}, {1, 3, 100}}, 2), (std::vector<Ps>{4, 4, 11}));
}

}  // namespace
}  // namespace takt::analysis::response_times_test
