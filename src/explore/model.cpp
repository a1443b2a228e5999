#include "explore/model.hpp"

#include <algorithm>
#include <utility>

#include "sim/check.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::PublishedState;
using handshake::Variant;
using program::Method;

Model::Model(const Question& question)
    : question_(question), renamings_(question.slaves, question.symmetry), members_(question_, renamings_) {
  TAKT_CHECK(question.slaves >= 1 && question.slaves <= most_slaves, "a group to explore is small");
  TAKT_CHECK(question.commands <= most_commands && question.fault_budget <= most_faults, "budgets are small");
  list_actions();
  make_beginnings();
}

void Model::list_actions() {
  const auto slaves = static_cast<std::uint8_t>(question_.slaves);
  const auto channels = static_cast<std::uint8_t>(2 * slaves);
  const auto add = [this](ActionKind kind, std::uint8_t who, std::uint8_t what) { actions_.push_back({kind, who, what}); };
  const auto each_peer = [&](ActionKind kind) {
    for (std::uint8_t slave = 0; slave < slaves; ++slave) add(kind, 0, slave);
    for (std::uint8_t i = 1; i <= slaves; ++i) add(kind, i, 0);
  };
  for (const ActionKind kind : {ActionKind::send, ActionKind::receive})
    for (std::uint8_t c = 0; c < channels; ++c) add(kind, c, 0);
  add(ActionKind::deliver_late, 0, 0);
  for (std::uint8_t i = 0; i <= slaves; ++i) add(ActionKind::initialised, i, 0);
  if (question_.faults.contains(Fault::crash)) each_peer(ActionKind::silence);
  network_count_ = actions_.size();
  for (std::uint8_t i = 0; i <= slaves; ++i)
    for (std::uint8_t m = 0; m < program::methods.size(); ++m) add(ActionKind::call, i, m);
  for (std::uint8_t i = 0; i <= slaves && question_.finishes; ++i) add(ActionKind::finish, i, 0);
  const auto each_channel = [&](ActionKind kind) {
    for (std::uint8_t c = 0; c < channels; ++c) add(kind, c, 0);
  };
  const auto each_participant = [&](ActionKind kind) {
    for (std::uint8_t i = 0; i <= slaves; ++i) add(kind, i, 0);
  };
  if (question_.faults.contains(Fault::loss)) each_channel(ActionKind::lose);
  if (question_.faults.contains(Fault::duplicate)) each_channel(ActionKind::duplicate);
  if (question_.faults.contains(Fault::reorder)) each_channel(ActionKind::reorder);
  if (question_.faults.contains(Fault::crash)) each_participant(ActionKind::crash);
  if (question_.faults.contains(Fault::restart)) each_participant(ActionKind::restart);
  if (question_.faults.contains(Fault::timeout)) each_peer(ActionKind::timeout);
}

bool Model::act(const State& state, Action action, Next& next) {
  next.state = state;
  next.properties = {};
  switch (action.kind) {
    case ActionKind::send: return send(action.who, next);
    case ActionKind::receive: return receive(action.who, next);
    case ActionKind::deliver_late: return deliver_late(next);
    case ActionKind::initialised:
      return members_[state.member(action.who)].state == PublishedState::HaltedInit && !is_down(state, action.who) &&
             step(action.who, {Input::Kind::Initialised}, next);
    case ActionKind::silence: return expire(action.who, action.what, true, next);
    case ActionKind::call: return call(action.who, action.what, next);
    case ActionKind::finish: return finish(action.who, next);
    default: break;
  }
  // A participant that is down may always come up again; everything else here costs a fault.
  const bool is_free = action.kind == ActionKind::restart && is_down(state, action.who);
  if (!is_free) {
    if (state.faults_left() == 0) return false;
    next.state.set_faults_left(state.faults_left() - 1);
  }
  switch (action.kind) {
    case ActionKind::lose: return lose(action.who, next);
    case ActionKind::duplicate: return keep_copy(action.who, false, next);
    case ActionKind::reorder: return keep_copy(action.who, true, next);
    case ActionKind::crash: return crash(action.who, next);
    case ActionKind::restart: return restart(action.who, next);
    case ActionKind::timeout: return expire(action.who, action.what, false, next);
    default: return false;
  }
}

bool Model::send(std::size_t channel, Next& next) const {
  State& state = next.state;
  const Members::Traits& sender = members_[state.member(sender_of(channel, question_.slaves))];
  if (sender.down || (sender.word == state.reg(channel) && !state.outdated(channel))) return false;
  state.set_reg(channel, sender.word);
  state.set_outdated(channel, false);
  if (state.late() == Late::same && state.late_channel() == channel) state.set_late(Late::newer_sent);
  return true;
}

