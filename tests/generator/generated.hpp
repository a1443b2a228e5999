// SPDX-License-Identifier: Apache-2.0
// A scenario for each number, and what the loader says of it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "tests/generator/features.hpp"

namespace takt::generator {

struct Generated {
  std::vector<Feature> asked;  ///< the pair that the number stands for, and some more
  std::string text;            ///< after repairs
  unsigned repairs = 0;        ///< parts that were left out because the loader refused them
  std::string first_refusal;   ///< what it said before any repair; empty if it took the scenario as it was drawn
  std::string problem;         ///< of the generator or the loader: refused to the end, or without saying where
  std::unique_ptr<scenario::Resolved> resolved;  ///< null with a problem
};

/// The same for the same number, everywhere. Consecutive numbers go through all pairs of features.
Generated generate(std::uint64_t number);

/// Where traces are looked for: the name of a file beside them.
const std::string& file_name();

}  // namespace takt::generator
