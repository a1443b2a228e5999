// SPDX-License-Identifier: Apache-2.0
// Phases for what moves as one: each mover occupies resources at fixed lags from its phase, strictly with its period.
// The search of search.hpp without ways.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "schedule/problem.hpp"

namespace takt::schedule {

struct Claim {
  std::uint32_t resource = 0;
  Ps lag = 0;     ///< may be negative
  Ps length = 0;  ///< at most the period
};

struct Mover {
  std::string name;
  Ps period = 0;
  std::vector<Claim> claims;
  std::optional<Ps> fixed;  ///< stays at this phase
};

/// A phase for each, from 0 to less than its period, such that no two meet; nothing if none was found in so many
/// attempts. Phases are sums and differences of what is given: where all that is whole ns, so are they. Same input,
/// same phases.
std::optional<std::vector<Ps>> find_phases(std::uint32_t resources, const std::vector<Mover>& movers,
                                           std::uint32_t attempts);

}  // namespace takt::schedule