bool Model::receive(std::size_t channel, Next& next) {
  const WordId word = next.state.reg(channel);
  const std::size_t receiver = receiver_of(channel, question_.slaves);
  if (word == no_word || is_down(next.state, receiver)) return false;
  const bool outdated = next.state.outdated(channel);
  bool data_counts = false;
  const auto peer = static_cast<std::uint8_t>(peer_at_receiver(channel, question_.slaves));
  bool changed = step(receiver, {Input::Kind::Received, peer, word, false}, next, data_counts);
  if (next.state.late() == Late::newer_sent && next.state.late_channel() == channel) {
    next.state.set_late(Late::overtaken);
    changed = true;
  }
  if (data_counts && outdated) next.properties.insert(Property::S3);
  return changed || next.properties.bits != 0;
}

bool Model::deliver_late(Next& next) {
  if (next.state.late() == Late::none) return false;
  const std::size_t channel = next.state.late_channel();
  const std::size_t receiver = receiver_of(channel, question_.slaves);
  const bool outdated = next.state.outdated(2U * question_.slaves);
  if (!is_down(next.state, receiver)) {
    const auto peer = static_cast<std::uint8_t>(peer_at_receiver(channel, question_.slaves));
    bool data_counts = false;
    step(receiver, {Input::Kind::Received, peer, next.state.late_word(), next.state.late() == Late::overtaken}, next, data_counts);
    if (data_counts && outdated) next.properties.insert(Property::S3);
  }
  next.state.clear_late();
  next.state.set_outdated(2U * question_.slaves, false);
  return true;
}

bool Model::call(std::size_t participant, std::size_t method, Next& next) {
  State& state = next.state;
  if (state.commands_left() == 0 || ((members_[state.member(participant)].calls >> method) & 1U) == 0) return false;
  if (question_.variant == Variant::Paper && at_rest(state)) {
    Ghost ghost = ghosts_[state.ghost()];
    ghost.at_rest();
    state.set_ghost(intern_ghost(ghost));
  }
  state.set_commands_left(state.commands_left() - 1);
  step(participant, {Input::Kind::Command, static_cast<std::uint8_t>(method)}, next);
  return true;
}

bool Model::finish(std::size_t participant, Next& next) {
  const Members::Traits& member = members_[next.state.member(participant)];
  if (next.state.commands_left() == 0 || member.down || member.state != PublishedState::Running) return false;
  if (question_.variant == Variant::Paper && at_rest(next.state)) {
    Ghost ghost = ghosts_[next.state.ghost()];
    ghost.at_rest();
    next.state.set_ghost(intern_ghost(ghost));
  }
  next.state.set_commands_left(next.state.commands_left() - 1);
  step(participant, {Input::Kind::Finished}, next);
  return true;
}

bool Model::lose(std::size_t channel, Next& next) const {
  if (next.state.reg(channel) == no_word) return false;
  next.state.set_reg(channel, no_word);
  next.state.set_outdated(channel, false);
  return true;
}

/// A copy of what stands in the register stays behind; if it is to be overtaken, the next word is published at once.
bool Model::keep_copy(std::size_t channel, bool overtaken, Next& next) const {
  State& state = next.state;
  if (state.late() != Late::none || state.reg(channel) == no_word) return false;
  state.set_late(Late::same, channel, state.reg(channel));
  state.set_outdated(2U * question_.slaves, state.outdated(channel));
  return !overtaken || send(channel, next);
}

bool Model::crash(std::size_t participant, Next& next) {
  if (is_down(next.state, participant)) return false;
  next.state.set_member(participant, members_.down(participant, members_.incarnation(next.state.member(participant))));
  return true;
}

/// A participant that is up goes down and comes up at once.
bool Model::restart(std::size_t participant, Next& next) {
  const std::uint32_t incarnation = members_.incarnation(next.state.member(participant));
  // `paper` does not publish incarnations, so its lives need not be told apart.
  next.state.set_member(participant, members_.fresh(participant, question_.variant == Variant::Paper ? incarnation : incarnation + 1));
  Ghost ghost = ghosts_[next.state.ghost()];
  ghost.on_restart(participant);
  next.state.set_ghost(intern_ghost(ghost));
  return true;
}

