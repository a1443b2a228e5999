// SPDX-License-Identifier: Apache-2.0
// The report of a study: one HTML file with tables and charts that needs nothing else, no network and no scripts.
#pragma once

#include <string>

#include "study/content.hpp"

namespace takt::study {

/// Main effects, response curves, heat maps, best and worst variants, Pareto fronts, where limits break, points without
/// a result.
std::string html_report(const Content& content);

/// The same in a few lines for the terminal.
std::string text_summary(const Content& content);

}  // namespace takt::study
