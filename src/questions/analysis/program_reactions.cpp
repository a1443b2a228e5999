// SPDX-License-Identifier: Apache-2.0
#include "analysis/program_reactions.hpp"

#include <algorithm>
#include <array>

#include "analysis/flow_graph.hpp"
#include "analysis/reaction_bound.hpp"
#include "scenario/programs/program_faults.hpp"

namespace takt::analysis {
namespace {

using handshake::Cause;
using scenario::Reaction;
using sim::Duration;

constexpr std::array<Reaction, 5> all_reactions = {Reaction::start, Reaction::halt, Reaction::suspend, Reaction::resume,
                                                   Reaction::reset};
/// What halts a group without a call, and is told apart.
constexpr std::array<Cause, 4> halting_causes = {Cause::crash, Cause::cut, Cause::silence, Cause::restart};
constexpr const char* no_bound_with_roles = "who has a role is settled while the Program runs";
constexpr const char* paper_notices_nothing = "the handshake paper notices neither silence nor a restart";

/// What is called for it.
program::Method method_of(Reaction kind) {
  using program::Method;
  constexpr Method methods[] = {Method::Start, Method::Halt, Method::Suspend, Method::Resume,
                                Method::Reset};  // as Reaction has them
  return methods[static_cast<std::size_t>(kind)];
}

Spread spread_of(Reaction kind) { return kind == Reaction::suspend ? Spread::after_barriers : Spread::at_once; }

/// One Program, and what its notifications rest on.
struct ProgramGroup {
  ReactionGroup group;  // without those within
  Assumptions assumptions;
  Assumptions of_faults;  // those of halts after a crash, a cut or a restart
  std::string reason;     // why a notification is unbounded
  bool notices_faults = true;
  Ps last_word = 0;   // of a peer, still under way when it falls silent
  Ps time_out = 0;    // of whoever notices it last, from the last word it has heard
  Ps first_word = 0;  // of a peer that is back, until it is heard
  std::vector<ParticipantBound> participants;

  Ps until_noticed(Cause cause) const {
    return cause == Cause::restart ? first_word : cause == Cause::silence ? time_out : sum(last_word, time_out);
  }
};

class GroupMaker {
 public:
  GroupMaker(const scenario::Resolved& r, const scenario::ResolvedProgram& program, const BoundOptions& options,
             const Bounds& bounds)
      : r_(r), program_(program), options_(options), bounds_(bounds) {}

  ProgramGroup make() {
    const std::size_t n = program_.members.size();
    made_.group.notify = MaxPlusMatrix(n, n);
    for (std::size_t p = 0; p < n; ++p) {
      made_.group.names.push_back(r_.topology.nodes[program_.members[p].node.value].name);
      made_.group.initialise.push_back(
          MaxPlus(sum(stretched(p, program_.description->initialisation.ps()), wake_up(p))));
      made_.participants.push_back({duration_of(publish_wait(p)), duration_of(made_.group.initialise.back().ps())});
      add_notifications(p);
      made_.time_out = std::max(made_.time_out, sum(stretched(p, program_.receive_timeout.ps()), wake_up(p)));
    }
    for (const scenario::ResolvedMember& each : program_.members)
      for (const auto& latency : bounds_.streams[each.state.value].by_listener)
        made_.last_word = latency ? std::max(made_.last_word, sum(latency->ps(), slowest_hearing())) : unbounded_ps;
    made_.notices_faults = program_.description->variant == scenario::Variant::robust;
    if (program_.description->publish == scenario::Publish::on_change)
      made_.assumptions.add(Assumption::program_publishes);
    made_.of_faults = made_.assumptions;
    for (const scenario::ResolvedMember& each : program_.members) {
      const StreamBound& state = bounds_.streams[each.state.value];
      if (state.reaches_all) continue;
      made_.assumptions.add(Assumption::no_loss);
      // Whom a crash or a cut keeps words from finds that out by its own time-out.
      if (!state.loses_by_faults_only || !r_.plan.impairments.empty()) made_.of_faults.add(Assumption::no_loss);
    }
    if (program_.description->variant == scenario::Variant::paper) made_.assumptions.add(Assumption::sampled_states);
    return std::move(made_);
  }

