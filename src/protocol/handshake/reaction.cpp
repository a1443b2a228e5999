// SPDX-License-Identifier: Apache-2.0
#include "handshake/reaction.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::handshake {
namespace {

/// What an alarm tells of its cause by itself.
constexpr Cause cause_of(Alarm alarm) {
  constexpr std::array<Cause, 6> causes{Cause::command, Cause::silence,  Cause::leave,
                                        Cause::restart, Cause::mismatch, Cause::nested};
  return causes[static_cast<std::size_t>(alarm)];
}
static_assert(cause_of(Alarm::peer_silent) == Cause::silence && cause_of(Alarm::peer_left) == Cause::leave &&
              cause_of(Alarm::peer_restarted) == Cause::restart && cause_of(Alarm::mismatch) == Cause::mismatch &&
              cause_of(Alarm::other_group) == Cause::nested);

}  // namespace

ReactionTracker::ReactionTracker(std::size_t participants)
    : state_(participants, PublishedState::Halted),
      is_there_(participants, true),
      left_halted_(participants),
      living_(participants) {
  count_[index_of(PublishedState::Halted)] = participants;
}

void ReactionTracker::on_step(std::size_t participant, const Outputs& outputs, const Word& after, sim::TrueTime at,
                              const Origin& origin) {
  if (outputs.raised && !joins_fault(outputs, after.intent)) {
    Reaction reaction;
    reaction.kind = outputs.raised_kind;
    reaction.initiator = static_cast<std::uint16_t>(participant);
    reaction.cause = origin.cause != Cause::command ? origin.cause : cause_of(outputs.alarm);
    reaction.began = origin.since != sim::TrueTime::never() ? std::max(origin.since, left_halted_[participant]) : at;
    if (origin.by_itself && fault_) {
      reaction.cause = fault_->cause;
      reaction.began = fault_->since;
    }
    if (reaction.kind == IntentKind::Halt && outputs.alarm != Alarm::none)
      fault_ = Origin{reaction.cause, reaction.began};
    if (reaction.kind == IntentKind::Start && !origin.by_itself) fault_.reset();
    begin(reaction, after.intent);
  }
  for (const StateChange& change : outputs.changes()) move(participant, change.to, at);
  if (outputs.raised) complete_those_reached(at);  // an alarm may be raised where all are Halted already
}

/// The second who notices a fault begins no reaction of its own.
bool ReactionTracker::joins_fault(const Outputs& outputs, const Intent& intent) {
  if (outputs.alarm == Alarm::none || outputs.raised_kind != IntentKind::Halt) return false;
  const auto fault = std::find_if(open_.begin(), open_.end(), [&](const Open& each) {
    return reactions_[each.reaction].kind == IntentKind::Halt && reactions_[each.reaction].cause != Cause::command;
  });
  if (fault == open_.end()) return false;
  const std::size_t position = fault->reaction;
  if (standing_of(intent, fault->intent) == Standing::later) fault->intent = intent;
  fault->is_awaited = false;
  supersede(position, intent);
  return true;
}

void ReactionTracker::on_crash(std::size_t participant, sim::TrueTime at) {
  if (!is_there_[participant]) return;
  on_leave(participant, at);
  if (is_reached(IntentKind::Halt)) return;
  // A node that is in several groups of a tree crashes once.
  const auto is_this = [&](const Open& each) {
    return reactions_[each.reaction].cause == Cause::crash && reactions_[each.reaction].began == at;
  };
  if (std::any_of(open_.begin(), open_.end(), is_this)) return;
  fault_ = Origin{Cause::crash, at};
  open_.push_back({reactions_.size(), {}, true});
  reactions_.push_back(
      {IntentKind::Halt, static_cast<std::uint16_t>(participant), Cause::crash, ReactionOutcome::pending, at});
}

void ReactionTracker::on_leave(std::size_t participant, sim::TrueTime at) {
  if (!is_there_[participant]) return;
  is_there_[participant] = false;
  --count_[index_of(state_[participant])];
  --living_;
  complete_those_reached(at);
}

void ReactionTracker::on_restart(std::size_t participant, sim::TrueTime at) {
  if (is_there_[participant]) return move(participant, PublishedState::Halted, at);
  is_there_[participant] = true;
  state_[participant] = PublishedState::Halted;
  ++count_[index_of(PublishedState::Halted)];
  ++living_;
}

void ReactionTracker::begin(const Reaction& reaction, const Intent& intent) {
  const std::size_t position = reactions_.size();
  reactions_.push_back(reaction);
  open_.push_back({position, intent});
  if (!supersede(position, intent)) return;
  reactions_[position].outcome = ReactionOutcome::superseded;
  std::erase_if(open_, [&](const Open& each) { return each.reaction == position; });
}

bool ReactionTracker::supersede(std::size_t position, const Intent& intent) {
  bool superseded = false;
  std::erase_if(open_, [&](const Open& other) {
    if (other.is_awaited || goal_of(reactions_[other.reaction].kind) == goal_of(reactions_[position].kind))
      return false;
    if (intent.number != 0 && other.intent.number != 0 && standing_of(intent, other.intent) == Standing::earlier) {
      superseded = true;
      return false;
    }
    reactions_[other.reaction].outcome = ReactionOutcome::superseded;
    return true;
  });
  return superseded;
}

void ReactionTracker::move(std::size_t participant, PublishedState to, sim::TrueTime at) {
  TAKT_CHECK(participant < state_.size() && is_there_[participant], "only a living participant moves");
  if (state_[participant] == PublishedState::Halted && to != PublishedState::Halted) left_halted_[participant] = at;
  --count_[index_of(state_[participant])];
  ++count_[index_of(to)];
  state_[participant] = to;
  complete_those_reached(at);
}

/// Where nobody lives, all have halted.
bool ReactionTracker::is_reached(IntentKind kind) const {
  return count_[index_of(goal_of(kind))] == living_ && (living_ > 0 || kind == IntentKind::Halt);
}

void ReactionTracker::complete_those_reached(sim::TrueTime at) {
  std::erase_if(open_, [&](const Open& each) {
    Reaction& reaction = reactions_[each.reaction];
    if (!is_reached(reaction.kind)) return false;
    reaction.outcome = ReactionOutcome::completed;
    reaction.completed = at;
    return true;
  });
}

void TreeReactions::on_step(std::size_t number, const Outputs& outputs, sim::TrueTime at, const Origin& origin) {
  Outputs seen = outputs;
  if (outputs.alarm == Alarm::other_group) seen.raised = false;
  tracker_.on_step(number, seen, Word{}, at,
                   origin);  // without an intent: numbers of different groups cannot be compared
}

}  // namespace takt::handshake
