// SPDX-License-Identifier: Apache-2.0
// takt's figures: every scenario is run, bounded or searched once, whatever is read off it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "papers/validation/entries.hpp"

namespace takt::papers::validation {

/// What takt says, in the unit of the figure.
struct Measured {
  std::optional<double> value;
  std::string exact;   ///< a fraction, of networks of servers
  std::string reason;  ///< why there is none
};

struct MeasureOptions {
  unsigned jobs = 1;                                               ///< threads; the figures are the same for any number
  std::function<void(std::size_t done, std::size_t of)> progress;  ///< told by any of them, one at a time
};

/// By figure. Mistakes in scenarios are diagnostics, and then the figure has none.
std::vector<Measured> measure(const Entries& entries, const MeasureOptions& options, json::Diagnostics& diagnostics);

}  // namespace takt::papers::validation
