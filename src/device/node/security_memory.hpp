// SPDX-License-Identifier: Apache-2.0
// What a node must not forget of secured messages when it is restarted: which life of it this is, and what it has
// heard. A file that is mapped into memory: writing to it is no system call, and what was written outlives the process,
// however it ends.
#pragma once

#include <memory>
#include <string>

#include "node/socket.hpp"
#include "security/replay_window.hpp"
#include "sim/time.hpp"

namespace takt::node {

/// NODE.memory in $STATE_DIRECTORY (of a service), as root in /var/lib/takt, otherwise in $XDG_STATE_HOME/takt or
/// ~/.local/state/takt.
std::string default_memory_path(std::string_view node);

class SecurityMemory {
 public:
  /// Null, and `problem` says why, if it cannot be had, belongs to another user, another process has it, or the disk is
  /// full. A new life begins, and that is on the disk when this returns. It is one more than the last one, and not
  /// before the time of day in units of which a key's lifetime has few enough to be ordered; so a node that has lost
  /// its memory begins behind its lives before. It waits for the next unit then: none of them can have begun in it.
  static std::unique_ptr<SecurityMemory> open(const std::string& path, sim::Duration key_lifetime,
                                              std::string& problem);
  ~SecurityMemory();
  SecurityMemory(const SecurityMemory&) = delete;
  SecurityMemory& operator=(const SecurityMemory&) = delete;

  std::uint16_t life() const;
  /// Another life from now on.
  std::uint16_t begin_life();
  security::ReplayMemory windows();

 private:
  struct Contents;
  SecurityMemory(FileDescriptor file, Contents& contents) : file_(std::move(file)), contents_(&contents) {}

  FileDescriptor file_;
  Contents* contents_;
};

}  // namespace takt::node
