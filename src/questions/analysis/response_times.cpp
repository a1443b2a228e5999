// SPDX-License-Identifier: Apache-2.0
#include "analysis/response_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "sim/check.hpp"

namespace takt::analysis {
namespace {

using models::CpuThreadPlan;
using models::SchedulingPolicy;

constexpr Ps longest_response = 1'000'000'000'000;  // 1 s: what takes longer is no bound that anybody wants
/// Windows are worked out at most so often for one thread: a load of nearly 100 % has windows that nobody waits for.
constexpr int most_steps = 20'000;
/// Threads that run anywhere wait for one another: so many rounds until what still grows counts as unbounded.
constexpr int most_rounds = 64;

constexpr Ps steps_of_a_part = 64;

std::int64_t count_in(const JobSource& source, Ps length) {
  if (length < 0) return 0;
  return source.arrivals.is_limited() && is_bounded(length) ? source.arrivals.count(length) : unbounded_ps;
}

class ResponseTimes {
 public:
  ResponseTimes(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& sources)
      : plan_(plan), sources_(sources), switching_(plan.switching.ps()), times_(plan.threads.size()) {
    for (std::size_t t = 0; t < times_.size(); ++t) {
      times_[t].least = std::max<Ps>(1, plan.threads[t].execution.least().ps());
      // The processor gives each job at least a picosecond, and no response is shorter than a job.
      for (JobSource& source : sources_[t])
        times_[t].worst = std::max(times_[t].worst, source.work = std::max<Ps>(1, source.work));
    }
  }

  std::vector<ThreadTime> run() {
    find_responses();
    for (std::size_t t = 0; t < times_.size(); ++t) conclude(t);
    return std::move(times_);
  }

 private:
  /// What the jobs of a thread meet on the core to which it is bound, or on the only one.
  struct Level {
    std::size_t thread;
    std::vector<std::size_t> here;      // others that go first, or may, and run on this core alone
    std::vector<std::size_t> anywhere;  // the same of those that run on any
    std::vector<std::size_t>
        elsewhere;  // the same of those that are bound to other cores: they may drive the former here
    Ps blocking = 0;
  };

  // --- Who goes before whom ---

  const CpuThreadPlan& plan_of(std::size_t i) const { return plan_.threads[i]; }
  bool is_floating(std::size_t i) const { return plan_.cores > 1 && !plan_of(i).core; }
  /// Some job of j may go before some job of i. Of itself, too.
  bool goes_first(std::size_t j, std::size_t i) const {
    const CpuThreadPlan &a = plan_of(j), &b = plan_of(i);
    return a.policy != b.policy ? a.policy < b.policy : a.policy != SchedulingPolicy::fifo || a.priority >= b.priority;
  }
  bool is_by_deadline(std::size_t i) const { return plan_of(i).policy == SchedulingPolicy::deadline; }
  bool is_fair(std::size_t i) const { return plan_of(i).policy == SchedulingPolicy::fair; }
  bool shares_core(std::size_t j, std::size_t i) const {
    return plan_.cores == 1 || plan_of(j).core == plan_of(i).core;
  }

  Ps longest_job(std::size_t i) const {
    Ps longest = 0;
    for (const JobSource& source : sources_[i]) longest = std::max(longest, source.work);
    return longest;
  }
  /// So long a job that has begun is held at most: it has worked for a picosecond, since between two jobs anybody may
  /// interrupt.
  Ps longest_hold(std::size_t i) const {
    return sources_[i].empty() ? 0 : std::min(plan_of(i).non_preemptive.ps(), longest_job(i) - 1);
  }

  Level level_of(std::size_t i) const {
    Level level{i, {}, {}, {}, 0};
    for (std::size_t j = 0; j < plan_.threads.size(); ++j) {
      if (j == i || sources_[j].empty()) continue;
      const bool is_near = is_floating(j) || shares_core(j, i);
      if (goes_first(j, i)) (is_floating(j) ? level.anywhere : is_near ? level.here : level.elsewhere).push_back(j);
      // A job whose deadline is later blocks as any less urgent one.
      const bool may_hold =
          !goes_first(j, i) || (is_by_deadline(i) && is_by_deadline(j) && *plan_of(j).deadline > *plan_of(i).deadline);
      if (is_near && may_hold) level.blocking = std::max(level.blocking, longest_hold(j));
    }
    return level;
  }

  // --- What comes in an interval ---

