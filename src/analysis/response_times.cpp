#include "analysis/response_times.hpp"

#include <algorithm>
#include <functional>
#include <optional>

namespace takt::analysis {
namespace {

using models::CpuThreadPlan;
using models::SchedulingPolicy;

constexpr Ps longest_response = 1'000'000'000'000;   // 1 s: what takes longer is no bound that anybody wants
constexpr int most_rounds_together = 1000;

class ResponseTimes {
 public:
  ResponseTimes(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& jobs) : plan_(plan), jobs_(jobs), times_(plan.threads.size()) {
    for (std::size_t t = 0; t < times_.size(); ++t) times_[t].least = std::max<Ps>(1, plan.threads[t].execution.least().ps());
    for (const CpuThreadPlan& thread : plan.threads) moves_ = moves_ || (plan.cores > 1 && !thread.core);
  }

  std::vector<ThreadTime> make() {
    for (std::size_t t = 0; t < times_.size(); ++t) find_doubts(t);
    if (moves_)
      bound_together();
    else
      for (std::size_t t = 0; t < times_.size(); ++t)
        if (times_[t].reason.empty()) bound_alone(t);
    for (std::size_t t = 0; t < times_.size(); ++t) look_for_refusals(t);
    for (ThreadTime& time : times_)
      if (!time.reason.empty()) time.worst = unbounded_ps;
    return std::move(times_);
  }

 private:
  /// How urgent, by policy and priority: the least goes first.
  int level(std::size_t t) const {
    const CpuThreadPlan& thread = plan_.threads[t];
    return thread.policy == SchedulingPolicy::deadline ? 0 : thread.policy == SchedulingPolicy::fifo ? 256 - thread.priority : 1000;
  }
  /// Whether the other may be worked at while the thread is ready. Of one level everybody may: who was there first, whose deadline is earlier, whose share is less.
  bool goes_before(std::size_t other, std::size_t t) const { return other != t && level(other) <= level(t); }
  bool may_run_on(std::size_t t, std::uint16_t core) const { return plan_.cores == 1 || !plan_.threads[t].core || *plan_.threads[t].core == core; }
  std::uint16_t core_of(std::size_t t) const { return plan_.threads[t].core.value_or(0); }
  bool is_fair(std::size_t t) const { return plan_.threads[t].policy == SchedulingPolicy::fair; }
  Ps switching() const { return plan_.switching.ps(); }

  void find_doubts(std::size_t t) {
    const auto doubt_of = [&](std::size_t other) -> std::string {
      for (const JobSource& source : jobs_[other])
        if (!source.arrivals.is_limited()) return source.what + " may have any number of jobs at any time";
      return {};
    };
    times_[t].reason = doubt_of(t);
    for (std::size_t other = 0; times_[t].reason.empty() && other < times_.size(); ++other)
      if (goes_before(other, t) && (moves_ || may_run_on(other, core_of(t))))
        if (const std::string doubt = doubt_of(other); !doubt.empty()) times_[t].reason = "thread " + plan_.threads[other].name + " before it: " + doubt;
    // A more urgent job that finds the core of a less urgent one held displaces this one instead, as often as one comes.
    for (std::size_t other = 0; moves_ && times_[t].reason.empty() && other < times_.size(); ++other)
      if (other != t && !goes_before(other, t) && held(other) > 0) times_[t].reason = "threads move between cores, and thread " + plan_.threads[other].name + " behind it holds one";
    if (times_[t].reason.empty() && is_fair(t) && plan_.slice.ps() <= switching()) times_[t].reason = "a slice is over when the thread has been switched to";
  }

  std::int64_t count(std::size_t t, Ps length) const {
    std::int64_t all = 0;
    for (const JobSource& source : jobs_[t]) all += source.arrivals.count(length);
    return all;
  }
  /// What the jobs that come in a closed interval of that length take, each with so much more.
  Ps demand(std::size_t t, Ps length, Ps more) const {
    Ps all = 0;
    for (const JobSource& source : jobs_[t]) all = sum(all, product(source.work + more, source.arrivals.count(length)));
    return all;
  }
  Ps greatest_work(std::size_t t) const {
    Ps greatest = 0;
    for (const JobSource& source : jobs_[t]) greatest = std::max(greatest, source.work);
    return greatest;
  }
  /// For so long it cannot be interrupted.
  Ps held(std::size_t t) const { return std::min(plan_.threads[t].non_preemptive.ps(), greatest_work(t)); }
  /// Threads of policy fair take turns after each slice.
  Ps turns(std::size_t t, Ps length) const { return is_fair(t) ? product(switching(), length / plan_.slice.ps() + 1) : 0; }

  /// The least length >= `from` that covers what work(length) says is to be done in it; unbounded beyond the limit.
  static Ps least_cover(Ps from, const std::function<Ps(Ps)>& work) {
    Ps length = from;
    for (;;) {
      const Ps next = work(length);
      if (next > longest_response) return unbounded_ps;
      if (next <= length) return length;
      length = next;
    }
  }

