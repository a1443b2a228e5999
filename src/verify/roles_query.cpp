#include "verify/roles_query.hpp"

#include <algorithm>

namespace takt::verify {

std::optional<std::string> set_roles(const scenario::ResolvedProgram& program, explore::Query& query) {
  const std::vector<scenario::Role>& roles = program.description->roles;
  if (roles.size() > explore::most_explored_roles) return "at most " + std::to_string(explore::most_explored_roles) + " roles can be explored";
  if (program.candidates().size() > explore::most_explored_candidates) return "at most " + std::to_string(explore::most_explored_candidates) + " candidates for roles can be explored";
  query.slaves = static_cast<std::uint8_t>(roles.size());
  query.candidates = static_cast<std::uint8_t>(program.candidates().size());
  query.joined = 0;
  for (std::size_t c = 0; c < program.candidates().size(); ++c) {
    const scenario::ResolvedMember& candidate = program.candidates()[c];
    if (!candidate.is_absent) query.joined = static_cast<std::uint8_t>(query.joined | 1U << c);
    query.offers[c] = 0;
    for (std::size_t role = 0; role < roles.size(); ++role)
      if (std::find(candidate.skills.begin(), candidate.skills.end(), roles[role].skill) != candidate.skills.end()) query.offers[c] = static_cast<std::uint8_t>(query.offers[c] | 1U << role);
  }
  query.starts_again = program.description->on_replacement != scenario::OnReplacement::stay_halted;
  return std::nullopt;
}

}  // namespace takt::verify
