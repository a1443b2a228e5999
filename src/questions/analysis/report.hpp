// SPDX-License-Identifier: Apache-2.0
// What `takt bound` prints.
#pragma once

#include <string>

#include "analysis/bounds.hpp"

namespace takt::analysis {

std::string text_report(const scenario::Resolved& resolved, const Bounds& bounds);
/// Keys and meaning: docs/reference/bound.md.
std::string json_report(const scenario::Resolved& resolved, const Bounds& bounds);

}  // namespace takt::analysis
