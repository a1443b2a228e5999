#include "analysis/response_times.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "sim/check.hpp"

namespace takt::analysis {
namespace {

using models::CpuThreadPlan;
using models::SchedulingPolicy;

/// Windows are worked out at most so often for one thread: a load of nearly 100 % has windows that nobody waits for.
constexpr int most_steps = 200'000;
/// Threads that run anywhere wait for one another: so many rounds until what still grows counts as unbounded.
constexpr int most_rounds = 64;

constexpr Ps steps_of_a_part = 64;

std::int64_t count_in(const JobSource& source, Ps length) {
  if (length < 0) return 0;
  return source.arrivals.is_limited() && is_bounded(length) ? source.arrivals.count(length) : unbounded_ps;
}
double rate_of(const JobSource& source) { return source.arrivals.is_limited() ? source.arrivals.calmest().rate() : std::numeric_limits<double>::infinity(); }

class Analysis {
 public:
  Analysis(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& sources)
      : plan_(plan), sources_(sources), switching_(plan.switching.ps()), result_{std::vector<ThreadResponse>(plan.threads.size()), std::vector<double>(plan.cores), 0, 0} {
    // The processor gives each job at least a picosecond.
    for (std::vector<JobSource>& of_thread : sources_)
      for (JobSource& source : of_thread) source.execution = std::max<Ps>(1, source.execution);
  }

  CpuResponses run() {
    measure_load();
    find_responses();
    for (std::size_t i = 0; i < plan_.threads.size(); ++i) conclude(i);
    return std::move(result_);
  }

 private:
  /// What the jobs of a thread meet on the core to which it is bound, or on the only one.
  struct Level {
    std::size_t thread;
    std::vector<std::size_t> here;         // others that go first, or may, and run on this core alone
    std::vector<std::size_t> anywhere;     // the same of those that run on any
    std::vector<std::size_t> elsewhere;    // the same of those that are bound to other cores: they may drive the former here
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
  bool shares_core(std::size_t j, std::size_t i) const { return plan_.cores == 1 || plan_of(j).core == plan_of(i).core; }

  Ps longest_job(std::size_t i) const {
    Ps longest = 0;
    for (const JobSource& source : sources_[i]) longest = std::max(longest, source.execution);
    return longest;
  }
  /// So long a job that has begun is held at most: it has worked for a picosecond, since between two jobs anybody may interrupt.
  Ps longest_hold(std::size_t i) const { return sources_[i].empty() ? 0 : std::min(plan_of(i).non_preemptive.ps(), longest_job(i) - 1); }

  Level level_of(std::size_t i) const {
    Level level{i, {}, {}, {}, 0};
    for (std::size_t j = 0; j < plan_.threads.size(); ++j) {
      if (j == i || sources_[j].empty()) continue;
      const bool is_near = is_floating(j) || shares_core(j, i);
      if (goes_first(j, i)) (is_floating(j) ? level.anywhere : is_near ? level.here : level.elsewhere).push_back(j);
      // A job whose deadline is later blocks as any less urgent one.
      const bool may_hold = !goes_first(j, i) || (is_by_deadline(i) && is_by_deadline(j) && *plan_of(j).deadline > *plan_of(i).deadline);
      if (is_near && may_hold) level.blocking = std::max(level.blocking, longest_hold(j));
    }
    return level;
  }

  // --- What comes in an interval ---

