// SPDX-License-Identifier: Apache-2.0
#include "wire/nesting.hpp"

#include "wire/program_node.hpp"

namespace takt::wire {

using handshake::Side;

Nesting::Nesting(ProgramNode& outer, ProgramNode& inner)
    : outer_(&outer.join(*this, Side::outer)), inner_(&inner.join(*this, Side::inner)), inner_node_(&inner) {
  TAKT_CHECK(outer_->settings().handshake.nested && inner_->settings().handshake.nested,
             "both participants wait for each other");
  TAKT_CHECK(outer_->settings().handshake.role == handshake::Role::slave &&
                 inner_->settings().handshake.role == handshake::Role::master,
             "a slave of the outer group is the master of the inner one");
}

void Nesting::settle(const Turn& turn) {
  if (settling_) return;
  settling_ = true;
  do {
    while (const auto next = coupling_.next(view_of(outer_->participant()),
                                            view_of(inner_->participant(), inner_node_->is_complete())))
      (next->side == Side::outer ? outer_ : inner_)->step(turn, next->input);
  } while (inner_node_->stabilise_roles(turn));
  settling_ = false;
}

void Nesting::initialised(const Turn& turn, Side side, std::uint32_t run) {
  coupling_.initialised(side, run);
  settle(turn);
}

}  // namespace takt::wire
