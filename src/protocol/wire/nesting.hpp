// SPDX-License-Identifier: Apache-2.0
// Joins two Programs of one node: slave of an outer group, master of an inner one (handshake/coupling.hpp).
#pragma once

#include "handshake/coupling.hpp"
#include "wire/program_endpoint.hpp"

namespace takt::wire {

class ProgramNode;

class Nesting {
 public:
  /// Both were made with `nested` in their Config. They outlive the nesting, which outlives all use of them. From now
  /// on a turn of either has the outputs of both, each with its side.
  Nesting(ProgramNode& outer, ProgramNode& inner);
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;

  // For the two:
  NodeOutputs& outputs() { return outputs_; }
  /// One of them has taken a step.
  void settle(const Turn& turn);
  /// The local initialisation of one has ended.
  void initialised(const Turn& turn, handshake::Side side, std::uint32_t run);
  /// The node has lost its memory.
  void forget() { coupling_ = {}; }

 private:
  ProgramEndpoint* outer_;
  ProgramEndpoint* inner_;
  ProgramNode* inner_node_;  // which binds the roles, if the inner group has some
  handshake::Coupling coupling_;
  NodeOutputs outputs_;
  bool settling_ = false;  // the steps that it takes itself come back to it
};

}  // namespace takt::wire
