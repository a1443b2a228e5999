// SPDX-License-Identifier: Apache-2.0
// The traffic classes of a device in those of takt, which has eight with one queue each and two maps from priorities.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "models/egress/class_set.hpp"
#include "scenario/description/description.hpp"

namespace takt::interchange {

struct ClassMap {
  enum class Fit : std::uint8_t {
    exact,         ///< eight classes, in one of takt's two orders
    split,         ///< fewer classes, in the order of priorities: each becomes several, served in strict priority
    not_in_order,  ///< a higher priority in a lower class: takt serves in another order
  };
  Fit fit = Fit::exact;
  scenario::TrafficClasses classes = scenario::TrafficClasses::standard;
  std::array<models::ClassSet, 16>
      of_device{};  ///< by class of the device: the classes of takt whose priority lies in it

  /// The classes of takt that lie in a set of classes of the device.
  models::ClassSet takt_classes(std::uint64_t device_classes) const {
    models::ClassSet set = 0;
    for (std::size_t d = 0; d < of_device.size(); ++d)
      if ((device_classes >> d & 1) != 0) set = static_cast<models::ClassSet>(set | of_device[d]);
    return set;
  }
};

/// `class_of_priority` has the class, below 16, of each of the eight priorities.
ClassMap class_map_of(std::span<const std::uint8_t, 8> class_of_priority);

/// A set as takt's files list it.
std::vector<std::uint8_t> list_of(models::ClassSet set);

}  // namespace takt::interchange
