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

/// "max slaves such that reaction.start.max <= 1ms && pass"
struct Question {
  bool is_max = true;
  std::size_t factor = 0;
  std::optional<Expression> condition;
  std::vector<std::uint32_t> levels;    ///< of the factor, ascending by number
  Variant variant;                      ///< the others' levels: their baselines, or as `at` says
};

/// Reads a question; adds measures to the plan for figures that are not measures of the study (short forms of measure.hpp).
/// `at` are other factors' levels, "cycle=200us". Nothing and `problem` after a mistake.
std::optional<Question> read_question(Plan& plan, const std::string& text, const std::vector<std::string>& at, std::string& problem);

struct Finding {
  struct Tried {
    std::uint32_t level = 0;
    std::uint32_t held = 0;             ///< of so many replications
    std::uint32_t runs = 0;
    std::string trouble;                ///< of a run without a result
  };
  std::vector<Tried> tried;             ///< in the order of the levels
  std::optional<std::uint32_t> level;   ///< the answer; none: it holds at no level
  bool is_at_end = false;               ///< it holds at the last level too
  bool is_monotone = true;              ///< what was tried does not contradict that it breaks once only
  double worst_share = 0;               ///< with 95 % confidence, at most this share of seeds breaks the condition at the answer
  bool interrupted = false;
  std::string problem;
};

/// A level holds if the condition does in every replication. Bisection supposes that the condition breaks once only along the levels.
Finding find(const Plan& plan, const Question& question, const RunOptions& options);

std::string text_of(const Plan& plan, const Question& question, const Finding& finding);

}  // namespace takt::study