 private:
  /// From a timer's expiry to the end of the turn that follows.
  Ps wake_up(std::size_t p) const {
    return sum(bounds_.hosts->wake_up(program_.members[p].node, program_.members[p].cpu_thread).greatest().ps(),
               turn(p));
  }
  /// From a message's arrival to the end of the turn that hears of it.
  Ps turn(std::size_t p) const {
    return bounds_.hosts->of(program_.members[p].node, program_.members[p].cpu_thread).worst;
  }
  /// The same of a message that must be opened, which is part of the turn on a thread.
  Ps hearing(std::size_t p) const {
    return program_.members[p].cpu_thread ? turn(p) : sum(turn(p), program_.members[p].open.ps());
  }
  Ps slowest_hearing() const {
    Ps slowest = 0;
    for (std::size_t p = 0; p < program_.members.size(); ++p) slowest = std::max(slowest, hearing(p));
    return slowest;
  }
  Ps stretched(std::size_t p, Ps local) const {
    const ClockQuality clock = clock_quality(r_, program_.members[p].node, options_);
    return sum(scaled_up(local, 1'000'000'000'000 + clock.rate_ppt, 1'000'000'000'000), 2 * clock.error);
  }
  Ps publish_wait(std::size_t p) const {
    if (program_.description->publish == scenario::Publish::on_change) return 0;
    return sum(stretched(p, program_.description->cycle.ps()), wake_up(p));
  }

  void add_notifications(std::size_t from) {
    const StreamBound& stream = bounds_.streams[program_.members[from].state.value];
    const models::StreamPlan& plan = r_.plan.streams[stream.index.value];
    for (std::size_t l = 0; l < plan.listeners.size(); ++l) {
      const auto to = static_cast<std::size_t>(
          std::ranges::find(program_.members, plan.listeners[l], &scenario::ResolvedMember::node) -
          program_.members.begin());
      if (to == program_.members.size()) continue;
      const Ps latency = sum(stream.by_listener[l] ? stream.by_listener[l]->ps() : unbounded_ps, hearing(to));
      made_.group.notify(to, from) = MaxPlus(sum(publish_wait(from), latency));
      // A node that is back publishes at the next instant of its cycle, whether or not it publishes on change as well.
      made_.first_word =
          std::max(made_.first_word, sum(stretched(from, program_.description->cycle.ps()), wake_up(from), latency));
      if (const ThreadTime& thread = bounds_.hosts->of(program_.members[to].node, program_.members[to].cpu_thread);
          !is_bounded(thread.worst) && made_.reason.empty())
        made_.reason = "the thread of " + program_.name + " on " +
                       r_.topology.nodes[program_.members[to].node.value].name + ": " + thread.reason;
      if (!stream.latency && made_.reason.empty())
        made_.reason = "stream " + stream.name + " is unbounded: " + stream.reason;
      made_.assumptions.add(stream.assumptions);
    }
  }

  const scenario::Resolved& r_;
  const scenario::ResolvedProgram& program_;
  const BoundOptions& options_;
  const Bounds& bounds_;
  ProgramGroup made_;
};

class ScenarioReactions {
 public:
  ScenarioReactions(const scenario::Resolved& r, const BoundOptions& options, Bounds& bounds) : r_(r), bounds_(bounds) {
    for (const scenario::ResolvedProgram& program : r.programs) {
      groups_.push_back(program.has_roles() ? ProgramGroup{} : GroupMaker(r, program, options, bounds).make());
      bounds.participants.push_back(groups_.back().participants);
    }
  }

  void make() {
    for (std::size_t p = 0; p < groups_.size(); ++p) {
      if (r_.programs[p].has_roles()) {
        for (const Reaction kind : all_reactions)
          bounds_.reactions.push_back({p, kind, Cause::command, false, {}, {}, no_bound_with_roles, {}});
        for (const Cause cause : halting_causes)
          bounds_.reactions.push_back({p, Reaction::halt, cause, false, {}, {}, no_bound_with_roles, {}});
        continue;
      }
      for (const Reaction kind : all_reactions) add(p, kind);
      for (const Cause cause : halting_causes) add_halt(p, cause, {p}, false);
      if (!r_.programs[p].outer && is_tree(p)) add_tree(p);
    }
  }

 private:
  bool is_tree(std::size_t root) const {
    return std::any_of(r_.programs.begin(), r_.programs.end(), [&](const scenario::ResolvedProgram& program) {
      return program.outer && program.outer->program == root;
    });
  }

  /// The group with all that is nested in it. `of_calls`: at whom they may be made; of any cause if absent.
  ReactionGroup tree_of(std::size_t p, std::optional<Reaction> of_calls = {}) const {
    ReactionGroup tree = groups_[p].group;
    if (of_calls) tree.origins = callers_of(p, *of_calls);
    for (std::size_t inner = 0; inner < groups_.size(); ++inner)
      if (const auto& outer = r_.programs[inner].outer; outer && outer->program == p)
        tree.inner.push_back({outer->participant, tree_of(inner, of_calls)});
    return tree;
  }

