// SPDX-License-Identifier: Apache-2.0
#include "dds/participant/event.hpp"

#include <array>

namespace takt::dds {

std::string_view name_of(EventKind kind) {
  static constexpr std::array<std::string_view, 14> names{
      "participant_discovered", "participant_lost", "matched",         "unmatched",      "incompatible_qos",
      "inconsistent_topic",     "data_available",   "sample_rejected", "sample_lost",    "deadline_missed",
      "liveliness_changed",     "liveliness_lost",  "writable",        "write_timed_out"};
  static_assert(static_cast<std::size_t>(EventKind::write_timed_out) + 1 == names.size());
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace takt::dds
