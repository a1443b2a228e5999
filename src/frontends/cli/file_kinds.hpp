// SPDX-License-Identifier: Apache-2.0
// Kinds of files that `takt schema` describes: a table of those of takt itself, and one of those that only companions
// read or write.
#pragma once

#include <span>
#include <string_view>

#include "cli/commands.hpp"
#include "json/fields.hpp"
#include "json/record.hpp"
#include "json/reference.hpp"

namespace takt::cli {

/// A kind of file that takt reads, or of output that it writes.
struct FileKind {
  const char* name;
  const char* title;
  json::Node (*schema)(std::string_view title);
  const json::Record* (*record)() = nullptr;  ///< of an output
};

template <class T>
constexpr FileKind read_as(const char* name, const char* title) {
  return {name, title, json::schema_tree<T>};
}
template <class T>
constexpr FileKind written_as(const char* name, const char* title) {
  return {name, title, [](std::string_view words) { return json::record_schema(describe(json::Type<T>{}), words); },
          [] { return &describe(json::Type<T>{}); }};
}

/// Names of the kinds that only the program takt-schema knows, in the order of its table.
inline constexpr const char* companion_kinds[] = {
    "study",           "node",    "applications", "key-service", "schedule",   "schedule-scenario",
    "schedule-change", "compare", "status",       "describe",    "statistics", "emulate"};

/// `takt schema` for these kinds. A kind of companion_kinds that is not among them is left to the program takt-schema.
void add_schema_command(Command app, ExitStatus& status, std::span<const FileKind> kinds);

}  // namespace takt::cli
