// SPDX-License-Identifier: Apache-2.0
// A file that was given to the wrong command is recognised by what it holds.
#pragma once

#include <cstdint>
#include <string>

#include "json/diagnostics.hpp"

namespace takt::cli {

enum class InputKind : std::uint8_t { unknown, scenario, study, node, server_network, result };

/// By the names at the root of the file; unknown if it cannot be read.
InputKind input_kind_of(const std::string& path);

/// Whether the file is of a kind that another command takes. Then `diagnostics` says which, instead of all that is
/// wrong with it as one of the wanted kind.
bool belongs_elsewhere(const std::string& path, InputKind wanted, json::Diagnostics& diagnostics);

}  // namespace takt::cli
