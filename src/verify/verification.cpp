#include "verify/verification.hpp"

#include <algorithm>
#include <utility>

namespace takt::verify {

const char* name_of(Conclusion verdict) {
  constexpr const char* names[] = {"pass", "refuted", "undecided", "contradiction"};
  return names[static_cast<std::size_t>(verdict)];
}

std::optional<double> Line::tightness() const {
  if (!adversarial || !bound || *bound <= sim::Duration()) return std::nullopt;
  return static_cast<double>(adversarial->ps()) / static_cast<double>(bound->ps());
}

Conclusion Verification::verdict() const {
  if (contradiction) return Conclusion::contradiction;
  Conclusion worst = partial ? Conclusion::undecided : Conclusion::pass;
  for (const Line& line : lines) {
    if (line.verdict == Conclusion::refuted) return Conclusion::refuted;
    if (line.verdict == Conclusion::undecided) worst = Conclusion::undecided;
  }
  return worst;
}

namespace {

/// The one place that says pass: the proof holds, and so does all that it rests on.
Line line_of(const Finding& finding, const Proof& proof, const analysis::AssumptionLedger& ledger) {
  Line line;
  line.requirement = finding.requirement;
  line.simulated = finding.simulated;
  line.adversarial = finding.longest.measured;
  const std::string objection = ledger.objection(proof.assumptions, proof.from);
  if (objection.empty()) line.bound = proof.time;   // what does not stand is no bound
  line.reason = proof.reason;
  line.remark = proof.remark;
  line.assumptions = proof.assumptions;
  line.worst = finding.worst.scenario;
  line.longest = finding.longest.scenario;
  line.runs = finding.runs;
  line.exhaustive = finding.exhaustive;
  if (finding.worst.failed)
    line.verdict = Conclusion::refuted;
  else if (proof.holds && objection.empty())
    line.verdict = Conclusion::pass;
  if (line.bound && line.requirement.limit && *line.bound > *line.requirement.limit)
    line.reason = finding.worst.failed ? "a run exceeds the limit" : "no run that was found exceeds the limit, but the bound does";
  if ((proof.holds || proof.time) && !objection.empty()) line.reason = objection;
  return line;
}

/// A requirement that is proved discharges what it says for others; one that a run refutes withdraws it.
void settle(analysis::AssumptionLedger& ledger, const std::vector<Violation>& violations) {
  for (const Violation& violation : violations) ledger.violate(violation.assumption, violation.witness);
}

/// A proof that stands, of a requirement that a run has failed.
std::optional<Contradiction> contradiction_of(const Line& line, const Finding& finding, const Proof& proof, const analysis::AssumptionLedger& ledger) {
  if (line.verdict != Conclusion::refuted || !proof.holds || !ledger.objection(proof.assumptions, proof.from).empty()) return std::nullopt;
  // A bound says how long a reaction or a frame takes, not that there is one: a requirement that fails for want of it is refuted, and that is all.
  if (line.requirement.limit && !finding.worst.measured) return std::nullopt;
  if (line.requirement.figure && !finding.worst.figure) return std::nullopt;   // likewise
  return Contradiction{line.requirement.text + ": a run fails what is proved", finding.worst.scenario};
}

/// What is not tight is looked at again, once nothing speaks against the bounds.
void add_slack(Verification& result, const analysis::Bounds& bounds, const std::function<bool()>& interrupted) {
  if (result.contradiction) return;
  for (Line& line : result.lines)
    if (const std::optional<double> tightness = line.tightness(); tightness && !is_tight(line.requirement.kind, *tightness))
      line.slack = slack_of({line.requirement, *line.adversarial, *line.bound, line.longest}, bounds, interrupted);
}

void add_help(Verification& result, const scenario::Resolved& resolved, const std::function<bool()>& interrupted) {
  if (result.contradiction || result.partial) return;
  for (Line& line : result.lines) {
    if (line.verdict == Conclusion::pass) continue;
    if (line.adversarial) line.weighty = weightiest_parts(line.longest, line.requirement, *line.adversarial, interrupted);
    line.remedies = remedies_for(resolved, line.requirement, interrupted);
  }
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
  for (std::size_t i = 0; i < found.findings.size(); ++i) {
    result.lines.push_back(line_of(found.findings[i], proofs[i], result.ledger));
    if (!result.contradiction) result.contradiction = contradiction_of(result.lines.back(), found.findings[i], proofs[i], result.ledger);
  }
  return result;
}

Verification verify(const scenario::Resolved& resolved, const Options& options) {
  const analysis::Bounds bounds = analysis::bound(resolved);
  Search found = search(resolved, bounds, options.search);
  std::vector<results::RequirementResult> requirements;
  for (const Finding& finding : found.findings) requirements.push_back(finding.requirement);
  const std::vector<Proof> proofs = prove(resolved, bounds, requirements, options.proof);
  Verification result = conclude(std::move(found), proofs, bounds.ledger);
  add_slack(result, bounds, options.search.interrupted);
  if (options.helps) add_help(result, resolved, options.search.interrupted);
  return result;
}

}  // namespace takt::verify
