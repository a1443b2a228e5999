// SPDX-License-Identifier: Apache-2.0
// What is said of each requirement: simulated maximum <= adversarial maximum <= analytic bound, and where the limit
// lies between them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verify/adversary.hpp"
#include "verify/bounds.hpp"
#include "verify/remedy.hpp"
#include "verify/slack.hpp"

namespace takt::verify {

enum class Conclusion : std::uint8_t {
  pass,           ///< proved: no run that the scenario allows exceeds the limit, and all that the proof rests on stands
  refuted,        ///< there is a run that exceeds it
  undecided,      ///< no run was found, and none is excluded
  contradiction,  ///< a run exceeds what was proved: a mistake of takt, nothing here is to be trusted
  reported,       ///< violations are reported only: nothing is proved, and nothing fails
  given,          ///< a promise of a data sheet that no run contradicts: nothing is proved of it
};
const char* name_of(Conclusion verdict);

struct Line {
  results::RequirementResult requirement;
  Conclusion verdict = Conclusion::undecided;
  std::optional<sim::Duration> simulated;
  std::optional<sim::Duration> adversarial;
  std::optional<sim::Duration> bound;
  std::string reason;                 ///< why it is not proved
  std::string remark;                 ///< how it is proved, where that is no bound
  std::string provided;               ///< of what is proved: the promises that it rests on; empty: none
  analysis::Assumptions assumptions;  ///< what the bound or proof rests on
  FoundRun worst;                     ///< the worst run; one that fails, if any does
  FoundRun longest;                   ///< the run that `adversarial` was measured in
  std::uint64_t runs = 0;
  Ended ended = Ended::interrupted;         ///< why there were no more
  bool exhaustive = false;                  ///< no run is worse than `adversarial`
  std::optional<std::uint64_t> violations;  ///< of a Program's invariants: the most in a run
  std::vector<SlackPart> slack;  ///< where the bound gives away what the worst run does not take, unless it is tight
  std::vector<WeightyPart>
      weighty;  ///< what took most of `adversarial`; only of what is not proved, and with Options::helps
  std::vector<Remedy> remedies;  ///< with what it could be proved; likewise
  /// adversarial / bound: at 1 the bound cannot be improved. Nothing without either.
  std::optional<double> tightness() const;
};

struct Verification {
  std::vector<Line> lines;
  analysis::AssumptionLedger ledger;  ///< after proofs and runs
  std::vector<FreeVariable> variables;
  std::uint64_t runs = 0;
  bool partial = false;  ///< interrupted: what has not been refuted or proved is undecided
  std::optional<Contradiction> contradiction;
  /// Contradiction if there is one, else refuted if one is, else undecided if one is, else pass if one is proved; of
  /// what is reported only reported.
  Conclusion verdict() const;
  /// "pass, if clocks are within 1us of the grandmaster".
  std::string verdict_text() const;
};

struct Options {
  SearchOptions search;
  ProofOptions proof;
  bool helps = false;  ///< say of what is not proved what would help
};

/// What follows from runs and proofs, one proof for each finding; `ledger` is that of the bounds, before any run.
Verification conclude(Search found, const std::vector<Proof>& proofs, const analysis::AssumptionLedger& ledger);

/// Prints nothing, and changes nothing but its result. All of it is within the budget of `options.search`: runs with
/// other seeds have a quarter of it at most, the search three quarters; states of the
/// handshake, replays of worst runs and the bounds of what would help have the rest. Once `options.search.interrupted`
/// says true it ends within a fraction of a second, and the result is partial.
Verification verify(const scenario::Resolved& resolved, const Options& options);

}  // namespace takt::verify
