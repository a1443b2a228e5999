// SPDX-License-Identifier: Apache-2.0
#include "interchange/class_map.hpp"

#include <algorithm>

#include "models/egress/port_config.hpp"

namespace takt::interchange {

ClassMap class_map_of(std::span<const std::uint8_t, 8> class_of_priority) {
  const auto is_in_order = [&](const std::array<models::TrafficClass, 8>& order) {
    std::array<std::uint8_t, 8> by_class{};
    for (std::size_t p = 0; p < 8; ++p) by_class[order[p]] = class_of_priority[p];
    return std::ranges::is_sorted(by_class);
  };
  ClassMap map;
  const bool standard = is_in_order(models::standard_traffic_classes);
  const bool identity = is_in_order(models::identity_traffic_classes);
  map.classes = !standard && identity ? scenario::TrafficClasses::identity : scenario::TrafficClasses::standard;
  const auto& takt = map.classes == scenario::TrafficClasses::identity ? models::identity_traffic_classes
                                                                       : models::standard_traffic_classes;
  for (std::size_t p = 0; p < 8; ++p)
    map.of_device[class_of_priority[p] & 15] = models::with(map.of_device[class_of_priority[p] & 15], takt[p]);
  const bool has_eight = std::ranges::all_of(std::span(map.of_device).first(8),
                                             [](models::ClassSet set) { return models::is_one_class(set); });
  map.fit = !standard && !identity ? ClassMap::Fit::not_in_order
            : has_eight            ? ClassMap::Fit::exact
                                   : ClassMap::Fit::split;
  return map;
}

std::vector<std::uint8_t> list_of(models::ClassSet set) {
  std::vector<std::uint8_t> list;
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    if (models::contains(set, q)) list.push_back(q);
  return list;
}

}  // namespace takt::interchange
