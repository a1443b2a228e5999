// SPDX-License-Identifier: Apache-2.0
// S1 to S5, what always holds in a group, and how it can be found violated (observer.hpp).
//
//   S1 nobody is Running in a run before all were Ready in it
//   S2 the master is Running only after all slaves were Running in it
//   S3 process data counts only between two that are Running in the same run
//   S4 from Halted to Running only through INIT
//   S5 only the nine transitions (and INIT entered and left)
//
// "Were" is meant: somebody may have halted since, and nobody can know that at once.
//
// The run is the word's run in `robust`. `paper` has none, so there the observer judges each participant by its own
// *round*: it begins when the participant enters INIT, or becomes Ready by a reset or a finish. Then S1 reads: since
// the round of the one that goes to Running began, each participant has at some time been Ready (one that was Ready
// already and stays so counts); S2: since the master's round began, each slave has become Running; S3: the data was
// sent by one that was Running, after the receiver's round began. That is as much as the states alone can mean: it
// blames nobody who was merely overtaken by a halt, and it does not see that somebody who has missed a halt is Ready
// from before.
//
// In nested groups S1 and S2 hold of each group and of the tree as a whole (`robust` only, like nesting):
//
//   S1 nobody in the tree is Running in a run of the tree before every node was Ready in it, and a node is Ready in the
//   outer group only after all
//      slaves of its inner group were Ready in the run that was started for it
//   S2 whoever has groups below it is Running only after everybody there was Running in it
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "handshake/io.hpp"

namespace takt::handshake {

enum class Invariant : std::uint8_t { S1, S2, S3, S4, S5 };

enum class Finding : std::uint8_t {
  running_before_all_ready,  ///< S1
  ready_before_inner_group,  ///< S1 of the tree
  master_before_slaves,      ///< S2
  data_of_one_not_running,   ///< S3: the sender was not Running when it sent
  data_to_one_not_running,   ///< S3
  data_of_another_run,       ///< S3
  running_without_init,      ///< S4
  no_such_transition,        ///< S5: not in the table
  state_jumped,              ///< S5: the change does not begin where the last one ended
};

struct Violation {
  Invariant invariant = Invariant::S1;
  Finding finding = Finding::running_before_all_ready;
  std::uint8_t participant = 0;  ///< who did it, of its group; for S3 the receiver
  std::uint16_t group = 0;       ///< of the tree
  bool of_tree = false;          ///< S1 and S2 of the whole tree; else of the group alone
  constexpr bool operator==(const Violation&) const = default;
};

constexpr std::string_view name_of(Invariant invariant) {
  constexpr std::string_view names[]{"S1", "S2", "S3", "S4", "S5"};
  return names[static_cast<std::size_t>(invariant)];
}
constexpr std::string_view text_of(Finding finding) {
  constexpr std::string_view texts[]{"is Running in a run in which not all have been Ready",
                                     "is Ready before all slaves of the group within its node have been Ready",
                                     "is master and Running before all slaves have been Running",
                                     "was given process data of a sender that was not Running",
                                     "was given process data while it was not Running",
                                     "was given process data of another run",
                                     "is Running without INIT since it was Halted",
                                     "took a transition that does not exist",
                                     "took a transition that does not leave its state"};
  return texts[static_cast<std::size_t>(finding)];
}

/// Of a state to itself there is none; `transition` has the number of the table, 0 where only the substate changes.
constexpr bool is_transition(const StateChange& change) {
  const bool substate = (change.from == PublishedState::Halted && change.to == PublishedState::HaltedInit) ||
                        (change.from == PublishedState::HaltedInit && change.to == PublishedState::Halted);
  if (change.transition == 0) return substate;
  const program::Transition* transition = program::transition_with_number(change.transition);
  return transition != nullptr && change.to != PublishedState::HaltedInit &&
         transition->from == base_state(change.from) && transition->to == base_state(change.to);
}

}  // namespace takt::handshake
