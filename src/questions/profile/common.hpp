// SPDX-License-Identifier: Apache-2.0
// What rules of several profiles look at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "profile/profile.hpp"

namespace takt::profile {

/// "a, b and 3 more".
std::string some_of(const std::vector<std::string>& names);

/// Whether an interval of gPTP messages is 2^log s, at all nodes.
void judge_interval(const scenario::Resolved& resolved, Found& found, int asked, std::int8_t scenario::Gptp::*interval,
                    const char* key);

/// The links of the longest of the shortest ways between two nodes with gPTP; nothing of a network that is too large to
/// look at each pair.
std::optional<std::uint32_t> longest_way(const scenario::Resolved& resolved);

/// All clocks that a scenario describes.
std::vector<const scenario::Clock*> clocks_of(const scenario::Resolved& resolved);

/// "1s", "125ms": 2^log s.
std::string interval_text(int log);

}  // namespace takt::profile
