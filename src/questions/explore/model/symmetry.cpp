// SPDX-License-Identifier: Apache-2.0
// Slaves that play the same part are one state: of all states that differ in names only, the least one stands for them.
#include <algorithm>

#include "explore/model/group_model.hpp"

namespace takt::explore {

/// What tells a slave from others without its name.
std::uint64_t GroupModel::sort_key(const State& state, std::size_t slave) const {
  const std::size_t up = slave - 1;
  const std::size_t down = up + query_.slaves;
  const std::uint64_t member = std::uint64_t{members_[state.member(slave)].orbit} << 32;
  if (query_.network == Network::channels)
    return member ^ std::uint64_t{contents_.orbit(state.content(up))} << 16 ^ contents_.orbit(state.content(down));
  return member ^ std::uint64_t{members_.word_orbit(state.reg(up))} << 16 ^ members_.word_orbit(state.reg(down));
}

/// Two intents that differ in their origin only: which of them is greater depends on names.
bool GroupModel::names_matter(const State& state) const {
  std::array<std::uint64_t, most_participants + most_capacity * most_channels + 1> seen{};
  std::size_t count = 0;
  const auto clashes = [&](WordId word) {
    const std::uint64_t rank = members_.rank(word);
    if (rank == 0) return false;
    for (std::size_t i = 0; i < count; ++i)
      if ((seen[i] ^ rank) < 0x100 && seen[i] != rank) return true;
    seen[count++] = rank;
    return false;
  };
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (clashes(members_[state.member(i)].word)) return true;
  for (std::size_t c = 0; c < wiring_.size(); ++c) {
    if (query_.network == Network::registers) {
      if (clashes(state.reg(c))) return true;
      continue;
    }
    const Content& content = contents_[state.content(c)];
    for (std::size_t i = 0; i < content.size(); ++i)
      if (clashes(content[i].word)) return true;
  }
  return state.late() != Late::none && clashes(state.late_word());
}

State GroupModel::canonical(const State& state) {
  if (renamings_.size() == 1) return state;
  std::array<std::uint64_t, most_slaves + 1> key{};
  bool rises = true;
  for (std::size_t i = 1; i <= query_.slaves; ++i) {
    key[i] = sort_key(state, i);
    rises = rises && (i == 1 || key[i - 1] < key[i]);
  }
  if (rises || names_matter(state)) return state;
  State least = state;
  bool found = false;
  for (std::size_t r = 0; r < renamings_.size(); ++r) {
    std::array<std::uint64_t, most_slaves + 1> sorted{};
    for (std::size_t i = 1; i <= query_.slaves; ++i) sorted[renamings_[r].to[i]] = key[i];
    if (!std::is_sorted(sorted.begin() + 1, sorted.begin() + 1 + query_.slaves)) continue;
    const State other = r == 0 ? state : renamed(state, r);
    if (!found || other < least) least = other;
    found = true;
  }
  return least;
}

State GroupModel::renamed(const State& state, std::size_t renaming) const {
  const Renaming& names = renamings_[renaming];
  const std::size_t slaves = query_.slaves;
  State result = state;
  const auto channel = [&](std::size_t c) {
    return static_cast<std::size_t>(renamed_channel_[c * renamings_.size() + renaming]);
  };
  for (std::size_t i = 0; i <= slaves; ++i) result.set_member(names.to[i], members_.renamed(state.member(i), renaming));
  for (std::size_t c = 0; c < wiring_.size(); ++c) {
    if (query_.network == Network::channels) {
      result.set_content(channel(c), contents_.renamed(state.content(c), renaming));
      continue;
    }
    result.set_reg(channel(c), members_.renamed_word(state.reg(c), renaming));
    if (state.any_outdated()) result.set_outdated(channel(c), state.outdated(c));
  }
  if (state.late() != Late::none)
    result.set_late(state.late(), channel(state.late_channel()), members_.renamed_word(state.late_word(), renaming));
  result.set_observer(renamed_observer_[state.observer() * renamings_.size() + renaming]);
  return result;
}

}  // namespace takt::explore
