// SPDX-License-Identifier: Apache-2.0
// The faults of a scenario that touch a Program: lines of its table, and what explains that words of a peer stay away.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "handshake/cause.hpp"
#include "handshake/reaction.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

struct ProgramFault {
  sim::TrueTime at;
  sim::TrueTime until = sim::TrueTime::never();
  std::string text = {};                       ///< "h3 crashes"
  std::string end_text = {};                   ///< "h3 is back"; empty: it has no end of its own
  std::optional<handshake::Cause> cause = {};  ///< crash or cut, of one that takes all words away
  /// Of a crash or a cut: from which node to which no word comes meanwhile. Ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> silenced = {};
};

/// By the instant at which they begin. Without rerouting, and of streams as they are laid at the beginning.
std::vector<ProgramFault> faults_of(const Resolved& resolved, const ResolvedProgram& program);

/// The latest fault that keeps words of `from` from `to` now and has done so since the last one came; if there is none,
/// silence since then.
handshake::Origin explain_silence(const std::vector<ProgramFault>& faults, std::uint32_t from, std::uint32_t to,
                                  sim::TrueTime since, sim::TrueTime now);

}  // namespace takt::scenario
