// A file that was given to the wrong command is recognised by what it holds.
#pragma once

#include <string>

#include "json/diagnostics.hpp"

namespace takt::cli {

enum class FileKind : std::uint8_t { unknown, scenario, study, node, server_network, result };

/// By the names at the root of the file; unknown if it cannot be read.
FileKind kind_of_file(const std::string& path);

/// Whether the file is of a kind that another command takes. Then `diagnostics` says which, instead of all that is wrong with it as one of the wanted kind.
bool belongs_elsewhere(const std::string& path, FileKind wanted, json::Diagnostics& diagnostics);

}  // namespace takt::cli
