#include "verify/sandwich.hpp"

#include <algorithm>

#include "scenario/json/quantity.hpp"

namespace takt::verify {

const char* name_of(Verdict verdict) {
  constexpr const char* names[] = {"pass", "refuted", "undecided"};
  return names[static_cast<std::size_t>(verdict)];
}

std::optional<double> Line::tightness() const {
  if (!adversarial || !bound || *bound <= sim::Duration()) return std::nullopt;
  return static_cast<double>(adversarial->ps()) / static_cast<double>(bound->ps());
}

Verdict Verification::verdict() const {
  Verdict worst = partial ? Verdict::undecided : Verdict::pass;
  for (const Line& line : lines) {
    if (line.verdict == Verdict::refuted) return Verdict::refuted;
    if (line.verdict == Verdict::undecided) worst = Verdict::undecided;
  }
  return worst;
}

namespace {

Line line_of(const Finding& finding, const Proved& proved) {
  Line line;
  line.requirement = finding.requirement;
  line.simulated = finding.simulated;
  line.adversarial = finding.worst.measured;
  line.bound = proved.time;
  line.reason = proved.reason;
  line.assumptions = proved.assumptions;
  line.worst = finding.worst.scenario;
  line.runs = finding.runs;
  line.exhaustive = finding.exhaustive;
  const bool is_proved = proved.time ? finding.requirement.limit && *proved.time <= *finding.requirement.limit : proved.holds;
  if (finding.worst.failed)
    line.verdict = Verdict::refuted;
  else if (is_proved)
    line.verdict = Verdict::pass;
  const bool exceeds = proved.time && finding.requirement.limit && *proved.time > *finding.requirement.limit;
  if (exceeds && line.reason.empty()) line.reason = finding.worst.failed ? "a run exceeds the limit" : "no run that was found exceeds the limit, but the bound does";
  return line;
}

/// A run that no bound allows; empty if there is none.
std::string contradiction_of(const Line& line) {
  if (line.bound && line.adversarial && *line.adversarial > *line.bound)
    return line.requirement.text + ": a run took " + scenario::json::to_text(*line.adversarial) + ", the bound is " + scenario::json::to_text(*line.bound);
  return {};
}

}  // namespace

Verification verify(const scenario::Resolved& resolved, const Options& options) {
  Verification result;
  Search found = search(resolved, options.search);
  result.freedoms = std::move(found.freedoms);
  result.runs = found.runs;
  result.partial = found.partial;
  std::vector<results::RequirementResult> requirements;
  for (const Finding& finding : found.findings) requirements.push_back(finding.requirement);
  const std::vector<Proved> proofs = prove(resolved, requirements, options.proof);
  for (std::size_t i = 0; i < found.findings.size(); ++i) {
    result.lines.push_back(line_of(found.findings[i], proofs[i]));
    if (result.contradiction.empty()) result.contradiction = contradiction_of(result.lines.back());
  }
  return result;
}

}  // namespace takt::verify
