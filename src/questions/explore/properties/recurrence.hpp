// SPDX-License-Identifier: Apache-2.0
// Which participants can go round: be again what they were, after network steps that changed them.
//
// Calls and faults come from budgets, so a cycle of the whole group consists of network steps, and on registers
// somebody in it goes round: as long as nobody changes, each register is written once at most. Participants are few,
// states many; where nobody can go round there is no cycle, and no state need be looked at.
#pragma once

#include <vector>

#include "explore/model/members.hpp"

namespace takt::explore {

/// By member. More may be named than do.
///
/// A cycle through a member is one of its own steps, too, and there each peer is either silent for good (who notices
/// that a peer is down hears nothing of it any more) or says what one member of the peer that goes round itself may
/// say, or always the same.
std::vector<bool> members_that_go_round(const Members& members, std::size_t most_peers);

}  // namespace takt::explore
