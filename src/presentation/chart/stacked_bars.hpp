// SPDX-License-Identifier: Apache-2.0
// A whole in its parts, as a bar of HTML: it takes the width that the page has, from a phone's on, and its text stays
// as large as that of the page.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace takt::chart {

/// How parts look: a colour, of some with stripes, on white and on black.
inline constexpr std::size_t stacked_looks = 9;

struct StackedPart {
  double size = 0;
  std::size_t look = 0;  ///< below stacked_looks
  std::string title;     ///< shown when the mouse rests on it
};

/// Parts that belong together, and what stands below them.
struct StackedGroup {
  std::string name;
  std::vector<StackedPart> parts;
};

struct StackedBar {
  std::string label;  ///< what a screen reader reads
  std::vector<StackedGroup> groups;
};

/// Groups without size are left out; nothing if none is left.
std::string stacked_bar_element(const StackedBar& bar);

struct StackedKey {
  std::size_t look = 0;
  std::string name;
};
std::string stacked_legend(const std::vector<StackedKey>& keys);

}  // namespace takt::chart
