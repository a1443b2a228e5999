// SPDX-License-Identifier: Apache-2.0
#include "handshake/participant.hpp"

#include "sim/check.hpp"

namespace takt::handshake {

template <std::size_t MaxPeers>
Participant<MaxPeers>::Participant(const Config& config) : config_(config) {
  TAKT_CHECK(config.slaves >= 1, "a group has at least one slave");
  TAKT_CHECK((config.role == Role::master) == (config.index == 0), "the master is participant 0, a slave is not");
  TAKT_CHECK(config.index <= config.slaves, "a participant's index is within its group");
  TAKT_CHECK(!config.nested || config.variant == Variant::robust, "the states alone cannot join two groups");
  TAKT_CHECK(peer_count() <= MaxPeers, "a participant has room for all its peers");
}

template <std::size_t MaxPeers>
Outputs Participant<MaxPeers>::step(const Input& input) {
  // Nearly all steps are these, once a cycle for each peer. (In `paper` no word is the next: sequence numbers are not
  // noted.)
  if (input.kind == Input::Kind::received && robust_is_next(input)) [[likely]] {
    if (robust_says_nothing_new(input)) [[likely]] {
      peers_[input.peer].sequence = input.sequence;
      return Outputs::of_a_word(input.peer);  // robust_barrier() would not move from here
    }
    if (input.word.incarnation == peers_[input.peer].incarnation) return robust_follow(input);
  }
  return step_at_length(input);
}

template <std::size_t MaxPeers>
Outputs Participant<MaxPeers>::step_at_length(const Input& input) {
  return input.kind == Input::Kind::received && config_.variant == Variant::robust ? robust_hear(input) : take(input);
}

/// A step with all that may come of it; but a word in `robust`.
template <std::size_t MaxPeers>
Outputs Participant<MaxPeers>::take(const Input& input) {
  const bool robust = config_.variant == Variant::robust;
  Outputs outputs;
  // What word() tells besides the intent, which says itself that it has changed.
  const PublishedState state_before = state();
  const std::uint32_t run_before = run_;
  switch (input.kind) {
    case Input::Kind::command:
      // A nested group is started through the group that it is nested in.
      if (config_.nested && is_master() && input.method == program::Method::Start && !input.coupled)
        outputs.status = program::StatusCode::BadInvalidState;
      else
        robust ? robust_command(input.method, outputs) : paper_command(input.method, outputs);
      break;
    case Input::Kind::received:
      TAKT_CHECK(input.peer < peer_count() && !robust, "a word comes from a peer");
      paper_received(input, outputs);
      break;
    case Input::Kind::initialised:
      initialised(input.run, outputs);
      break;
    case Input::Kind::finished:
      finished(input.coupled, outputs);
      break;
    case Input::Kind::released:
      if (config_.nested && input.run == run_ && may_run()) move_to(PublishedState::Running, outputs);
      break;
    case Input::Kind::peer_left:
      TAKT_CHECK((is_master() || config_.nested) && input.peer < peer_count() && robust,
                 "the master's peers leave, or those of an inner group");
      if (state() != PublishedState::Halted) raise_alarm(Alarm::peer_left, intent_.number, outputs);
      break;
    case Input::Kind::peer_replaced:
      TAKT_CHECK(is_master() && input.peer < peer_count(), "the master's peers are replaced");
      if (machine_.at_rest()) {
        peers_[input.peer] = {};
        sort_peer(input.peer);
      }
      break;
    case Input::Kind::peer_silent:
      TAKT_CHECK(input.peer < peer_count(), "only a peer falls silent");
      if (robust) robust_silent(input.peer, outputs);
      break;
  }
  outputs.publish = outputs.publish || state() != state_before || run_ != run_before;
  if (input.coupled && outputs.raised) outputs.alarm = Alarm::other_group;
  check_word(outputs);
  return outputs;
}

/// A word behind the last one of a peer, under the intent that stands here.
template <std::size_t MaxPeers>
inline bool Participant<MaxPeers>::robust_is_next(const Input& input) const {
  if (input.word.intent != intent_ || input.peer >= MaxPeers) return false;
  const Peer& peer = peers_[input.peer];  // one that is no peer was never heard
  const auto ahead = static_cast<std::int16_t>(static_cast<std::uint16_t>(input.sequence - peer.sequence));
  return peer.sequence_known && ahead >= 0;
}

/// Such a word of which robust_received would note the sequence number only: what the peer said last, in the same life,
/// and what this participant says itself. So it can be said under this intent: a peer that has said it under another
/// one, and says so still, is damaged or made up. Whoever is Ready or in INIT may have a barrier to take.
template <std::size_t MaxPeers>
inline bool Participant<MaxPeers>::robust_says_nothing_new(const Input& input) const {
  const Peer& peer = peers_[input.peer];
  const Word& word = input.word;
  const auto both = [](std::uint32_t incarnation, std::uint32_t run) {
    return incarnation | std::uint64_t{run} << 32;
  };  // neighbours in memory
  return machine_.is_just_in(static_cast<program::State>(word.state)) && word.state != PublishedState::Ready &&
         word.state == peer.state && both(word.incarnation, word.run) == both(peer.incarnation, peer.run) &&
         word.run == run_;
}

/// One that is nested may be Ready already: then the run that it is to be Ready in has waited for the other group.
template <std::size_t MaxPeers>
void Participant<MaxPeers>::initialised(std::uint32_t run, Outputs& outputs) {
  const bool joins =
      config_.nested && state() == PublishedState::Ready && intent_.kind == IntentKind::Start && run_ != intent_.run;
  if ((!machine_.initialising() && !joins) || run != intent_.run) return;
  if (is_master()) {
    initialised_ = true;
    config_.variant == Variant::robust ? robust_barrier(outputs) : paper_barrier(outputs);
  } else {
    run_ = intent_.run;
    move_to(PublishedState::Ready, outputs);
  }
}

template <std::size_t MaxPeers>
void Participant<MaxPeers>::finished(bool coupled, Outputs& outputs) {
  // The other group may have finished within its own barrier, while this one is still in its.
  const bool in_barrier = coupled && config_.nested && intent_.kind == IntentKind::Start &&
                          state() != PublishedState::Halted &&
                          (is_master() ? run_ == intent_.run || peers_ready() : may_run());
  if (machine_.state() != program::State::Running && !in_barrier) return;
  if (config_.variant == Variant::robust) {
    if (in_barrier) run_ = intent_.run;
    raise(IntentKind::Finish, intent_.number, outputs);
  } else {
    outputs.raised = true;
    outputs.raised_kind = IntentKind::Finish;
  }
  move_to(PublishedState::Ready, outputs);
}

template <std::size_t MaxPeers>
bool Participant<MaxPeers>::may_run() const {
  return !is_master() && intent_.kind == IntentKind::Start && state() == PublishedState::Ready && run_ == intent_.run &&
         ((ready_ | running_) & 1U) != 0;
}

template <std::size_t MaxPeers>
bool Participant<MaxPeers>::process_data_counts(std::size_t peer) const {
  TAKT_CHECK(peer < peer_count(), "process data comes from a peer");
  return process_data_counts(peer, peers_[peer].run);
}

template <std::size_t MaxPeers>
bool Participant<MaxPeers>::process_data_counts(std::size_t peer, std::uint32_t sender_run) const {
  TAKT_CHECK(peer < peer_count(), "process data comes from a peer");
  const Peer& sender = peers_[peer];
  return machine_.state() == program::State::Running && sender.state == PublishedState::Running && sender.run == run_ &&
         sender_run == run_;
}

/// Goes to a state by the one transition that leads there. INIT is always entered afresh, from Halted.
template <std::size_t MaxPeers>
void Participant<MaxPeers>::move_to(PublishedState target, Outputs& outputs) {
  const PublishedState from = state();
  if (target == PublishedState::HaltedInit) {
    if (from != PublishedState::Halted) move_to(PublishedState::Halted, outputs);
    enter_init(outputs);
    return;
  }
  if (target == from) return;
  if (target == PublishedState::Halted) run_ = 0;
  initialised_ = false;
  if (machine_.state() == base_state(target)) {
    machine_.leave_init();
    record(0, from, outputs);
    return;
  }
  const program::Transition* transition = program::transition_between(machine_.state(), base_state(target));
  TAKT_CHECK(transition != nullptr, "the rules ask only for moves that one transition makes");
  machine_.apply(*transition);
  record(transition->number, from, outputs);
}

template <std::size_t MaxPeers>
void Participant<MaxPeers>::enter_init(Outputs& outputs) {
  machine_.enter_init();
  run_ = 0;
  record(0, PublishedState::Halted, outputs);
  outputs.begin_initialisation = true;
  outputs.initialisation_run = intent_.run;
  // Whoever has not been heard for long gets a full time-out from the moment at which it begins to matter.
  if (config_.variant == Variant::robust) outputs.arm_timeout = all_peers();
}

template <std::size_t MaxPeers>
void Participant<MaxPeers>::record(std::uint8_t transition, PublishedState from, Outputs& outputs) {
  outputs.add({transition, from, state()});
  if (from == PublishedState::Running) outputs.process_stopped = true;
  if (state() == PublishedState::Running) outputs.process_started = true;
}

/// Keeps ready_ and running_ true for all peers, after intent_ has changed.
template <std::size_t MaxPeers>
void Participant<MaxPeers>::sort_all_peers() {
  PeerSet ready = 0;
  PeerSet running = 0;
  const std::size_t count = peer_count();
  for (std::size_t peer = 0; peer < count; ++peer) {
    const PeerSet counts = peers_[peer].run == intent_.run ? 1 : 0;
    ready |= (peers_[peer].state == PublishedState::Ready ? counts : 0) << peer;
    running |= (peers_[peer].state == PublishedState::Running ? counts : 0) << peer;
  }
  ready_ = ready;
  running_ = running;
}

template <std::size_t MaxPeers>
auto Participant<MaxPeers>::renamed(std::span<const std::uint8_t> to) const -> Participant {
  TAKT_CHECK(to.size() > config_.slaves && to[0] == 0,
             "a new index for each participant, and the master stays the master");
  Participant result = *this;
  result.config_.index = to[config_.index];
  result.intent_.origin = intent_.origin < to.size() ? to[intent_.origin] : intent_.origin;
  result.ready_ = 0;
  result.running_ = 0;
  for (std::size_t peer = 0; peer < peer_count(); ++peer) {
    const std::size_t other = result.peer_of(to[participant_of(peer)]);
    TAKT_CHECK(other < peer_count(), "no two participants have one index");
    result.peers_[other] = peers_[peer];
    result.ready_ |= (ready_ >> peer & 1U) << other;
    result.running_ |= (running_ >> peer & 1U) << other;
  }
  return result;
}

template <std::size_t MaxPeers>
auto Participant<MaxPeers>::part_of(std::size_t peer) const -> PeerPart {
  TAKT_CHECK(peer < peer_count(), "only a peer is known");
  return {peers_[peer], (ready_ >> peer & 1U) != 0, (running_ >> peer & 1U) != 0};
}

template <std::size_t MaxPeers>
auto Participant<MaxPeers>::with_parts(std::span<const PeerPart> parts) const -> Participant {
  TAKT_CHECK(!parts.empty() && parts.size() <= MaxPeers && (is_master() || parts.size() == 1),
             "a participant has room for all its peers");
  Participant result = *this;
  if (is_master()) result.config_.slaves = static_cast<std::uint8_t>(parts.size());
  result.peers_ = {};
  result.ready_ = 0;
  result.running_ = 0;
  for (std::size_t peer = 0; peer < parts.size(); ++peer) {
    result.peers_[peer] = parts[peer].peer;
    result.ready_ |= PeerSet{parts[peer].ready} << peer;
    result.running_ |= PeerSet{parts[peer].running} << peer;
  }
  return result;
}

template <std::size_t MaxPeers>
bool Participant<MaxPeers>::has_heard_beyond(std::size_t peer, std::uint16_t sequence) const {
  const Peer& each = peers_[peer];
  return each.sequence_known && static_cast<std::int16_t>(static_cast<std::uint16_t>(sequence - each.sequence)) < 0;
}

template <std::size_t MaxPeers>
std::uint64_t Participant<MaxPeers>::hash() const {
  std::uint64_t digest = 0xCBF29CE484222325ULL;
  const auto mix = [&digest](std::uint64_t value) {
    digest = (digest ^ value) * 0x9E3779B97F4A7C15ULL;
    digest ^= digest >> 29;
  };
  const auto byte = [](auto value) { return static_cast<std::uint64_t>(static_cast<std::uint8_t>(value)); };
  mix(byte(config_.variant) | byte(config_.role) << 8 | byte(config_.nested) << 9 | byte(config_.index) << 16 |
      byte(config_.slaves) << 24 | byte(config_.subscription) << 31 | std::uint64_t{config_.incarnation} << 32);
  mix(byte(state()) | byte(machine_.last_transition()) << 8 | byte(initialised_) << 16 | byte(intent_.kind) << 24 |
      std::uint64_t{intent_.number} << 32);
  mix(byte(intent_.origin) | std::uint64_t{intent_.run} << 8);
  mix(run_);
  // ready_ and running_ follow from the rest.
  for (std::size_t i = 0; i < peer_count(); ++i) {
    const Peer& peer = peers_[i];
    mix(std::uint64_t{peer.incarnation} | std::uint64_t{peer.run} << 32);
    mix(peer.sequence | byte(peer.state) << 16 | byte(peer.heard) << 24 | byte(peer.sequence_known) << 32);
  }
  return digest;
}

template class Participant<4>;
template class Participant<64>;

}  // namespace takt::handshake
