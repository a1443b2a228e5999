// SPDX-License-Identifier: Apache-2.0
// How many random cases a test draws, by the tier of the tests. See docs/testing.md.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace takt::support {

/// The quick tier leaves long searches to the full one.
inline bool is_quick_tier() {
  const char* const tier = std::getenv("TAKT_TIER");
  return tier != nullptr && std::string_view(tier) == "quick";
}

/// The value of the environment variable `variable` if it is set, for a search by hand. Otherwise `full` cases; a fifth
/// of them where TAKT_TIER is "quick" and five times as many where it is "night". At least one.
inline std::uint64_t case_count(const char* variable, std::uint64_t full) {
  if (const char* const wanted = std::getenv(variable)) return std::strtoull(wanted, nullptr, 10);
  const char* const tier = std::getenv("TAKT_TIER");
  const std::string_view name = tier != nullptr ? tier : "full";
  if (is_quick_tier()) return std::max<std::uint64_t>(1, full / 5);
  if (name == "night") return full * 5;
  return full;
}

}  // namespace takt::support
