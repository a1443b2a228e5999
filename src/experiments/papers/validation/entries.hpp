// SPDX-License-Identifier: Apache-2.0
// Tables as a list: each figure with the scenario that it is taken from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json/diagnostics.hpp"
#include "json/document.hpp"
#include "papers/validation/table.hpp"

namespace takt::papers::validation {

/// Of a table, without its figures.
struct SourceOfFigures {
  std::string id;  ///< the name of its file: "conext22"
  std::string name;
  std::string reference;
  std::string about;
  double budget = 0;
};

struct Entry {
  std::size_t source = 0;  ///< in Entries::sources
  FigureText text;
  json::Document scenario;  ///< with all that the figure puts there
};

struct Entries {
  std::vector<SourceOfFigures> sources;
  std::vector<Entry> figures;  ///< by source
};

/// Reads all tables (*.json) of a folder, by name. Nothing if one of them is wrong: the diagnostics say how.
std::optional<Entries> read_tables(const std::string& folder, bool is_short, json::Diagnostics& diagnostics);

}  // namespace takt::papers::validation
