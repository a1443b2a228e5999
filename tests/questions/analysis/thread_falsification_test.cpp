// SPDX-License-Identifier: Apache-2.0
// Response times of random threads, by simulation of their processor alone at the worst that arrivals allow: never
// above the bound, and at it where it is exact. cpu_falsification_test.cpp has whole hosts.
// TAKT_FALSIFICATION_CPUS=20000 looks at more processors than the 400 of every run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "analysis/response_times.hpp"
#include "models/host/cpu.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis {
namespace {

using models::CpuPlan;
using models::SchedulingPolicy;
using sim::Duration;
using sim::TrueTime;

constexpr Ps us = 1'000'000;
using Sources = std::vector<std::vector<JobSource>>;

struct Release {
  std::uint32_t thread;
  std::uint32_t source;
  Ps at;
  Ps work;
};

/// Releases jobs when it is told to, and writes down what they found.
class CpuRun final : public sim::Component, public models::CpuUser {
 public:
  CpuRun(const CpuPlan& plan, std::vector<Release> releases, std::uint64_t seed)
      : simulation_(seed),
        cpu_(simulation_, plan, models::NodeIndex{0}, "host"),
        source_(simulation_.add(*this)),
        releases_(std::move(releases)) {
    simulation_.group(source_.id(), cpu_.id());
    ends.assign(releases_.size(), 0);
    for (std::size_t n = 0; n < releases_.size(); ++n)
      simulation_.schedule(source_, TrueTime::from_ps(releases_[n].at), sim::Phase::timer, source_.id(), 0, n);
  }
  void run(Ps until) { simulation_.run(TrueTime::from_ps(until)); }
  const std::vector<Release>& releases() const { return releases_; }
  void handle(sim::Simulation& simulation, const sim::Event& event) override {
    const Release& release = releases_[event.argument];
    cpu_.submit(release.thread, *this, source_.id().index, 0, event.argument, simulation.now(),
                Duration::from_ps(release.work));
  }
  void job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) override {
    ends[job] = simulation.now().ps();
    if (ending == Ending::refused) refused.push_back(releases_[job].thread);
  }
  std::vector<Ps> ends;                // 0: not yet
  std::vector<std::uint32_t> refused;  // threads

 private:
  sim::Simulation simulation_;
  models::Cpu cpu_;
  sim::EventSource source_;
  std::vector<Release> releases_;
};

struct Machine {
  CpuPlan plan;
  Sources sources;
};

class Random {
 public:
  explicit Random(std::uint64_t seed) : stream_(seed, "cpus", "test") {}
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(stream_.below(static_cast<std::uint64_t>(high - low + 1)));
  }
  bool one_in(std::int64_t n) { return between(1, n) == 1; }

 private:
  sim::RandomStream stream_;
};

Machine random_machine(Random& random) {
  Machine machine;
  CpuPlan& plan = machine.plan;
  plan.cores = static_cast<std::uint16_t>(random.one_in(2) ? 1 : random.between(2, 3));
  plan.switching = Duration::from_ps(random.one_in(2) ? 0 : random.between(1, 8) * us / 4);
  plan.slice = Duration::from_ps(random.between(1, 20) * us);
  const std::int64_t threads = random.between(2, 5) + (plan.cores > 1 ? 1 : 0);
  const std::int64_t bound = random.between(0, 2);    // none, some, all
  const std::int64_t load = random.between(20, 110);  // percent, on average
  const bool has_holds = random.one_in(2);
  const std::int64_t policies = random.between(0, 4);
  for (std::int64_t n = 0; n < threads; ++n) {
    models::CpuThreadPlan thread;
    thread.name = "t" + std::to_string(n);
    const std::int64_t policy = policies <= 1   ? 1
                                : policies == 2 ? 0
                                : policies == 3 ? 2
                                                : random.between(0, 2);  // all fifo, all by deadline, all fair, any
    thread.policy = static_cast<SchedulingPolicy>(policy);
    thread.priority = static_cast<std::uint8_t>(random.between(1, 4));
    thread.weight = static_cast<std::uint32_t>(random.between(1, 4) * 512);
    if (bound == 2 || (bound == 1 && random.one_in(2)))
      thread.core = static_cast<std::uint16_t>(random.between(0, plan.cores - 1));
    if (has_holds && random.one_in(2)) thread.non_preemptive = Duration::from_ps(random.between(1, 30) * us);
    std::vector<JobSource> sources;
    Ps shortest = 1000 * us;
    for (std::int64_t k = random.between(1, 2); k > 0; --k) {
      const Ps period = random.between(20, 200) * us;
      shortest = std::min(shortest, period);
      ArrivalPattern pattern{period, random.one_in(4) ? random.between(2, 3) : 1, 0,
                             random.one_in(2) ? 0 : random.between(1, 2 * period / us) * us};
      pattern.gap = pattern.frames > 1 && random.one_in(2) ? period / 8 : 0;
      const Ps share = period / us * load * plan.cores / (150 * threads * pattern.frames);
      sources.push_back({FrameArrivals(pattern),
                         random.between(1, std::max<Ps>(1, std::min<Ps>(share, period / us / 2))) * us, "jobs"});
    }
    if (random.one_in(6)) thread.most_waiting = static_cast<std::uint32_t>(random.between(1, 6));
    thread.deadline = Duration::from_ps(random.between(1, 3) * shortest);
    plan.threads.push_back(thread);
    machine.sources.push_back(sources);
  }
  return machine;
}

