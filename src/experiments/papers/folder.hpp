// SPDX-License-Identifier: Apache-2.0
// Comparisons as text and JSON, and the folder that a reproduction leaves.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "json/node.hpp"
#include "papers/comparison.hpp"

namespace takt::papers {

/// published | reproduced | deviation | verdict, one line each; a column of what was measured if there is any.
std::string text_of(const std::vector<Comparison>& comparisons);
json::Node json_of(const std::vector<Comparison>& comparisons);

struct Folder {
  std::string text;                                            ///< report.txt
  std::string json;                                            ///< report.json
  std::vector<Figure> figures;                                 ///< NAME.svg
  std::vector<std::pair<std::string, std::string>> scenarios;  ///< scenarios/NAME.json
  std::vector<std::pair<std::string, std::string>> others;     ///< file names and contents
};

/// Creates the folder if it is missing. An empty text, or what went wrong.
[[nodiscard]] std::string write_folder(const std::string& folder, const Folder& content);

}  // namespace takt::papers
