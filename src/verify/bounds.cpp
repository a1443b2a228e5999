#include "verify/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/program_assessment.hpp"
#include "explore/search.hpp"
#include "scenario/figures/requirement_rules.hpp"
#include "scenario/json/quantity.hpp"

namespace takt::verify {
namespace {

using results::RequirementKind;
using results::RequirementResult;
using sim::Duration;

/// As takt bound names it; nothing where it has no line for it.
std::optional<std::string_view> bounded_as(RequirementKind kind) {
  switch (kind) {
    case RequirementKind::reaction: return "reaction";
    case RequirementKind::latency: return "latency";
    case RequirementKind::jitter: return "jitter";
    case RequirementKind::dropped: return "dropped";
    case RequirementKind::delivered: return "delivered";
    case RequirementKind::sync: return "sync";
    default: return std::nullopt;
  }
}

class Prover {
 public:
  Prover(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const ProofOptions& options) : resolved_(resolved), options_(options), bounds_(bounds) {}

  Proof of(const RequirementResult& requirement) {
    if (requirement.kind == RequirementKind::invariants) return invariants(requirement);
    Proof proof;
    const auto what = bounded_as(requirement.kind);
    const auto bound = std::find_if(bounds_.requirements.begin(), bounds_.requirements.end(),
                                    [&](const analysis::Bounds::Requirement& each) { return what && each.requirement == requirement.requirement && each.what == *what; });
    if (bound == bounds_.requirements.end()) {
      proof.reason = "nothing is known about it";
      return proof;
    }
    proof.from = scenario::counts_from(resolved_.scenario, resolved_.scenario.require[bound->requirement]);
    proof.time = bound->bound.duration;
    proof.reason = bound->bound.reason;
    proof.assumptions = bound->bound.assumptions;
    if (requirement.kind == RequirementKind::delivered) return delivered(requirement, std::move(proof));
    if (requirement.kind == RequirementKind::dropped)
      judge_count(requirement, bound->bound.count, proof);
    else
      judge_time(requirement, proof);
    return proof;
  }

 private:
  const analysis::StreamBound* stream_named(const std::string& name) const {
    const auto found = std::find_if(bounds_.streams.begin(), bounds_.streams.end(), [&](const analysis::StreamBound& s) { return s.name == name; });
    return found == bounds_.streams.end() ? nullptr : &*found;
  }

  void judge_time(const RequirementResult& requirement, Proof& proof) const {
    if (!proof.time || !requirement.limit) return;
    if (*proof.time > *requirement.limit) return;
    const bool is_of_stream = requirement.kind == RequirementKind::latency || requirement.kind == RequirementKind::jitter;
    if (is_of_stream && !scenario::requires_losses_separately(resolved_.scenario, requirement.subject, proof.from))
      if (const analysis::StreamBound* const stream = stream_named(requirement.subject); stream == nullptr || !stream->loses_nothing) {
        proof.reason = "frames may be lost, and no requirement \"dropped\" says how many" + (stream == nullptr ? std::string() : ": " + stream->loss_reason);
        return;
      }
    if (requirement.least_limit && *requirement.least_limit > Duration()) {
      const analysis::StreamBound* const stream = stream_named(requirement.subject);
      if (requirement.kind != RequirementKind::latency || stream == nullptr || stream->least < *requirement.least_limit) {
        proof.reason = "nothing shows that it is never less than " + scenario::json::to_text(*requirement.least_limit);
        return;
      }
    }
    proof.holds = true;
  }

  static void judge_count(const RequirementResult& requirement, std::optional<std::uint64_t> count, Proof& proof) {
    if (!count) return;
    proof.holds = *count <= requirement.count_limit.value_or(0);
    if (!proof.holds) proof.reason = "up to " + std::to_string(*count) + " frames may be dropped";
  }

  /// Whatever has been produced so early that it must have come.
  Proof delivered(const RequirementResult& requirement, Proof proof) const {
    const analysis::StreamBound* const bound = stream_named(requirement.subject);
    const auto& streams = resolved_.scenario.streams;
    const auto stream = std::find_if(streams.begin(), streams.end(), [&](const scenario::Stream& s) { return s.name == requirement.subject; });
    if (bound == nullptr || stream == streams.end() || !stream->every) {
      proof.reason = "how many frames there are is not known beforehand";
    } else if (!bound->loses_nothing || !bound->latency) {
      proof.reason = !bound->reason.empty() ? bound->reason : bound->loss_reason;
    } else {
      const Duration last = resolved_.scenario.duration - *bound->latency - stream->jitter - stream->offset.value_or(Duration()) - proof.from;
      // One more than whole periods if the first frame comes with the first instant.
      const std::int64_t begun = proof.from == Duration() ? 1 : 0;
      const std::uint64_t frames = last < Duration() ? 0 : static_cast<std::uint64_t>(last.ps() / stream->every->ps() + begun) * resolved_.plan.streams[bound->index.value].listeners.size();
      proof.holds = frames >= requirement.count_limit.value_or(0);
      proof.reason = proof.holds ? "" : "only " + std::to_string(frames) + " frames must have come at the end";
      proof.assumptions = bound->assumptions;
    }
    return proof;
  }

  Proof invariants(const RequirementResult& requirement) {
    const auto program = std::find_if(resolved_.programs.begin(), resolved_.programs.end(), [&](const scenario::ResolvedProgram& p) { return p.name == requirement.subject; });
    const auto unknown = [](std::string why) { return Proof{{}, false, std::move(why), {}, {}, {}}; };
    if (program == resolved_.programs.end()) return unknown("no such Program");
    if (program->description->violations == scenario::Violations::reported) return {{}, true, {}, {}, {}, {}};
    if (program->has_roles()) return unknown("who has a role is settled while the Program runs");
    if (!program->nested.empty()) return unknown("takt explore looks at single groups, not at nodes that join two");
    const std::size_t slaves = program->participants.size() - 1;
    if (slaves > explore::most_slaves) return unknown("at most " + std::to_string(explore::most_slaves) + " slaves can be explored");
    if (program->description->subscription != scenario::Subscription::star) return unknown("takt explore --subscription all-to-all looks at it");
    return invariants_of(*program);
  }

