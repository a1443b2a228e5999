// SPDX-License-Identifier: Apache-2.0
// Tables for people: as wide as they must be and no wider than the page, quantities one below the other by their
// decimal points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace takt::output {

/// How a page is laid out.
struct Layout {
  std::size_t width = 0;  ///< columns of the page; 0: as many as it takes
  bool all = false;       ///< lists are whole, however long
};

class Table {
 public:
  enum class Align : std::uint8_t {
    left,
    right,
    quantity
  };  ///< quantity: "24.109 us", by the decimal point, the unit behind
  struct Column {
    std::string title;
    Align align = Align::left;
    unsigned rank = 0;  ///< where the page is too narrow, the column of the highest rank goes first; of rank 0 never
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// Cells by column; fewer than columns leave the others empty. The remark stands behind the row, or below it where
  /// the page ends.
  void add(std::vector<std::string> cells, std::string remark = {}) {
    rows_.push_back({std::move(cells), std::move(remark)});
  }
  /// The title row, the rows, and what was left out for want of width; each line is indented by two and ends with a
  /// newline.
  std::string text(const Layout& layout) const;

 private:
  struct Row {
    std::vector<std::string> cells;
    std::string remark;
  };
  /// What the cells of a column take, by their parts.
  struct Extent {
    std::size_t whole = 0;  ///< before the decimal point
    std::size_t rest = 0;   ///< from the point on
    std::size_t unit = 0;
    std::size_t total = 0;
  };
  Extent extent_of(std::size_t column) const;
  std::string laid(const std::string& cell, std::size_t column, const Extent& extent) const;

  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

/// "trajectory/...generator": shortened in the middle to `most` characters (at least 8).
std::string shortened(std::string_view name, std::size_t most);

/// The rows one after another; if there are more than `most`, the first and the last of them, and in the middle how
/// many are left out.
std::string elided(const std::vector<std::string>& rows, std::size_t most, const Layout& layout);

}  // namespace takt::output
