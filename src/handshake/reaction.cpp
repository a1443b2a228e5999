#include "handshake/reaction.hpp"

#include "sim/check.hpp"

namespace takt::handshake {

ReactionTracker::ReactionTracker(std::size_t participants) : state_(participants, PublishedState::Halted) {
  count_[index_of(PublishedState::Halted)] = participants;
}

void ReactionTracker::on_step(std::size_t participant, const Outputs& outputs, const Word& after, sim::TrueTime at) {
  if (outputs.raised) {
    Reaction reaction;
    reaction.kind = outputs.raised_kind;
    reaction.initiator = static_cast<std::uint16_t>(participant);
    reaction.alarm = outputs.alarm;
    reaction.began = at;
    begin(reaction, after.intent);
  }
  for (const StateChange& change : outputs.changes()) move(participant, change.to, at);
  if (outputs.raised) complete_those_reached(at);  // an alarm may be raised where all are Halted already
}

void ReactionTracker::on_restart(std::size_t participant, sim::TrueTime at) {
  move(participant, PublishedState::Halted, at);
}

void ReactionTracker::begin(const Reaction& reaction, const Intent& intent) {
  const std::size_t position = reactions_.size();
  reactions_.push_back(reaction);
  bool superseded = false;
  std::erase_if(open_, [&](const Open& other) {
    if (goal_of(reactions_[other.reaction].kind) == goal_of(reaction.kind)) return false;
    if (intent.number != 0 && other.intent.number != 0 && standing_of(intent, other.intent) == Standing::earlier) {
      superseded = true;
      return false;
    }
    reactions_[other.reaction].outcome = ReactionOutcome::Superseded;
    return true;
  });
  if (superseded) {
    reactions_[position].outcome = ReactionOutcome::Superseded;
  } else {
    open_.push_back({position, intent});
  }
}

void ReactionTracker::move(std::size_t participant, PublishedState to, sim::TrueTime at) {
  TAKT_CHECK(participant < state_.size(), "only a participant moves");
  --count_[index_of(state_[participant])];
  ++count_[index_of(to)];
  state_[participant] = to;
  complete_those_reached(at);
}

void ReactionTracker::complete_those_reached(sim::TrueTime at) {
  std::erase_if(open_, [&](const Open& each) {
    Reaction& reaction = reactions_[each.reaction];
    if (count_[index_of(goal_of(reaction.kind))] != state_.size()) return false;
    reaction.outcome = ReactionOutcome::Completed;
    reaction.completed = at;
    return true;
  });
}

}  // namespace takt::handshake
