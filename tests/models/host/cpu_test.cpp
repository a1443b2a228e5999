// SPDX-License-Identifier: Apache-2.0
// Schedules of a processor, each derived by hand: when which job ends. Times in microseconds.
#include "models/host/cpu.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace takt::models {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::TrueTime;

constexpr TrueTime at(Duration since_start) { return TrueTime() + since_start; }

CpuThreadPlan fifo(std::uint8_t priority, std::optional<std::uint16_t> core = {}) {
  CpuThreadPlan thread;
  thread.name = "fifo";
  thread.priority = priority;
  thread.core = core;
  return thread;
}
CpuThreadPlan deadline(Duration after) {
  CpuThreadPlan thread;
  thread.name = "deadline";
  thread.policy = SchedulingPolicy::deadline;
  thread.deadline = after;
  return thread;
}
CpuThreadPlan fair(std::uint32_t weight = 1024, std::optional<std::uint16_t> core = {}) {
  CpuThreadPlan thread;
  thread.name = "fair";
  thread.policy = SchedulingPolicy::fair;
  thread.weight = weight;
  thread.core = core;
  return thread;
}

/// A processor whose jobs are numbered in the order in which they are asked for here.
class Machine final : public sim::Component, public CpuUser, public CpuObserver {
 public:
  Machine(CpuPlan p) : plan(std::move(p)), cpu(simulation, plan, NodeIndex{0}, "host"), source_(simulation.add(*this)) {
    simulation.group(source_.id(), cpu.id());
    cpu.set_observer(this);
  }
  void submit(std::uint32_t thread, Duration when, std::optional<Duration> work = {}) {
    submissions_.push_back({thread, work});
    simulation.schedule(source_, at(when), sim::Phase::timer, source_.id(), 0, submissions_.size() - 1);
  }
  void crash(Duration when) { simulation.schedule(source_, at(when), sim::Phase::control, source_.id(), 1, 0); }
  /// What ends when, by job; microseconds.
  std::map<std::uint64_t, double> run(Duration until = 1_s) {
    simulation.run(at(until));
    return ends;
  }

  void handle(sim::Simulation&, const sim::Event& event) override {
    if (event.kind() == 1) return cpu.crash();
    const auto& [thread, work] = submissions_[event.argument];
    cpu.submit(thread, *this, source_.id().index, 0, event.argument, simulation.now(), work);
  }
  void job_ended(sim::Simulation&, std::uint64_t job, Ending ending) override {
    (ending == Ending::done      ? ends
     : ending == Ending::refused ? refused
                                 : crashed)[job] = static_cast<double>(simulation.now().ps()) / 1e6;
    if (on_end) on_end(job, ending);
  }
  void job_done(std::uint32_t, TrueTime, Duration response, bool in_time) override {
    responses.push_back(response);
    late += in_time ? 0 : 1;
  }
  void job_refused(std::uint32_t, TrueTime) override { ++refusals; }
  void ran(std::uint32_t thread, Duration time) override { spent[thread] += time; }

  sim::Simulation simulation{1};
  CpuPlan plan;
  Cpu cpu;
  std::map<std::uint64_t, double> ends, refused, crashed;
  std::function<void(std::uint64_t, Ending)> on_end;
  std::vector<Duration> responses;
  std::map<std::uint32_t, Duration> spent;
  int late = 0, refusals = 0;

 private:
  struct Submission {
    std::uint32_t thread;
    std::optional<Duration> work;
  };
  sim::EventSource source_;
  std::vector<Submission> submissions_;
};
using Ends = std::map<std::uint64_t, double>;

TEST(Cpu, TheMoreUrgentInterruptsAndTheOtherGoesOn) {
  Machine machine({.threads = {fifo(1), fifo(2)}});
  machine.submit(0, 0_us, 10_us);
  machine.submit(1, 4_us, 3_us);  // 4 .. 7; the other: 0 .. 4 and 7 .. 13
  EXPECT_EQ(machine.run(), (Ends{{1, 7}, {0, 13}}));
  EXPECT_EQ(machine.responses, (std::vector{3_us, 13_us}));
  EXPECT_EQ(machine.spent, (std::map<std::uint32_t, Duration>{{0, 10_us}, {1, 3_us}}));
}

TEST(Cpu, ExecutionTimesAreThoseOfTheThreadIfTheJobHasNone) {
  CpuPlan plan{.threads = {fifo(1)}};
  plan.threads[0].execution = sim::Distribution::constant(6_us);
  Machine machine(plan);
  machine.submit(0, 1_us);
  machine.submit(0, 20_us, 0_us);  // what lasts no time lasts a picosecond
  EXPECT_EQ(machine.run(), (Ends{{0, 7}, {1, 20.000001}}));
}

