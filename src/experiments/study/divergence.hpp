// SPDX-License-Identifier: Apache-2.0
// Where two runs diverge: the first instant at which not the same happens in both.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "sim/time.hpp"

namespace takt::study {

struct Divergence {
  sim::TrueTime at;
  std::vector<std::string>
      only_a;  ///< what happens then in the first run only: "frame 12 of axis leaves sw1 towards sw2"
  std::vector<std::string> only_b;
  std::uint64_t seed = 0;  ///< of both runs
};

/// Runs both side by side until they differ in what is produced, sent or dropped, by names: nodes and streams of one
/// may be missing in the other. Nothing: they do not differ up to the end of the shorter one, or `interrupted`.
std::optional<Divergence> first_divergence(const scenario::Resolved& a, const scenario::Resolved& b,
                                           const std::function<bool()>& interrupted);

}  // namespace takt::study
