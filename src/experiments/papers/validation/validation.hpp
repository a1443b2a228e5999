// SPDX-License-Identifier: Apache-2.0
// Every published or measured figure that takt was compared with. Start here.
//
//   Validation made = validate(options, diagnostics);   // runs, bounds and searches every scenario of the tables
//   text_report(made), markdown_report(made)            // report.hpp
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "papers/comparison.hpp"
#include "papers/validation/judge.hpp"

namespace takt::papers::validation {

struct Options {
  std::string tables = "validation";                 ///< the folder of the tables
  bool is_short = false;                             ///< of large families some rows only
  unsigned jobs = 0;                                 ///< threads; 0: one for each core
  std::function<void(const std::string&)> progress;  ///< told what is done; may be empty
};

struct Validation {
  bool is_short = false;
  std::vector<SourceOfFigures> sources;
  std::vector<Judged> figures;  ///< by source
  std::vector<Figure> pictures;
  /// Every figure is met, or is one of those that the tables say differ.
  bool holds() const;
  std::size_t count(Agreement verdict, std::optional<std::size_t> source = {}) const;
};

/// Nothing if a table or a scenario is wrong: the diagnostics say how.
std::optional<Validation> validate(const Options& options, json::Diagnostics& diagnostics);

}  // namespace takt::papers::validation
