// SPDX-License-Identifier: Apache-2.0
// What a port is configured to do; shared by the ports that are configured alike.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "models/egress/shaping_config.hpp"
#include "models/ethernet/frame.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// IEEE 802.1Q Table 8-5 for eight traffic classes: priority 1 (background) lies below priority 0 (best effort).
inline constexpr std::array<TrafficClass, 8> standard_traffic_classes = {1, 0, 2, 3, 4, 5, 6, 7};
/// Priority n in class n, as many TSN profiles configure it.
inline constexpr std::array<TrafficClass, 8> identity_traffic_classes = {0, 1, 2, 3, 4, 5, 6, 7};

/// The most that one queue holds; frames that wait, not the one that is being sent.
struct QueueLimit {
  std::uint32_t frames = 0xFFFF'FFFF;
  std::uint32_t octets = 0xFFFF'FFFF;  ///< lengths from DA to FCS
  bool drops_oldest =
      false;  ///< a frame that finds no room takes the place of those at the head, not the other way round
  constexpr bool is_finite() const { return frames != 0xFFFF'FFFF || octets != 0xFFFF'FFFF; }
  bool operator==(const QueueLimit&) const = default;
};

struct PortConfig {
  std::array<TrafficClass, 8> traffic_class_of_priority = standard_traffic_classes;
  std::array<QueueLimit, traffic_class_count> queue_limits{};
  ShapingConfig shaping;
  std::optional<PreemptionConfig> preemption;
  /// Classes whose frames may begin to leave through this port before they have come wholly.
  ClassSet cut_through = 0;
  /// Frames leave without a VLAN tag. For ports towards hosts.
  bool untagged = false;
  bool operator==(const PortConfig&) const = default;
};

}  // namespace takt::models
