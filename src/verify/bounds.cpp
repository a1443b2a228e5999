#include "verify/bounds.hpp"

#include <algorithm>
#include <map>

#include "analysis/bounds.hpp"
#include "explore/search.hpp"

namespace takt::verify {
namespace {

using results::RequirementKind;
using results::RequirementResult;
using sim::Duration;

std::vector<std::string> texts_of(const analysis::Assumptions& assumptions) {
  std::vector<std::string> texts;
  for (const analysis::Assumption assumption : assumptions.list()) texts.emplace_back(analysis::text_of(assumption));
  return texts;
}

/// Whether takt bound has a line for it.
bool is_bounded(RequirementKind kind) {
  using enum RequirementKind;
  return kind == reaction || kind == latency || kind == jitter || kind == dropped || kind == delivered || kind == sync;
}

class Prover {
 public:
  Prover(const scenario::Resolved& resolved, const ProofOptions& options) : resolved_(resolved), options_(options), bounds_(analysis::bound(resolved)) {}

  /// `limit`: which of those limits of the scenario's requirements it is that takt bound looks at.
  Proved of(const RequirementResult& requirement, std::size_t limit) {
    if (requirement.kind == RequirementKind::invariants) return invariants(requirement);
    if (!is_bounded(requirement.kind) || limit >= bounds_.requirements.size()) return {{}, false, "nothing is known about it", {}};
    const analysis::RequirementBound& bound = bounds_.requirements[limit].bound;
    if (requirement.kind == RequirementKind::delivered) return delivered(requirement);
    Proved proved{bound.duration, false, bound.reason, texts_of(bound.assumptions)};
    if (requirement.kind == RequirementKind::dropped) {
      proved.holds = bound.count && *bound.count <= requirement.count_limit.value_or(0);
      if (bound.count && !proved.holds) proved.reason = "up to " + std::to_string(*bound.count) + " frames may be dropped";
    }
    return proved;
  }

 private:
  /// Whatever has been produced so early that it must have come.
  Proved delivered(const RequirementResult& requirement) const {
    Proved proved;
    const auto bound = std::find_if(bounds_.streams.begin(), bounds_.streams.end(), [&](const analysis::StreamBound& s) { return s.name == requirement.subject; });
    const auto& streams = resolved_.scenario.streams;
    const auto stream = std::find_if(streams.begin(), streams.end(), [&](const scenario::Stream& s) { return s.name == requirement.subject; });
    if (bound == bounds_.streams.end() || stream == streams.end() || !stream->every) {
      proved.reason = "how many frames there are is not known beforehand";
    } else if (!bound->loses_nothing || !bound->latency) {
      proved.reason = bound->reason.empty() ? "frames may be lost" : bound->reason;
    } else {
      const Duration last = resolved_.scenario.duration - *bound->latency - stream->jitter - stream->offset.value_or(Duration());
      const std::uint64_t frames = last < Duration() ? 0 : static_cast<std::uint64_t>(last.ps() / stream->every->ps() + 1) * resolved_.plan.streams[bound->index.value].listeners.size();
      proved.holds = frames >= requirement.count_limit.value_or(0);
      if (!proved.holds) proved.reason = "only " + std::to_string(frames) + " frames must have come at the end";
      proved.assumptions = texts_of(bound->assumptions);
    }
    return proved;
  }

  Proved invariants(const RequirementResult& requirement) {
    const auto program = std::find_if(resolved_.programs.begin(), resolved_.programs.end(), [&](const scenario::ResolvedProgram& p) { return p.name == requirement.subject; });
    if (program == resolved_.programs.end()) return {{}, false, "no such Program", {}};
    if (program->description->violations == scenario::Violations::reported) return {{}, true, {}, {}};
    if (program->has_roles()) return {{}, false, "who has a role is settled while the Program runs", {}};
    if (!program->nested.empty()) return {{}, false, "takt explore looks at single groups, not at nodes that join two", {}};
    const std::size_t slaves = program->participants.size() - 1;
    if (slaves > explore::most_slaves) return {{}, false, "at most " + std::to_string(explore::most_slaves) + " slaves can be explored", {}};
    if (program->description->subscription != scenario::Subscription::star) return {{}, false, "takt explore --subscription all-to-all looks at it", {}};
    explore::Question question;
    question.variant = program->description->variant == scenario::Variant::robust ? handshake::Variant::Robust : handshake::Variant::Paper;
    question.slaves = static_cast<std::uint8_t>(slaves);
    for (const explore::Fault fault : {explore::Fault::loss, explore::Fault::duplicate, explore::Fault::reorder, explore::Fault::crash, explore::Fault::restart, explore::Fault::timeout})
      question.faults.insert(fault);
    question.commands = slaves == 1 ? 3 : 1;
    question.states = options_.states;
    const auto key = std::pair(question.variant, question.slaves);
    const auto known = explored_.find(key);
    return known != explored_.end() ? known->second : explored_.emplace(key, explored(question)).first->second;
  }

  Proved explored(const explore::Question& question) const {
    const explore::Answer answer = explore::explore(question, [&](const auto&...) { return !options_.interrupted || !options_.interrupted(); });
    Proved proved;
    for (const explore::Property property : {explore::Property::S1, explore::Property::S2, explore::Property::S3, explore::Property::S4, explore::Property::S5})
      if (answer[property] == explore::Verdict::violated)
        proved.reason = "takt explore finds a run that violates " + std::string(explore::name_of(property)) + ", though perhaps not with this script";
    if (!proved.reason.empty()) return proved;
    if (!answer.exhausted) {
      proved.reason = std::to_string(answer.states) + " states of the handshake were looked at, not all; takt explore takes the time";
      return proved;
    }
    proved.holds = true;
    proved.assumptions.push_back("the invariants were explored for at most " + std::to_string(question.commands) + " calls and one fault of the network or a participant in a row (" +
                                 std::to_string(answer.states) + " states)");
    return proved;
  }

  const scenario::Resolved& resolved_;
  const ProofOptions& options_;
  analysis::Bounds bounds_;
  std::map<std::pair<handshake::Variant, std::uint8_t>, Proved> explored_;
};

}  // namespace

std::vector<Proved> prove(const scenario::Resolved& resolved, const std::vector<RequirementResult>& requirements, const ProofOptions& options) {
  Prover prover(resolved, options);
  std::vector<Proved> proofs;
  std::size_t limit = 0;
  for (const RequirementResult& requirement : requirements) {
    proofs.push_back(prover.of(requirement, limit));
    limit += is_bounded(requirement.kind) ? 1 : 0;
  }
  return proofs;
}

}  // namespace takt::verify