  /// By participant: on whom the Program says that the method is called; empty: it does not say.
  std::vector<bool> callers_of(std::size_t p, Reaction kind) const {
    const std::optional<std::vector<std::string>>& named =
        plant::callers_of(*r_.programs[p].description, method_of(kind));
    if (!named) return {};
    std::vector<bool> callers;
    for (const std::string& name : groups_[p].group.names)
      callers.push_back(std::ranges::find(*named, name) != named->end());
    return callers;
  }
  /// The same for the group alone, to which a reaction may come from the group around it, or from one within.
  std::vector<bool> origins_of(std::size_t p, Reaction kind) const {
    std::vector<bool> origins = callers_of(p, kind);
    if (origins.empty()) return origins;
    if (r_.programs[p].outer) origins[0] = true;
    for (const scenario::ResolvedProgram& inner : r_.programs)
      if (inner.outer && inner.outer->program == p) origins[inner.outer->participant] = true;
    return origins;
  }
  void rest_on_tree(std::size_t p, ReactionBound& made) const {
    made.assumptions.add(groups_[p].assumptions);
    if (made.reason.empty()) made.reason = groups_[p].reason;
    for (std::size_t inner = 0; inner < groups_.size(); ++inner)
      if (const auto& outer = r_.programs[inner].outer; outer && outer->program == p) rest_on_tree(inner, made);
  }

  /// What the group itself takes. A halt and the like that comes from another group is one of its own from then on.
  void add(std::size_t p, Reaction kind) {
    ReactionBound made;
    made.program = p;
    made.kind = kind;
    if (kind == Reaction::start) return add_start(std::move(made));
    made.assumptions = groups_[p].assumptions;
    made.reason = groups_[p].reason;
    ReactionGroup group = groups_[p].group;
    group.origins = origins_of(p, kind);
    take(made, spread_bound(group), [&] { return spread_parts(group); });
    if (kind != Reaction::halt || group.origins.empty()) return;
    // Anybody may find that it cannot follow.
    made.cause = Cause::mismatch;
    take(made, spread_bound(groups_[p].group), [&] { return spread_parts(groups_[p].group); });
  }

  /// Noticed by the last of those who can, and spread from there.
  void add_halt(std::size_t p, Cause cause, const std::vector<std::size_t>& groups, bool of_tree) {
    ReactionBound made;
    made.program = p;
    made.kind = Reaction::halt;
    made.cause = cause;
    made.of_tree = of_tree;
    if (of_tree && refuse(p, made)) return;
    Ps noticed = 0;
    bool notices = true;
    for (const std::size_t g : groups) {
      made.assumptions.add(cause == Cause::silence ? groups_[g].assumptions : groups_[g].of_faults);
      if (made.reason.empty()) made.reason = groups_[g].reason;
      noticed = std::max(noticed, groups_[g].until_noticed(cause));
      notices = notices && groups_[g].notices_faults;
    }
    if (!notices) {
      made.reason = paper_notices_nothing;
      bounds_.reactions.push_back(std::move(made));
      return;
    }
    const ReactionGroup whole = of_tree ? tree_of(p) : groups_[p].group;
    take(made, MaxPlus(noticed) * spread_bound(whole), [&] {
      std::vector<ReactionPart> parts{{cause == Cause::restart   ? "the first word of who is back"
                                       : cause == Cause::silence ? "time-out"
                                                                 : "last word, then time-out",
                                       Duration::from_ps(noticed)}};
      for (ReactionPart& part : spread_parts(whole)) parts.push_back(std::move(part));
      return parts;
    });
  }

  std::vector<std::size_t> groups_of_tree(std::size_t root) const {
    std::vector<std::size_t> groups{root};
    for (std::size_t i = 0; i < groups.size(); ++i)
      for (std::size_t inner = 0; inner < groups_.size(); ++inner)
        if (const auto& outer = r_.programs[inner].outer; outer && outer->program == groups[i]) groups.push_back(inner);
    return groups;
  }

  bool says_callers(std::size_t root, Reaction kind) const {
    return std::ranges::any_of(groups_of_tree(root), [&](std::size_t p) { return !callers_of(p, kind).empty(); });
  }

