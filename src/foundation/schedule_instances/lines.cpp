// SPDX-License-Identifier: Apache-2.0
#include "schedule_instances/lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

namespace takt::schedule_instances {
namespace {

/// The cells of a line of CSV; nothing if a quote is not closed.
std::optional<std::vector<Cell>> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  for (;;) {
    Cell cell{{}, static_cast<std::uint32_t>(at + 1)};
    if (at < line.size() && line[at] == '"') {
      for (++at;; ++at) {
        if (at >= line.size()) return std::nullopt;
        if (line[at] != '"')
          cell.text += line[at];
        else if (at + 1 < line.size() && line[at + 1] == '"')
          cell.text += line[at++];
        else
          break;
      }
      ++at;
    }
    while (at < line.size() && line[at] != ',') cell.text += line[at++];
    cells.push_back(std::move(cell));
    if (at >= line.size()) return cells;
    ++at;
  }
}

}  // namespace

json::Place place_in(const TextFile& file, std::uint32_t line, std::uint32_t column) {
  return {file.name, line, column, ""};
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

Csv::Csv(const TextFile& file, const std::vector<std::string_view>& columns, json::Diagnostics& diagnostics)
    : file_(file), diagnostics_(diagnostics) {
  std::string_view rest = file.text;
  std::size_t width = 0;
  for (std::uint32_t number = 1; !rest.empty(); ++number) {
    if (number > most_lines) {
      diagnostics.error(place_in(file, number), "too many lines", {"more", fmt::format("at most {}", most_lines)});
      return;
    }
    const std::size_t end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line.empty()) continue;
    auto cells = cells_of(line);
    if (!cells) {
      diagnostics.error(place_in(file, number), "a quote that is not closed");
      continue;
    }
    if (width == 0) {
      width = cells->size();
      for (const std::string_view column : columns) {
        const auto found =
            std::find_if(cells->begin(), cells->end(), [&](const Cell& cell) { return trimmed(cell.text) == column; });
        if (found == cells->end())
          diagnostics.error(place_in(file, number), fmt::format("there is no column \"{}\"", column));
        order_.push_back(static_cast<std::size_t>(found - cells->begin()));
      }
      if (diagnostics.has_errors()) return;
      continue;
    }
    if (cells->size() != width) {
      diagnostics.error(place_in(file, number), "not as many cells as the first line",
                        {std::to_string(cells->size()), std::to_string(width)});
      continue;
    }
    rows_.push_back({number, std::move(*cells)});
  }
  if (width == 0) diagnostics.error(place_in(file, 1), "an empty table");
}

std::optional<std::int64_t> whole_of(std::string_view text, Range range) {
  text = trimmed(text);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < range.least || value > range.most)
    return std::nullopt;
  return value;
}

std::int64_t Csv::whole(const Line& row, std::size_t column, Range range) const {
  const auto value = whole_of(cell(row, column).text, range);
  if (!value)
    diagnostics_.error(
        place(row, column), "not in range",
        {json::quote(cell(row, column).text), fmt::format("a whole number from {} to {}", range.least, range.most)});
  return value.value_or(range.least);
}

std::int64_t Csv::scaled(const Line& row, std::size_t column, double unit, Range range) const {
  const std::string_view text = trimmed(cell(row, column).text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const double product = value * unit;
  if (error == std::errc() && end == text.data() + text.size() && product >= static_cast<double>(range.least) &&
      product <= static_cast<double>(range.most) &&
      std::abs(product - std::nearbyint(product)) <= std::max(0.01, std::abs(product) * 1e-12))
    return static_cast<std::int64_t>(std::nearbyint(product));
  diagnostics_.error(
      place(row, column), "not in range",
      {json::quote(text), fmt::format("a number from {:g} to {:g}", static_cast<double>(range.least) / unit,
                                      static_cast<double>(range.most) / unit)});
  return range.least;
}

std::optional<std::vector<std::string>> list_of(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 2 || !((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')')))
    return std::nullopt;
  text = text.substr(1, text.size() - 2);
  std::vector<std::string> items;
  while (!trimmed(text).empty()) {
    const std::size_t comma = text.find(',');
    std::string_view item = trimmed(text.substr(0, comma));
    if (item.size() >= 2 && (item.front() == '\'' || item.front() == '"') && item.back() == item.front())
      item = item.substr(1, item.size() - 2);
    if (item.empty()) return std::nullopt;
    items.emplace_back(item);
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return items;
}

}  // namespace takt::schedule_instances
