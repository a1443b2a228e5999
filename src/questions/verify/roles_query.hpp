// SPDX-License-Identifier: Apache-2.0
// The roles of a scenario's Program, and the Programs of a tree, as a query to the explorer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/model/query.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::verify {

/// Sets roles and candidates; what cannot be explored, or nothing.
std::optional<std::string> set_roles(const scenario::ResolvedProgram& program, explore::Query& query);

/// The tree that the program is in; itself alone if it is in none. The root comes first.
std::vector<std::uint32_t> tree_of(const scenario::Resolved& resolved, std::uint32_t program);

/// Sets groups, roles and candidates of a tree of two groups; what cannot be explored, or nothing.
std::optional<std::string> set_tree(const scenario::Resolved& resolved, const std::vector<std::uint32_t>& tree,
                                    explore::Query& query);

}  // namespace takt::verify
