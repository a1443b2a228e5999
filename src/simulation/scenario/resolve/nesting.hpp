// SPDX-License-Identifier: Apache-2.0
// Which Program is nested in which: checked, and noted in the resolved programs.
#pragma once

#include "json/diagnostics.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// After all programs have been resolved.
void resolve_nesting(Resolved& resolved, json::Diagnostics& diagnostics);

/// The trees of nested programs: for each the numbers of its programs, the outer ones first. Programs without nesting
/// are in none.
std::vector<std::vector<std::uint32_t>> trees_of(const Resolved& resolved);

}  // namespace takt::scenario
