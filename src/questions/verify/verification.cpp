// SPDX-License-Identifier: Apache-2.0
#include "verify/verification.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace takt::verify {

const char* name_of(Conclusion verdict) {
  constexpr const char* names[] = {"pass", "refuted", "undecided", "contradiction", "reported", "given"};
  return names[static_cast<std::size_t>(verdict)];
}

std::optional<double> Line::tightness() const {
  if (!adversarial || !bound || *bound <= sim::Duration()) return std::nullopt;
  return static_cast<double>(adversarial->ps()) / static_cast<double>(bound->ps());
}

Conclusion Verification::verdict() const {
  if (contradiction) return Conclusion::contradiction;
  const auto is_any = [&](Conclusion verdict) {
    return std::ranges::any_of(lines, [&](const Line& line) { return line.verdict == verdict; });
  };
  if (is_any(Conclusion::refuted)) return Conclusion::refuted;
  if (partial || is_any(Conclusion::undecided)) return Conclusion::undecided;
  if (is_any(Conclusion::pass)) return Conclusion::pass;
  return is_any(Conclusion::reported) ? Conclusion::reported
         : is_any(Conclusion::given)  ? Conclusion::given
                                      : Conclusion::pass;
}

std::string Verification::verdict_text() const {
  std::set<std::string> provided;
  if (verdict() == Conclusion::pass)
    for (const Line& line : lines)
      if (!line.provided.empty()) provided.insert(line.provided);
  std::string text = name_of(verdict());
  for (const std::string& each : provided) text += (each == *provided.begin() ? ", if " : " and ") + each;
  return text;
}

namespace {

/// Which of the assumptions nothing but a data sheet promises.
std::string promises_in(const analysis::Assumptions& assumptions, const analysis::AssumptionLedger& ledger) {
  std::string text;
  for (const analysis::Assumption each : assumptions.list())
    if (ledger[each].standing == analysis::Standing::condition && !analysis::is_condition(each))
      text += (text.empty() ? "" : " and ") + ledger[each].text;
  return text;
}

/// The one place that says pass: the proof holds, and so does all that it rests on.
Line line_of(const Finding& finding, const Proof& proof, const analysis::AssumptionLedger& ledger) {
  Line line;
  line.requirement = finding.requirement;
  line.simulated = finding.simulated;
  line.adversarial = finding.longest.measured;
  const std::string objection = ledger.objection(proof.assumptions, proof.from);
  if (objection.empty()) line.bound = proof.time;  // what does not stand is no bound
  line.reason = proof.reason;
  line.remark = proof.remark;
  line.assumptions = proof.assumptions;
  line.worst = finding.worst.run;
  line.longest = finding.longest.run;
  line.runs = finding.runs;
  line.ended = finding.ended;
  line.exhaustive = finding.exhaustive;
  if (finding.requirement.kind == results::RequirementKind::invariants) line.violations = finding.broken;
  if (proof.is_reported_only) {
    line.verdict = Conclusion::reported;
    return line;
  }
  if (finding.worst.failed)
    line.verdict = Conclusion::refuted;
  else if (proof.is_given)
    line.verdict = Conclusion::given;
  else if (proof.holds && objection.empty())
    line.verdict = Conclusion::pass;
  if (line.bound && line.requirement.limit && *line.bound > *line.requirement.limit)
    line.reason = finding.worst.failed ? "a run exceeds the limit"
                                       : "no run that was found exceeds the limit, but the bound does";
  if ((proof.holds || proof.time) && !objection.empty()) line.reason = objection;
  if (line.verdict == Conclusion::pass) line.provided = promises_in(proof.assumptions, ledger);
  return line;
}

/// A requirement that is proved discharges what it says for others; one that a run refutes withdraws it.
void settle(analysis::AssumptionLedger& ledger, const std::vector<Violation>& violations) {
  for (const Violation& violation : violations) ledger.violate(violation.assumption, violation.witness);
}

/// A run fails what a proof says. A bound says how long a reaction or a frame takes, not that there is one: a
/// requirement that fails for want of it is refuted, and that is all. Likewise a figure.
bool fails_what_is_said(const Finding& finding, const Proof& proof) {
  if (!finding.worst.failed || !proof.holds) return false;
  if (finding.requirement.limit && !finding.worst.measured) return false;
  return !finding.requirement.figure || finding.worst.figure;
}

/// A run that fails what is proved on a promise of a data sheet shows that the promise is not kept.
void withdraw_promises(analysis::AssumptionLedger& ledger, const std::vector<Finding>& findings,
                       const std::vector<Proof>& proofs) {
  for (std::size_t i = 0; i < findings.size(); ++i) {
    if (!fails_what_is_said(findings[i], proofs[i])) continue;
    for (const analysis::Assumption each : proofs[i].assumptions.list())
      if (each == analysis::Assumption::drained && ledger[each].standing == analysis::Standing::condition)
        ledger.violate(each, "a run fails " + results::titled(findings[i].requirement));
  }
}

/// A proof that stands, of a requirement that a run has failed.
std::optional<Contradiction> contradiction_of(const Line& line, const Finding& finding, const Proof& proof,
                                              const analysis::AssumptionLedger& ledger) {
  if (line.verdict != Conclusion::refuted || !fails_what_is_said(finding, proof)) return std::nullopt;
  if (!ledger.objection(proof.assumptions, proof.from).empty()) return std::nullopt;
  return Contradiction{results::titled(line.requirement) + ": a run fails what is proved",
                       finding.worst.run.scenario()};
}

/// Of the runs that the explanation of a line takes.
constexpr std::uint64_t replays = 4;

/// What is not tight is looked at again, once nothing speaks against the bounds.
void add_slack(Verification& result, const analysis::Bounds& bounds, Budget& budget, std::uint64_t cost_of_run) {
  if (result.contradiction) return;
  for (Line& line : result.lines) {
    const std::optional<double> tightness = line.tightness();
    if (!tightness || is_tight(line.requirement.kind, *tightness) || budget.is_interrupted() ||
        budget.left() < replays * cost_of_run)
      continue;
    budget.spend(replays / 2 * cost_of_run);
    line.slack = slack_of({line.requirement, *line.adversarial, *line.bound, line.longest.scenario()}, bounds,
                          budget.interrupted());
  }
}

void add_help(Verification& result, const scenario::Resolved& resolved, const analysis::Bounds& bounds, unsigned seeds,
              Budget& budget, std::uint64_t cost_of_run) {
  if (result.contradiction || result.partial) return;
  for (Line& line : result.lines) {
    if (line.verdict != Conclusion::refuted && line.verdict != Conclusion::undecided) continue;
    if (line.adversarial && budget.left() >= replays * cost_of_run) {
      budget.spend(replays / 2 * cost_of_run);
      line.weighty =
          weightiest_parts(line.longest.scenario(), line.requirement, *line.adversarial, budget.interrupted());
    }
    RemedyQuestion question{line.requirement, bounds, {}, seeds, cost_of_run};
    for (const FoundRun& run : {line.worst, line.longest})
      if (run) question.worst.push_back(run);
    line.remedies = remedies_for(resolved, question, budget);
  }
}

/// Those that are asked for; all if nothing is said.
void keep(std::vector<Finding>& findings, const std::vector<bool>& asked) {
  if (asked.empty()) return;
  std::vector<Finding> kept;
  for (std::size_t i = 0; i < findings.size(); ++i)
    if (asked[i]) kept.push_back(std::move(findings[i]));
  findings = std::move(kept);
}

/// How many states of the handshake may be looked at: some whatever the budget, and others for twenty events each.
std::uint64_t states_within(const Budget& budget, std::uint64_t wanted) {
  constexpr std::uint64_t always = 200'000;
  constexpr std::uint64_t events_of_a_state = 20;
  return std::min(wanted, always + budget.left() / events_of_a_state);
}

}  // namespace

