// SPDX-License-Identifier: Apache-2.0
// What an export format gets and gives: files, and a list of what the format cannot say.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interchange/interfaces.hpp"
#include "interchange/settings.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::interchange {

struct OutputFile {
  std::string name;  ///< within the folder
  std::string content;
  bool is_executable = false;
};

/// Something that the scenario says and the format cannot: a run by what is written would differ.
struct Loss {
  std::string where;  ///< "sw1 to sw2", "stream camera"
  std::string what;   ///< what is lost, and why
  bool operator==(const Loss&) const = default;
};

struct ExportRequest {
  const scenario::Resolved& resolved;
  std::optional<std::uint32_t> node = {};  ///< only for this node
  Settings settings = {};
  InterfaceNames interfaces = {};  ///< as the table beside the scenario has them
  bool concerns(std::uint32_t which) const { return !node || *node == which; }
};

struct Exported {
  std::vector<OutputFile> files;
  std::vector<Loss> losses;
  std::string mistake = {};  ///< a setting that makes no sense here; nothing else counts then

  /// Each loss once.
  void lose(std::string where, std::string what);
};

/// The losses, one a line, each behind `mark` ("# ", "// ").
std::string losses_as_comments(const std::vector<Loss>& losses, std::string_view mark);

}  // namespace takt::interchange