  Ps work(std::size_t j, Ps length, Ps extra) const {
    Ps total = 0;
    for (const JobSource& source : sources_[j]) total = sum(total, product(sum(source.execution, extra), count_in(source, length)));
    return total;
  }
  std::int64_t jobs(std::size_t j, Ps length) const {
    std::int64_t total = 0;
    for (const JobSource& source : sources_[j]) total = sum(total, count_in(source, length));
    return total;
  }
  /// Jobs of j that are there at some instant of a window of that length: released at most a response time before it.
  std::int64_t jobs_there(std::size_t j, Ps window) const { return is_bounded(response(j)) ? jobs(j, sum(window, response(j)) - 2) : unbounded_ps; }
  /// What they work in it. Of those whose response times end in it before they could have done all of their work in it, the last one gets the rest.
  Ps work_there(std::size_t j, Ps window) const {
    if (!is_bounded(response(j))) return unbounded_ps;
    Ps total = 0;
    for (const JobSource& source : sources_[j]) {
      const Ps c = source.execution;
      const Ps reach = sum(window, response(j)) - 1;
      const std::int64_t whole = count_in(source, reach - c);
      total = sum(total, product(c, whole));
      // The greatest part of a job with which all the whole ones are possible: that many and one come in an interval of reach - part.
      Ps low = 0, high = c - 1;
      while (low < high) {
        const Ps middle = high - (high - low) / 2;
        (count_in(source, reach - middle) > whole ? low : high) = count_in(source, reach - middle) > whole ? middle : middle - 1;
      }
      // In steps, since it grows with the window as fast as the window does: fixed points would be approached by picoseconds.
      const Ps step = std::max<Ps>(1, c / steps_of_a_part);
      total = sum(total, std::min(c - 1, (low + step - 1) / step * step));
    }
    return total;
  }
  Ps response(std::size_t j) const { return result_.threads[j].response; }

  // --- Windows ---

  /// The least x >= start with demand(x) = x.
  template <class Demand>
  Ps least_fixed_point(Ps start, const Demand& demand) {
    for (Ps x = start; is_bounded(x) && ++steps_ < most_steps;) {
      const Ps next = demand(x);
      if (next <= x) return x;
      x = next;
    }
    return unbounded_ps;
  }

  Ps slices(Ps fair_work) const { return is_bounded(fair_work) ? fair_work / plan_.slice.ps() : unbounded_ps; }

  /// What others take of the core in a window, against a job that is released at `released` of it. `own`: what the thread itself works in it.
  Ps taken(const Level& level, Ps window, std::optional<Ps> released, Ps own) const {
    const std::size_t i = level.thread;
    Ps total = 0, fair_work = own;
    for (const std::size_t j : level.here) {
      Ps length = window - 1;
      // Of what goes by deadlines, only what is due as early.
      if (released && is_by_deadline(i) && is_by_deadline(j)) length = std::min(length, *released + (*plan_of(i).deadline - *plan_of(j).deadline).ps());
      total = sum(total, work(j, length, 2 * switching_));
      if (is_fair(j)) fair_work = sum(fair_work, work(j, length, 0));
    }
    for (const std::size_t j : level.anywhere) total = sum(total, work_there(j, window), product(2 * switching_, switching_ == 0 ? 0 : jobs_there(j, window)));
    if (!level.anywhere.empty() && switching_ > 0) {
      total = sum(total, switching_);
      for (const std::size_t j : level.elsewhere) total = sum(total, product(switching_, jobs(j, window - 1)));
    }
    if (is_fair(i)) total = sum(total, product(switching_, switching_ == 0 ? 0 : slices(fair_work)));
    return total;
  }

