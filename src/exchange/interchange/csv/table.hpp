// SPDX-License-Identifier: Apache-2.0
// CSV as spreadsheets write it: with a byte order mark, with commas, semicolons or tabs between cells, with decimal
// commas.
#pragma once

#include <string>
#include <vector>

#include "interchange/import.hpp"

namespace takt::interchange::csv {

struct Cell {
  std::string text;  ///< without blanks around it
  json::Place place;
};
using Row = std::vector<Cell>;

struct Table {
  Row header;             ///< lower case, with _ for blanks
  std::vector<Row> rows;  ///< each as long as the header
  char separator = ',';
};

/// Reads RFC 4180 with the separator that the first line has most of; "sep=;" in the first line says it. Blank lines
/// and lines that begin with # are passed over, empty cells behind the last column are dropped.
Table read_table(const InputFile& file, json::Diagnostics& diagnostics);

/// A quantity as people write it for one of takt: "1 Gbit/s": "1Gbps", "0,5 ms" between semicolons: "0.5ms". `unit` is
/// that of a bare number; may be empty.
std::string as_quantity(std::string text, std::string_view unit, bool has_decimal_commas);

/// The names of a cell with several: behind semicolons, bars, or commas where these do not separate cells.
std::vector<std::string> names_in(const Cell& cell, char separator);

}  // namespace takt::interchange::csv
