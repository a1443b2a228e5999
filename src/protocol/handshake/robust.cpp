// SPDX-License-Identifier: Apache-2.0
// The rules of the variant `robust`. Each rule is explained in README.md; here they stand in the order of a step.
#include <algorithm>
#include <array>
#include <optional>

#include "handshake/participant.hpp"
#include "sim/check.hpp"

namespace takt::handshake {
namespace {

using program::Method;
using program::StatusCode;

constexpr auto halted = PublishedState::Halted;
constexpr auto ready = PublishedState::Ready;
constexpr auto running = PublishedState::Running;
constexpr auto suspended = PublishedState::Suspended;
constexpr auto init = PublishedState::HaltedInit;
constexpr std::optional<PublishedState> mismatch = std::nullopt;

using Row = std::array<std::optional<PublishedState>, published_state_count>;

/// Where a participant goes when it adopts an intent of a kind (row) in a state (column); mismatch: it cannot follow.
constexpr std::array<Row, intent_kind_count> reactions{{
    //  Halted     Ready      Running    Suspended  INIT
    Row{init, ready, init, init, init},                       // Start
    Row{mismatch, mismatch, running, running, mismatch},      // Resume
    Row{mismatch, mismatch, suspended, suspended, mismatch},  // Suspend
    Row{mismatch, ready, ready, ready, mismatch},             // Finish
    Row{mismatch, ready, ready, ready, mismatch},             // Reset
    Row{halted, halted, halted, halted, halted},              // Halt
}};

/// A reaction is one transition, or goes through Halted to INIT, or the state stays.
constexpr bool reactions_are_sound() {
  for (std::size_t kind = 0; kind < intent_kind_count; ++kind) {
    for (std::size_t from = 0; from < published_state_count; ++from) {
      const std::optional<PublishedState> to = reactions[kind][from];
      if (!to || *to == init) continue;
      if (*to != goal_of(static_cast<IntentKind>(kind)) && static_cast<IntentKind>(kind) != IntentKind::Start)
        return false;
      const program::State base = base_state(published_state_at(from));
      if (base != base_state(*to) && !program::transition_exists(base, base_state(*to))) return false;
    }
  }
  return true;
}
static_assert(reactions_are_sound(), "each reaction is a move that the machine can make, towards the intent's goal");

constexpr bool belongs_to_a_run(IntentKind kind) { return kind != IntentKind::Start && kind != IntentKind::Halt; }

}  // namespace

template <std::size_t MaxPeers>
void Participant<MaxPeers>::robust_command(Method method, Outputs& outputs) {
  const PublishedState now = state();
  bool allowed = false;
  switch (method) {
    case Method::Start:
      allowed = robust_may_start();
      break;
    case Method::Halt:
      allowed = now != halted;
      break;
    case Method::Suspend:
      allowed = robust_may_suspend();
      break;
    case Method::Resume:
    case Method::Reset:
      allowed = now == suspended;
      break;
  }
  if (!allowed) {
    outputs.status = StatusCode::BadInvalidState;
    return;
  }
  const IntentKind kind = kind_of(method);
  raise(kind, intent_.number, outputs);
  // Ready stays Ready on a Start: run_ follows when all slaves are Ready in the new run (robust_barrier).
  move_to(*reactions[index_of(kind)][index_of(now)], outputs);
}

template <std::size_t MaxPeers>
bool Participant<MaxPeers>::robust_may_start() const {
  if (!is_master()) return false;
  if (state() == halted) return true;
  return state() == ready && (intent_.kind == IntentKind::Reset || intent_.kind == IntentKind::Finish);
}

/// A slave waits until it knows that the barrier is over, so nobody can be caught Ready by a suspend.
template <std::size_t MaxPeers>
bool Participant<MaxPeers>::robust_may_suspend() const {
  if (state() != running) return false;
  if (is_master()) return true;
  return peers_[0].run == run_ && (peers_[0].state == running || peers_[0].state == suspended);
}

template <std::size_t MaxPeers>
inline void Participant<MaxPeers>::robust_received(const Input& input, Outputs& outputs) {
  const Word& word = input.word;
  const bool is_sound = is_valid(word, Variant::robust, config_.slaves);
  const Freshness freshness = is_sound ? note_word(peers_[input.peer], word, input.sequence) : Freshness::stale;
  if (freshness == Freshness::stale) {
    outputs.ignored = true;
    return;
  }
  outputs.arm_timeout = PeerSet{1} << input.peer;
  sort_peer(input.peer);
  const bool is_greater = supersedes(word.intent, input.peer);
  const bool is_current = is_greater || word.intent == intent_;
  const std::uint32_t above = is_greater ? word.intent.number : intent_.number;
  if (freshness == Freshness::restarted && state() != halted) {
    raise_alarm(Alarm::peer_restarted, above, outputs);
  } else if (is_current && counted_without_me(input.peer, word)) {
    raise_alarm(Alarm::mismatch, above, outputs);
  } else if (is_current && ran_without_me(word)) {
    raise_alarm(Alarm::mismatch, above, outputs);
  } else if (is_greater) {
    adopt(word.intent, outputs);
  }
  if (is_in_barrier()) robust_barrier(outputs);
}

/// A step with a word.
template <std::size_t MaxPeers>
Outputs Participant<MaxPeers>::robust_hear(const Input& input) {
  TAKT_CHECK(input.peer < peer_count(), "a word comes from a peer");
  Outputs outputs;
  const std::uint32_t run_before = run_;
  robust_received(input, outputs);
  outputs.publish =
      outputs.publish || outputs.change_count > 0 || run_ != run_before;  // INIT is begun anew for a new intent only
  check_word(outputs);
  return outputs;
}

/// The same of the next word of a peer's present life, shorter: its intent is the one here, which is valid, and it is
/// fresh. An alarm is left to the long way.
template <std::size_t MaxPeers>
Outputs Participant<MaxPeers>::robust_follow(const Input& input) {
  const Word& word = input.word;
  if (!may_hold(word.intent, word.state, word.run) || counted_without_me(input.peer, word) || ran_without_me(word))
      [[unlikely]]
    return robust_hear(input);
  return robust_take_note(input);
}

template <std::size_t MaxPeers>
inline Outputs Participant<MaxPeers>::robust_take_note(const Input& input) {
  Outputs outputs = Outputs::of_a_word(input.peer);
  const Word& word = input.word;
  Peer& peer = peers_[input.peer];
  peer.sequence = input.sequence;
  if (word.state != peer.state || word.run != peer.run) {
    peer.run = word.run;
    peer.state = word.state;
    sort_peer(input.peer);
  }
  if (!is_in_barrier()) return outputs;
  const std::uint32_t run_before = run_;
  robust_barrier(outputs);
  outputs.publish = outputs.change_count > 0 || run_ != run_before;
  check_word(outputs);
  return outputs;
}

/// Remembers a word unless it is older than what is known.
template <std::size_t MaxPeers>
auto Participant<MaxPeers>::note_word(Peer& peer, const Word& word, std::uint16_t sequence) -> Freshness {
  Freshness freshness = Freshness::fresh;
  if (peer.heard && word.incarnation == peer.incarnation) {
    const auto ahead = static_cast<std::int16_t>(static_cast<std::uint16_t>(sequence - peer.sequence));
    if (peer.sequence_known && ahead < 0) return Freshness::stale;
  } else if (peer.heard) {
    // A late word of a former incarnation looks the same. It costs a halt; to tell them apart would take an order of
    // incarnations, and whoever got that wrong would be ignored for ever.
    freshness = Freshness::restarted;
  }
  peer.incarnation = word.incarnation;
  peer.run = word.run;
  peer.sequence = sequence;
  peer.state = word.state;
  peer.heard = true;
  peer.sequence_known = true;
  return freshness;
}

/// Later ones do. Of two that are apart the master's holds, or neither side could ever follow the other.
template <std::size_t MaxPeers>
bool Participant<MaxPeers>::supersedes(const Intent& intent, std::size_t peer) const {
  const Standing standing = standing_of(intent, intent_);
  return standing == Standing::later || (standing == Standing::apart && !is_master() && peer == 0);
}

/// The master has taken me into the barrier of a run in which I have never been: I must have lost my memory since.
template <std::size_t MaxPeers>
bool Participant<MaxPeers>::counted_without_me(std::size_t peer, const Word& word) const {
  return word.run != run_ && word.intent.kind == IntentKind::Start && !is_master() && peer == 0 &&
         word.run == word.intent.run;
}

/// A slave runs in a run in which I have never been Ready: somebody has told it that I am.
template <std::size_t MaxPeers>
bool Participant<MaxPeers>::ran_without_me(const Word& word) const {
  return word.run != run_ && word.intent.kind == IntentKind::Start && is_master() && word.state == running;
}

template <std::size_t MaxPeers>
void Participant<MaxPeers>::adopt(const Intent& intent, Outputs& outputs) {
  const std::optional<PublishedState> target = reactions[index_of(intent.kind)][index_of(state())];
  const bool another_run = belongs_to_a_run(intent.kind) && intent.run != run_;
  // Only the master starts, so a start that it does not know is one of its former life.
  const bool former_start = is_master() && intent.kind == IntentKind::Start;
  if (!target || another_run || former_start) {
    raise_alarm(Alarm::mismatch, intent.number, outputs);
    return;
  }
  const bool is_another_run = intent.run != intent_.run;
  intent_ = intent;
  outputs.publish = true;
  if (is_another_run) sort_all_peers();
  // One that is nested joins the new run when the other group is ready for it (Initialised).
  if (intent.kind == IntentKind::Start && state() == ready && !config_.nested) run_ = intent.run;
  move_to(*target, outputs);
}

/// Makes an intent of this participant that is greater than all of this number, which is its own intent's or supersedes
/// it.
template <std::size_t MaxPeers>
void Participant<MaxPeers>::raise(IntentKind kind, std::uint32_t above, Outputs& outputs) {
  const std::uint32_t number = next_number(above);
  const std::uint32_t run = kind == IntentKind::Start  ? run_of(config_.incarnation, number)
                            : kind == IntentKind::Halt ? 0
                                                       : run_;
  const bool is_another_run = run != intent_.run;
  intent_ = Intent{number, kind, config_.index, run};
  outputs.publish = true;  // the number is another one
  if (is_another_run) sort_all_peers();
  outputs.raised = true;
  outputs.raised_kind = kind;
}

template <std::size_t MaxPeers>
[[gnu::cold]] void Participant<MaxPeers>::raise_alarm(Alarm alarm, std::uint32_t above, Outputs& outputs) {
  raise(IntentKind::Halt, above, outputs);
  outputs.alarm = alarm;
  move_to(halted, outputs);
}

/// Silence halts the group; in Halted it only means that the peer's sequence numbers may begin anywhere.
template <std::size_t MaxPeers>
void Participant<MaxPeers>::robust_silent(std::size_t peer, Outputs& outputs) {
  peers_[peer].sequence_known = false;
  if (state() != halted) raise_alarm(Alarm::peer_silent, intent_.number, outputs);
}

/// The start barrier of one run: slaves Ready, master Ready, slaves Running, master Running.
template <std::size_t MaxPeers>
void Participant<MaxPeers>::robust_barrier(Outputs& outputs) {
  if (intent_.kind != IntentKind::Start) return;
  if (!is_master()) {
    if (may_run() && !config_.nested) move_to(running, outputs);  // nested: Released
    return;
  }
  const bool in_run = run_ == intent_.run;
  const bool has_initialised = initialised_ || (state() == ready && !config_.nested);
  const bool may_be_ready = has_initialised && (state() == init || (state() == ready && !in_run));
  if (may_be_ready && ready_ == all_peers()) {
    run_ = intent_.run;
    initialised_ = false;
    move_to(ready, outputs);
  } else if (state() == ready && in_run && running_ == all_peers()) {
    move_to(running, outputs);
  }
}

template void Participant<4>::robust_command(Method, Outputs&);
template Outputs Participant<4>::robust_hear(const Input&);
template Outputs Participant<4>::robust_follow(const Input&);
template void Participant<4>::robust_silent(std::size_t, Outputs&);
template void Participant<4>::raise(IntentKind, std::uint32_t, Outputs&);
template void Participant<4>::robust_barrier(Outputs&);
template void Participant<4>::raise_alarm(Alarm, std::uint32_t, Outputs&);
template bool Participant<4>::robust_may_start() const;
template bool Participant<4>::robust_may_suspend() const;
template void Participant<64>::robust_command(Method, Outputs&);
template Outputs Participant<64>::robust_hear(const Input&);
template Outputs Participant<64>::robust_follow(const Input&);
template void Participant<64>::robust_silent(std::size_t, Outputs&);
template void Participant<64>::raise(IntentKind, std::uint32_t, Outputs&);
template void Participant<64>::robust_barrier(Outputs&);
template void Participant<64>::raise_alarm(Alarm, std::uint32_t, Outputs&);
template bool Participant<64>::robust_may_start() const;
template bool Participant<64>::robust_may_suspend() const;

}  // namespace takt::handshake
