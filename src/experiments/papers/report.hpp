// SPDX-License-Identifier: Apache-2.0
// A reproduction as text and as JSON.
#pragma once

#include <string>

#include "papers/programs.hpp"

namespace takt::papers {

std::string text_report(const Reproduction& made);
std::string json_report(const Reproduction& made);
/// Writes report.txt, report.json, the figures as SVG and the scenarios that were made into the folder, which is
/// created if it is missing. An empty text, or what went wrong.
[[nodiscard]] std::string write_folder(const std::string& folder, const Reproduction& made);

}  // namespace takt::papers
