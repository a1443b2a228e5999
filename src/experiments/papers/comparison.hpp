// SPDX-License-Identifier: Apache-2.0
// A published figure beside the reproduced one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace takt::papers {

enum class Standing {
  calibrated,  ///< the model was fitted to this figure: it says nothing about the model
  predicted,   ///< it was not
  claim,       ///< a statement of the paper
  flaw,        ///< of the paper: it contradicts itself, and the run shows it; holds means that it does
};
std::string_view name_of(Standing standing);

struct Comparison {
  std::string what;
  std::string published;
  std::string reproduced;
  std::string measured = {};             ///< on this machine; empty: not measured
  std::optional<double> deviation = {};  ///< (reproduced - published) / published, or their difference
  std::optional<double> tolerance = {};  ///< of the deviation, either way
  bool in_points = false;                ///< the deviation is a difference in percentage points
  Standing standing = Standing::claim;
  bool holds = true;
  std::string remark = {};
};

/// `published` and `reproduced` in one unit, of which `decimals` are shown.
Comparison compare(std::string what, double published, double reproduced, std::string_view unit, int decimals,
                   double tolerance, Standing standing);

/// Shares in per cent: the deviation is their difference, in percentage points, and so is the tolerance.
Comparison compare_shares(std::string what, double published, double reproduced, double tolerance, Standing standing);

/// A statement of the paper that holds or does not.
Comparison claim(std::string what, std::string published, std::string reproduced, bool holds, std::string remark = {});

/// A picture that belongs to the reproduction: name without ending, SVG.
struct Figure {
  std::string name;
  std::string svg;
};

}  // namespace takt::papers
