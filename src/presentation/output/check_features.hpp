// SPDX-License-Identifier: Apache-2.0
// The part of `takt check` that shows what is configured beyond strict priority and what goes wrong.
#pragma once

#include <cstddef>
#include <string>

#include "scenario/resolved/resolved.hpp"

namespace takt::output {

/// Ports, ingress of switches, redundant streams, faults: a line each, at most so many of a kind; nothing where there
/// is nothing.
std::string feature_pages(const scenario::Resolved& resolved, std::size_t most_rows);

}  // namespace takt::output
