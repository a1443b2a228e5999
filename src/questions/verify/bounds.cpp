// SPDX-License-Identifier: Apache-2.0
#include "verify/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/figure_bound.hpp"
#include "analysis/program_assessment.hpp"
#include "explore/parts/views.hpp"
#include "explore/search/search.hpp"
#include "json/quantity.hpp"
#include "scenario/figures/requirement.hpp"
#include "sim/check.hpp"
#include "verify/roles_query.hpp"
#include "wire/program_node.hpp"

namespace takt::verify {
namespace {

using results::RequirementKind;
using results::RequirementResult;
using scenario::RequiredFigure;
using sim::Duration;

class Prover {
 public:
  Prover(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const ProofOptions& options)
      : resolved_(resolved), options_(options), bounds_(bounds) {}

  Proof of(const RequirementResult& requirement) {
    if (!requirement.requirement)
      return is_reported_only(requirement.subject) ? reported() : invariants(requirement.subject);
    const RequiredFigure& required = resolved_.requirements[*requirement.requirement];
    const analysis::RequirementBound& bound = bounds_.requirements[*requirement.requirement];
    Proof proof;
    proof.from = required.from;
    proof.time = bound.duration;
    proof.reason = bound.reason;
    proof.assumptions = bound.assumptions;
    proof.is_given = required.given;
    if (is_of_misses(required.kind)) return misses(required, bound, std::move(proof));
    if (required.kind == RequirementKind::figure || required.kind == RequirementKind::success)
      return figure(required, bound, std::move(proof));
    if (required.kind == RequirementKind::delivered) return delivered(required, std::move(proof));
    if (required.kind == RequirementKind::dropped)
      judge_count(required, bound.count, proof);
    else
      judge_time(required, proof);
    return proof;
  }

 private:
  bool is_reported_only(const std::string& program) const {
    return std::ranges::any_of(resolved_.programs, [&](const scenario::ResolvedProgram& each) {
      return each.name == program && each.description->violations == scenario::Violations::reported;
    });
  }
  static Proof reported() {
    Proof proof;
    proof.is_reported_only = true;
    return proof;
  }

  const analysis::StreamBound* stream_named(const std::string& name) const {
    const auto found = std::find_if(bounds_.streams.begin(), bounds_.streams.end(),
                                    [&](const analysis::StreamBound& s) { return s.name == name; });
    return found == bounds_.streams.end() ? nullptr : &*found;
  }

  void judge_time(const RequiredFigure& required, Proof& proof) const {
    if (!proof.time || *proof.time > *required.longest) return;
    const bool is_of_stream = required.kind == RequirementKind::latency || required.kind == RequirementKind::jitter;
    if (is_of_stream && !scenario::requires_losses_separately(resolved_, required.subject, proof.from))
      if (const analysis::StreamBound* const stream = stream_named(required.subject);
          stream == nullptr || !stream->reaches_all) {
        proof.reason = "frames may be lost, and no requirement \"dropped\" says how many" +
                       (stream == nullptr ? std::string() : ": " + stream->loss_reason);
        return;
      }
    if (required.shortest && *required.shortest > Duration()) {
      const analysis::StreamBound* const stream = stream_named(required.subject);
      if (required.kind != RequirementKind::latency || stream == nullptr || stream->least < *required.shortest) {
        proof.reason = "nothing shows that it is never less than " + json::to_text(*required.shortest);
        return;
      }
    }
    proof.holds = true;
  }

  /// The most that may be missed one after another, or the fewest that are met.
  static Proof misses(const RequiredFigure& required, const analysis::RequirementBound& bound, Proof proof) {
    if (!bound.count) return proof;
    const bool is_met = required.kind == RequirementKind::met;
    const std::uint64_t value = is_met ? required.of - std::min(required.of, *bound.count) : *bound.count;
    proof.holds = required.limit.holds(static_cast<double>(value));
    proof.remark = fmt::format("{} {} {}", is_met ? "at least" : "at most", value, scenario::misses_name(required));
    if (!proof.holds)
      proof.reason = fmt::format("{} may be {}", *bound.count, is_met ? "missed" : scenario::misses_name(required));
    return proof;
  }

  static void judge_count(const RequiredFigure& required, std::optional<std::uint64_t> count, Proof& proof) {
    if (!count) return;
    proof.holds = required.limit.holds(static_cast<double>(*count));
    if (!proof.holds) proof.reason = "up to " + std::to_string(*count) + " frames may be dropped";
  }

