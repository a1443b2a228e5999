// SPDX-License-Identifier: Apache-2.0
// The comparison with published figures as text, JSON and as the page docs/validation.md.
#pragma once

#include <string>

#include "papers/validation/validation.hpp"

namespace takt::papers::validation {

/// A line for each source, then every figure that is not met.
std::string text_report(const Validation& made);
std::string json_report(const Validation& made);
/// docs/validation.md, if the form is not short.
std::string markdown_report(const Validation& made);
/// Writes report.txt, report.json, validation.md and the pictures. An empty text, or what went wrong.
[[nodiscard]] std::string write_folder(const std::string& folder, const Validation& made);

}  // namespace takt::papers::validation
