// SPDX-License-Identifier: Apache-2.0
// Rows of CSV as objects of a scenario file: cables, devices and Programs, whose columns are the keys of the schema.
#pragma once

#include "interchange/csv/table.hpp"

namespace takt::interchange::csv {

enum class TableKind : std::uint8_t { streams, cables, devices, programs };

/// What a table is of, by its header; an error, with what each kind has, if it is none.
std::optional<TableKind> kind_of(const Table& table, json::Diagnostics& diagnostics);

void read_cables(const Table& table, scenario::Scenario& scenario, Imported& imported, json::Diagnostics& diagnostics);
void read_devices(const Table& table, scenario::Scenario& scenario, Imported& imported, json::Diagnostics& diagnostics);
void read_programs(const Table& table, scenario::Scenario& scenario, Imported& imported,
                   json::Diagnostics& diagnostics);

}  // namespace takt::interchange::csv