  /// On its core everything is worked at that may go before it, one behind the other, since nothing of that waited.
  void bound_alone(std::size_t t) {
    const std::uint16_t core = core_of(t);
    if (jobs_[t].empty()) return;
    Ps blocking = 0;
    std::vector<std::size_t> before;
    for (std::size_t other = 0; other < times_.size(); ++other) {
      if (other == t || !may_run_on(other, core) || jobs_[other].empty()) continue;
      if (goes_before(other, t))
        before.push_back(other);
      else
        blocking = std::max(blocking, held(other));
    }
    // What comes at the very end of a job does not delay it: arrivals in an interval that is open at its end.
    const auto finish = [&](Ps own, Ps from) {
      return least_cover(from, [&](Ps length) {
        Ps work = sum(blocking, switching(), own, turns(t, length));
        for (const std::size_t other : before) work = sum(work, demand(other, std::max<Ps>(0, length - 1), 2 * switching()));
        return work;
      });
    };
    const Ps window = least_cover(1, [&](Ps length) { return finish(demand(t, std::max<Ps>(0, length - 1), 0), length); });
    if (!is_bounded(window)) {
      times_[t].reason = "its core has more to do than it can";
      return;
    }
    Ps end = 1;
    for (Ps released = 0; released < window;) {
      end = finish(demand(t, released, 0), end);
      times_[t].worst = std::max(times_[t].worst, end - released);
      Ps next = unbounded_ps;
      for (const JobSource& source : jobs_[t]) next = std::min(next, source.arrivals.next_jump(released));
      if (next <= released) break;
      released = next;
    }
  }

  /// Threads move between cores. While a job waits, what goes before it is worked at that came no earlier than its own thread's longest response before that.
  void bound_together() {
    for (std::size_t t = 0; t < times_.size(); ++t)
      if (times_[t].reason.empty() && !jobs_[t].empty()) times_[t].worst = greatest_work(t);
    for (int round = 0;; ++round) {
      bool has_changed = false;
      for (std::size_t t = 0; t < times_.size(); ++t) {
        if (!times_[t].reason.empty() || jobs_[t].empty()) continue;
        const Ps longer = least_cover(times_[t].worst, [&](Ps length) { return work_while_waiting(t, length); });
        if (longer == times_[t].worst) continue;
        has_changed = true;
        times_[t].worst = longer;
        if (!is_bounded(longer) || round > most_rounds_together) times_[t] = {times_[t].least, unbounded_ps, "the cores have more to do than they can, or nearly so"};
      }
      if (!has_changed) return;
    }
  }

  Ps work_while_waiting(std::size_t t, Ps length) const {
    const bool is_bound = plan_.threads[t].core.has_value();
    Ps elsewhere = 0;                      // what keeps it from its core, or all cores
    std::int64_t jobs_before = 0;
    for (std::size_t other = 0; other < times_.size(); ++other) {
      if (other == t || jobs_[other].empty()) continue;
      if (!goes_before(other, t)) continue;
      if (!times_[other].reason.empty()) return unbounded_ps;
      const Ps interval = sum(length, times_[other].worst);
      if (!is_bounded(interval)) return unbounded_ps;
      jobs_before += count(other, interval);
      // One that is bound to another core only makes threads move.
      elsewhere = sum(elsewhere, !is_bound || may_run_on(other, core_of(t)) ? demand(other, interval, 2 * switching()) : product(2 * switching(), count(other, interval)));
    }
    const std::size_t cores = is_bound ? 1 : plan_.cores;
    const Ps share = is_bounded(elsewhere) ? (elsewhere + static_cast<Ps>(cores) - 1) / static_cast<Ps>(cores) : unbounded_ps;
    // Its own jobs, this one among them, and its way back to a core.
    const Ps own = sum(demand(t, length, switching()), is_bound ? 0 : product(switching(), jobs_before), turns(t, length));
    return sum(share, own);
  }

  /// All that waits of a thread came within its longest response.
  void look_for_refusals(std::size_t t) {
    if (!times_[t].reason.empty() || jobs_[t].empty()) return;
    const std::int64_t most = count(t, times_[t].worst);
    if (most > plan_.threads[t].most_waiting) times_[t].reason = std::to_string(most) + " jobs may be there at a time, and " + std::to_string(plan_.threads[t].most_waiting) + " have room";
  }

  const models::CpuPlan& plan_;
  const std::vector<std::vector<JobSource>>& jobs_;
  std::vector<ThreadTime> times_;
  bool moves_ = false;
};

}  // namespace

std::vector<ThreadTime> response_times(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& jobs) { return ResponseTimes(plan, jobs).make(); }

}  // namespace takt::analysis