bool Model::expire(std::size_t participant, std::size_t peer, bool peer_is_down, Next& next) {
  const std::size_t other = participant == 0 ? peer + 1 : 0;
  if (is_down(next.state, participant) || is_down(next.state, other) != peer_is_down) return false;
  bool changed = step(participant, {Input::Kind::PeerSilent, static_cast<std::uint8_t>(peer)}, next);
  // Silence means that nothing of the peer is under way any more.
  const std::size_t channel = participant == 0 ? peer : participant - 1U + question_.slaves;
  if (peer_is_down && next.state.reg(channel) != no_word) {
    next.state.set_reg(channel, no_word);
    next.state.set_outdated(channel, false);
    changed = true;
  }
  return changed || next.properties.bits != 0;
}

bool Model::step(std::size_t participant, const Stimulus& stimulus, Next& next, bool& data_counts) {
  const MemberId before = next.state.member(participant);
  const Stepped stepped = members_.step(before, stimulus);
  data_counts = stepped.data_counts;
  next.state.set_member(participant, stepped.member);
  if (stepped.effect != 0) watch(participant, stepped.effect, next);
  return stepped.member != before;
}

/// Shows a step to the ghost.
void Model::watch(std::size_t participant, std::uint16_t effect, Next& next) {
  const Effect& seen = members_.effect(effect);
  const std::uint64_t key = std::uint64_t{next.state.ghost()} << 20 | std::uint64_t{participant} << 16 | effect;
  std::uint64_t found = watched_.find(key);
  if (found == Memo::absent) {
    Ghost ghost = ghosts_[next.state.ghost()];
    const PropertySet violated = ghost.on_effect(participant, seen);
    found = std::uint64_t{intern_ghost(ghost)} | std::uint64_t{violated.bits} << 32;
    watched_.insert(key, found);
  }
  next.state.set_ghost(static_cast<std::uint32_t>(found));
  next.properties.bits |= static_cast<std::uint32_t>(found >> 32) | seen.properties.bits;
  if (question_.variant != Variant::Paper || !seen.begins_round()) return;
  for (std::size_t c = 0; c < 2U * question_.slaves; ++c)
    if (receiver_of(c, question_.slaves) == participant && next.state.reg(c) != no_word &&
        members_.word(next.state.reg(c)).state == PublishedState::Running)
      next.state.set_outdated(c, true);
  if (next.state.late() != Late::none && receiver_of(next.state.late_channel(), question_.slaves) == participant)
    next.state.set_outdated(2U * question_.slaves, true);
}

std::uint32_t Model::intern_ghost(const Ghost& ghost) {
  const std::uint32_t id = ghosts_.intern(ghost);
  const std::size_t count = renamings_.size();
  if ((id + 1U) * count <= renamed_ghost_.size()) return id;
  std::vector<std::uint32_t> images;
  for (std::size_t r = 0; r < count; ++r) images.push_back(ghosts_.intern(ghost.renamed(renamings_[r])));
  renamed_ghost_.resize(ghosts_.size() * count, 0);
  for (std::size_t r = 0; r < count; ++r)
    for (std::size_t s = 0; s < count; ++s) renamed_ghost_[images[r] * count + s] = images[renamings_.then(r, s)];
  return id;
}

bool Model::anybody_down(const State& state) const {
  for (std::size_t i = 0; i <= question_.slaves; ++i)
    if (is_down(state, i)) return true;
  return false;
}

bool Model::all_running(const State& state) const {
  for (std::size_t i = 0; i <= question_.slaves; ++i)
    if (members_[state.member(i)].state != PublishedState::Running || is_down(state, i)) return false;
  return true;
}

/// Nothing is under way: all are in one state, and every register says so.
bool Model::at_rest(const State& state) const {
  const PublishedState first = members_[state.member(0)].state;
  if (first == PublishedState::HaltedInit || state.late() != Late::none) return false;
  for (std::size_t i = 0; i <= question_.slaves; ++i)
    if (is_down(state, i) || members_[state.member(i)].state != first) return false;
  for (std::size_t c = 0; c < 2U * question_.slaves; ++c)
    if (state.reg(c) != members_[state.member(sender_of(c, question_.slaves))].word) return false;
  return true;
}

bool Model::settled(const State& state) const {
  if (anybody_down(state)) {
    for (std::size_t i = 0; i <= question_.slaves; ++i)
      if (!is_down(state, i) && members_[state.member(i)].state != PublishedState::Halted) return false;
    return true;
  }
  const handshake::Word& first = members_.word(members_[state.member(0)].word);
  for (std::size_t i = 1; i <= question_.slaves; ++i) {
    const handshake::Word& word = members_.word(members_[state.member(i)].word);
    if (word.state != first.state || !(word.intent == first.intent)) return false;
  }
  if (question_.variant == Variant::Robust) return first.state == handshake::goal_of(first.intent.kind);
  return first.state != PublishedState::HaltedInit && ghosts_[state.ghost()].asked(first.state);
}

}  // namespace takt::explore
