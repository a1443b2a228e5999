// SPDX-License-Identifier: Apache-2.0
// The formats of `takt export` and `takt import`: one line of a table for each, from which the commands, their help and
// the tables of docs/interchange.md follow. How to add one: README.md.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interchange/export.hpp"
#include "interchange/import.hpp"

namespace takt::interchange {

struct ExportFormat {
  std::string_view name;
  std::string_view help;     ///< what is written, in a phrase
  std::string_view carries;  ///< what of a scenario it can say
  std::string_view outside;  ///< what of a scenario is not its business, and is not told as lost
  std::span<const SettingInfo> settings;
  Exported (*write)(const ExportRequest& request);
};

struct ImportFormat {
  std::string_view name;
  std::string_view help;   ///< what is read, in a phrase
  std::string_view files;  ///< what the files are
  std::span<const SettingInfo> settings;
  bool into_base = false;  ///< reads what devices are set to, and puts it into a scenario given with --into
  bool is_binary = false;
  Imported (*read)(const ImportRequest& request, json::Diagnostics& diagnostics);
};

std::span<const ExportFormat> export_formats();
std::span<const ImportFormat> import_formats();

const ExportFormat* find_export_format(std::string_view name);
const ImportFormat* find_import_format(std::string_view name);

/// Both tables as Markdown, for docs/interchange.md.
std::string formats_reference();

}  // namespace takt::interchange
