// SPDX-License-Identifier: Apache-2.0
#include "handshake/binder.hpp"

#include <algorithm>
#include <bit>

#include "sim/check.hpp"

namespace takt::handshake {

SkillId skill_id(std::string_view name) {
  std::uint32_t hash = 2'166'136'261U;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16'777'619U;
  return hash == 0 ? 1 : hash;
}

Binder::Binder(std::span<const SkillId> roles, std::size_t candidates, bool restarts)
    : role_count_(static_cast<std::uint8_t>(roles.size())),
      candidate_count_(static_cast<std::uint8_t>(candidates)),
      restarts_(restarts) {
  TAKT_CHECK(!roles.empty() && roles.size() <= most_roles, "a group has 1 to 64 roles");
  TAKT_CHECK(candidates <= most_candidates, "at most 64 nodes offer their skills to a group");
  std::copy(roles.begin(), roles.end(), skills_.begin());
}

bool Binder::announced(std::uint8_t candidate, const Announcement& announcement) {
  TAKT_CHECK(candidate < candidate_count_, "an announcement is one of a candidate");
  // A late one of a former life says nothing; but after silence the clock that gave the life may have been set back.
  if (candidates_[candidate].here && is_later_life(candidates_[candidate].last.life, announcement.life)) return false;
  candidates_[candidate].last = announcement;
  candidates_[candidate].here = true;
  return true;
}

void Binder::silent(std::uint8_t candidate) { candidates_[candidate].here = false; }

void Binder::role_silent(std::size_t role) {
  if (bindings_[role].bound()) candidates_[bindings_[role].candidate].here = false;
}

bool Binder::present(std::uint8_t candidate) const {
  const Candidate& each = candidates_[candidate];
  return each.here && !each.last.leaving && (each.used_life == 0 || is_later_life(each.last.life, each.used_life));
}

bool Binder::is_lost(std::size_t role) const {
  const Binding& binding = bindings_[role];
  return binding.bound() && (!present(binding.candidate) || candidates_[binding.candidate].last.life != binding.life);
}

bool Binder::complete() const {
  for (std::size_t role = 0; role < role_count_; ++role)
    if (!bindings_[role].bound() || is_lost(role)) return false;
  return changed_ == 0;
}

auto Binder::next(const MasterView& master) -> std::optional<Input> {
  std::optional<std::size_t> lost;
  for (std::size_t role = role_count_; role-- > 0;)
    if (is_lost(role)) lost = role;
  if (lost && was_running_) restart_wanted_ = restarts_;
  was_running_ = master.runs;
  if (master.state != PublishedState::Halted) return lost ? std::optional(Input::peer_left(*lost)) : std::nullopt;
  bind();
  if (changed_ != 0) {
    const auto role = static_cast<std::size_t>(std::countr_zero(changed_));
    changed_ &= changed_ - 1;
    return Input::peer_replaced(role);
  }
  // Not before all have told that they have halted, or an intent of theirs could be greater than the start.
  const PeerSet all = ~PeerSet{0} >> (64 - role_count_);
  if (restart_wanted_ && complete() && (master.heard_halted & all) == all) {
    restart_wanted_ = false;
    return Input::command(program::Method::Start);
  }
  return std::nullopt;
}

bool Binder::offers(std::uint8_t candidate, SkillId skill) const {
  const auto& skills = candidates_[candidate].last.skills;
  return std::find(skills.begin(), skills.end(), skill) != skills.end();
}

void Binder::release(std::size_t role) {
  candidates_[bindings_[role].candidate].used_life = bindings_[role].life;
  bindings_[role] = {};
  changed_ |= PeerSet{1} << role;
}

/// Fills the roles that nobody has. Who has one keeps it unless one more role can be filled by moving it; then it is
/// let go, and bound again in its next life.
void Binder::bind() {
  std::array<std::uint8_t, most_candidates> role_of;
  role_of.fill(Binding::nobody);
  for (std::size_t role = 0; role < role_count_; ++role) {
    if (is_lost(role)) release(role);
    if (bindings_[role].bound()) role_of[bindings_[role].candidate] = static_cast<std::uint8_t>(role);
  }
  // Kuhn's matching: candidates by number, those without a role first.
  const auto place = [&](auto&& self, std::size_t role, std::uint64_t& visited) -> bool {
    for (const bool taken : {false, true}) {
      for (std::uint8_t c = 0; c < candidate_count_; ++c) {
        if ((visited >> c & 1U) != 0 || !present(c) || !offers(c, skills_[role]) ||
            (role_of[c] != Binding::nobody) != taken)
          continue;
        visited |= std::uint64_t{1} << c;
        if (taken && !self(self, role_of[c], visited)) continue;
        role_of[c] = static_cast<std::uint8_t>(role);
        return true;
      }
    }
    return false;
  };
  for (std::size_t role = 0; role < role_count_; ++role) {
    std::uint64_t visited = 0;
    if (!bindings_[role].bound()) place(place, role, visited);
  }
  for (std::size_t role = 0; role < role_count_; ++role)
    if (bindings_[role].bound() && role_of[bindings_[role].candidate] != role) release(role);
  for (std::uint8_t c = 0; c < candidate_count_; ++c) {
    if (role_of[c] == Binding::nobody || bindings_[role_of[c]].bound() || !present(c)) continue;
    bindings_[role_of[c]] = {c, candidates_[c].last.life};
    changed_ |= PeerSet{1} << role_of[c];
  }
}

Candidate::Candidate(std::uint8_t number, std::uint32_t life, std::span<const SkillId> skills) : number_(number) {
  TAKT_CHECK(skills.size() <= most_skills, "a node offers at most 8 skills");
  announcement_.life = life;
  std::copy(skills.begin(), skills.end(), announcement_.skills.begin());
}

void Candidate::leave() {
  if (role_)
    announcement_.leaving = true;
  else
    joined_ = false;
}

auto Candidate::table(std::span<const Binding> bindings, std::uint32_t used_life) -> Change {
  if (role_) {
    const Binding& mine = bindings[*role_];
    if (mine.candidate == number_ && mine.life == announcement_.life) return Change::none;
    role_.reset();
    announcement_.life = next_life(announcement_.life);
    if (announcement_.leaving) joined_ = false;
    announcement_.leaving = false;
    return Change::released;
  }
  if (used_life != 0 && !is_later_life(announcement_.life, used_life)) announcement_.life = next_life(used_life);
  if (!joined_) return Change::none;
  for (std::size_t role = 0; role < bindings.size(); ++role) {
    if (bindings[role].candidate != number_ || bindings[role].life != announcement_.life) continue;
    role_ = static_cast<std::uint8_t>(role);
    return Change::bound;
  }
  return Change::none;
}

}  // namespace takt::handshake
