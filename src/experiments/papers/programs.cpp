// SPDX-License-Identifier: Apache-2.0
#include "papers/programs.hpp"

#include <algorithm>

#include "papers/beyond.hpp"
#include "papers/claims.hpp"
#include "papers/handshakes.hpp"
#include "papers/round_trips.hpp"

namespace takt::papers {

bool Reproduction::holds() const {
  // A run above its bound is worse than a missed figure of the paper, and counts the same.
  const auto exceeds = [](const ReactionCell& cell) {
    return cell.simulated && cell.bound && *cell.simulated > *cell.bound;
  };
  for (const BeyondTable& table : beyond)
    for (const BeyondRow& row : table.rows)
      if (std::any_of(row.reactions.begin(), row.reactions.end(), exceeds)) return false;
  return std::all_of(comparisons.begin(), comparisons.end(),
                     [](const Comparison& comparison) { return comparison.holds; });
}

std::optional<Reproduction> reproduce_programs(const ProgramsOptions& options, json::Diagnostics& diagnostics) {
  Reproduction made;
  made.is_short = options.is_short;
  if (!reproduce_round_trips(options, made, diagnostics)) return std::nullopt;
  if (!reproduce_handshakes(options, made, diagnostics)) return std::nullopt;
  if (!check_claims(options, made, diagnostics)) return std::nullopt;
  if (options.beyond && !go_beyond(options, made, diagnostics)) return std::nullopt;
  return made;
}

}  // namespace takt::papers