  Ps work(std::size_t j, Ps length, Ps extra) const {
    Ps total = 0;
    for (const JobSource& source : sources_[j])
      total = sum(total, product(sum(source.work, extra), count_in(source, length)));
    return total;
  }
  std::int64_t jobs(std::size_t j, Ps length) const {
    std::int64_t total = 0;
    for (const JobSource& source : sources_[j]) total = sum(total, count_in(source, length));
    return total;
  }
  /// Jobs of j that are there at some instant of a window of that length: released at most a response time before it.
  std::int64_t jobs_there(std::size_t j, Ps window) const {
    return is_bounded(response(j)) ? jobs(j, sum(window, response(j)) - 2) : unbounded_ps;
  }
  /// What they work in it. A job that is released u - R before the window, R its longest response, works at most u in
  /// it; one that is released v before its end, at most v. Those for which neither is less than their work are whole.
  /// Of the others, since a thread does one thing at a time, the last of the first kind and the first of the second
  /// kind stand for all of theirs.
  Ps work_there(std::size_t j, Ps window) const {
    if (!is_bounded(response(j)) || !is_bounded(window)) return unbounded_ps;
    const Ps span = window + response(j);
    Ps total = 0;
    for (const JobSource& source : sources_[j]) {
      const Ps c = source.work;
      if (span < 2 * c) {
        total = sum(total, window);
        continue;
      }
      const std::int64_t whole = count_in(source, span - 2 * c);
      const Ps one_more = length_of(source, whole + 1, span - 2 * c), two_more = length_of(source, whole + 2, one_more);
      const Ps one = std::max<Ps>(0, span - c - one_more), both = std::max<Ps>(0, span - two_more);
      // In steps, since it grows with the window as fast as the window does: fixed points would be approached by
      // picoseconds.
      const Ps step = std::max<Ps>(1, c / steps_of_a_part);
      const Ps part = (std::max(one, std::min(2 * one, both)) + step - 1) / step * step;
      total = sum(total, product(c, whole), std::min(part, 2 * c));
    }
    return total;
  }
  /// The least length from `from` on in which that many jobs may come.
  static Ps length_of(const JobSource& source, std::int64_t jobs, Ps from) {
    Ps length = from;
    while (is_bounded(length) && source.arrivals.count(length) < jobs) length = source.arrivals.next_jump(length);
    return std::min(length, unbounded_ps);
  }
  Ps response(std::size_t j) const { return times_[j].worst; }

  // --- Windows ---

  /// The least x >= start with demand(x) = x.
  template <class Demand>
  Ps least_fixed_point(Ps start, const Demand& demand) {
    for (Ps x = start; x <= longest_response && ++steps_ < most_steps;) {
      const Ps next = demand(x);
      if (next <= x) return x;
      x = next;
    }
    return unbounded_ps;
  }

  Ps slices(Ps fair_work) const { return is_bounded(fair_work) ? fair_work / plan_.slice.ps() : unbounded_ps; }

  /// What its own jobs cost in changes of thread on a core, besides two for each of the others': what each start and
  /// each end leads to. Between equal priorities none of its starts interrupts anybody, and who goes on after one of
  /// its ends begins then, or its start was paid for.
  Ps own_changes(const Level& level, Ps length) const {
    if (switching_ == 0) return 0;
    const bool interrupts = is_by_deadline(level.thread) || !level.anywhere.empty();
    const std::int64_t n = jobs(level.thread, length);
    return product(switching_, interrupts ? sum(n, n) - 1 : is_fair(level.thread) ? n : 1);
  }

  /// What others take of the core in a window, against a job that is released at `released` of it. `own`: what the
  /// thread itself works in it.
  Ps taken(const Level& level, Ps window, std::optional<Ps> released, Ps own) const {
    const std::size_t i = level.thread;
    Ps total = 0, fair_work = own;
    for (const std::size_t j : level.here) {
      Ps length = window - 1;
      // Of what goes by deadlines, only what is due as early.
      if (released && is_by_deadline(i) && is_by_deadline(j))
        length = std::min(length, *released + (*plan_of(i).deadline - *plan_of(j).deadline).ps());
      total = sum(total, work(j, length, 2 * switching_));
      if (is_fair(j)) fair_work = sum(fair_work, work(j, length, 0));
    }
    for (const std::size_t j : level.anywhere)
      total = sum(total, work_there(j, window), product(2 * switching_, switching_ == 0 ? 0 : jobs_there(j, window)));
    if (switching_ == 0) return total;
    Ps turns = is_fair(i) ? slices(fair_work) : 0;
    if (!level.anywhere.empty()) {
      total = sum(total, 2 * switching_);
      for (const std::size_t j : level.elsewhere) total = sum(total, product(switching_, jobs(j, window - 1)));
      if (is_fair(i)) {
        // Turns on other cores may drive threads here, too.
        for (const auto& others : {level.anywhere, level.elsewhere})
          for (const std::size_t j : others)
            if (is_fair(j)) fair_work = sum(fair_work, work_there(j, window));
        turns = product(2, sum(slices(fair_work), plan_.cores));
      }
    }
    return sum(total, product(switching_, turns));
  }

