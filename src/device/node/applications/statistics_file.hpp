// SPDX-License-Identifier: Apache-2.0
// The file that the statistics of a node go to.
#pragma once

#include <string>

#include "node/applications/config.hpp"

namespace takt::node {

/// Why the file could not be written later; "" if it can. Nothing is left behind.
std::string statistics_problem(const std::string& path);
/// Reports it at the key `statistics`, if there is one. True if all is well.
bool check_statistics(const ApplicationsConfig& config, json::Diagnostics& diagnostics);
/// Writes the file whole or not at all; the problem, or "". What is no plain file (a pipe, a device) is written to as
/// it is.
std::string write_statistics(const std::string& path, const std::string& text);

}  // namespace takt::node
