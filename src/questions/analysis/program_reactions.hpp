// SPDX-License-Identifier: Apache-2.0
// The reactions of a scenario's Programs, alone and in trees of nested ones, from the bounds of their state messages.
#pragma once

#include "analysis/bounds.hpp"

namespace takt::analysis {

/// What the faults of the scenario can halt the program by, or a tree of which it is the outermost one. Ascending.
/// `bounds` has its streams.
std::vector<handshake::Cause> causes_of_halts(const scenario::Resolved& resolved, const Bounds& bounds,
                                              std::size_t program, bool of_tree);

/// `bounds` has its streams.
void add_reactions(const scenario::Resolved& resolved, const BoundOptions& options, Bounds& bounds);

}  // namespace takt::analysis
