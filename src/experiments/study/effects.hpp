// SPDX-License-Identifier: Apache-2.0
// What the points say about factors: means over what else varies, with confidence intervals over the replications.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "study/content.hpp"
#include "study/statistics.hpp"

namespace takt::study {

/// For each level of a factor the summary of a measure: first the mean over all variants of each replication, then mean
/// and interval over the replications, which are independent. Missing figures are left out.
std::vector<Summary> main_effect(const Content& content, std::size_t factor, std::size_t measure);

/// The same by levels of two factors: [level of a][level of b].
std::vector<std::vector<Summary>> joint_effect(const Content& content, std::size_t a, std::size_t b,
                                               std::size_t measure);

/// By variant, mean, least and greatest over its replications; without an interval.
std::vector<Summary> by_variant(const Content& content, std::size_t measure);

/// By variant: 1 if all its points pass, 0 if one does not, nothing if it has none.
std::vector<std::optional<bool>> variants_that_pass(const Content& content);

/// The variants that no other one beats in both measures (means), by the first measure.
std::vector<std::uint32_t> pareto_front(const Content& content, std::size_t a, std::size_t b);

/// How much of the variance of a measure between variants the levels of a factor account for by themselves: the sum of
/// squares of its levels' means over the whole one (eta squared).
struct Influence {
  std::size_t factor = 0;
  double share = 0;  ///< 0 to 1
};
/// The greatest first; empty if the measure is the same in all variants. Exact where every level meets every other
/// equally often; the rest of 1 is what factors do together.
std::vector<Influence> influences(const Content& content, std::size_t measure);

/// Whether two factors can be told apart: at least half of all pairs of their levels have results. Else a chart of both
/// would show one of them, or a third factor.
bool are_crossed(const Content& content, std::size_t a, std::size_t b);

/// For a numeric factor and one combination of the other factors' levels: up to where all points pass, and where the
/// first does not.
struct Break {
  std::uint32_t variant = 0;               ///< one of the combination, for the names of the other levels
  std::optional<std::uint32_t> last_good;  ///< level before the first that breaks; none: it breaks at once
  std::optional<std::uint32_t> first_bad;  ///< none: it never breaks
};
/// Combinations that never break stand last.
std::vector<Break> breaks_along(const Content& content, std::size_t factor);

}  // namespace takt::study
