// SPDX-License-Identifier: Apache-2.0
// The runs of a search: choices are run within the budget, and of each requirement the worst one is kept.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "verify/adversary.hpp"
#include "verify/budget.hpp"
#include "verify/meeting_log.hpp"
#include "verify/probe.hpp"

namespace takt::verify {

class Trials {
 public:
  /// All outlive it.
  Trials(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const SearchOptions& options,
         Budget& budget);

  /// First: the scenario as it is. The first run is made whatever it costs, those with other seeds within the budget.
  /// False if it was interrupted.
  bool run_baseline();
  /// From now on runs are those of the scenario with less waiting, where it shows the same.
  void shorten();
  /// From now on runs are made for this requirement, and may cost so many events.
  void begin(std::size_t line, std::uint64_t events);

  /// Runs as many of the choices as are affordable; of each that was run how bad it is for the requirement, the greater
  /// the worse.
  std::vector<std::int64_t> try_all(const std::vector<Choice>& choices);
  /// A choice that was run, once more, and which frames met in it. Nothing if it was interrupted, or there were too
  /// many.
  std::optional<std::vector<MeetingLog::Visit>> meetings_of(const Choice& choice);
  /// The worst choice for the requirement, once more in full length where runs are shorter.
  void run_in_full();

  bool is_affordable() const { return !is_interrupted() && !is_at_bound() && budget_.spent() + cost_of_run_ <= limit_; }
  std::uint64_t affordable_runs() const {
    return (limit_ - std::min(limit_, budget_.spent())) / std::max<std::uint64_t>(1, cost_of_run_);
  }
  bool is_interrupted() const { return search_.partial || budget_.is_interrupted(); }
  /// No run can be worse than what was found: it reaches the bound, but for the instant by which one frame comes before
  /// another.
  bool is_at_bound() const;
  /// Whether the bound shows that the requirement holds.
  bool is_proved(std::size_t line) const;
  /// Runs with another seed are the same.
  bool is_without_chance() const { return is_without_chance_; }

  std::size_t line() const { return line_; }
  Choice as_it_is() const { return {ground_->whole.seed, std::vector<sim::Duration>(ground_->variables.size())}; }
  const results::RequirementResult& requirement() const { return search_.findings[line_].requirement; }
  const std::optional<std::pair<std::int64_t, Choice>>& best() const { return best_; }
  const Ground& ground() const { return *ground_; }
  Search& search() { return search_; }
  const Search& search() const { return search_; }

 private:
  const analysis::RequirementBound* standing_bound(std::size_t line) const;
  void note(const Probe& probe, const FoundRun& run, bool is_as_it_is = false);
  bool run_seeds(unsigned from, unsigned many);
  bool loses_too_much(const Choice& choice, const Probe& probe) const;
  bool shows_the_same(const Probe& part) const;
  bool adopt_shorter(scenario::Scenario shorter);
  std::int64_t badness(const Probe& probe) const;
  FoundRun run_of(const Choice& choice) const { return {ground_, std::make_shared<const Choice>(choice), is_shorter_}; }

  const scenario::Resolved& resolved_;
  const analysis::Bounds& bounds_;
  const SearchOptions& options_;
  Budget& budget_;
  std::shared_ptr<Ground> ground_;
  Search search_;
  std::optional<Probe> as_it_is_;  // with the scenario's seed, in full length
  bool is_shorter_ = false;
  bool is_without_chance_ = false;
  unsigned digests_differ_ = 0;  // runs with other seeds that did
  std::size_t line_ = 0;
  std::uint64_t limit_ = 0;  // of what may be spent in all
  std::uint64_t cost_of_run_ = 1;
  std::optional<std::pair<std::int64_t, Choice>> best_;  // of the search for the present requirement
};

}  // namespace takt::verify
