// SPDX-License-Identifier: Apache-2.0
#include "models/host/cpu.hpp"

#include <algorithm>
#include <tuple>

#include "models/ethernet/traffic.hpp"

namespace takt::models {
namespace {
constexpr sim::Duration least_work = sim::Duration::from_ps(1);  // what lasts no time would end before it is seen
}

Cpu::Cpu(sim::Simulation& simulation, const CpuPlan& plan, NodeIndex node, std::string_view path)
    : simulation_(&simulation), plan_(&plan), node_(node), source_(simulation.add(*this)) {
  TAKT_CHECK(plan.cores > 0 && plan.slice > sim::Duration(), "there is a core, and slices are not empty");
  for (const CpuThreadPlan& thread : plan.threads) {
    TAKT_CHECK(thread.weight > 0, "a fair thread has a share");
    TAKT_CHECK(!thread.core || *thread.core < plan.cores, "a thread runs on a core that there is");
    TAKT_CHECK(thread.policy != SchedulingPolicy::deadline || thread.deadline, "a thread by deadline has one");
    threads_.push_back(
        {&thread, sim::RandomStream(simulation.seed(), std::string(path) + "/" + thread.name, "execution")});
  }
  for (std::uint16_t core = 0; core < plan.cores; ++core)
    cores_.emplace_back(sim::Timer(source_.id(), sim::Phase::timer, core));
}

/// Before the ports, which see what jobs send at their ends. What is submitted while it decides comes behind them.
void Cpu::decide_later() {
  if (!asked_) simulation_->decide_later(source_.id(), is_deciding_ ? sim::Decision::egress : sim::Decision::processor);
  asked_ = true;
}

void Cpu::submit(std::uint32_t thread, CpuUser& user, std::uint32_t user_id, std::uint32_t rank, std::uint64_t job,
                 sim::TrueTime released, std::optional<sim::Duration> work, sim::Duration besides) {
  TAKT_CHECK(thread < threads_.size() && released <= now(), "a job is for a thread, and not for later");
  arrived_.push_back({thread, user_id, rank, {&user, job, released, work, besides}});
  decide_later();
}

void Cpu::crash() {
  for (Core& core : cores_) {
    charge(core);
    core.timer.cancel();
    core.thread = core.last = std::nullopt;
  }
  fair_time_ = 0;
  const auto tell = [this](const Job& job) { job.user->job_ended(*simulation_, job.number, CpuUser::Ending::crashed); };
  for (Thread& thread : threads_) {
    thread.core.reset();
    thread.virtual_time = 0;
    for (const Job& job : std::exchange(thread.jobs, {})) tell(job);
  }
  for (const Arrived& arrived : std::exchange(arrived_, {})) tell(arrived.job);
}

/// What the thread on the core has done since it was looked at last.
void Cpu::charge(Core& core) {
  const sim::TrueTime since = std::exchange(core.since, now());
  if (!core.thread || since == now()) return;
  Thread& thread = threads_[*core.thread];
  const sim::Duration ran = now() - since;
  const sim::Duration switched = std::min(ran, core.switching);
  const sim::Duration worked = ran - switched;
  core.switching -= switched;
  core.last = core.thread;
  thread.remaining -= worked;
  TAKT_CHECK(thread.remaining >= sim::Duration(), "a job is not worked at beyond its end");
  thread.is_begun = thread.is_begun || worked > sim::Duration();
  // Slices are of work: were switching counted, threads whose slices are not longer than it would never get on.
  thread.slice_used += worked;
  thread.virtual_time += static_cast<std::uint64_t>(static_cast<sim::int128>(worked.ps()) * 1024 / thread.plan->weight);
  if (thread.plan->policy == SchedulingPolicy::fair) keep_fair_time();
  if (observer_ != nullptr) observer_->ran(*core.thread, ran);
}

/// Fair threads that were away have no claim on what the others ran meanwhile, even if all of them are away by now:
/// what a thread starts from never goes back.
void Cpu::keep_fair_time() {
  std::optional<std::uint64_t> least;
  for (const Thread& thread : threads_)
    if (thread.plan->policy == SchedulingPolicy::fair && !thread.jobs.empty())
      least = std::min(least.value_or(thread.virtual_time), thread.virtual_time);
  fair_time_ = std::max(fair_time_, least.value_or(0));
}

void Cpu::handle(sim::Simulation& simulation, const sim::Event& event) {
  if (event.kind() == sim::Simulation::decide_now) {
    simulation.uncount_event();
    simulation.decide_later(source_.id(), sim::Decision::processor);
    return;
  }
  Core& core = cores_[event.kind()];
  if (!core.timer.fired(simulation, source_, event)) return;
  decide_later();
}

/// When the instant is complete, so that it does not matter whether what else happens in it happened before.
void Cpu::end_jobs() {
  for (Core& core : cores_)
    if (core.thread && core.switching == sim::Duration() && threads_[*core.thread].remaining == sim::Duration())
      end_job(*core.thread);
}

void Cpu::end_job(std::uint32_t number) {
  Thread& thread = threads_[number];
  const Job job = thread.jobs.front();
  thread.jobs.pop_front();
  const sim::Duration response = now() - job.released;
  simulation_->digest().add(static_cast<std::uint32_t>(Occurrence::job_done), sim::joined(node_.value, number), now(),
                            static_cast<std::uint64_t>(response.ps()));
  if (observer_ != nullptr)
    observer_->job_done(number, job.released, response, !thread.plan->deadline || response <= *thread.plan->deadline);
  if (thread.jobs.empty()) {
    cores_[*thread.core].thread.reset();
    thread.core.reset();
  } else {
    begin(thread);
  }
  job.user->job_ended(*simulation_, job.number, CpuUser::Ending::done);
}

void Cpu::begin(Thread& thread) {
  const Job& job = thread.jobs.front();
  thread.remaining =
      std::max(least_work, (job.work ? *job.work : thread.plan->execution.draw(thread.chance)) + job.besides);
  thread.is_begun = false;
}

void Cpu::accept_pending() {
  // A user that is refused may submit at once: that is seen when it decides again.
  taken_in_.clear();
  std::swap(taken_in_, arrived_);
  std::stable_sort(taken_in_.begin(), taken_in_.end(), [](const Arrived& a, const Arrived& b) {
    return std::tie(a.thread, a.user_id, a.rank) < std::tie(b.thread, b.user_id, b.rank);
  });
  for (const Arrived& arrived : taken_in_) {
    Thread& thread = threads_[arrived.thread];
    if (thread.jobs.size() >= thread.plan->most_waiting) {
      if (observer_ != nullptr) observer_->job_refused(arrived.thread, arrived.job.released);
      arrived.job.user->job_ended(*simulation_, arrived.job.number, CpuUser::Ending::refused);
      continue;
    }
    thread.jobs.push_back(arrived.job);
    if (thread.jobs.size() > 1) continue;
    thread.ready_since = now();
    thread.virtual_time = std::max(thread.virtual_time, fair_time_);
    begin(thread);
  }
}

/// It runs, and nobody may interrupt it. Between two jobs anybody may, so a job that has not begun yet is not held.
bool Cpu::is_held(const Thread& thread) const {
  return thread.core && thread.is_begun && cores_[*thread.core].switching == sim::Duration() &&
         thread.remaining <= thread.plan->non_preemptive;
}

bool Cpu::is_more_urgent(std::uint32_t a, std::uint32_t b) const {
  const auto key = [this](std::uint32_t number) {
    const Thread& thread = threads_[number];
    const CpuThreadPlan& plan = *thread.plan;
    std::int64_t first = 0;
    std::uint64_t second = 0;
    bool third = false;
    switch (plan.policy) {
      case SchedulingPolicy::deadline:
        first = thread.jobs.front().released.plus_saturated(*plan.deadline).ps();
        second = thread.is_begun ? 0 : 1;  // equal deadlines are no reason to interrupt
        break;
      case SchedulingPolicy::fifo:
        first = -std::int64_t{plan.priority};
        second = static_cast<std::uint64_t>(thread.ready_since.ps());
        break;
      case SchedulingPolicy::fair:
        first = thread.core && thread.slice_used < plan_->slice ? 0 : 1;
        second = thread.virtual_time;
        third = thread.core.has_value();  // among equals it is the others' turn
        break;
    }
    return std::tuple(!is_held(thread), plan.policy, first, second, third, number);
  };
  return key(a) < key(b);
}

/// The most urgent choose first. Who runs stays, so that a less urgent thread never costs a more urgent one a move.
void Cpu::choose() {
  ready_.clear();
  for (std::uint32_t t = 0; t < threads_.size(); ++t)
    if (!threads_[t].jobs.empty()) ready_.push_back(t);
  std::sort(ready_.begin(), ready_.end(), [this](std::uint32_t a, std::uint32_t b) { return is_more_urgent(a, b); });
  placed_.assign(cores_.size(), std::nullopt);
  for (const std::uint32_t t : ready_)
    if (const std::optional<std::uint16_t> core = core_for(threads_[t])) placed_[*core] = t;
}

/// Of the cores that no more urgent thread has taken: the one on which it is; the one to which it is bound; else an
/// idle one, if possible one for for which no bound job waits, and then the one on which it was; else that of the least
/// urgent thread.
std::optional<std::uint16_t> Cpu::core_for(const Thread& thread) const {
  const std::optional<std::uint16_t>& own = thread.core ? thread.core : thread.plan->core;
  if (own && !placed_[*own]) return own;
  if (thread.plan->core) return std::nullopt;
  std::optional<std::uint16_t> best;
  std::tuple<std::ptrdiff_t, bool, bool> best_key;
  for (std::uint16_t core = 0; core < cores_.size(); ++core) {
    if (placed_[core]) continue;
    const std::optional<std::uint32_t>& occupant = cores_[core].thread;
    const std::ptrdiff_t behind = occupant ? ready_.end() - std::find(ready_.begin(), ready_.end(), *occupant) : 0;
    const bool is_wanted = std::any_of(ready_.begin(), ready_.end(), [&](std::uint32_t t) {
      return threads_[t].plan->core == core && !threads_[t].core;
    });
    const std::tuple key(behind, is_wanted, thread.last_core != core);
    if (!best || key < best_key) std::tie(best, best_key) = std::tuple(std::optional(core), key);
  }
  return best;
}

void Cpu::dispatch(std::uint16_t number, std::optional<std::uint32_t> thread) {
  Core& core = cores_[number];
  if (core.thread != thread) {
    core.thread = thread;
    if (thread) {
      core.switching = core.last == thread ? sim::Duration() : plan_->switching;
      threads_[*thread].slice_used = {};
    }
  }
  if (!thread) return;
  threads_[*thread].core = threads_[*thread].last_core = number;
  if (threads_[*thread].slice_used >= plan_->slice) threads_[*thread].slice_used = {};
}

void Cpu::arm() {
  const bool fair_wait = std::any_of(ready_.begin(), ready_.end(), [this](std::uint32_t t) {
    return threads_[t].plan->policy == SchedulingPolicy::fair && !threads_[t].core;
  });
  for (Core& core : cores_) {
    if (!core.thread) {
      core.timer.cancel();
      continue;
    }
    const Thread& thread = threads_[*core.thread];
    sim::Duration next = core.switching + thread.remaining;
    if (fair_wait && thread.plan->policy == SchedulingPolicy::fair)
      next = std::min(next, core.switching + plan_->slice - thread.slice_used);
    core.timer.arm(*simulation_, source_, now().plus_saturated(next));
  }
}

void Cpu::decide(sim::Simulation&) {
  is_deciding_ = true;
  for (Core& core : cores_) charge(core);
  end_jobs();
  asked_ = false;
  accept_pending();
  choose();
  for (Thread& thread : threads_) thread.core.reset();
  for (std::uint16_t core = 0; core < cores_.size(); ++core) dispatch(core, placed_[core]);
  arm();
  is_deciding_ = false;
}

}  // namespace takt::models
