// SPDX-License-Identifier: Apache-2.0
#include "study/runner.hpp"

#include <fmt/format.h>

#include <map>

#include "study/pool.hpp"
#include "study/spread_order.hpp"

namespace takt::study {
namespace {

Outcome outcome_of(const Answer& answer) {
  if (answer.kind == Answer::Kind::answered)
    if (auto outcome = unpacked(answer.text)) return *outcome;
  Outcome outcome;
  switch (answer.kind) {
    case Answer::Kind::too_long:
      outcome.status = Status::too_long;
      break;
    case Answer::Kind::too_large:
      outcome.status = Status::too_large;
      break;
    case Answer::Kind::died:
    case Answer::Kind::answered:
      outcome.status = Status::failed;
      break;
  }
  outcome.error = answer.text;
  return outcome;
}

JobLimits limits_of(const Plan& plan) { return {plan.study.effort.cpu, plan.study.effort.memory.count}; }

/// Mistakes of many variants, each told once.
class Mistakes {
 public:
  void add(const Plan& plan, std::size_t variant, const std::string& text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string line = text.substr(begin, end - begin);
      const auto [found, is_new] = known_.emplace(line, Kept{name_of(plan, plan.variants[variant]), 0, order_.size()});
      if (is_new) order_.push_back(line);
      ++found->second.count;
      begin = end + 1;
    }
  }
  std::string text() const {
    constexpr std::size_t most_lines = 20;
    std::string text;
    for (std::size_t i = 0; i < std::min(order_.size(), most_lines); ++i) {
      const Kept& kept = known_.at(order_[i]);
      text += order_[i] + "\n  in the variant " + kept.first +
              (kept.count > 1 ? fmt::format(", and {} more", kept.count - 1) : "") + "\n";
    }
    if (order_.size() > most_lines) text += fmt::format("{} more\n", order_.size() - most_lines);
    return text;
  }

 private:
  struct Kept {
    std::string first;
    std::size_t count;
    std::size_t order;
  };
  std::map<std::string, Kept> known_;
  std::vector<std::string> order_;
};

}  // namespace

std::string validate(const Plan& plan, const RunOptions& options, const std::vector<bool>& finished) {
  std::vector<std::size_t> variants;
  for (std::uint64_t point = 0; point < plan.points(); ++point)
    if (!finished[point] && options.shard.has(point) && (variants.empty() || variants.back() != plan.variant_of(point)))
      variants.push_back(plan.variant_of(point));
  std::map<std::size_t, std::string> mistakes;
  std::uint64_t done = 0;
  std::size_t next = 0;
  Pool pool(options.jobs, limits_of(plan), [&](std::uint64_t variant) { return mistakes_of(plan, variant); });
  const std::string problem = pool.run(
      [&]() -> std::optional<std::uint64_t> {
        return next < variants.size() ? std::optional(std::uint64_t{variants[next++]}) : std::nullopt;
      },
      [&](std::uint64_t variant, const Answer& answer) {
        ++done;
        // What a variant's size costs is found again when it runs, and is then a row.
        if (answer.kind == Answer::Kind::answered && !answer.text.empty()) mistakes[variant] = answer.text;
        return true;
      },
      [&] {
        if (options.progress) options.progress("checking", done, variants.size());
        return !options.interrupted || !options.interrupted();
      });
  if (!problem.empty()) return problem + "\n";
  if (mistakes.empty() || (plan.study.impossible == Impossible::recorded && mistakes.size() < variants.size()))
    return {};
  Mistakes told;
  for (const auto& [variant, text] : mistakes) told.add(plan, variant, text);
  return told.text();
}

RunSummary run_study(const Plan& plan, Store& store, const RunOptions& options, const std::vector<bool>& finished) {
  RunSummary summary;
  const auto is_wanted = [&](std::uint64_t point) { return !finished[point] && options.shard.has(point); };
  std::uint64_t wanted = 0;
  for (std::uint64_t point = 0; point < plan.points(); ++point) wanted += is_wanted(point) ? 1 : 0;
  const SpreadOrder order(plan.points());
  std::uint64_t next = 0;  // in that order
  Pool pool(options.jobs, limits_of(plan),
            [&](std::uint64_t point) { return packed(run_point(plan, point, options.threads)); });
  const std::string problem = pool.run(
      [&]() -> std::optional<std::uint64_t> {
        while (next < plan.points() && !is_wanted(order[next])) ++next;
        return next < plan.points() ? std::optional(order[next++]) : std::nullopt;
      },
      [&](std::uint64_t point, const Answer& answer) {
        const Outcome outcome = outcome_of(answer);
        summary.problem = store.add(plan, point, outcome);
        if (!summary.problem.empty()) return false;
        ++summary.ran;
        summary.troubled += outcome.status == Status::done ? 0 : 1;
        return true;
      },
      [&] {
        if (options.progress) options.progress("running", summary.ran, wanted);
        summary.interrupted = options.interrupted && options.interrupted();
        return !summary.interrupted;
      });
  if (summary.problem.empty()) summary.problem = problem;
  return summary;
}

}  // namespace takt::study