TEST(Cpu, DeadlineBeforeFifoBeforeFair) {
  Machine machine({.threads = {fair(), fifo(0), deadline(1_s)}});
  for (std::uint32_t thread = 0; thread < 3; ++thread) machine.submit(thread, 0_us, 5_us);
  EXPECT_EQ(machine.run(), (Ends{{2, 5}, {1, 10}, {0, 15}}));
}

TEST(Cpu, EqualPrioritiesGoInTheOrderInWhichTheyBecameReady) {
  Machine machine({.threads = {fifo(1), fifo(1), fifo(2)}});
  machine.submit(1, 0_us, 10_us);
  machine.submit(0, 2_us, 1_us);  // waits, though its number is less
  machine.submit(2, 5_us, 2_us);  // interrupts
  machine.submit(1, 6_us, 4_us);  // thread 1 has been ready since 0 and stays before thread 0
  EXPECT_EQ(machine.run(), (Ends{{2, 7}, {0, 12}, {3, 16}, {1, 17}}));
}

TEST(Cpu, JobsOfAThreadOneByOneInTheOrderOfAnInstant) {
  Machine machine({.threads = {fifo(1)}});
  machine.submit(0, 0_us, 2_us);
  machine.submit(0, 0_us, 1_us);
  machine.submit(0, 1_us, 1_us);
  EXPECT_EQ(machine.run(), (Ends{{0, 2}, {1, 3}, {2, 4}}));
}

TEST(Cpu, TheEarliestDeadlineFirst) {
  Machine machine({.threads = {deadline(20_us), deadline(8_us), deadline(14_us)}});
  machine.submit(0, 0_us, 6_us);  // by 20
  machine.submit(1, 4_us, 5_us);  // by 12: interrupts at 4, ends at 9
  machine.submit(2, 5_us, 2_us);  // by 19: before the rest of the first
  EXPECT_EQ(machine.run(), (Ends{{1, 9}, {2, 11}, {0, 13}}));
  EXPECT_EQ(machine.late, 0);
}

TEST(Cpu, EqualDeadlinesDoNotInterrupt) {
  Machine machine({.threads = {deadline(8_us), deadline(10_us)}});
  machine.submit(1, 0_us, 4_us);
  machine.submit(0, 2_us, 4_us);  // both by 10
  EXPECT_EQ(machine.run(), (Ends{{1, 8}, {0, 4}}));
}

TEST(Cpu, WhatEndsAfterItsDeadlineIsLate) {
  Machine machine({.threads = {deadline(5_us), deadline(6_us)}});
  machine.submit(0, 0_us, 4_us);
  machine.submit(1, 0_us, 4_us);
  machine.run();
  EXPECT_EQ(machine.late, 1);
}

TEST(Cpu, FairThreadsShareByWeight) {
  // Slices of 3 us. Virtual times: A (weight 1) gains 3 a slice, B (weight 2) 1.5. A first (equal, lower number): 3, 0:
  // B, B (1.5, 3): equal, A: 6, B, B, ...
  Machine machine({.slice = 3_us, .threads = {fair(1024), fair(2048)}});
  machine.submit(0, 0_us, 9_us);   // 0..3, 9..12, 18..21
  machine.submit(1, 0_us, 12_us);  // 3..9, 12..18
  EXPECT_EQ(machine.run(), (Ends{{0, 21}, {1, 18}}));
}

TEST(Cpu, AFairThreadThatWasAwayHasNoClaimOnThatTime) {
  Machine machine({.slice = 2_us, .threads = {fair(), fair()}});
  machine.submit(0, 0_us, 100_us);  // alone until 50
  machine.submit(1, 50_us, 4_us);   // from then on turn by turn: B 50..52, A 52..54, B 54..56
  EXPECT_EQ(machine.run(), (Ends{{0, 104}, {1, 56}}));
}

TEST(Cpu, NorIfNoneWasThereWhenItCame) {
  Machine machine({.slice = 2_us, .threads = {fair(), fair()}});
  machine.submit(0, 0_us, 100_us);
  machine.submit(1, 200_us, 100_us);  // both start anew: A need not wait for 100 us of B
  machine.submit(0, 201_us, 4_us);    // B 200..202, A ..204, B ..206, A ..208
  EXPECT_EQ(machine.run(), (Ends{{0, 100}, {1, 304}, {2, 208}}));
}

TEST(Cpu, ASliceThatNobodyWaitsForEndsWithTheNextThatComes) {
  Machine machine({.slice = 2_us, .threads = {fair(), fair()}});
  machine.submit(0, 0_us, 10_us);
  machine.submit(1, 7_us, 1_us);  // the slice is over since 2
  EXPECT_EQ(machine.run(), (Ends{{0, 11}, {1, 8}}));
}

