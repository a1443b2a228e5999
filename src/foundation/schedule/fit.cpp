// SPDX-License-Identifier: Apache-2.0
#include "schedule/fit.hpp"

namespace takt::schedule {

std::optional<Ps> first_fit(const Board& board, const Periods& periods, std::uint32_t period, const Way& way, Ps from,
                            Ps until) {
  Ps at = from;
  std::uint32_t pushes = 0;
  constexpr std::uint32_t most_pushes = 1'000'000;
  const std::size_t hops = way.links.size();
  // Once round the links without being pushed is a place.
  for (std::size_t hop = 0, passed = 0; passed < hops; hop = hop + 1 == hops ? 0 : hop + 1) {
    const Ps push = board.push(way.links[hop], period, at + way.lags[hop], way.occupied[hop]);
    if (push == 0) {
      ++passed;
      continue;
    }
    at += push;
    if (at > until || ++pushes > most_pushes) return std::nullopt;
    // What is next in another row may push again.
    passed = periods.size() > 1 ? 0 : 1;
  }
  return at > until ? std::nullopt : std::optional(at);
}

}  // namespace takt::schedule
