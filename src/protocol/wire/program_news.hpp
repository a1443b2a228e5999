// SPDX-License-Identifier: Apache-2.0
// What happens to a Program of a node, for whoever shows it to others: a plain value that can be handed over from one
// thread to another.
#pragma once

#include "handshake/io.hpp"
#include "program/method.hpp"
#include "uadp/builtin_type.hpp"

namespace takt::wire {

struct ProgramNews {
  enum class Kind : std::uint8_t {
    transition,  ///< the own state has changed
    intent,      ///< a call, or an alarm, leads the group somewhere
    peer,        ///< a peer has been heard in another state
    methods,     ///< what may be called has changed
  };

  std::uint16_t program = 0;
  Kind kind = Kind::methods;
  handshake::StateChange change = {};
  handshake::IntentKind intent =
      handshake::IntentKind::Halt;                  ///< of an intent: its kind; of a transition: whom it follows
  handshake::Alarm alarm = handshake::Alarm::none;  ///< why, if nobody asked for it
  bool by_call = false;                             ///< of a transition: a method that was called here causes it
  program::Method method = program::Method::Halt;   ///< and which one
  std::uint16_t peer = 0;
  handshake::PublishedState peer_state = handshake::PublishedState::Halted;
  program::MethodSet executable = {};  ///< from now on
  uadp::DateTime time = {};
};

}  // namespace takt::wire