  /// Explores what the scenario can bring about: from any state in which the group rests, as many calls and faults as come before it rests again.
  Proof invariants_of(const scenario::ResolvedProgram& program) {
    explore::Question question;
    question.variant = program.description->variant == scenario::Variant::robust ? handshake::Variant::Robust : handshake::Variant::Paper;
    question.slaves = static_cast<std::uint8_t>(program.participants.size() - 1);
    const analysis::EventsInARow row = analysis::events_in_a_row(resolved_, bounds_, static_cast<std::size_t>(&program - resolved_.programs.data()));
    question.commands = static_cast<std::uint32_t>(std::max<std::size_t>(1, row.calls));
    question.fault_budget = static_cast<std::uint32_t>(row.faults);
    for (const explore::Fault fault : {explore::Fault::crash, explore::Fault::restart})
      if (row.faults > 0) question.faults.insert(fault);
    question.states = options_.states;
    if (question.commands > explore::most_commands || question.fault_budget > explore::most_faults)
      return {{}, false, fmt::format("{} calls and {} faults come before the group is at rest, more than can be explored", row.calls, row.faults), {}, {}, {}};
    Proof proof;
    proof.assumptions.add(analysis::Assumption::nothing_else);
    if (!resolved_.scenario.faults.empty()) proof.assumptions.add(analysis::Assumption::listed_faults_only);
    for (const models::StreamIndex stream : program.state_streams) {
      const analysis::StreamBound& state = bounds_.streams[stream.value];
      proof.assumptions.add(state.assumptions);
      if (!state.loses_nothing && !is_lost_with_its_ends(program, state)) proof.assumptions.add(analysis::Assumption::no_loss);
      if (!is_heard_in_time(program, state)) {
        proof.reason = "a participant may be taken for silent: the time-out " + std::to_string(program.receive_timeout.ps() / 1'000'000) + " us is not longer than a cycle and the bound of " + state.name;
        return proof;
      }
    }
    const auto key = std::tuple(question.variant, question.slaves, question.commands, question.fault_budget);
    auto known = explored_.find(key);
    if (known == explored_.end()) known = explored_.emplace(key, explored(question)).first;
    proof.holds = known->second.holds;
    proof.reason = known->second.reason;
    proof.remark = known->second.remark;
    return proof;
  }

  /// Nothing but crashes of participants loses its frames: that is what the explored crashes stand for.
  bool is_lost_with_its_ends(const scenario::ResolvedProgram& program, const analysis::StreamBound& state) const {
    return state.loses_by_faults_only && resolved_.plan.impairments.empty() && std::all_of(resolved_.script.begin(), resolved_.script.end(), [&](const scenario::ResolvedAction& action) {
      const auto* const node = std::get_if<scenario::ResolvedNode>(&action.what);
      const bool is_participant = node != nullptr && std::find(program.participants.begin(), program.participants.end(), node->node) != program.participants.end();
      return is_participant || (node == nullptr && !std::holds_alternative<scenario::ResolvedLink>(action.what));
    });
  }

  bool is_heard_in_time(const scenario::ResolvedProgram& program, const analysis::StreamBound& state) const {
    if (!state.latency) return false;
    const models::OsLatency& os = resolved_.plan.os_latencies[resolved_.plan.nodes[resolved_.plan.streams[state.index.value].talker.value].os_latency];
    // Clocks are never so bad that a time-out is a tenth shorter, or a cycle a tenth longer.
    const std::int64_t longest = program.description->cycle.ps() + program.description->cycle.ps() / 10 + (*state.latency - state.least).ps() + os.wake_up.greatest().ps();
    return longest < program.receive_timeout.ps() - program.receive_timeout.ps() / 10;
  }

  Proof explored(const explore::Question& question) const {
    const explore::Answer answer = explore::explore(question, [&](const auto&...) { return !options_.interrupted || !options_.interrupted(); });
    Proof proof;
    for (const explore::Property property : {explore::Property::S1, explore::Property::S2, explore::Property::S3, explore::Property::S4, explore::Property::S5})
      if (answer[property] == explore::Verdict::violated)
        proof.reason = "takt explore finds a run that violates " + std::string(explore::name_of(property)) + ", though perhaps not with this script";
    if (!proof.reason.empty()) return proof;
    if (!answer.exhausted) {
      proof.reason = fmt::format("{} states of the handshake were looked at, not all; takt explore takes the time", answer.states);
      return proof;
    }
    proof.holds = true;
    proof.remark = fmt::format("explored: {} states, {} call{} and {} fault{} before the group rests", answer.states, question.commands, question.commands == 1 ? "" : "s",
                               question.fault_budget, question.fault_budget == 1 ? "" : "s");
    return proof;
  }

  const scenario::Resolved& resolved_;
  const ProofOptions& options_;
  const analysis::Bounds& bounds_;
  std::map<std::tuple<handshake::Variant, std::uint8_t, std::uint32_t, std::uint32_t>, Proof> explored_;
};

}  // namespace

std::vector<Proof> prove(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const std::vector<RequirementResult>& requirements, const ProofOptions& options) {
  Prover prover(resolved, bounds, options);
  std::vector<Proof> proofs;
  for (const RequirementResult& requirement : requirements) proofs.push_back(prover.of(requirement));
  return proofs;
}

}  // namespace takt::verify
