// SPDX-License-Identifier: Apache-2.0
// "Did you mean ...?": the nearest of a few known names.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace takt::json {

/// Insertions, deletions, replacements and swaps of neighbours that turn a into b (optimal string alignment), or
/// limit + 1 if more than limit are needed. Octets, not characters.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit);

/// The candidate that is nearest to the name, or "" if none is near: a different case is always near; otherwise one
/// edit is allowed for a name of up to 3 octets, two up to 7, three beyond. Of equally near ones the first. If none is
/// near, the first that begins with the name, if that has at least 3 octets. Names longer than 64 octets get none, and
/// the distance of at most 2000 candidates is worked out, so the work is bounded.
std::string suggest(std::string_view name, std::span<const std::string_view> candidates);

}  // namespace takt::json
