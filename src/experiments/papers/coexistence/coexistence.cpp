// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/coexistence.hpp"

#include <algorithm>

#include "papers/coexistence/criteria.hpp"
#include "papers/coexistence/improvements.hpp"
#include "papers/coexistence/signals.hpp"

namespace takt::papers::coexistence {

bool Reproduction::holds() const {
  return std::all_of(comparisons.begin(), comparisons.end(),
                     [](const Comparison& comparison) { return comparison.holds; });
}

std::optional<Reproduction> reproduce(const Options& options, json::Diagnostics& diagnostics) {
  Reproduction made;
  made.is_short = options.is_short;
  made.laws = compare_laws();
  if (!reproduce_criteria(options, made, diagnostics)) return std::nullopt;
  if (!reproduce_signals(options, made, diagnostics)) return std::nullopt;
  if (!improve(options, made, diagnostics)) return std::nullopt;
  if (options.measured) add_measured(*options.measured, made);
  return made;
}

}  // namespace takt::papers::coexistence
