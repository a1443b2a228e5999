// SPDX-License-Identifier: Apache-2.0
// What stands first in a report: what its figures are, and which levels pass.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/content.hpp"

namespace takt::study {

/// A level of a factor whose levels are names, such as a protection or a link.
struct LevelScore {
  std::uint32_t level = 0;
  std::size_t passing = 0;                 ///< variants with it of which every point passes
  std::size_t known = 0;                   ///< variants with it that have a point
  std::optional<std::size_t> first_break;  ///< the row of the first point that does not pass
};
/// The level of which most pass comes first; levels without a point are left out.
std::vector<LevelScore> level_scores(const Content& content, std::size_t factor);

/// Whether the levels of a factor are names that an answer can be: at least two of them, and not all numbers.
bool has_named_levels(const ContentFactor& factor);

/// "slaves = 3, cycle = 200us": all levels of a variant but that of one factor.
std::string others_of(const Content& content, std::uint32_t variant, std::size_t factor);
/// Which limits a point does not keep, and its figures: "lost <= 0: 12 frames".
std::string broken_by(const Content& content, std::size_t row);

/// What a measure's figures are: "of runs: 5 of each variant, ...".
std::string meaning_of(const Content& content, std::size_t measure);

// As HTML, and as text for a terminal.
std::string figures_table(const Content& content);
std::string level_tables(const Content& content);
std::string level_text(const Content& content);

}  // namespace takt::study
