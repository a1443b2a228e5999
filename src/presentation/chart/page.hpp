// SPDX-License-Identifier: Apache-2.0
// A page that needs nothing else: one file, no network, no scripts; light and dark as the reader's screen is, from a
// phone's width to a wall's, and on paper.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace takt::chart {

/// From the doctype to the page's heading, with the style sheets of page and charts.
std::string page_head(std::string_view title);
std::string page_end();

/// A heading with what a reader should know of what follows; no note if it is empty.
std::string section(std::string_view title, std::string_view note = {});
/// Charts side by side as far as the page is wide; nothing if there are none.
std::string charts(const std::vector<std::string>& elements);
/// A chart that keeps its size, and scrolls by itself where the page is too narrow for it.
std::string wide_chart(const std::string& element);

/// A cell of a table; its text is escaped.
struct Cell {
  std::string text;
  bool is_number = false;      ///< stands at the right
  std::string_view look = {};  ///< a class: "pass", "fail", "undecided", "note"
};

/// A table, without a head row if it has no heads, that scrolls by itself where the page is too narrow for it. Rows
/// beyond `most_rows` are counted, not shown.
class Table {
 public:
  explicit Table(std::vector<std::string> heads, std::size_t most_rows = 200)
      : heads_(std::move(heads)), most_rows_(most_rows) {}
  void row(const std::vector<Cell>& cells);
  /// Nothing if it has no rows.
  std::string take();

 private:
  std::vector<std::string> heads_;
  std::size_t most_rows_;
  std::size_t rows_ = 0;
  std::string body_;
};

}  // namespace takt::chart
