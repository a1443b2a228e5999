#include "verify/roles_question.hpp"

#include <algorithm>

namespace takt::verify {

std::optional<std::string> set_roles(const scenario::ResolvedProgram& program, explore::Question& question) {
  const std::vector<scenario::Role>& roles = program.description->roles;
  if (roles.size() > explore::most_explored_roles) return "at most " + std::to_string(explore::most_explored_roles) + " roles can be explored";
  if (program.candidates.size() > explore::most_explored_candidates) return "at most " + std::to_string(explore::most_explored_candidates) + " candidates for roles can be explored";
  question.slaves = static_cast<std::uint8_t>(roles.size());
  question.candidates = static_cast<std::uint8_t>(program.candidates.size());
  question.joined = 0;
  for (std::size_t c = 0; c < program.candidates.size(); ++c) {
    const scenario::ResolvedCandidate& candidate = program.candidates[c];
    if (!candidate.is_absent) question.joined = static_cast<std::uint8_t>(question.joined | 1U << c);
    question.offers[c] = 0;
    for (std::size_t role = 0; role < roles.size(); ++role)
      if (std::find(candidate.skills.begin(), candidate.skills.end(), roles[role].skill) != candidate.skills.end()) question.offers[c] = static_cast<std::uint8_t>(question.offers[c] | 1U << role);
  }
  question.starts_again = program.description->on_replacement != scenario::OnReplacement::stay_halted;
  return std::nullopt;
}

}  // namespace takt::verify
