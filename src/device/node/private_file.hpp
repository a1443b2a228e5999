// SPDX-License-Identifier: Apache-2.0
// Files that only their owner may read: keys, passwords.
#pragma once

#include <optional>
#include <string>

#include "json/diagnostics.hpp"

namespace takt::node {

/// As it is named in the file at `named_at`: below the folder of that file unless it begins with a slash.
std::string beside(const json::Place& named_at, const std::string& path);
/// What it holds. Nothing, and `what` in it is refused at `named_at`, also if others than the owner may read or write
/// it, or it belongs to somebody else (root may own it).
std::optional<std::string> read_private(const std::string& path, const std::string& what, const json::Place& named_at,
                                        json::Diagnostics& diagnostics);

/// Clears what was read.
void wipe(std::string& text);

}  // namespace takt::node
