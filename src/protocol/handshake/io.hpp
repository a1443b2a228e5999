// SPDX-License-Identifier: Apache-2.0
// What goes into a participant's step and what comes out of it: plain values, no pointers, no allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "handshake/word.hpp"
#include "program/method.hpp"
#include "program/status.hpp"
#include "sim/check.hpp"

namespace takt::handshake {

/// A set of peers, bit i for peer i.
using PeerSet = std::uint64_t;

/// One input of a step; made by the named functions.
struct Input {
  enum class Kind : std::uint8_t {
    command,
    received,
    initialised,
    finished,
    peer_silent,
    released,
    peer_replaced,
    peer_left
  };

  Kind kind = Kind::finished;
  program::Method method = program::Method::Halt;  ///< Command
  std::uint8_t peer = 0;                           ///< Received, PeerSilent: index of the peer, not of the participant
  std::uint16_t sequence = 0;                      ///< Received: sequence number of the message, wraps
  std::uint32_t run = 0;                           ///< Initialised, Released
  bool coupled = false;                            ///< Command, Finished: passed on from the other group of this node
  Word word;                                       ///< Received

  /// A client or the user calls a method here.
  static constexpr Input command(program::Method method) {
    Input input;
    input.kind = Kind::command;
    input.method = method;
    return input;
  }
  /// A word of a peer has arrived. A word older than the last one of the same incarnation is ignored; the same sequence
  /// number again is taken again, which changes nothing.
  static constexpr Input received(std::size_t peer, const Word& word, std::uint16_t sequence) {
    Input input;
    input.kind = Kind::received;
    input.peer = static_cast<std::uint8_t>(peer);
    input.sequence = sequence;
    input.word = word;
    return input;
  }
  /// The local initialisation that Outputs::begin_initialisation asked for has ended; `run` is
  /// Outputs::initialisation_run. One that has been overtaken by a halt or by a newer start changes nothing.
  static constexpr Input initialised(std::uint32_t run) {
    Input input;
    input.kind = Kind::initialised;
    input.run = run;
    return input;
  }
  /// The local process has ended by itself (RunningToReady). Anywhere but in Running it changes nothing.
  static constexpr Input finished() { return Input{}; }
  /// The MessageReceiveTimeout of a peer has expired since it was last armed (Outputs::arm_timeout).
  static constexpr Input peer_silent(std::size_t peer) {
    Input input;
    input.kind = Kind::peer_silent;
    input.peer = static_cast<std::uint8_t>(peer);
    return input;
  }
  /// The inner group of a nested slave is Running, so the slave may be so too, in this run.
  static constexpr Input released(std::uint32_t run) {
    Input input;
    input.kind = Kind::released;
    input.run = run;
    return input;
  }
  /// The node behind a peer is gone: the group halts. At the master; at a slave whose inner group lacks somebody
  /// (coupling.hpp).
  static constexpr Input peer_left(std::size_t peer) {
    Input input;
    input.kind = Kind::peer_left;
    input.peer = static_cast<std::uint8_t>(peer);
    return input;
  }
  /// From now on another one is this peer: whatever was heard of the former one is forgotten. At the master in Halted;
  /// else it changes nothing.
  static constexpr Input peer_replaced(std::size_t peer) {
    Input input;
    input.kind = Kind::peer_replaced;
    input.peer = static_cast<std::uint8_t>(peer);
    return input;
  }
};

/// A change of the local state. `transition` is the number of the OPC UA transition, or 0 where only the substate
/// changes: INIT entered (Halted to HaltedInit) or left by a halt (HaltedInit to Halted). INIT to Ready is
/// transition 1.
struct StateChange {
  std::uint8_t transition = 0;
  PublishedState from = PublishedState::Halted;
  PublishedState to = PublishedState::Halted;
  constexpr bool operator==(const StateChange&) const = default;
};

/// Why a step has raised an intent that nobody asked for by a command here.
enum class Alarm : std::uint8_t {
  none,
  peer_silent,  ///< a peer's MessageReceiveTimeout expired
  peer_left,    ///< a peer's node has left the group or has begun another life, or a role of the inner group has nobody
  peer_restarted,  ///< a peer's incarnation changed
  mismatch,        ///< an intent that cannot be followed from here, so somebody's history is not mine
  other_group,     ///< the group that this one is nested in, or that is nested in it, has done the same
};

/// What the host has to do after a step, in the order of the fields.
struct Outputs {
  static constexpr std::size_t max_changes = 3;  ///< Running to Halted to INIT are two
  static constexpr StateChange unused{
      0, PublishedState{},
      PublishedState{}};  // that all is 0 at first is cheapest, and nearly every step brings nothing else

  program::StatusCode status = program::StatusCode::Good;  ///< of a command; Good for every other input
  bool ignored = false;  ///< Received: stale or invalid. Process data of the same message must not be used either
  bool raised = false;   ///< a new intent was raised here: its kind in `raised_kind` (`paper`: the command's)
  IntentKind raised_kind{};
  Alarm alarm = Alarm::none;
  bool publish = false;          ///< word() differs from before the step
  bool process_stopped = false;  ///< Running was left: stop the process and its data
  bool process_started = false;  ///< Running was entered
  /// INIT was entered: initialise (abandoning an older initialisation), then say Initialised.
  bool begin_initialisation = false;
  std::uint32_t initialisation_run = 0;  ///< to hand back with Initialised
  std::uint8_t change_count = 0;
  std::array<StateChange, max_changes> change{unused, unused, unused};
  PeerSet arm_timeout = 0;  ///< peers whose MessageReceiveTimeout starts anew now

  /// Of a word that changes nothing but when the peer was heard last.
  static constexpr Outputs of_a_word(std::size_t peer) {
    Outputs outputs;
    outputs.arm_timeout = PeerSet{1} << peer;
    return outputs;
  }

  constexpr std::span<const StateChange> changes() const { return {change.data(), change_count}; }
  /// Nothing has come of the step that others could see: neither a transition nor another word nor an intent. So it is
  /// of nearly all steps.
  constexpr bool is_quiet() const { return change_count == 0 && !publish && !raised; }
  constexpr void add(StateChange next) {
    TAKT_CHECK(change_count < max_changes, "a step changes the state three times at most");
    change[change_count++] = next;
  }
  constexpr bool operator==(const Outputs&) const = default;
};

}  // namespace takt::handshake