Verification conclude(Search found, const std::vector<Proof>& proofs, const analysis::AssumptionLedger& ledger) {
  Verification result;
  result.variables = std::move(found.variables);
  result.runs = found.runs;
  result.partial = found.partial;
  result.contradiction = std::move(found.contradiction);
  result.ledger = ledger;
  settle(result.ledger, found.violations);
  withdraw_promises(result.ledger, found.findings, proofs);
  for (std::size_t i = 0; i < found.findings.size(); ++i) {
    result.lines.push_back(line_of(found.findings[i], proofs[i], result.ledger));
    if (!result.contradiction)
      result.contradiction = contradiction_of(result.lines.back(), found.findings[i], proofs[i], result.ledger);
  }
  return result;
}

Verification verify(const scenario::Resolved& resolved, const Options& options) {
  Budget budget(options.search.events, options.search.interrupted);
  const analysis::Bounds bounds = analysis::bound(resolved, {.interrupted = options.search.interrupted});
  if (bounds.is_interrupted) {
    Verification none;
    none.ledger = bounds.ledger;
    none.partial = true;
    return none;
  }
  Search found = search(resolved, bounds, options.search, budget);
  keep(found.findings, options.search.asked);
  const std::uint64_t cost_of_run = found.cost_of_run;
  std::vector<results::RequirementResult> requirements;
  for (const Finding& finding : found.findings) requirements.push_back(finding.requirement);
  ProofOptions proof = options.proof;
  proof.states = states_within(budget, proof.states);
  if (!proof.interrupted) proof.interrupted = options.search.interrupted;
  const std::vector<Proof> proofs = prove(resolved, bounds, requirements, proof);
  Verification result = conclude(std::move(found), proofs, bounds.ledger);
  add_slack(result, bounds, budget, cost_of_run);
  if (options.helps) add_help(result, resolved, bounds, options.search.seeds, budget, cost_of_run);
  result.partial = result.partial || budget.is_interrupted();
  return result;
}

}  // namespace takt::verify
