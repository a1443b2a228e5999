// SPDX-License-Identifier: Apache-2.0
// The rules of the variant `paper`: Fig. 3 to 6, nothing added. A notification is a change of a peer's received state.
#include <array>

#include "handshake/participant.hpp"

namespace takt::handshake {
namespace {

using program::Method;
using program::StatusCode;

constexpr auto halted = PublishedState::Halted;
constexpr auto ready = PublishedState::Ready;
constexpr auto running = PublishedState::Running;
constexpr auto suspended = PublishedState::Suspended;
constexpr auto init = PublishedState::HaltedInit;

using Row = std::array<PublishedState, published_state_count>;
using Table = std::array<Row, published_state_count>;

/// Where a participant in a state (row) goes when it hears that a peer has changed to a state (column). Rows and
/// columns: Halted, Ready, Running, Suspended, INIT. INIT of a peer means Halted to whoever is beyond the start (Fig.
/// 4).
constexpr Table master_reactions{{
    //  Halted  Ready    Running  Suspended  INIT
    Row{halted, halted, halted, halted, halted},
    Row{halted, ready, ready, ready, halted},
    Row{halted, running, running, suspended, halted},
    Row{halted, ready, running, suspended, halted},
    Row{halted, init, init, init, init},
}};
constexpr Table slave_reactions{{
    //  Halted  Ready    Running  Suspended  INIT
    Row{halted, halted, halted, halted, init},    // the master's INIT starts a slave
    Row{halted, running, running, ready, ready},  // Fig. 3 (4), (5)
    Row{halted, running, running, suspended, halted},
    Row{halted, ready, running, suspended, halted},  // Fig. 5 and 6 (3a)
    Row{halted, init, init, init, init},
}};
/// The same for a slave that hears another slave: the barrier is the master's alone, so its steps mean nothing here.
constexpr Table sibling_reactions{{
    //  Halted  Ready    Running  Suspended  INIT
    Row{halted, halted, halted, halted, halted},
    Row{halted, ready, ready, ready, ready},
    Row{halted, running, running, suspended, halted},
    Row{halted, ready, running, suspended, halted},
    Row{halted, init, init, init, init},
}};

/// What a method does where it is called (row: the method; column: the state); the same state means: not allowed.
/// The machine of Part 10, but Halted is left through INIT only. Fig. 4 to 6, (1a) and (1b).
constexpr std::array<Row, program::methods.size()> commands{{
    //  Halted  Ready    Running    Suspended  INIT
    Row{init, running, running, suspended, init},    // Start
    Row{halted, ready, suspended, suspended, init},  // Suspend
    Row{halted, ready, running, running, init},      // Resume
    Row{halted, halted, halted, halted, halted},     // Halt
    Row{halted, ready, running, ready, init},        // Reset
}};

constexpr bool move_exists(std::size_t from_index, PublishedState to) {
  const program::State from = base_state(published_state_at(from_index));
  return from == base_state(to) || program::transition_exists(from, base_state(to));
}
constexpr bool tables_are_sound() {
  for (std::size_t from = 0; from < published_state_count; ++from) {
    for (const Table* table : {&master_reactions, &slave_reactions, &sibling_reactions})
      for (const PublishedState to : (*table)[from])
        if (!move_exists(from, to)) return false;
    for (const Row& row : commands)
      if (!move_exists(from, row[from])) return false;
  }
  return true;
}
static_assert(tables_are_sound(), "each reaction is a move that the machine can make");

}  // namespace

template <std::size_t MaxPeers>
void Participant<MaxPeers>::paper_command(Method method, Outputs& outputs) {
  const PublishedState target = commands[program::index_of(method)][index_of(state())];
  if (target == state()) {
    outputs.status = StatusCode::BadInvalidState;
    return;
  }
  outputs.raised = true;
  outputs.raised_kind = kind_of(method);
  move_to(target, outputs);
}

template <std::size_t MaxPeers>
void Participant<MaxPeers>::paper_received(const Input& input, Outputs& outputs) {
  if (!is_valid(input.word, Variant::paper, config_.slaves)) {
    outputs.ignored = true;
    return;
  }
  // A peer that was never heard counts as Halted: its first Halted is no news, so that all can be switched on in any
  // order.
  Peer& peer = peers_[input.peer];
  const bool news = peer.state != input.word.state;
  peer.state = input.word.state;
  sort_peer(input.peer);
  if (news) {
    const Table& reactions = is_master() ? master_reactions : input.peer == 0 ? slave_reactions : sibling_reactions;
    const PublishedState target = reactions[index_of(state())][index_of(input.word.state)];
    if (target != state()) {
      move_to(target, outputs);
      return;  // one transition for one notification: each state is published before the next
    }
  }
  paper_barrier(outputs);
}

/// The master's part of Fig. 3: (2) to (3) and (6) to (7). The slaves' part is in slave_reactions.
template <std::size_t MaxPeers>
void Participant<MaxPeers>::paper_barrier(Outputs& outputs) {
  if (!is_master()) return;
  if (state() == init && initialised_ && ready_ == all_peers()) {
    move_to(ready, outputs);
  } else if (state() == ready && running_ == all_peers()) {
    move_to(running, outputs);
  }
}

template void Participant<4>::paper_command(Method, Outputs&);
template void Participant<4>::paper_received(const Input&, Outputs&);
template void Participant<4>::paper_barrier(Outputs&);
template void Participant<64>::paper_command(Method, Outputs&);
template void Participant<64>::paper_received(const Input&, Outputs&);
template void Participant<64>::paper_barrier(Outputs&);

}  // namespace takt::handshake
