// The bound of a reaction of nested groups, from the notifications within each.
#pragma once

#include <optional>

#include "analysis/bounds.hpp"

namespace takt::papers {

/// Of program 0 and all that are nested in it: its start, or whatever spreads (halt, suspend, resume). `bounds` has the streams. Clocks are ideal.
std::optional<sim::Duration> bound_of_tree(const scenario::Resolved& resolved, const analysis::Bounds& bounds, bool is_start);

}  // namespace takt::papers
