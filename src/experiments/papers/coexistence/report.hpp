// SPDX-License-Identifier: Apache-2.0
// The reproduction of the second paper as text and as JSON.
#pragma once

#include <string>

#include "papers/coexistence/coexistence.hpp"

namespace takt::papers::coexistence {

std::string text_report(const Reproduction& made);
std::string json_report(const Reproduction& made);
/// Writes report.txt, report.json, figures as SVG, the digital signals as VCD and the scenarios that were made. An
/// empty text, or what went wrong.
[[nodiscard]] std::string write_folder(const std::string& folder, const Reproduction& made);

}  // namespace takt::papers::coexistence
