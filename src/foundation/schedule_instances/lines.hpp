// SPDX-License-Identifier: Apache-2.0
// Texts that are not JSON: lines, columns of CSV, numbers, each with its place.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "schedule_instances/builder.hpp"
#include "schedule_instances/formats.hpp"

namespace takt::schedule_instances {

inline constexpr std::size_t most_lines = 1'000'000;

/// A part of a line.
struct Cell {
  std::string text;
  std::uint32_t column = 1;
};

struct Line {
  std::uint32_t number = 1;
  std::vector<Cell> cells;
};

json::Place place_in(const TextFile& file, std::uint32_t line, std::uint32_t column = 1);

/// Rows of CSV whose first line names the columns; a cell may stand in double quotes. Told if columns are missing or a
/// row has not as many cells.
class Csv {
 public:
  Csv(const TextFile& file, const std::vector<std::string_view>& columns, json::Diagnostics& diagnostics);
  const std::vector<Line>& rows() const { return rows_; }
  /// The cell of the column with that index in `columns`.
  const Cell& cell(const Line& row, std::size_t column) const { return row.cells[order_[column]]; }
  json::Place place(const Line& row, std::size_t column) const {
    return place_in(file_, row.number, cell(row, column).column);
  }
  std::int64_t whole(const Line& row, std::size_t column, Range range) const;
  std::int64_t scaled(const Line& row, std::size_t column, double unit, Range range) const;

 private:
  const TextFile& file_;
  json::Diagnostics& diagnostics_;
  std::vector<std::size_t> order_;
  std::vector<Line> rows_;
};

/// All numbers or words of a list such as "[3, 4]" or "(0, 1)"; nothing if it is none.
std::optional<std::vector<std::string>> list_of(std::string_view text);
std::optional<std::int64_t> whole_of(std::string_view text, Range range);
std::string_view trimmed(std::string_view text);

}  // namespace takt::schedule_instances
