// SPDX-License-Identifier: Apache-2.0
// Is there a schedule? Search and refutation in the order in which they cost: one quick placement, proofs, search with
// strict repetition, then what more freedom there is.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "schedule/certificate.hpp"
#include "schedule/search.hpp"

namespace takt::schedule {

enum class Objective : std::uint8_t {
  feasible,  ///< any schedule
  latency,   ///< the sum of latencies
  entries,   ///< the longest gate control list
  slack,     ///< the greatest clock error that the schedule survives
};

struct Decision {
  enum class Verdict : std::uint8_t { scheduled, infeasible, undecided };
  Verdict verdict = Verdict::undecided;
  SearchResult found;                      ///< a schedule, or the best partial one
  std::optional<Certificate> certificate;  ///< why there is none
  std::string_view how;                    ///< "first fit" or "search"
  std::vector<std::string> rejected;       ///< what the judge said of certificates that proved nothing
  Ps margin = 0;  ///< clock error that the schedule is made for: the problem's, or what `slack` found
};

Decision decide(const Problem& problem, const SearchOptions& options, Objective objective = Objective::feasible);

/// The sum over streams of the greatest latency to any listener.
Ps sum_of_latencies(const Problem& problem, const Solution& solution);

}  // namespace takt::schedule
