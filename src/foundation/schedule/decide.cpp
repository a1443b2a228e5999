// SPDX-License-Identifier: Apache-2.0
#include "schedule/decide.hpp"

#include <algorithm>

#include "schedule/clausal.hpp"
#include "schedule/gate_lists.hpp"
#include "schedule/refute.hpp"

namespace takt::schedule {
namespace {

constexpr std::uint32_t first_attempts = 2;

std::int64_t longest_list(const Problem& problem, const Solution& solution) {
  Solution with_lists = solution;
  if (make_gate_lists(problem, with_lists, {})) return longest_time;
  return static_cast<std::int64_t>(most_entries(with_lists));
}

/// True: the problem is refuted. A certificate that the judge rejects refutes nothing.
bool is_refuted(const Problem& problem, const SearchOptions& options, std::optional<Certificate> certificate,
                Decision& decision) {
  if (!certificate) return false;
  if (std::string why = options.judge ? options.judge(problem, *certificate) : std::string(); !why.empty()) {
    decision.rejected.push_back(std::move(why));
    return false;
  }
  decision.certificate = std::move(certificate);
  decision.verdict = Decision::Verdict::infeasible;
  return true;
}

/// Attempts and proofs in turn, more of both each time: who was moved most often is tried in proofs, and placed first
/// by the next attempts.
void search_or_refute(const Problem& problem, const SearchOptions& options, Decision& decision) {
  SearchOptions now = options;
  ClausalEffort effort;
  for (std::uint32_t round = 0;; ++round) {
    // Scores compare attempts of one search.
    now.attempts =
        options.score ? options.attempts : std::min(options.attempts, first_attempts << std::min(2 * round, 24u));
    SearchResult found = search(problem, now);
    const bool is_better = round == 0 || found.left_over.size() < decision.found.left_over.size();
    now.hardness = std::move(found.hardness);
    if (is_better) decision.found = std::move(found);
    if (decision.found.is_complete() || options.stop()) return;
    // Where many are left over a proof is more likely than a schedule, where few are, a schedule.
    const std::size_t left = decision.found.left_over.size(), all = problem.streams.size();
    ClausalEffort here = effort;
    if (left * 7 > all) here.most_clauses *= 4;
    const bool may_refute = round > 0 || left * 50 > all;
    if (may_refute &&
        is_refuted(problem, options, refute_by_clauses(problem, now.hardness, here, options.stop), decision))
      return;
    if (now.attempts >= options.attempts || options.stop()) return;
    now.first = now.attempts;
    effort.conflicts = std::min<std::uint32_t>(effort.conflicts * 4, 1u << 24);
    effort.most_thresholds *= 2;
    effort.most_clauses *= 4;
  }
}

Decision decide_without_reduction(const Problem& problem, const SearchOptions& options) {
  Decision decision;
  decision.how = "first fit";
  decision.margin = problem.model.margin;
  if (!options.score) decision.found = place_once(problem, options);
  if (options.score || !decision.found.is_complete()) {
    if (is_refuted(problem, options, refute(problem, options.stop), decision)) return decision;
    decision.how = "search";
    search_or_refute(problem, options, decision);
    if (decision.certificate) return decision;
  }
  if (decision.found.is_complete()) decision.verdict = Decision::Verdict::scheduled;
  return decision;
}

/// Doubles the margin until nothing is found, then halves the difference, to the ns.
Decision decide_with_slack(Problem problem, SearchOptions options) {
  Decision best = decide_without_reduction(problem, options);
  if (best.verdict != Decision::Verdict::scheduled) return best;
  constexpr Ps ns = 1'000;
  options.attempts = std::min<std::uint32_t>(options.attempts, 4);
  const auto try_margin = [&](Ps margin) {
    problem.model.margin = margin;
    Decision decision = decide_without_reduction(problem, options);
    if (decision.verdict != Decision::Verdict::scheduled) return false;
    best = std::move(decision);
    return true;
  };
  Ps good = problem.model.margin, step = ns;
  while (step < longest_time / 4 && try_margin(good + step)) good += step, step *= 2;
  for (step /= 2; step >= ns && !options.stop(); step /= 2)
    if (try_margin(good + step)) good += step;
  return best;
}

}  // namespace

Ps sum_of_latencies(const Problem& problem, const Solution& solution) {
  const Timing timing(problem, solution.timing);
  Ps sum = 0;
  for (StreamIndex s = 0; s < solution.streams.size(); ++s) {
    if (!solution.streams[s]) continue;
    const Placement& placement = *solution.streams[s];
    const Stream& stream = problem.streams[s];
    Ps longest = 0;
    for (std::size_t k = 0; k < placement.starts.front().size(); ++k) {
      Ps begin = longest_time;
      for (std::size_t hop = 0; hop < placement.route.size(); ++hop)
        if (problem.links[placement.route[hop]].from == stream.talker)
          begin = std::min(begin, placement.starts[hop][k]);
      for (std::size_t hop = 0; hop < placement.route.size(); ++hop) {
        const Link& link = problem.links[placement.route[hop]];
        if (std::find(stream.listeners.begin(), stream.listeners.end(), link.to) == stream.listeners.end()) continue;
        longest = std::max(longest, placement.starts[hop][k] + timing.to_listener(stream, link) - begin);
      }
    }
    sum += longest;
  }
  return sum;
}

Decision decide(const Problem& problem, const SearchOptions& options, Objective objective) {
  SearchOptions with = options;
  if (objective == Objective::latency)
    with.score = [&problem](const Solution& solution) { return sum_of_latencies(problem, solution); };
  if (objective == Objective::entries)
    with.score = [&problem](const Solution& solution) { return longest_list(problem, solution); };
  return objective == Objective::slack ? decide_with_slack(problem, with) : decide_without_reduction(problem, with);
}

}  // namespace takt::schedule