  bool has_roles_below(std::size_t root) const {
    return std::ranges::any_of(groups_of_tree(root), [&](std::size_t p) { return r_.programs[p].has_roles(); });
  }
  /// True if nothing can be said, because somebody in the tree of this root comes and goes.
  bool refuse(std::size_t root, const ReactionBound& made) {
    if (!has_roles_below(root)) return false;
    bounds_.reactions.push_back({made.program, made.kind, made.cause, made.of_tree, {}, {}, no_bound_with_roles, {}});
    return true;
  }

  /// A nested group starts after the outermost one, and runs when that has let it: the bound counts from the outer
  /// start.
  void add_start(ReactionBound made) {
    std::size_t root = made.program;
    MaxPlus heard = MaxPlus::one();
    std::vector<ReactionPart> down;
    while (const auto& outer = r_.programs[root].outer) {
      const ReactionGroup& group = groups_[outer->program].group;
      const MaxPlus step = group.notify(outer->participant, 0);
      heard *= step;
      if (is_bounded(step.ps()))
        down.insert(down.begin(), {group.names[outer->participant] + " hears of Ready", Duration::from_ps(step.ps())});
      root = outer->program;
    }
    if (refuse(root, made)) return;
    rest_on_tree(root, made);
    made.assumptions.add(Assumption::initialisation);
    const ReactionGroup whole = tree_of(root);
    const ReactionGroup own = tree_of(made.program);
    take(made, ready_bound(whole) * heard * run_bound(own), [&] {
      std::vector<ReactionPart> parts = ready_parts(whole);
      for (const std::vector<ReactionPart>& more : {down, run_parts(own)})
        parts.insert(parts.end(), more.begin(), more.end());
      return parts;
    });
  }

  void add_tree(std::size_t root) {
    const ReactionGroup whole = tree_of(root);
    for (const Reaction kind : all_reactions) {
      ReactionBound made;
      made.program = root;
      made.kind = kind;
      made.of_tree = true;
      if (kind == Reaction::start) {
        add_start(std::move(made));  // the outermost master runs last of all
        continue;
      }
      if (refuse(root, made)) continue;
      rest_on_tree(root, made);
      const ReactionGroup called = tree_of(root, kind);
      take(made, spread_bound(called, spread_of(kind)), [&] { return spread_parts(called, spread_of(kind)); });
      if (kind != Reaction::halt || !says_callers(root, kind)) continue;
      made.cause = Cause::mismatch;
      take(made, spread_bound(whole), [&] { return spread_parts(whole); });
    }
    for (const Cause cause : halting_causes) add_halt(root, cause, groups_of_tree(root), true);
  }

  void take(ReactionBound made, MaxPlus whole, const auto& parts) {
    if (is_bounded(whole.ps())) {
      made.bound = Duration::from_ps(whole.ps());
      made.reason.clear();
      made.parts = parts();
    } else if (made.reason.empty()) {
      made.reason = "a notification is unbounded";
    }
    bounds_.reactions.push_back(made);
  }

  const scenario::Resolved& r_;
  Bounds& bounds_;
  std::vector<ProgramGroup> groups_;  // by program
};

}  // namespace

std::vector<Cause> causes_of_halts(const scenario::Resolved& resolved, const Bounds& bounds, std::size_t program,
                                   bool of_tree) {
  std::vector<Cause> causes;
  const bool loses_no_word = std::ranges::all_of(
      resolved.programs[program].members,
      [&](const scenario::ResolvedMember& each) { return bounds.streams[each.state.value].reaches_all; });
  for (const scenario::ProgramFault& fault : scenario::faults_of(resolved, resolved.programs[program])) {
    if (fault.cause == Cause::cut && loses_no_word) continue;  // a copy is left
    causes.push_back(fault.cause.value_or(Cause::silence));
    if (fault.cause == Cause::crash && fault.until != sim::TrueTime::never()) causes.push_back(Cause::restart);
  }
  for (std::size_t inner = 0; of_tree && inner < resolved.programs.size(); ++inner)
    if (const auto& outer = resolved.programs[inner].outer; outer && outer->program == program) {
      const std::vector<Cause> more = causes_of_halts(resolved, bounds, inner, true);
      causes.insert(causes.end(), more.begin(), more.end());
    }
  std::sort(causes.begin(), causes.end());
  causes.erase(std::unique(causes.begin(), causes.end()), causes.end());
  return causes;
}

void add_reactions(const scenario::Resolved& resolved, const BoundOptions& options, Bounds& bounds) {
  ScenarioReactions(resolved, options, bounds).make();
}

}  // namespace takt::analysis
