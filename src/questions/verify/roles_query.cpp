// SPDX-License-Identifier: Apache-2.0
#include "verify/roles_query.hpp"

#include <algorithm>
#include <utility>

#include "scenario/resolve/nesting.hpp"

namespace takt::verify {

std::optional<std::string> set_roles(const scenario::ResolvedProgram& program, explore::Query& query) {
  const std::vector<scenario::Role>& roles = program.description->roles;
  if (roles.size() > explore::most_explored_roles)
    return "at most " + std::to_string(explore::most_explored_roles) + " roles can be explored";
  if (program.candidates().size() > explore::most_explored_candidates)
    return "at most " + std::to_string(explore::most_explored_candidates) + " candidates for roles can be explored";
  query.slaves = static_cast<std::uint8_t>(roles.size());
  query.candidates = static_cast<std::uint8_t>(program.candidates().size());
  query.joined = 0;
  for (std::size_t c = 0; c < program.candidates().size(); ++c) {
    const scenario::ResolvedMember& candidate = program.candidates()[c];
    if (!candidate.is_absent) query.joined = static_cast<std::uint8_t>(query.joined | 1U << c);
    query.offers[c] = 0;
    for (std::size_t role = 0; role < roles.size(); ++role)
      if (std::find(candidate.skills.begin(), candidate.skills.end(), roles[role].skill) != candidate.skills.end())
        query.offers[c] = static_cast<std::uint8_t>(query.offers[c] | 1U << role);
  }
  query.starts_again = program.description->on_replacement != scenario::OnReplacement::stay_halted;
  return std::nullopt;
}

std::vector<std::uint32_t> tree_of(const scenario::Resolved& resolved, std::uint32_t program) {
  for (std::vector<std::uint32_t>& tree : scenario::trees_of(resolved))
    if (std::ranges::find(tree, program) != tree.end()) return std::move(tree);
  return {program};
}

std::optional<std::string> set_tree(const scenario::Resolved& resolved, const std::vector<std::uint32_t>& tree,
                                    explore::Query& query) {
  if (tree.size() != 2) return "trees of two groups can be explored, not of " + std::to_string(tree.size());
  const scenario::ResolvedProgram& outer = resolved.programs[tree[0]];
  const scenario::ResolvedProgram& inner = resolved.programs[tree[1]];
  for (const scenario::ResolvedProgram* each : {&outer, &inner})
    if (each->description->subscription != scenario::Subscription::star) return "nested groups are explored in stars";
  const std::size_t outer_slaves = outer.members.size() - 1;
  if (outer_slaves > explore::most_outer_slaves)
    return "nested groups are explored with at most " + std::to_string(explore::most_outer_slaves) + " outer slaves";
  query.candidates = 0;
  if (inner.has_roles()) {
    if (const auto wrong = set_roles(inner, query)) return wrong;
    if (query.candidates > explore::most_inner_candidates)
      return "nested groups are explored with at most " + std::to_string(explore::most_inner_candidates) +
             " candidates";
  }
  const std::size_t inner_slaves = inner.participant_names.size() - 1;
  if (inner_slaves > explore::most_inner_slaves)
    return "nested groups are explored with at most " + std::to_string(explore::most_inner_slaves) + " inner slaves";
  query.slaves = static_cast<std::uint8_t>(outer_slaves);
  query.inner_slaves = static_cast<std::uint8_t>(inner_slaves);
  return std::nullopt;
}

}  // namespace takt::verify