  /// Whatever has been produced so early that it must have come.
  Proof delivered(const RequiredFigure& required, Proof proof) const {
    const analysis::StreamBound* const bound = stream_named(required.subject);
    TAKT_CHECK(bound != nullptr, "a stream of a requirement is one");
    const analysis::DeliveredFrames frames = analysis::frames_delivered(resolved_, *bound, proof.from);
    proof.assumptions = bound->assumptions;
    proof.holds = frames.least && required.limit.holds(static_cast<double>(*frames.least));
    proof.reason = proof.holds ? ""
                   : frames.least.value_or(0) == 0 && !frames.reason.empty()
                       ? frames.reason
                       : "only " + std::to_string(frames.least.value_or(0)) + " frames must have come at the end";
    return proof;
  }

  /// What is known of the figure must lie within the limit.
  Proof figure(const RequiredFigure& asked, const analysis::RequirementBound& bound, Proof proof) {
    TAKT_CHECK(bound.figure, "what is known of a figure is a range");
    analysis::FigureRange range = *bound.figure;
    if (counts_violations(asked.figure)) range = violations(asked.figure.steps[1], proof);
    const auto exceeds = [&](const std::optional<double>& end, bool is_asked) {
      return is_asked && end && !asked.limit.holds(end);
    };
    const bool asks_least = asked.limit.relation != scenario::Relation::at_most;
    const bool asks_greatest = asked.limit.relation != scenario::Relation::at_least;
    proof.holds =
        (!asks_least || asked.limit.holds(range.least)) && (!asks_greatest || asked.limit.holds(range.greatest));
    if (proof.holds) {
      proof.reason.clear();
      if (!proof.time && proof.remark.empty())
        proof.remark = "between " + (range.least ? scenario::text_of(*range.least, asked.figure.unit) : "0") + " and " +
                       (range.greatest ? scenario::text_of(*range.greatest, asked.figure.unit) : "any figure");
    } else if (exceeds(range.greatest, asks_greatest)) {
      proof.reason = "it may be as much as " + scenario::text_of(*range.greatest, asked.figure.unit);
    } else if (exceeds(range.least, asks_least)) {
      proof.reason = "it may be as little as " + scenario::text_of(*range.least, asked.figure.unit) +
                     (bound.reason.empty() ? "" : ": " + bound.reason);
    }
    return proof;
  }

  static bool counts_violations(const scenario::Figure& figure) {
    return figure.steps.size() == 5 && figure.steps[0] == "programs" && figure.steps[2] == "violations" &&
           figure.take == scenario::Take::count;
  }

  /// None of Programs whose invariants are proved.
  analysis::FigureRange violations(const std::string& of, Proof& proof) {
    analysis::FigureRange range{0.0, 0.0};
    proof.reason.clear();
    for (const scenario::ResolvedProgram& program : resolved_.programs) {
      if (of != "*" && program.name != of) continue;
      const Proof each = invariants(program.name);
      proof.assumptions.add(each.assumptions);
      if (!each.holds) range.greatest.reset();
      if (proof.reason.empty()) proof.reason = each.reason;
      if (proof.remark.empty()) proof.remark = each.remark;
    }
    return range;
  }

  Proof invariants(const std::string& name) {
    const auto program = std::find_if(resolved_.programs.begin(), resolved_.programs.end(),
                                      [&](const scenario::ResolvedProgram& p) { return p.name == name; });
    const auto unknown = [](std::string why) {
      Proof proof;
      proof.reason = std::move(why);
      return proof;
    };
    if (program == resolved_.programs.end()) return unknown("no such Program");
    if (!program->nested.empty() || program->has_roles()) return invariants_of(*program);
    if (program->description->subscription != scenario::Subscription::star)
      return unknown("takt explore --subscription all-to-all looks at it");
    const std::size_t slaves = program->members.size() - 1;
    if (slaves > explore::most_slaves && program->description->variant != scenario::Variant::robust)
      return unknown("at most " + std::to_string(explore::most_slaves) + " slaves can be explored with paper");
    return invariants_of(*program);
  }

