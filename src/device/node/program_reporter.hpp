// SPDX-License-Identifier: Apache-2.0
// Tells the server of a node what happens to one Program: in the cycle's thread, and only when something has changed.
#pragma once

#include <optional>
#include <vector>

#include "node/hand_over.hpp"
#include "wire/program_node.hpp"

namespace takt::node {

class ProgramReporter {
 public:
  /// `hand_over` may be null: then nothing is told. It outlives this.
  ProgramReporter(HandOver* hand_over, std::size_t program, std::size_t peers)
      : hand_over_(hand_over), program_(static_cast<std::uint16_t>(program)), heard_(peers) {}

  /// A method that is being called here is the cause of what follows, until it is told that it is none any more.
  void calling(std::optional<program::Method> method) { calling_ = method; }
  void stepped(const handshake::Outputs& outputs, const wire::ProgramNode& part);
  void heard(std::size_t peer, const handshake::Word& word, const wire::ProgramNode& part);
  /// What may be called now, whether or not anything has happened: at the start, and when a role has come or gone.
  void methods(const wire::ProgramNode& part);

 private:
  struct Heard {
    bool is_heard = false;
    handshake::PublishedState state = handshake::PublishedState::Halted;
    std::uint32_t run = 0;
  };
  wire::ProgramNews news(wire::ProgramNews::Kind kind) const;

  HandOver* hand_over_;
  std::uint16_t program_;
  std::vector<Heard> heard_;
  std::optional<program::Method> calling_;
  program::MethodSet executable_;
};

/// 100 ns since 1601, now.
uadp::DateTime utc_now();

}  // namespace takt::node
