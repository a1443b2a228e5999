// SPDX-License-Identifier: Apache-2.0
// The charts of a study's report. Each returns <svg> elements, or nothing where there is nothing to show.
#pragma once

#include <string>

#include "study/content.hpp"

namespace takt::study {

/// More levels than that are drawn as a cloud of points, not as bars or curves.
constexpr std::size_t most_levels_shown = 40;

/// A measure over the levels of a factor, averaged over everything else.
std::string main_effect_chart(const Content& content, std::size_t factor, std::size_t measure);
/// A measure over a numeric factor, one curve for each level of another.
std::string response_chart(const Content& content, std::size_t x, std::size_t curves, std::size_t measure);
std::string heat_map_chart(const Content& content, std::size_t rows, std::size_t columns, std::size_t measure);
std::string pareto_chart(const Content& content, std::size_t a, std::size_t b);
/// The share of variants that pass, over the levels of a factor.
std::string pass_chart(const Content& content, std::size_t factor);

/// "start in ms"
std::string label_of(const ContentMeasure& measure);

}  // namespace takt::study