  /// Explores what the scenario can bring about: from any state in which the group rests, as many calls and faults as
  /// come before it rests again.
  Proof invariants_of(const scenario::ResolvedProgram& program) {
    Proof proof;
    explore::Query query;
    query.variant = program.description->variant == scenario::Variant::robust ? handshake::Variant::robust
                                                                              : handshake::Variant::paper;
    query.slaves = static_cast<std::uint8_t>(program.members.size() - 1);
    const auto number = static_cast<std::uint32_t>(&program - resolved_.programs.data());
    analysis::EventsInARow row = analysis::events_in_a_row(resolved_, bounds_, number);
    const std::vector<std::uint32_t> tree = tree_of(resolved_, number);
    if (tree.size() > 1 || program.has_roles()) {
      if (const auto wrong = tree.size() > 1 ? set_tree(resolved_, tree, query) : set_roles(program, query)) {
        proof.reason = *wrong;
        return proof;
      }
    }
    if (query.has_roles()) {
      // Who has a role at rest depends on all that was before: the whole scenario is one row from the start.
      query.beginnings = explore::Beginnings::switched_on;
      row = all_events();
    }
    query.commands = static_cast<std::uint32_t>(std::max<std::size_t>(1, row.calls));
    query.fault_budget = static_cast<std::uint32_t>(row.faults);
    const bool comes_back = std::ranges::any_of(resolved_.script, [](const scenario::ResolvedAction& action) {
      const auto* const node = std::get_if<scenario::ResolvedNode>(&action.what);
      return node != nullptr && node->up;
    });
    if (row.faults > 0) query.faults.insert(explore::Fault::crash);
    if (row.faults > 0 && comes_back) query.faults.insert(explore::Fault::restart);
    query.states = options_.states;
    if (query.commands > explore::most_commands || query.fault_budget > explore::most_faults) {
      proof.reason = fmt::format("{} calls and {} faults come before the group is at rest, more than can be explored",
                                 row.calls, row.faults);
      return proof;
    }
    proof.assumptions.add(analysis::Assumption::nothing_else);
    if (!resolved_.scenario.faults.empty()) proof.assumptions.add(analysis::Assumption::listed_faults_only);
    for (const auto& [stream, cycle, timeout] : messages_of(tree)) {
      const analysis::StreamBound& state = bounds_.streams[stream.value];
      proof.assumptions.add(state.assumptions);
      if (!state.reaches_all && !analysis::is_lost_with_its_ends(resolved_, number, state))
        proof.assumptions.add(analysis::Assumption::no_loss);
      const analysis::Ps turn = longest_turn(tree);
      if (!analysis::is_bounded(turn)) {
        proof.reason = "a participant may be taken for silent: nothing is known of how long its host takes for a turn";
        return proof;
      }
      if (!is_heard_in_time(cycle, timeout, state, turn)) {
        proof.reason = "a participant may be taken for silent: the time-out " +
                       std::to_string(timeout.ps() / 1'000'000) + " us is not longer than a cycle and the bound of " +
                       state.name;
        return proof;
      }
    }
    auto known =
        std::find_if(explored_.begin(), explored_.end(), [&](const auto& each) { return each.first == query; });
    if (known == explored_.end()) known = explored_.insert(explored_.end(), {query, proved(query)});
    proof.holds = known->second.holds;
    proof.reason = known->second.reason;
    proof.remark = known->second.remark;
    return proof;
  }

  struct Cyclic {
    models::StreamIndex stream;
    Duration cycle;
    Duration timeout;
  };
  /// What the Programs publish, and after which time their silence is noticed. The table has no time-out: it goes with
  /// the master's state.
  std::vector<Cyclic> messages_of(const std::vector<std::uint32_t>& tree) const {
    std::vector<Cyclic> messages;
    for (const std::uint32_t number : tree) {
      const scenario::ResolvedProgram& program = resolved_.programs[number];
      for (const scenario::ResolvedMember& each : program.members) {
        messages.push_back({each.state, program.description->cycle, program.receive_timeout});
        if (each.roles)
          messages.push_back({*each.roles, program.announce_every, wire::announce_timeout(program.announce_every)});
      }
    }
    return messages;
  }

  /// Calls, joins and leaves are calls here; every node that goes down may be one of the Program's, and the explorer
  /// lets it come up for nothing.
  analysis::EventsInARow all_events() const {
    analysis::EventsInARow all;
    for (const scenario::ResolvedAction& action : resolved_.script) {
      if (std::holds_alternative<scenario::ResolvedCall>(action.what) ||
          std::holds_alternative<scenario::ResolvedMembership>(action.what))
        ++all.calls;
      const auto* const node = std::get_if<scenario::ResolvedNode>(&action.what);
      all.faults += node != nullptr && !node->up;
    }
    return all;
  }