TEST(Cpu, SwitchingToAndFro) {
  Machine machine({.switching = 1_us, .threads = {fifo(1), fifo(2)}});
  machine.submit(0, 0_us, 10_us);  // to it: 0..1, works 1..4
  machine.submit(1, 4_us, 3_us);   // to it: 4..5, works 5..8; back: 8..9, the first works 9..16
  machine.submit(0, 20_us, 2_us);  // the core was there last: at once
  EXPECT_EQ(machine.run(), (Ends{{1, 8}, {0, 16}, {2, 22}}));
  EXPECT_EQ(machine.spent, (std::map<std::uint32_t, Duration>{{0, 14_us}, {1, 4_us}}));
}

TEST(Cpu, InterruptedWhileItIsSwitchedToItStartsAgain) {
  Machine machine({.switching = 4_us, .threads = {fifo(1), fifo(2)}});
  machine.submit(0, 0_us, 5_us);
  machine.submit(1, 3_us, 1_us);  // 3..7 to it, ends at 8; 8..12 to the first, ends at 17
  EXPECT_EQ(machine.run(), (Ends{{1, 8}, {0, 17}}));
}

TEST(Cpu, SlicesAreOfWork) {
  // Switching takes longer than a slice, and both get on: 4 to A, 2 of it, 4 to B, 2 of it, 4 to A, 1 of it, 4 to B, 1
  // of it.
  Machine machine({.switching = 4_us, .slice = 2_us, .threads = {fair(), fair()}});
  machine.submit(0, 0_us, 3_us);
  machine.submit(1, 0_us, 3_us);
  EXPECT_EQ(machine.run(), (Ends{{0, 17}, {1, 22}}));
}

TEST(Cpu, NobodyInterruptsTheEndOfAJob) {
  CpuPlan plan{.threads = {fifo(1), fifo(2)}};
  plan.threads[0].non_preemptive = 4_us;
  Machine machine(plan);
  machine.submit(0, 0_us, 10_us);
  machine.submit(1, 3_us, 1_us);  // 3..4: seven are left
  machine.submit(1, 7_us, 1_us);  // four are left: waits until 11
  machine.submit(1, 20_us, 1_us);
  EXPECT_EQ(machine.run(), (Ends{{1, 4}, {0, 11}, {2, 12}, {3, 21}}));
}

TEST(Cpu, BetweenTwoJobsAnybodyMayInterrupt) {
  // All of each job is such an end. The other one waits for the first job, not for all that follow.
  CpuPlan plan{.threads = {fifo(1), fifo(2)}};
  plan.threads[0].non_preemptive = 10_us;
  Machine machine(plan);
  for (int n = 0; n < 3; ++n) machine.submit(0, 0_us, 5_us);
  machine.submit(1, 2_us, 1_us);
  EXPECT_EQ(machine.run(), (Ends{{0, 5}, {3, 6}, {1, 11}, {2, 16}}));
}

TEST(Cpu, AJobThatComesAtTheInstantOfAnEndIsSeenBeforeTheNextBegins) {
  CpuPlan plan{.threads = {fifo(1), fifo(2)}};
  plan.threads[0].non_preemptive = 10_us;
  Machine machine(plan);
  machine.submit(0, 0_us, 5_us);
  machine.submit(0, 0_us, 5_us);
  machine.submit(1, 5_us, 1_us);
  EXPECT_EQ(machine.run(), (Ends{{0, 5}, {2, 6}, {1, 11}}));
}

TEST(Cpu, TwoCoresRunTheTwoMostUrgent) {
  Machine machine({.cores = 2, .threads = {fifo(1), fifo(2), fifo(3)}});
  for (std::uint32_t thread = 0; thread < 3; ++thread) machine.submit(thread, 0_us, 4_us + thread * 1_us);
  EXPECT_EQ(machine.run(), (Ends{{1, 5}, {2, 6}, {0, 9}}));  // the least one: 5..9
}

TEST(Cpu, ABoundThreadWaitsForItsCore) {
  Machine machine({.cores = 2, .threads = {fifo(1, 0), fifo(2, 0)}});
  machine.submit(0, 0_us, 4_us);
  machine.submit(1, 1_us, 4_us);  // the other core stays idle
  EXPECT_EQ(machine.run(), (Ends{{1, 5}, {0, 8}}));
}

TEST(Cpu, ALessUrgentThreadDoesNotMoveAnyone) {
  // The thread that may run anywhere is on core 0, and it stays there though core 1 is idle: moving would cost it a
  // switch.
  Machine machine({.cores = 2, .switching = 1_us, .threads = {fifo(5), fifo(1, 0)}});
  machine.submit(0, 0_us, 6_us);  // 0..1 to it, until 7
  machine.submit(1, 2_us, 3_us);  // 7..8 to it, until 11
  EXPECT_EQ(machine.run(), (Ends{{0, 7}, {1, 11}}));
}

