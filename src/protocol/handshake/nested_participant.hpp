// SPDX-License-Identifier: Apache-2.0
// A node in two nested groups as one value: slave of the outer group, master of the inner one.
//
// For hosts that keep both participants together (the explorer, tests). The endpoints of wire/ keep theirs apart and
// use the same Coupling. Copied, compared and hashed like a Participant; a step allocates nothing.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "handshake/coupling.hpp"

namespace takt::handshake {

/// What both participants ask for after one input, in the order in which they took their steps.
struct NestedOutputs {
  struct One {
    Side side = Side::outer;
    Outputs outputs;
    Word after;  ///< of that side
  };
  std::uint8_t count = 0;
  std::array<One, Coupling::most_steps + 1> steps{};
  std::span<const One> all() const { return {steps.data(), count}; }
};

template <std::size_t MaxOuterPeers, std::size_t MaxInnerPeers>
class NestedParticipant {
 public:
  /// The outer role is Slave, the inner one Master; `nested` is set in both here.
  NestedParticipant(Config outer, Config inner) : outer_(nested(outer)), inner_(nested(inner)) {
    TAKT_CHECK(outer.role == Role::slave && inner.role == Role::master,
               "a slave of one group is the master of the other");
  }

  /// An input of one side. Outputs::begin_initialisation of each side asks for an initialisation of its own.
  NestedOutputs step(Side side, const Input& input) {
    NestedOutputs outputs;
    if (input.kind == Input::Kind::initialised)
      coupling_.initialised(side, input.run);
    else
      take(side, input, outputs);
    while (const auto next = coupling_.next(view_of(outer_), view_of(inner_))) take(next->side, next->input, outputs);
    TAKT_CHECK(in_step(outer_.state(), inner_.state()), "both groups of a node are in step");
    return outputs;
  }

  const Participant<MaxOuterPeers>& outer() const { return outer_; }
  const Participant<MaxInnerPeers>& inner() const { return inner_; }
  const Coupling& coupling() const { return coupling_; }

  /// Participant::forget_last_transition of both.
  void forget_last_transition() {
    outer_.forget_last_transition();
    inner_.forget_last_transition();
  }

  bool operator==(const NestedParticipant&) const = default;
  std::uint64_t hash() const { return (outer_.hash() * 31 + inner_.hash()) * 31 + coupling_.hash(); }

 private:
  static Config nested(Config config) {
    config.nested = true;
    return config;
  }
  void take(Side side, const Input& input, NestedOutputs& outputs) {
    TAKT_CHECK(outputs.count < outputs.steps.size(), "few steps follow from one input");
    NestedOutputs::One& one = outputs.steps[outputs.count++];
    one.side = side;
    one.outputs = side == Side::outer ? outer_.step(input) : inner_.step(input);
    one.after = side == Side::outer ? outer_.word() : inner_.word();
  }

  Participant<MaxOuterPeers> outer_;
  Participant<MaxInnerPeers> inner_;
  Coupling coupling_;
};

static_assert(std::is_trivially_copyable_v<NestedParticipant<4, 4>>);

}  // namespace takt::handshake
