// SPDX-License-Identifier: Apache-2.0
// Published figures and takt's, drawn.
#pragma once

#include <vector>

#include "papers/comparison.hpp"
#include "papers/validation/validation.hpp"

namespace takt::papers::validation {

/// One picture of all ratios, and one of each source whose figures come in rows: what was measured between what takt
/// found and what it proves.
std::vector<Figure> draw_charts(const Validation& made);

}  // namespace takt::papers::validation
