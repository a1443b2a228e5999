// The reactions of a scenario's Programs, alone and in trees of nested ones, from the bounds of their state messages.
#pragma once

#include "analysis/bounds.hpp"

namespace takt::analysis {

/// `bounds` has its streams.
void add_reactions(const scenario::Resolved& resolved, const BoundOptions& options, Bounds& bounds);

}  // namespace takt::analysis