  /// `turn`: the longest that a participant's thread of a processor takes for a turn; 0 where turns take no time.
  bool is_heard_in_time(Duration cycle, Duration timeout, const analysis::StreamBound& state, analysis::Ps turn) const {
    if (!state.latency) return false;
    const models::NodePlan& talker = resolved_.plan.nodes[resolved_.plan.streams[state.index.value].talker.value];
    analysis::Ps wake_up = resolved_.plan.os_latencies[talker.os_latency].wake_up.greatest().ps();
    for (std::size_t t = 0; talker.cpu && t < talker.cpu->threads.size(); ++t)
      if (const auto& law = talker.cpu->threads[t].wake_up) wake_up = std::max(wake_up, law->greatest().ps());
    // Clocks are never so bad that a time-out is a tenth shorter, or a cycle a tenth longer. It is published, and
    // heard, at the end of a turn.
    const std::int64_t longest =
        cycle.ps() + cycle.ps() / 10 + (*state.latency - state.least).ps() + wake_up + 2 * turn;
    return longest < timeout.ps() - timeout.ps() / 10;
  }
  analysis::Ps longest_turn(const std::vector<std::uint32_t>& programs) const {
    analysis::Ps longest = 0;
    for (const std::uint32_t program : programs)
      for (const scenario::ResolvedMember& member : resolved_.programs[program].members)
        longest = std::max(longest, bounds_.hosts->of(member.node, member.cpu_thread).worst);
    return longest;
  }

  /// A small group is explored. What that leaves open, and a larger group, is proved for every number of slaves if that
  /// goes through; else as many are explored as can be.
  Proof proved(const explore::Query& query) const {
    Proof small;
    if (!query.has_parts()) {
      small = explored(query);
      if (small.holds || !query.can_have_parts()) return small;
    }
    const Proof any = proved_for_any_number(query);
    if (any.holds || !query.has_parts()) return any.holds ? any : small;
    if (query.slaves > explore::most_equal_slaves) return any;
    Proof large = explored(query);
    if (!large.holds) large.reason = any.reason + "; " + large.reason;
    return large;
  }

  Proof proved_for_any_number(const explore::Query& query) const {
    const explore::AnyNumber result = explore::prove_for_any_number(
        query, [&](const auto&...) { return !options_.interrupted || !options_.interrupted(); });
    Proof proof;
    proof.holds = true;
    for (const explore::Property property : {explore::Property::S1, explore::Property::S2, explore::Property::S3,
                                             explore::Property::S4, explore::Property::S5}) {
      if (result[property] == explore::PropertyVerdict::holds) continue;
      proof.holds = false;
      proof.reason = result.exhausted
                         ? "the proof for every number of slaves fails at " + std::string(explore::name_of(property))
                         : fmt::format("{} views of the master and one slave were looked at, not all", result.views);
      return proof;
    }
    proof.remark = fmt::format(
        "proved for every number of slaves: {} views, {} call{} and {} fault{} before the group rests", result.views,
        query.commands, query.commands == 1 ? "" : "s", query.fault_budget, query.fault_budget == 1 ? "" : "s");
    return proof;
  }

  Proof explored(const explore::Query& query) const {
    const explore::SearchResult result =
        explore::explore(query, [&](const auto&...) { return !options_.interrupted || !options_.interrupted(); });
    Proof proof;
    for (const explore::Property property : {explore::Property::S1, explore::Property::S2, explore::Property::S3,
                                             explore::Property::S4, explore::Property::S5})
      if (result[property] == explore::PropertyVerdict::violated)
        proof.reason = "takt explore finds a run that violates " + std::string(explore::name_of(property)) +
                       ", though perhaps not with this script";
    if (!proof.reason.empty()) return proof;
    if (!result.exhausted) {
      proof.reason =
          fmt::format("{} states of the handshake were looked at, not all; takt explore takes the time", result.states);
      return proof;
    }
    proof.holds = true;
    proof.remark =
        fmt::format("explored: {} states, {} call{} and {} fault{} {}", result.states, query.commands,
                    query.commands == 1 ? "" : "s", query.fault_budget, query.fault_budget == 1 ? "" : "s",
                    query.has_roles() ? "in all, joins and leaves among the calls" : "before the group rests");
    return proof;
  }

  const scenario::Resolved& resolved_;
  const ProofOptions& options_;
  const analysis::Bounds& bounds_;
  std::vector<std::pair<explore::Query, Proof>> explored_;
};

}  // namespace

std::vector<Proof> prove(const scenario::Resolved& resolved, const analysis::Bounds& bounds,
                         const std::vector<RequirementResult>& requirements, const ProofOptions& options) {
  Prover prover(resolved, bounds, options);
  std::vector<Proof> proofs;
  for (const RequirementResult& requirement : requirements) proofs.push_back(prover.of(requirement));
  return proofs;
}

}  // namespace takt::verify
