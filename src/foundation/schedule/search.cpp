// SPDX-License-Identifier: Apache-2.0
#include "schedule/search.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "schedule/attempt.hpp"

namespace takt::schedule {
namespace {

/// 1, 1, 2, 1, 1, 2, 4, ...: no attempt that is long costs more than all short ones together.
std::uint64_t luby(std::uint64_t i) {
  for (std::uint64_t power = 1;; power *= 2) {
    if (i == 2 * power - 2) return power;
    if (i < 2 * power - 2) return luby(i - (power - 1));
  }
}

SearchResult result_of(Attempt& attempt, std::uint32_t number) {
  SearchResult result;
  result.solution = attempt.solution();
  result.left_over = attempt.left_over();
  result.attempt = number;
  result.steps = attempt.steps();
  return result;
}

}  // namespace

SearchResult place_once(const Problem& problem, const SearchOptions& options) {
  const Ground ground(problem, options);
  Attempt attempt(ground, 0);
  attempt.place_all_once();
  return result_of(attempt, 0);
}

SearchResult search(const Problem& problem, const SearchOptions& options) {
  const Ground ground(problem, options);
  std::mutex mutex;
  SearchResult best;
  bool has_any = false;
  std::size_t best_count = 0;
  std::int64_t best_score = 0;
  std::vector<std::uint64_t> hardness = options.hardness;
  hardness.resize(problem.streams.size());
  std::atomic<std::uint32_t> next = options.first;
  std::atomic<std::uint32_t> end = options.attempts;  // attempts from this number on cannot count any more
  // The first two are short: what they do not find soon the others, which may wait, find sooner.
  const auto steps_of = [&](std::uint32_t number) {
    return std::max<std::uint64_t>(300, (number < 2 ? 1 : 6) * problem.streams.size()) * luby(number / 2);
  };
  const auto note = [&](Attempt& attempt, std::uint32_t number, bool done) {
    const std::lock_guard lock(mutex);
    for (StreamIndex s = 0; s < hardness.size(); ++s) hardness[s] += attempt.prices()[s] - 1;
    if (done) {
      if (number >= end) return;
      const std::int64_t score = options.score ? options.score(attempt.solution()) : 0;
      end = std::min<std::uint32_t>(end, options.score ? std::max(options.scored, number + 1) : number + 1);
      // What counted before may do so no longer.
      const bool is_first = !has_any || !best.is_complete() || best.attempt >= end;
      if (is_first || score < best_score || (score == best_score && number < best.attempt))
        best = result_of(attempt, number), best_score = score;
    } else if (!has_any || (!best.is_complete() && (attempt.most_placed() > best_count ||
                                                    (attempt.most_placed() == best_count && number < best.attempt)))) {
      best = result_of(attempt, number);
      best_count = attempt.most_placed();
    }
    has_any = true;
  };
  const auto work = [&] {
    for (;;) {
      const std::uint32_t number = next++;
      if (number >= end || (number > options.first && options.stop())) return;
      Attempt attempt(ground, number);
      const bool done = attempt.run(steps_of(number), [&] { return number >= end || options.stop(); });
      note(attempt, number, done);
    }
  };
  // What a thread throws ends the others and is thrown again here.
  std::exception_ptr failure;
  const auto work_and_catch = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      end = 0;
    }
  };
  {
    std::vector<std::jthread> others;  // joined also where the machine gives no further one
    for (unsigned i = 1; i < options.jobs; ++i) others.emplace_back(work_and_catch);
    work_and_catch();
  }
  if (failure) std::rethrow_exception(failure);
  best.hardness = std::move(hardness);
  return best;
}

}  // namespace takt::schedule