  /// Instants of a busy window at which a job of the thread may be the latest that is released, so that it waits
  /// longest.
  std::vector<Ps> candidates(const Level* level, std::size_t i, Ps busy) {
    std::vector<Ps> found;
    const auto add = [&](std::size_t j, Ps shift) {
      for (const JobSource& source : sources_[j])
        for (Ps length = 0; is_bounded(length) && length + shift < busy && ++steps_ < most_steps;
             length = source.arrivals.next_jump(length))
          if (length + shift >= 0) found.push_back(length + shift);
    };
    add(i, 0);
    if (level != nullptr && is_by_deadline(i))
      for (const std::size_t j : level->here)
        if (is_by_deadline(j)) add(j, (*plan_of(j).deadline - *plan_of(i).deadline).ps());
    found.push_back(0);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// Of a thread on a core of its own, or on the only one: a busy window begins with all cores' work of its level that
  /// is bound to the core.
  void bound_on_core(std::size_t i) {
    const Level level = level_of(i);
    const Ps busy = least_fixed_point(1, [&](Ps x) {
      return sum(level.blocking, work(i, x - 1, 0), own_changes(level, x - 1), taken(level, x, {}, work(i, x - 1, 0)));
    });
    if (!is_bounded(busy)) return fail(i);
    const std::vector<Ps> instants = candidates(&level, i, busy);
    for (std::size_t k = 0; k < sources_[i].size(); ++k) {
      // From when it has begun and no more is left than this, nobody interrupts it.
      const Ps held = std::min(plan_of(i).non_preemptive.ps(), sources_[i][k].work - 1);
      Ps ready = 1;
      for (const Ps released : instants) {
        const Ps own = work(i, released, 0);
        const Ps fixed = sum(level.blocking, own, own_changes(level, released)) - held;
        // With deadlines, a later release lets more go first: windows only grow.
        ready = least_fixed_point(std::max(ready, fixed),
                                  [&](Ps x) { return std::max(x, sum(fixed, taken(level, x, released, own))); });
        if (!is_bounded(ready)) return fail(i);
        note(i, ready + held - released);
      }
    }
  }

  /// Of a thread that runs anywhere: the window begins with its own work, and while it waits all cores work for others.
  void bound_anywhere(std::size_t i) {
    std::vector<std::size_t> others;
    for (std::size_t j = 0; j < plan_.threads.size(); ++j)
      if (j != i && !sources_[j].empty() && goes_first(j, i)) others.push_back(j);
    const std::int64_t cores = plan_.cores;
    // Less urgent threads that are held when it begins to wait, as it does at first and whenever a more urgent job
    // comes: once each, on a core each.
    std::vector<Ps> holds;
    for (std::size_t j = 0; j < plan_.threads.size(); ++j)
      if (!sources_[j].empty() && !goes_first(j, i) && longest_hold(j) > 0) holds.push_back(longest_hold(j));
    std::sort(holds.begin(), holds.end(), std::greater<>());
    Ps held = 0;
    for (std::size_t n = 0; n < std::min<std::size_t>(holds.size(), plan_.cores); ++n)
      held = sum(held, holds[n], switching_);
    const auto needed = [&](Ps x, Ps own) {
      std::vector<Ps> works;
      Ps fair_work = own, switched = 0, own_switched = 0;
      for (const std::size_t j : others) {
        works.push_back(work_there(j, x));
        if (is_fair(j)) fair_work = sum(fair_work, works.back());
      }
      if (switching_ > 0 || held > 0) {
        std::int64_t n = 0;
        for (const std::size_t j : others) n = sum(n, jobs_there(j, x));
        const std::int64_t over = is_fair(i) ? sum(slices(fair_work), cores) : 0;
        own_switched = product(switching_, sum(1, n, over));
        switched = sum(product(switching_, sum(n, n, n, cores, over, over)), product(held, sum(n, 1)));
      }
      // While it waits all cores are taken, each thread takes one at a time: with the k busiest aside, the others fill
      // the remaining cores.
      std::sort(works.begin(), works.end());
      Ps waits = unbounded_ps, rest = switched;
      const auto aside = std::min<std::size_t>(works.size(), static_cast<std::size_t>(cores) - 1);
      for (std::size_t n = 0; n + aside < works.size(); ++n) rest = sum(rest, works[n]);
      for (std::size_t k = aside;; --k) {
        if (is_bounded(rest)) waits = std::min(waits, rest / (cores - static_cast<std::int64_t>(k)));
        if (k == 0) break;
        rest = sum(rest, works[works.size() - k]);
      }
      return sum(own, own_switched, waits);
    };
    const Ps busy = least_fixed_point(1, [&](Ps x) { return needed(x, work(i, x - 1, 0)); });
    if (!is_bounded(busy)) return fail(i);
    Ps end = 1;
    for (const Ps released : candidates(nullptr, i, busy)) {
      const Ps own = work(i, released, 0);
      end = least_fixed_point(std::max(end, own), [&](Ps x) { return std::max(x, needed(x, own)); });
      if (!is_bounded(end)) return fail(i);
      note(i, end - released);
    }
  }

  void note(std::size_t i, Ps response) { times_[i].worst = std::max(times_[i].worst, response); }
  void fail(std::size_t i, std::string reason = {}) {
    times_[i].worst = unbounded_ps;
    if (times_[i].reason.empty()) times_[i].reason = std::move(reason);
  }
  bool is_decided(std::size_t i) const { return is_bounded(response(i)); }

  // --- All threads together ---

  /// Why nothing is to be had for thread i; empty: try.
  std::string doubt(std::size_t i) const {
    const auto doubt_of = [&](std::size_t j) -> std::string {
      for (const JobSource& source : sources_[j])
        if (!source.arrivals.is_limited()) return source.what + " may have any number of jobs at any time";
      return {};
    };
    if (std::string why = doubt_of(i); !why.empty()) return why;
    double load = 0;
    for (std::size_t j = 0; j < plan_.threads.size(); ++j) {
      if (!goes_first(j, i) || !(is_floating(i) || is_floating(j) || shares_core(j, i))) continue;
      if (const std::string why = doubt_of(j); !why.empty())
        return fmt::format("thread {} before it: {}", plan_of(j).name, why);
      for (const JobSource& source : sources_[j])
        load += source.arrivals.calmest().rate() *
                static_cast<double>(source.work + (is_floating(i) || j == i ? 0 : 2 * switching_));
    }
    // What is nearly all is found out by windows.
    if (load > 1.000001 * (is_floating(i) ? plan_.cores : 1)) return more_than_it_can(i);
    return {};
  }
  std::string more_than_it_can(std::size_t i) const {
    return is_floating(i) ? "the cores have more to do than they can, or nearly so"
                          : "its core has more to do than it can";
  }

  void find_responses() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < plan_.threads.size(); ++i)
      if (!sources_[i].empty()) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return goes_first(a, b) && !goes_first(b, a); });
    for (const std::size_t i : order)
      if (std::string why = doubt(i); !why.empty()) fail(i, std::move(why));
    const bool is_one_pass = std::none_of(order.begin(), order.end(), [&](std::size_t i) { return is_floating(i); });
    // From below to the least solution. Once all hold, none can be the first to be late: it would have to wait for one
    // that was late before.
    for (int round = 0;; ++round) {
      bool has_changed = false;
      for (const std::size_t i : order) {
        if (!is_decided(i)) continue;
        const Ps before = response(i);
        steps_ = 0;
        is_floating(i) ? bound_anywhere(i) : bound_on_core(i);
        if (steps_ >= most_steps) fail(i);
        if (response(i) == before && round > 0) continue;
        has_changed = true;
        if (round >= most_rounds) fail(i);
      }
      if (!has_changed || is_one_pass) break;
    }
  }

  /// All that waits of a thread came within its longest response.
  void conclude(std::size_t i) {
    if (!is_decided(i)) {
      if (times_[i].reason.empty()) times_[i].reason = reason_of_others(i);
      return;
    }
    if (const std::int64_t most = jobs(i, response(i) - 1); most > plan_of(i).most_waiting)
      fail(i, fmt::format("{} jobs may be there at a time, and {} have room", most, plan_of(i).most_waiting));
  }
  std::string reason_of_others(std::size_t i) const {
    for (std::size_t j = 0; j < plan_.threads.size(); ++j)
      if (j != i && is_floating(j) && goes_first(j, i) && !goes_first(i, j) && !is_decided(j))
        return fmt::format("thread {} before it: {}", plan_of(j).name,
                           times_[j].reason.empty() ? more_than_it_can(j) : times_[j].reason);
    return more_than_it_can(i);
  }

  const models::CpuPlan& plan_;
  std::vector<std::vector<JobSource>> sources_;
  Ps switching_;
  std::vector<ThreadTime> times_;
  int steps_ = 0;
};

}  // namespace

std::vector<ThreadTime> response_times(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& jobs) {
  TAKT_CHECK(jobs.size() == plan.threads.size(), "each thread has its sources");
  return ResponseTimes(plan, jobs).run();
}

}  // namespace takt::analysis