/// As many as early as possible from `from` on, or somewhere that the pattern allows.
std::vector<Release> releases_of(const Machine& machine, Random& random, Ps horizon) {
  std::vector<Release> made;
  const Ps critical = random.between(100, 300) * us;
  const bool is_critical = random.one_in(2), is_longest = random.one_in(2);
  for (std::uint32_t thread = 0; thread < machine.sources.size(); ++thread) {
    // Less urgent threads that block come a little before.
    const Ps from =
        critical -
        (machine.plan.threads[thread].non_preemptive.ps() > 0 && random.one_in(2) ? random.between(0, 20) * us + 1 : 0);
    for (std::uint32_t k = 0; k < machine.sources[thread].size(); ++k) {
      const JobSource& source = machine.sources[thread][k];
      const ArrivalPattern& p = source.arrivals.patterns().front();
      // Critical: all that could have been released since from - jitter is released at `from` at once, then each as
      // early as it can.
      const Ps phase = is_critical ? from - p.jitter : random.between(0, p.period / us) * us;
      std::vector<Ps> times;
      for (Ps start = phase; start < horizon; start += p.period)
        for (std::int64_t frame = 0; frame < p.frames; ++frame) {
          const Ps nominal = start + frame * p.gap;
          times.push_back(is_critical ? std::max(nominal, from)
                                      : nominal + (p.jitter == 0      ? 0
                                                   : random.one_in(3) ? p.jitter
                                                                      : random.between(0, p.jitter)));
        }
      for (const Ps at : times)
        if (at >= 0)
          made.push_back({thread, k, at,
                          is_longest || random.one_in(2)
                              ? source.work
                              : random.between(1, source.work / us) * us - (random.one_in(2) ? us / 2 : 0)});
    }
  }
  std::stable_sort(made.begin(), made.end(), [](const Release& a, const Release& b) { return a.at < b.at; });
  return made;
}

int processors() { return static_cast<int>(support::case_count("TAKT_FALSIFICATION_CPUS", 400)); }

TEST(ThreadFalsification, NoResponseIsAboveItsBound) {
  int decided = 0, undecided = 0;
  double nearest = 0, sum_of_ratios = 0;
  for (int n = 0; n < processors(); ++n) {
    Random random(static_cast<std::uint64_t>(n) + 1);
    const Machine machine = random_machine(random);
    const std::vector<ThreadTime> bound = response_times(machine.plan, machine.sources);
    for (const ThreadTime& thread : bound) ++(is_bounded(thread.worst) ? decided : undecided);
    for (int trial = 0; trial < 4; ++trial) {
      const Ps horizon = 3000 * us;
      CpuRun run(machine.plan, releases_of(machine, random, horizon), static_cast<std::uint64_t>(n));
      run.run(horizon);
      std::vector<double> greatest(bound.size());
      for (std::size_t job = 0; job < run.releases().size(); ++job) {
        const Release& release = run.releases()[job];
        const ThreadTime& thread = bound[release.thread];
        if (!is_bounded(thread.worst) || release.at > horizon) continue;
        const Ps limit = thread.worst;
        const Ps response = run.ends[job] == 0 ? horizon - release.at : run.ends[job] - release.at;
        ASSERT_LE(response, limit) << "processor " << n << ", trial " << trial << ", thread " << release.thread << " ("
                                   << machine.plan.cores << " cores), released at " << release.at;
        greatest[release.thread] =
            std::max(greatest[release.thread], static_cast<double>(response) / static_cast<double>(limit));
      }
      for (std::uint32_t t = 0; t < bound.size(); ++t) {
        if (!is_bounded(bound[t].worst)) continue;
        ASSERT_EQ(std::count(run.refused.begin(), run.refused.end(), t), 0) << "processor " << n << ", thread " << t;
        nearest = std::max(nearest, greatest[t]);
        sum_of_ratios += greatest[t] / 4;
      }
    }
  }
  RecordProperty("decided", decided);
  RecordProperty("undecided", undecided);
  std::printf("%d threads decided, %d undecided; a run comes to %.2f of the bound on average, to %.3f at best\n",
              decided, undecided, sum_of_ratios / decided, nearest);
  // The falsification must not become one of nothing.
  EXPECT_GT(decided, undecided);
  EXPECT_EQ(nearest, 1.0);
}

