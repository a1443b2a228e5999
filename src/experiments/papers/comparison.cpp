// SPDX-License-Identifier: Apache-2.0
#include "papers/comparison.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace takt::papers {

std::string_view name_of(Standing standing) {
  constexpr std::array<std::string_view, 4> names = {"calibrated", "predicted", "claim", "flaw of the paper"};
  return names[static_cast<std::size_t>(standing)];
}

Comparison compare(std::string what, double published, double reproduced, std::string_view unit, int decimals,
                   double tolerance, Standing standing) {
  Comparison made;
  made.what = std::move(what);
  made.published = fmt::format("{:.{}f} {}", published, decimals, unit);
  made.reproduced = fmt::format("{:.{}f} {}", reproduced, decimals, unit);
  made.deviation = (reproduced - published) / published;
  made.tolerance = tolerance;
  made.standing = standing;
  made.holds = std::abs(*made.deviation) <= tolerance;
  return made;
}

Comparison compare_shares(std::string what, double published, double reproduced, double tolerance, Standing standing) {
  Comparison made;
  made.what = std::move(what);
  made.published = fmt::format("{:g} %", published);
  made.reproduced = fmt::format("{:.1f} %", reproduced);
  made.deviation = reproduced - published;
  made.tolerance = tolerance;
  made.in_points = true;
  made.standing = standing;
  made.holds = std::abs(*made.deviation) <= tolerance;
  return made;
}

Comparison claim(std::string what, std::string published, std::string reproduced, bool holds, std::string remark) {
  Comparison made;
  made.what = std::move(what);
  made.published = std::move(published);
  made.reproduced = std::move(reproduced);
  made.standing = Standing::claim;
  made.holds = holds;
  made.remark = std::move(remark);
  return made;
}

}  // namespace takt::papers
