// SPDX-License-Identifier: Apache-2.0
// HistorySettings: HISTORY and RESOURCE_LIMITS as a history needs them (DDS 1.4, 2.2.3.18 and 2.2.3.19).
#pragma once

#include <cstdint>
#include <limits>

#include "dds/qos/policies.hpp"

namespace takt::dds {

struct HistorySettings {
  static constexpr std::uint32_t no_limit = std::numeric_limits<std::uint32_t>::max();

  bool keep_all = false;
  std::uint32_t depth = 1;  ///< of KEEP_LAST, per instance, at least 1
  std::uint32_t max_samples = no_limit;
  std::uint32_t max_instances = no_limit;
  std::uint32_t max_samples_per_instance = no_limit;

  /// Samples that one instance may have.
  constexpr std::uint32_t per_instance() const {
    return keep_all || depth > max_samples_per_instance ? max_samples_per_instance : depth;
  }

  /// Precondition: the policies do not contradict themselves (problems_of).
  static constexpr HistorySettings from(const History& history, const ResourceLimits& limits) {
    const auto number = [](std::int32_t limit) {
      return limit == unlimited ? no_limit : static_cast<std::uint32_t>(limit);
    };
    return {history.kind == HistoryKind::keep_all, static_cast<std::uint32_t>(history.depth),
            number(limits.max_samples), number(limits.max_instances), number(limits.max_samples_per_instance)};
  }
};

}  // namespace takt::dds
