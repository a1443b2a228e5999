// SPDX-License-Identifier: Apache-2.0
// What pages of runs and of verifications both show.
#pragma once

#include <string>
#include <string_view>

#include "chart/limit_bars.hpp"
#include "results/run_result.hpp"

namespace takt::report {

/// The class of a verdict on the page, by its name.
std::string_view look_of(std::string_view verdict);
/// The sentence on top.
std::string verdict_line(std::string_view verdict, std::string_view sentence);
/// "12.4 us of 30 us", or the figure in its unit.
std::string figures_of(const results::RequirementResult& requirement);
/// A requirement as a bar, as far as it has a limit other than 0.
chart::LimitBar limit_bar(const results::RequirementResult& requirement, std::string_view verdict);

}  // namespace takt::report
