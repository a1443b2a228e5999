// SPDX-License-Identifier: Apache-2.0
// The greatest or least level of a factor at which a condition still holds, by bisection.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/expression.hpp"
#include "study/plan.hpp"
#include "study/runner.hpp"

namespace takt::study {

/// A figure that the verification knows more of than a run shows: it lies between the worst that was found and the
/// bound.
struct VerifiedFigure {
  std::size_t measure = 0;  ///< of runs; in Plan::measures, as are the others
  std::size_t worst = 0;
  std::size_t bound = 0;
};

/// "max slaves such that reaction.start.max <= 1ms && pass"
struct Question {
  bool is_max = true;
  std::size_t factor = 0;
  std::optional<Expression> condition;
  std::vector<std::uint32_t> levels;     ///< of the factor, ascending by number
  Variant variant;                       ///< the others' levels: their baselines, or as `at` says
  std::vector<VerifiedFigure> verified;  ///< of the condition, or of the limits if it asks for "pass"
  std::optional<std::size_t> verdict;    ///< the measure of it, if the condition asks for "pass"
  bool is_verified() const { return !verified.empty() || verdict; }
};

/// Reads a question; adds measures to the plan: for figures that are not measures of the study (short forms of
/// measure.hpp), and for the worst found and the bound of each figure that has them, so that no answer rests on a few
/// runs where more is known. `at` are other factors' levels, "cycle=200us". Nothing and `problem` after a mistake.
std::optional<Question> read_question(Plan& plan, const std::string& text, const std::vector<std::string>& at,
                                      std::string& problem);

struct Finding {
  /// A verified figure at a level: the greatest of all replications, in its unit.
  struct Seen {
    std::optional<double> of_runs;
    std::optional<double> worst;  ///< none: some run has no such figure
    std::optional<double> bound;  ///< none: it is not bounded
  };
  struct Tried {
    std::uint32_t level = 0;
    std::uint32_t held = 0;  ///< of so many replications, by their runs alone
    std::uint32_t runs = 0;
    Truth truth = Truth::yes;  ///< of all replications: proved or held by all runs, undecided, refuted
    std::vector<Seen> seen;    ///< by Question::verified
    std::string trouble;       ///< of a run without a result
  };
  std::vector<Tried> tried;             ///< in the order of the levels
  std::optional<std::uint32_t> proved;  ///< the last level at which it holds for certain
  std::optional<std::uint32_t> open;    ///< the last at which nothing that was found breaks it
  /// The answer: `proved` or, if there is none, `open`. None: it holds at no level.
  std::optional<std::uint32_t> level() const { return proved ? proved : open; }
  bool is_at_end = false;   ///< it is the last level of the range
  bool is_monotone = true;  ///< what was tried does not contradict that it breaks once only
  double worst_share = 0;   ///< with 95 % confidence, at most this share of seeds breaks the condition at the answer
  bool interrupted = false;
  std::string problem;
};

/// A level holds if the condition does in every replication: for the bound of each figure that has one, and for the
/// runs of all else. It is refuted if the worst found breaks it. Bisection supposes that the condition breaks once only
/// along the levels.
Finding find(const Plan& plan, const Question& question, const RunOptions& options);

std::string text_of(const Plan& plan, const Question& question, const Finding& finding);

}  // namespace takt::study
