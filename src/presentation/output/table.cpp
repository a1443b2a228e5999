// SPDX-License-Identifier: Apache-2.0
#include "output/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace takt::output {
namespace {

constexpr std::size_t narrowest_name = 12;

struct Parts {
  std::string_view whole;
  std::string_view rest;
  std::string_view unit;
};

Parts parts_of(std::string_view cell) {
  const std::size_t space = std::min(cell.find(' '), cell.size());
  const std::size_t point = std::min(cell.find('.'), space);
  return {cell.substr(0, point), cell.substr(point, space - point),
          space < cell.size() ? cell.substr(space + 1) : std::string_view()};
}

/// Characters, not octets: names may be of any script.
std::size_t length_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padding(std::size_t wanted, std::size_t had) { return std::string(wanted > had ? wanted - had : 0, ' '); }

void end_line(std::string& line) {
  while (!line.empty() && line.back() == ' ') line.pop_back();
  line += '\n';
}

}  // namespace

std::string shortened(std::string_view name, std::size_t most) {
  constexpr std::string_view dots = "...";
  if (length_of(name) <= most || length_of(name) != name.size()) return std::string(name);
  const std::size_t left = (most - dots.size() + 1) / 2;
  return std::string(name.substr(0, left)).append(dots).append(name.substr(name.size() - (most - dots.size() - left)));
}

Table::Extent Table::extent_of(std::size_t column) const {
  Extent extent;
  for (const Row& row : rows_) {
    if (column >= row.cells.size()) continue;
    extent.total = std::max(extent.total, length_of(row.cells[column]));
    const Parts parts = parts_of(row.cells[column]);
    extent.whole = std::max(extent.whole, length_of(parts.whole));
    extent.rest = std::max(extent.rest, length_of(parts.rest));
    extent.unit = std::max(extent.unit, length_of(parts.unit));
  }
  if (columns_[column].align == Align::quantity)
    extent.total = extent.whole + extent.rest + (extent.unit > 0 ? 1 + extent.unit : 0);
  extent.total = std::max(extent.total, length_of(columns_[column].title));
  return extent;
}

std::string Table::laid(const std::string& cell, std::size_t column, const Extent& extent) const {
  if (columns_[column].align == Align::left) return cell + padding(extent.total, length_of(cell));
  if (columns_[column].align == Align::right) return padding(extent.total, length_of(cell)) + cell;
  const Parts parts = parts_of(cell);
  std::string text = padding(extent.whole, length_of(parts.whole)) + std::string(parts.whole) +
                     std::string(parts.rest) + padding(extent.rest, length_of(parts.rest));
  if (extent.unit > 0) text += " " + std::string(parts.unit) + padding(extent.unit, length_of(parts.unit));
  return padding(extent.total, length_of(text)) + text;
}

std::string Table::text(const Layout& layout) const {
  std::vector<Extent> extents;
  for (std::size_t c = 0; c < columns_.size(); ++c) extents.push_back(extent_of(c));
  std::vector<bool> is_shown(columns_.size(), true);
  const auto width = [&] {
    std::size_t sum = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c) sum += is_shown[c] ? 2 + extents[c].total : 0;
    return sum;
  };
  while (layout.width > 0 && width() > layout.width) {
    std::size_t least = columns_.size();
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (is_shown[c] && columns_[c].rank > 0 && (least == columns_.size() || columns_[c].rank > columns_[least].rank))
        least = c;
    if (least == columns_.size()) break;
    is_shown[least] = false;
  }
  // What is still too much is taken from the names.
  if (layout.width > 0 && width() > layout.width && extents[0].total > narrowest_name)
    extents[0].total = std::max(narrowest_name, extents[0].total - std::min(extents[0].total, width() - layout.width));

  const auto line_of = [&](const std::vector<std::string>& cells, bool is_title) {
    std::string line;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (!is_shown[c]) continue;
      const std::string cell =
          c < cells.size() ? (c == 0 ? shortened(cells[c], extents[c].total) : cells[c]) : std::string();
      if (is_title)
        line += "  " + (columns_[c].align == Align::left ? cell + padding(extents[c].total, length_of(cell))
                                                         : padding(extents[c].total, length_of(cell)) + cell);
      else
        line += "  " + laid(cell, c, extents[c]);
    }
    return line;
  };

  std::vector<std::string> titles;
  std::string left_out;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    titles.push_back(columns_[c].title);
    if (!is_shown[c]) left_out += (left_out.empty() ? "" : ", ") + columns_[c].title;
  }
  std::string out;
  if (std::any_of(titles.begin(), titles.end(), [](const std::string& title) { return !title.empty(); })) {
    std::string line = line_of(titles, true);
    end_line(line);
    out += line;
  }
  for (const Row& row : rows_) {
    std::string line = line_of(row.cells, false);
    if (!row.remark.empty()) {
      if (layout.width > 0 && length_of(line) + 2 + length_of(row.remark) > layout.width) {
        end_line(line);
        line += "        " + row.remark;
      } else {
        line += "  " + row.remark;
      }
    }
    end_line(line);
    out += line;
  }
  if (!left_out.empty()) out += "  (a wider terminal shows " + left_out + ", too)\n";
  return out;
}

std::string elided(const std::vector<std::string>& rows, std::size_t most, const Layout& layout) {
  const auto joined = [&](std::size_t from, std::size_t to) {
    return std::accumulate(rows.begin() + static_cast<std::ptrdiff_t>(from),
                           rows.begin() + static_cast<std::ptrdiff_t>(to), std::string());
  };
  if (layout.all || rows.size() <= most) return joined(0, rows.size());
  const std::size_t last = most / 2;
  const std::size_t first = most - last;
  return joined(0, first) + fmt::format("  ... {} more, which --all shows\n", rows.size() - most) +
         joined(rows.size() - last, rows.size());
}

}  // namespace takt::output
