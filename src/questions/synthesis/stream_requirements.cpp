// SPDX-License-Identifier: Apache-2.0
#include "synthesis/stream_requirements.hpp"

#include <algorithm>

#include "json/quantity.hpp"
#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"
#include "verify/bounds.hpp"

namespace takt::synthesis {
namespace {

using results::RequirementKind;

bool is_of_streams(const scenario::RequiredFigure& required) {
  static constexpr RequirementKind kinds[] = {RequirementKind::latency, RequirementKind::jitter,
                                              RequirementKind::dropped, RequirementKind::delivered};
  return std::ranges::find(kinds, required.taken_as) != std::end(kinds);
}

StreamRequirement judged(const scenario::RequiredFigure& required, const analysis::RequirementBound& bound,
                         const verify::Proof& proof) {
  StreamRequirement made;
  made.text = results::titled(required.name, required.text);
  made.stream = required.subject;
  made.bound = proof.time;
  made.limit = required.longest;
  made.reason = proof.reason;
  const bool exceeds = (made.bound && made.limit && *made.bound > *made.limit) ||
                       (bound.count && !required.limit.holds(static_cast<double>(*bound.count)));
  made.state = proof.holds ? StreamRequirement::State::kept
               : exceeds   ? StreamRequirement::State::broken
                           : StreamRequirement::State::unbounded;
  return made;
}

}  // namespace

std::vector<StreamRequirement> stream_requirements(const scenario::Resolved& resolved, const analysis::Bounds& bounds) {
  std::vector<results::RequirementResult> asked;
  for (std::size_t i = 0; i < resolved.requirements.size(); ++i) {
    if (!is_of_streams(resolved.requirements[i])) continue;
    asked.emplace_back();
    asked.back().requirement = i;
    asked.back().subject = resolved.requirements[i].subject;
  }
  const std::vector<verify::Proof> proofs = verify::prove(resolved, bounds, asked, {});
  std::vector<StreamRequirement> all;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::size_t index = *asked[i].requirement;
    all.push_back(judged(resolved.requirements[index], bounds.requirements[index], proofs[i]));
    all.back().requirement = index;
  }
  return all;
}

bool requires_of_streams(const scenario::Resolved& resolved) {
  return std::ranges::any_of(resolved.requirements, is_of_streams);
}

std::string first_broken(const std::vector<StreamRequirement>& requirements) {
  const auto broken = std::ranges::find(requirements, StreamRequirement::State::broken, &StreamRequirement::state);
  if (broken == requirements.end()) return {};
  return broken->text + ": " + (broken->bound ? "the bound is " + json::to_text(*broken->bound) : broken->reason);
}

Shortfall shortfall_of(const std::vector<StreamRequirement>& requirements) {
  Shortfall all;
  for (const StreamRequirement& each : requirements) {
    if (each.state != StreamRequirement::State::broken) continue;
    ++all.broken;
    all.excess += each.excess();
  }
  return all;
}

}  // namespace takt::synthesis
