// SPDX-License-Identifier: Apache-2.0
// How many streams can be scheduled: of a study of schedules what became of the draws, by number of streams, topology
// and method.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/content.hpp"

namespace takt::study {

/// Of one number of streams, on one topology, by one method.
struct Draws {
  std::size_t scheduled = 0;
  std::size_t infeasible = 0;  ///< proved
  std::size_t undecided = 0;
  std::size_t without_result = 0;  ///< too long, too large, no scenario
  std::size_t all() const { return scheduled + infeasible + undecided + without_result; }
};

struct Frontier {
  std::size_t factor = 0;               ///< that the numbers of streams are levels of
  std::vector<std::uint32_t> levels;    ///< of it, ascending
  std::string across;                   ///< the factor whose levels are the topologies; "" if there is none
  std::vector<std::string> topologies;  ///< one, empty, if there is no such factor
  std::vector<std::string> methods;  ///< combinations of the levels of all other factors; one, empty, if there are none
  std::vector<std::vector<std::vector<Draws>>> draws;  ///< by topology, method and number of streams (as in `levels`)

  /// Index into `levels` of the greatest number of streams such that of it, and of each smaller one, at least this
  /// share of the draws is scheduled; nothing: not even of the least.
  std::optional<std::size_t> reach(std::size_t topology, std::size_t method, double share) const;
};

/// The share that pictures and words are about.
constexpr double frontier_share = 0.9;

/// Nothing for a study that runs its points, or in which the number of streams does not vary.
std::optional<Frontier> frontier_of(const Content& content);

/// The frontier as bars, what is scheduled and what is refuted over the number of streams as curves, and all shares as
/// a table.
std::string frontier_charts(const Content& content, const Frontier& frontier);
std::string frontier_table(const Content& content, const Frontier& frontier);
/// A line for each topology and method.
std::string frontier_text(const Content& content, const Frontier& frontier);

}  // namespace takt::study
