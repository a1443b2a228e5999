// SPDX-License-Identifier: Apache-2.0
#include "interchange/csv/table.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace takt::interchange::csv {
namespace {

std::string trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return std::string(text);
}

char separator_of(std::string_view text) {
  if (text.starts_with("sep=") && text.size() > 4) return text[4];
  while (!text.empty() && (text.front() == '#' || text.front() == '\n' || text.front() == '\r'))
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  std::array<std::pair<char, int>, 3> counts{{{',', 0}, {';', 0}, {'\t', 0}}};
  bool is_quoted = false;
  for (const char c : text.substr(0, text.find('\n'))) {
    if (c == '"') is_quoted = !is_quoted;
    for (auto& [sign, count] : counts)
      if (c == sign && !is_quoted) ++count;
  }
  return std::ranges::max_element(counts, {}, &std::pair<char, int>::second)->first;
}

class TableReader {
 public:
  TableReader(const InputFile& file, std::string_view text, char separator, json::Diagnostics& diagnostics)
      : file_(file), text_(text), separator_(separator), diagnostics_(diagnostics) {}

  std::vector<Row> run() {
    std::vector<Row> rows;
    while (at_ < text_.size()) {
      if (text_[at_] == '\n' || text_[at_] == '#' || text_[at_] == '\r') {
        skip_line();
        continue;
      }
      Row row = read_row();
      if (std::ranges::any_of(row, [](const Cell& cell) { return !cell.text.empty(); })) rows.push_back(std::move(row));
    }
    return rows;
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    ++at_;
    ++line_;
  }

 private:
  Row read_row() {
    Row row;
    column_ = 1;
    for (bool goes_on = true; goes_on;) {
      row.push_back(read_cell());
      goes_on = at_ < text_.size() && text_[at_] == separator_;
      if (at_ < text_.size()) ++at_;
      ++column_;
    }
    ++line_;
    return row;
  }

  Cell read_cell() {
    while (at_ < text_.size() && text_[at_] == ' ') {
      ++at_;
      ++column_;
    }
    Cell cell{"", {file_.name, line_, column_, ""}};
    bool is_quoted = false;
    if (at_ < text_.size() && text_[at_] == '"') {
      is_quoted = true;
      ++at_;
      ++column_;
      while (at_ < text_.size() && !(text_[at_] == '"' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '"'))) {
        if (text_[at_] == '"') ++at_;  // two stand for one
        if (text_[at_] == '\n') {
          ++line_;
          column_ = 0;
        }
        cell.text += text_[at_++];
        ++column_;
      }
      if (at_ >= text_.size())
        diagnostics_.error(cell.place, "a cell that does not end", {"no closing quote", "a quote at its end"});
      else {
        ++at_;
        ++column_;
      }
    }
    for (; at_ < text_.size() && text_[at_] != separator_ && text_[at_] != '\n'; ++at_, ++column_)
      if (text_[at_] != '\r') cell.text += text_[at_];
    if (!is_quoted) cell.text = trimmed(cell.text);
    return cell;
  }

  const InputFile& file_;
  std::string_view text_;
  char separator_;
  json::Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1, column_ = 1;
};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

Table read_table(const InputFile& file, json::Diagnostics& diagnostics) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string_view text = file.text;
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  Table table;
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    diagnostics.error({file.name, 1, 1, ""}, "text of 16 bits a character",
                      {"a byte order mark of UTF-16", "UTF-8: in a spreadsheet \"CSV UTF-8\""});
    return table;
  }
  table.separator = separator_of(text);
  TableReader reader(file, text, table.separator, diagnostics);
  if (text.starts_with("sep=")) reader.skip_line();
  std::vector<Row> rows = reader.run();
  if (rows.empty()) {
    diagnostics.error({file.name, 1, 1, ""}, "no header", {"an empty file", "name,from,to,payload,every,..."});
    return table;
  }
  table.header = std::move(rows.front());
  while (!table.header.empty() && table.header.back().text.empty()) table.header.pop_back();
  for (Cell& cell : table.header)
    std::ranges::transform(cell.text, cell.text.begin(), [](unsigned char c) {
      return c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(c));
    });
  for (std::size_t i = 1; i < rows.size(); ++i) {
    Row& row = rows[i];
    while (row.size() > table.header.size() && row.back().text.empty()) row.pop_back();
    if (row.size() != table.header.size())
      diagnostics.error(row.front().place, "a row of another length than the header",
                        {std::to_string(row.size()) + " cells", std::to_string(table.header.size())});
    else
      table.rows.push_back(std::move(row));
  }
  return table;
}

std::string as_quantity(std::string text, std::string_view unit, bool has_decimal_commas) {
  if (has_decimal_commas) std::ranges::replace(text, ',', '.');
  replace_all(text, "\xC2\xB5", "u");  // the micro sign, and the Greek letter
  replace_all(text, "\xCE\xBC", "u");
  replace_all(text, "\xC2\xA0", "");  // a blank that is not broken
  std::erase(text, ' ');
  for (const char* const per_second : {"bit/s", "Bit/s", "b/s", "BIT/S"}) replace_all(text, per_second, "bps");
  if (text.ends_with("bit")) text.replace(text.size() - 3, 3, "bps");
  if (text.ends_with("Byte")) text.replace(text.size() - 4, 4, "B");
  if (text.ends_with("Bytes") || text.ends_with("bytes")) text.replace(text.size() - 5, 5, "B");
  const bool is_bare = !text.empty() && text.find_first_not_of("0123456789.") == std::string::npos;
  return is_bare ? text + std::string(unit) : text;
}

std::vector<std::string> names_in(const Cell& cell, char separator) {
  const std::string signs = separator == ',' ? ";|" : ";|,";
  std::vector<std::string> names;
  std::string_view rest = cell.text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of(signs), rest.size());
    if (std::string name = trimmed(rest.substr(0, end)); !name.empty()) names.push_back(std::move(name));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return names;
}

}  // namespace takt::interchange::csv