// One core, priorities that differ, one source a thread, jobs of constant length, no switching: what comes at once
// reaches the bound.
TEST(ThreadFalsification, TheBoundIsReached) {
  int looked_at = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    Machine machine;
    const std::int64_t threads = random.between(2, 5);
    for (std::int64_t n = 0; n < threads; ++n) {
      models::CpuThreadPlan thread;
      thread.name = "t" + std::to_string(n);
      thread.priority = static_cast<std::uint8_t>(n);
      thread.most_waiting = 10'000;
      machine.plan.threads.push_back(thread);
      const Ps period = random.between(10, 60) * us;
      const Ps jitter = random.one_in(2) ? 0 : random.between(0, 2 * period / us) * us;
      machine.sources.push_back({{FrameArrivals(ArrivalPattern{period, 1, 0, jitter}),
                                  random.between(1, period / us * 2 / threads) * us, "jobs"}});
    }
    const std::vector<ThreadTime> bound = response_times(machine.plan, machine.sources);
    std::vector<Release> releases;
    const Ps from = 200 * us, horizon = 20'000 * us;
    for (std::uint32_t t = 0; t < threads; ++t) {
      const JobSource& source = machine.sources[t][0];
      const ArrivalPattern& p = source.arrivals.patterns().front();
      for (Ps at = from - p.jitter; at < horizon; at += p.period)
        releases.push_back({t, 0, std::max(from, at), source.work});
    }
    std::stable_sort(releases.begin(), releases.end(), [](const Release& a, const Release& b) { return a.at < b.at; });
    CpuRun run(machine.plan, releases, seed);
    run.run(2 * horizon);
    for (std::uint32_t t = 0; t < threads; ++t) {
      if (!is_bounded(bound[t].worst)) continue;
      Ps greatest = 0;
      for (std::size_t n = 0; n < releases.size(); ++n)
        if (releases[n].thread == t) greatest = std::max(greatest, run.ends[n] - releases[n].at);
      EXPECT_EQ(greatest, bound[t].worst) << "seed " << seed << ", thread " << t;
      ++looked_at;
    }
  }
  EXPECT_GT(looked_at, 300);
}

// Jobs of 1 us that are due 5 us later interrupt one of 20 us four times, which costs two changes of thread each: 1 + 1
// + 1 of every 5 us. It has worked for 8 us when the fifth one comes, which is due no earlier than it: that waits for
// the other 12, and is done 2 us later.
TEST(ThreadFalsification, OwnJobsByDeadlineCostTwoChangesOfThread) {
  Machine machine;
  machine.plan.switching = Duration::from_ps(us);
  for (const Ps due : {26 * us, 5 * us}) {
    models::CpuThreadPlan thread;
    thread.name = "t";
    thread.policy = SchedulingPolicy::deadline;
    thread.deadline = Duration::from_ps(due);
    machine.plan.threads.push_back(thread);
  }
  machine.sources = {{{FrameArrivals(ArrivalPattern{1000 * us, 1, 0, 0}), 20 * us, "jobs"}},
                     {{FrameArrivals(ArrivalPattern{5 * us, 1, 0, 0}), us, "jobs"}}};
  std::vector<Release> releases = {{0, 0, 0, 20 * us}};
  for (Ps at = us; at <= 21 * us; at += 5 * us) releases.push_back({1, 0, at, us});
  CpuRun run(machine.plan, releases, 1);
  run.run(1000 * us);
  EXPECT_EQ(run.ends.back() - releases.back().at, 14 * us);
  EXPECT_GE(response_times(machine.plan, machine.sources)[1].worst, 14 * us);
}

// Two cores, nobody bound. Whenever the most urgent thread comes, the least urgent one has begun a job that nobody
// interrupts: the thread between them loses its core for 9 of every 30 us, not for the half of 10 that the most urgent
// one takes.
TEST(ThreadFalsification, LessUrgentThreadsMayBlockAgainAndAgain) {
  Machine machine;
  machine.plan.cores = 2;
  const std::vector<Ps> work = {10 * us, 100 * us, 10 * us}, period = {30 * us, 1000 * us, 30 * us};
  std::vector<Release> releases;
  for (std::uint32_t t = 0; t < 3; ++t) {
    models::CpuThreadPlan thread;
    thread.name = "t" + std::to_string(t);
    thread.priority = static_cast<std::uint8_t>(3 - t);
    if (t == 2) thread.non_preemptive = Duration::from_ps(10 * us);
    machine.plan.threads.push_back(thread);
    machine.sources.push_back({{FrameArrivals(ArrivalPattern{period[t], 1, 0, 0}), work[t], "jobs"}});
    for (Ps at = t == 0 ? us : 0; at < 500 * us; at += period[t]) releases.push_back({t, 0, at, work[t]});
  }
  CpuRun run(machine.plan, releases, 1);
  run.run(1000 * us);
  // Its core is taken in 1..10, 31..40, 61..70, 91..100 and 121..130.
  const auto job =
      std::find_if(releases.begin(), releases.end(), [](const Release& release) { return release.thread == 1; }) -
      releases.begin();
  EXPECT_EQ(run.ends[static_cast<std::size_t>(job)], 145 * us);
  EXPECT_GE(response_times(machine.plan, machine.sources)[1].worst, 145 * us);
}

}  // namespace
}  // namespace takt::analysis
