// SPDX-License-Identifier: Apache-2.0
// Joins two groups on one node: the node is a slave of the outer group and the master of the inner one.
//
// A value that looks at both participants and says what one of them must be told next; it is asked again until there is
// nothing left. So both sides are in step whenever the node's step is over (rules: README.md, "Nested Programs"):
//
//   outer      inner      meaning
//   Halted     Halted
//   INIT       INIT       the inner group is being prepared
//   Ready      INIT       it is prepared: all inner slaves are Ready, and their master waits for the outer barrier
//   Ready      Ready      reset or finished; or the outer barrier is over and the inner one goes on
//   Running    Running
//   Suspended  Suspended
//   Running    Suspended  an inner participant has suspended within the outer barrier; passed on when that is over
#pragma once

#include <cstdint>
#include <optional>

#include "handshake/participant.hpp"

namespace takt::handshake {

/// The two participants of a node in nested groups.
enum class Side : std::uint8_t { outer, inner };

/// What the coupling looks at.
struct GroupView {
  PublishedState state = PublishedState::Halted;
  Intent intent;
  std::uint32_t run = 0;
  bool peers_ready = false;  ///< Participant::peers_ready
  bool may_run = false;      ///< Participant::may_run
  bool may_start = false;    ///< Participant::may_start
  bool may_suspend = false;  ///< Participant::may_suspend
  bool initialised = false;  ///< Participant::waits_initialised
  bool complete = true;      ///< inner group with roles: all are bound (Binder::complete)
};

template <std::size_t MaxPeers>
GroupView view_of(const Participant<MaxPeers>& participant) {
  return {participant.state(),
          participant.intent(),
          participant.run(),
          participant.peers_ready(),
          participant.may_run(),
          participant.may_start(),
          participant.may_suspend(),
          participant.waits_initialised(),
          true};
}

/// Of a group with roles; `is_complete`: all of them are bound.
template <std::size_t MaxPeers>
GroupView view_of(const Participant<MaxPeers>& participant, bool is_complete) {
  GroupView view = view_of(participant);
  view.complete = is_complete;
  return view;
}

class Coupling {
 public:
  struct Step {
    Side side = Side::outer;
    Input input;
  };
  /// More steps than that never follow from one input.
  static constexpr std::size_t most_steps = 6;

  /// The local initialisation that this side's participant asked for has ended. Goes here instead of to the
  /// participant.
  void initialised(Side side, std::uint32_t run) {
    (side == Side::outer ? outer_initialised_ : inner_initialised_) = run;
  }
  /// What to tell one of the two now; nothing if both are in step. Ask again after each step of either.
  std::optional<Step> next(const GroupView& outer, const GroupView& inner);

  bool operator==(const Coupling&) const = default;
  std::uint64_t hash() const;

 private:
  std::optional<Step> follow(const GroupView& outer, const GroupView& inner) const;
  std::optional<Step> pass_barriers(const GroupView& outer, const GroupView& inner) const;

  std::uint32_t started_for_ = 0;        ///< outer run for which the inner group was started last
  std::uint32_t outer_initialised_ = 0;  ///< run of the last local initialisation that has ended
  std::uint32_t inner_initialised_ = 0;
  PublishedState outer_state_ = PublishedState::Halted;  ///< as seen last
  PublishedState inner_state_ = PublishedState::Halted;
  Side leader_ = Side::outer;  ///< whose state changed last
};

/// True for a pair of the table above; so it is after each step of the node.
bool in_step(PublishedState outer, PublishedState inner);

}  // namespace takt::handshake
