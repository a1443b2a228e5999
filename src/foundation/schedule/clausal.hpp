// SPDX-License-Identifier: Apache-2.0
// Proofs of more streams than the simple ones can speak of: few streams are found that have no place beside each other,
// and clauses about them are refuted by a solver.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "schedule/certificate.hpp"
#include "schedule/search.hpp"

namespace takt::schedule {

/// How much is tried; work is counted, so that the answer is the same on every machine.
struct ClausalEffort {
  std::uint64_t most_thresholds = 15'000;  ///< of one set of clauses
  std::uint64_t most_clauses = 100'000;    ///< that are made altogether
  std::uint32_t conflicts =
      500;  ///< of one call of the solver, and four times as many of one while streams are dropped
};

/// `hardness`: by stream, how often the search had to move it; those that it moved most are tried together first. A
/// certificate of streams of which none can be dropped, as far as the effort shows. Only of problems that repeat
/// strictly.
std::optional<Certificate> refute_by_clauses(
    const Problem& problem, std::span<const std::uint64_t> hardness, const ClausalEffort& effort,
    const Stop& stop = [] { return false; });

/// Whether clauses about just these streams are refuted.
std::optional<Certificate> refute_streams(
    const Problem& problem, std::span<const StreamIndex> streams, const ClausalEffort& effort,
    const Stop& stop = [] { return false; });

}  // namespace takt::schedule