TEST(Cpu, AMoreUrgentBoundThreadDoes) {
  Machine machine({.cores = 2, .switching = 1_us, .threads = {fifo(1), fifo(5, 0), fifo(0)}});
  machine.submit(0, 0_us, 6_us);  // on core 0: 1..2; core 1: 2..3 to it, until 8
  machine.submit(2, 0_us, 6_us);  // on core 1: 1..2; back on core 0 at 6..7 after the bound one, until 12
  machine.submit(1, 2_us, 3_us);  // core 0: 2..3 to it, until 6
  EXPECT_EQ(machine.run(), (Ends{{2, 6}, {0, 8}, {1, 12}}));
}

TEST(Cpu, WhoMayRunAnywhereLeavesAFreeCoreToWhoIsBoundToIt) {
  Machine machine({.cores = 2, .threads = {fifo(5), fifo(1, 0)}});
  machine.submit(0, 0_us, 4_us);
  machine.submit(1, 0_us, 4_us);
  EXPECT_EQ(machine.run(), (Ends{{0, 4}, {1, 4}}));
}

TEST(Cpu, WhoComesBackTakesTheCoreOnWhichItWas) {
  Machine machine({.cores = 2, .switching = 1_us, .threads = {fifo(1), fifo(2)}});
  machine.submit(1, 0_us, 1_us);  // core 0 until 2
  machine.submit(0, 0_us, 2_us);  // core 1 until 3
  machine.submit(0, 5_us, 2_us);  // core 1 again, at once
  EXPECT_EQ(machine.run(), (Ends{{0, 2}, {1, 3}, {2, 7}}));
}

TEST(Cpu, AHeldThreadKeepsItsCoreAndTheOtherIsInterrupted) {
  CpuPlan plan{.cores = 2, .threads = {fifo(1), fifo(2), fifo(3)}};
  plan.threads[0].non_preemptive = 8_us;
  Machine machine(plan);
  machine.submit(0, 0_us, 10_us);  // held from 2 on: until 10
  machine.submit(1, 0_us, 10_us);  // 0..4, 7..13
  machine.submit(2, 4_us, 3_us);
  EXPECT_EQ(machine.run(), (Ends{{2, 7}, {0, 10}, {1, 13}}));
}

TEST(Cpu, MoreThanMayWaitAreRefused) {
  CpuPlan plan{.threads = {fifo(1)}};
  plan.threads[0].most_waiting = 2;
  Machine machine(plan);
  for (int n = 0; n < 3; ++n) machine.submit(0, 0_us, 5_us);
  machine.submit(0, 5_us, 5_us);  // one has ended at this instant
  machine.submit(0, 6_us, 5_us);
  EXPECT_EQ(machine.run(), (Ends{{0, 5}, {1, 10}, {3, 15}}));
  EXPECT_EQ(machine.refused, (Ends{{2, 0}, {4, 6}}));
  EXPECT_EQ(machine.refusals, 2);
}

TEST(Cpu, WhoIsRefusedMaySubmitAtOnce) {
  CpuPlan plan{.threads = {fifo(2), fifo(1)}};
  plan.threads[0].most_waiting = 1;
  Machine machine(plan);
  machine.on_end = [&](std::uint64_t job, CpuUser::Ending ending) {
    if (ending == CpuUser::Ending::refused)
      machine.cpu.submit(1, machine, 0, 0, 10 + job, machine.simulation.now(), 1_us);
  };
  for (int n = 0; n < 40; ++n) machine.submit(0, 0_us, 5_us);
  machine.run();
  EXPECT_EQ(machine.refused.size(), 39u);
  EXPECT_EQ(machine.ends.size(), 40u);
  EXPECT_EQ(machine.ends.at(0), 5);
  EXPECT_EQ(machine.ends.at(49), 44);  // 39 further ones of 1 us each
}

TEST(Cpu, ACrashEndsAllJobs) {
  Machine machine({.switching = 1_us, .threads = {fifo(1), fifo(2)}});
  machine.submit(0, 0_us, 5_us);
  machine.submit(0, 0_us, 5_us);
  machine.submit(1, 2_us, 5_us);
  machine.crash(4_us);
  machine.submit(1, 10_us, 5_us);  // nothing is left of before: the core is switched to it
  EXPECT_EQ(machine.run(), (Ends{{3, 16}}));
  EXPECT_EQ(machine.crashed, (Ends{{0, 4}, {1, 4}, {2, 4}}));
}

}  // namespace
}  // namespace takt::models
