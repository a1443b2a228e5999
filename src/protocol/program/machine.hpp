// SPDX-License-Identifier: Apache-2.0
// One Program's state machine as a value: where it is and how it got there. It knows no peers; handshake/ moves it.
//
// INIT is a substate of Halted (paper III.B): a nested machine, so its entry and exit are none of the nine transitions,
// and a base transition out of Halted ends it.
#pragma once

#include <cstdint>

#include "program/status.hpp"
#include "program/table.hpp"
#include "sim/check.hpp"

namespace takt::program {

class Machine {
 public:
  /// A new Program is Halted or Ready (Part 10, 4.2.10).
  constexpr explicit Machine(State initial = State::Halted) : state_(initial) {
    TAKT_CHECK(initial == State::Halted || initial == State::Ready, "a new Program is Halted or Ready");
  }

  constexpr State state() const { return state_; }
  /// True in the substate INIT of Halted.
  constexpr bool initialising() const { return initialising_; }
  /// In this state and in no substate.
  constexpr bool is_just_in(State state) const { return state_ == state && !initialising_; }
  /// Halted and in no substate.
  constexpr bool at_rest() const { return state_ == State::Halted && !initialising_; }
  /// The number of the last transition; 0 before the first one.
  constexpr std::uint8_t last_transition() const { return last_transition_; }

  /// A client's call on a Program that stands alone: Good, or BadInvalidState and nothing changes.
  constexpr StatusCode call(Method method) {
    const Transition* transition = transition_caused_by(method, state_);
    if (transition == nullptr) return StatusCode::BadInvalidState;
    apply(*transition);
    return StatusCode::Good;
  }

  /// Takes a transition, which must leave the present state.
  constexpr void apply(const Transition& transition) {
    TAKT_CHECK(transition.from == state_, "a Program takes only transitions that leave its state");
    state_ = transition.to;
    last_transition_ = transition.number;
    initialising_ = false;
  }

  constexpr void enter_init() {
    TAKT_CHECK(at_rest(), "INIT is entered from Halted only");
    initialising_ = true;
  }
  constexpr void leave_init() {
    TAKT_CHECK(initialising_, "only INIT can be left");
    initialising_ = false;
  }

  /// As if no transition had been taken. The last one is told to clients; no step depends on it.
  constexpr void forget_last_transition() { last_transition_ = 0; }

  constexpr bool operator==(const Machine&) const = default;

 private:
  State state_;
  bool initialising_ = false;
  std::uint8_t last_transition_ = 0;
};

}  // namespace takt::program
