// SPDX-License-Identifier: Apache-2.0
// The number of behaviour: two builds of takt with the same number give the same digests and figures of the same
// scenario and seed; builds with different numbers may not. It is raised by a line in behaviours.inc whenever a pinned
// digest changes, or what a figure means (tests/golden/renew.py).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace takt::results {

/// Of this build. The least is 1.
std::uint32_t behaviour();

/// Who made a file: what files say of the takt that wrote them.
struct Maker {
  std::string version;          ///< "0.2.0"
  std::uint32_t behaviour = 0;  ///< 0: the file names none
};
/// This build.
Maker this_takt();

/// "takt 0.2.0 with behaviour 3"; "takt 0.1.0 without a number of behaviour".
std::string name_of(const Maker& maker);

/// Empty if this build behaves as the maker of a file does. Else what differs, with both numbers: "x.sqlite was made by
/// takt 0.2.0 with behaviour 1, this is takt 0.1.0 with behaviour 3. Since then: ...".
std::string difference_to(const Maker& maker, std::string_view file);

}  // namespace takt::results