  /// Instants of a busy window at which a job of the thread may be the latest that is released, so that it waits longest.
  std::vector<Ps> candidates(const Level* level, std::size_t i, Ps busy) {
    std::vector<Ps> found;
    const auto add = [&](std::size_t j, Ps shift) {
      for (const JobSource& source : sources_[j])
        for (Ps length = 0; is_bounded(length) && length + shift < busy && ++steps_ < most_steps; length = source.arrivals.next_jump(length))
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

  /// Of a thread on a core of its own, or on the only one: a busy window begins with all cores' work of its level that is bound to the core.
  void bound_on_core(std::size_t i) {
    const Level level = level_of(i);
    const Ps busy = least_fixed_point(1, [&](Ps x) { return sum(level.blocking, work(i, x - 1, switching_), taken(level, x, {}, work(i, x - 1, 0))); });
    if (!is_bounded(busy)) return fail(i);
    const std::vector<Ps> instants = candidates(&level, i, busy);
    for (std::size_t k = 0; k < sources_[i].size(); ++k) {
      // From when it has begun and no more is left than this, nobody interrupts it.
      const Ps held = std::min(plan_of(i).non_preemptive.ps(), sources_[i][k].execution - 1);
      Ps ready = 1;
      for (const Ps released : instants) {
        const Ps own = work(i, released, 0);
        const Ps fixed = sum(level.blocking, work(i, released, switching_)) - held;
        // With deadlines, a later release lets more go first: windows only grow.
        ready = least_fixed_point(std::max(ready, fixed), [&](Ps x) { return std::max(x, sum(fixed, taken(level, x, released, own))); });
        if (!is_bounded(ready)) return fail(i);
        note(i, k, ready + held - released);
      }
    }
  }

  /// Of a thread that runs anywhere: the window begins with its own work, and while it waits all cores work for others.
  void bound_anywhere(std::size_t i) {
    std::vector<std::size_t> others;
    for (std::size_t j = 0; j < plan_.threads.size(); ++j)
      if (j != i && !sources_[j].empty() && goes_first(j, i)) others.push_back(j);
    const std::int64_t cores = plan_.cores;
    const auto needed = [&](Ps x, Ps own, std::int64_t own_jobs) {
      std::vector<Ps> works;
      Ps fair_work = own, switched = 0, own_switched = 0;
      for (const std::size_t j : others) {
        works.push_back(work_there(j, x));
        if (is_fair(j)) fair_work = sum(fair_work, works.back());
      }
      if (switching_ > 0) {
        std::int64_t n = 0;
        for (const std::size_t j : others) n = sum(n, jobs_there(j, x));
        const std::int64_t over = is_fair(i) ? sum(slices(fair_work), cores) : 0;
        own_switched = product(switching_, sum(own_jobs, n, over));
        switched = product(switching_, sum(n, n, n, cores, over, over));
      }
      // While it waits all cores are taken, each thread takes one at a time: with the k busiest aside, the others fill the remaining cores.
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
    const Ps busy = least_fixed_point(1, [&](Ps x) { return needed(x, work(i, x - 1, 0), jobs(i, x - 1)); });
    if (!is_bounded(busy)) return fail(i);
    Ps end = 1;
    for (const Ps released : candidates(nullptr, i, busy)) {
      const Ps own = work(i, released, 0);
      const std::int64_t own_jobs = jobs(i, released);
      end = least_fixed_point(std::max(end, own), [&](Ps x) { return std::max(x, needed(x, own, own_jobs)); });
      if (!is_bounded(end)) return fail(i);
      for (std::size_t k = 0; k < sources_[i].size(); ++k) note(i, k, end - released);
    }
  }

  void note(std::size_t i, std::size_t source, Ps response) {
    ThreadResponse& thread = result_.threads[i];
    thread.responses[source] = std::max(thread.responses[source], response);
    thread.response = std::max(thread.response, response);
  }
  void fail(std::size_t i, std::string reason = {}) {
    ThreadResponse& thread = result_.threads[i];
    thread.response = unbounded_ps;
    std::fill(thread.responses.begin(), thread.responses.end(), unbounded_ps);
    if (thread.reason.empty()) thread.reason = std::move(reason);
  }

  // --- All threads together ---

  void measure_load() {
    for (std::size_t i = 0; i < plan_.threads.size(); ++i) {
      ThreadResponse& thread = result_.threads[i];
      thread.responses.assign(sources_[i].size(), 0);
      for (const JobSource& source : sources_[i]) {
        thread.utilization += rate_of(source) * static_cast<double>(source.execution);
        // From below: no response is shorter.
        thread.response = std::max(thread.response, source.execution);
      }
      result_.total += thread.utilization;
      if (plan_of(i).core || plan_.cores == 1)
        result_.cores[plan_of(i).core.value_or(0)] += thread.utilization;
      else
        result_.anywhere += thread.utilization;
    }
  }

  /// Why nothing is to be had for thread i; empty: try.
  std::string doubt(std::size_t i) const {
    double load = 0;
    bool has_floating = false, has_bound = false, has_fair_floating = false;
    for (std::size_t j = 0; j < plan_.threads.size(); ++j) {
      if (sources_[j].empty()) continue;
      has_bound = has_bound || !is_floating(j);
      has_fair_floating = has_fair_floating || (is_floating(j) && is_fair(j));
      if (is_floating(i) && !goes_first(j, i) && longest_hold(j) > 0)
        return fmt::format("it runs on any core, and ends of jobs of thread \"{}\", which goes after it, are not interrupted", plan_of(j).name);
      if (!goes_first(j, i) || !(is_floating(i) || is_floating(j) || shares_core(j, i))) continue;
      has_floating = has_floating || is_floating(j);
      for (const JobSource& source : sources_[j]) {
        if (!source.arrivals.is_limited()) return fmt::format("any number of jobs may come for thread \"{}\"", plan_of(j).name);
        load += rate_of(source) * static_cast<double>(source.execution + (switching_ == 0 ? 0 : j == i ? switching_ : 2 * switching_));
      }
    }
    const double cores = is_floating(i) ? plan_.cores : 1;
    if (load > cores * (1 + 1e-9))
      return fmt::format("its jobs and those that go first take {:.1f} % of {}, with switching", 100 * load / cores, is_floating(i) ? "all cores" : "its core");
    if (is_fair(i) && switching_ > 0 && has_fair_floating && has_bound) return "fair threads, some of them bound to a core, move and switch from core to core in too many ways";
    return {};
  }

  void find_responses() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < plan_.threads.size(); ++i)
      if (!sources_[i].empty()) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return goes_first(a, b) && !goes_first(b, a); });
    for (const std::size_t i : order)
      if (std::string why = doubt(i); !why.empty()) fail(i, std::move(why));
    const bool is_one_pass = std::none_of(order.begin(), order.end(), [&](std::size_t i) { return is_floating(i); });
    // From below to the least solution. Once all hold, none can be the first to be late: it would have to wait for one that was late before.
    for (int round = 0;; ++round) {
      bool has_changed = false;
      for (const std::size_t i : order) {
        if (!result_.threads[i].is_decided()) continue;
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

  void conclude(std::size_t i) {
    ThreadResponse& thread = result_.threads[i];
    if (!thread.is_decided()) {
      if (thread.reason.empty()) thread.reason = reason_of_others(i);
      return;
    }
    std::int64_t most = 0;
    for (std::size_t k = 0; k < sources_[i].size(); ++k) most = sum(most, count_in(sources_[i][k], thread.responses[k] - 1));
    thread.most_outstanding = most;
    thread.loses_nothing = most <= plan_of(i).most_waiting;
  }
  std::string reason_of_others(std::size_t i) const {
    for (std::size_t j = 0; j < plan_.threads.size(); ++j)
      if (j != i && is_floating(j) && goes_first(j, i) && !result_.threads[j].is_decided() && !sources_[j].empty())
        return fmt::format("nothing is known of thread \"{}\", which may go first on any core", plan_of(j).name);
    return "the threads leave so little of the processor that no window was found in which all work is done";
  }

  const models::CpuPlan& plan_;
  std::vector<std::vector<JobSource>> sources_;
  Ps switching_;
  CpuResponses result_;
  int steps_ = 0;
};

}  // namespace

CpuResponses response_times(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& sources) {
  TAKT_CHECK(sources.size() == plan.threads.size(), "each thread has its sources");
  return Analysis(plan, sources).run();
}

}  // namespace takt::analysis
