// SPDX-License-Identifier: Apache-2.0
// What makes a group react: somebody's command, or something that happens to it.
#pragma once

#include <cstdint>

namespace takt::handshake {

enum class Cause : std::uint8_t {
  command,   ///< a method was called
  crash,     ///< a participant's node has failed
  restart,   ///< a participant is back without its memory, before anybody found it silent
  cut,       ///< a link or a bridge between participants has failed
  silence,   ///< words of a peer stay away, and no crash or cut explains it
  leave,     ///< a node with a role has left
  mismatch,  ///< an intent that cannot be followed
  nested,    ///< the group that this one is nested in, or that is nested in it, has done the same
};

}  // namespace takt::handshake
