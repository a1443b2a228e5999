// SPDX-License-Identifier: Apache-2.0
// Event: what a participant tells its user.
#pragma once

#include "dds/history/instance_key.hpp"
#include "dds/history/status.hpp"
#include "dds/message/guid.hpp"
#include "dds/qos/matching.hpp"
#include "sim/time.hpp"

namespace takt::dds {

enum class EventKind : std::uint8_t {
  participant_discovered,
  participant_lost,
  matched,  ///< PUBLICATION_MATCHED, SUBSCRIPTION_MATCHED
  unmatched,
  incompatible_qos,  ///< OFFERED_, REQUESTED_INCOMPATIBLE_QOS; `policy` is the first that does not fit, `reason` tells
                     ///< all
  inconsistent_topic,  ///< one topic, two types
  data_available,
  sample_rejected,
  sample_lost,
  deadline_missed,  ///< OFFERED_ at a writer, REQUESTED_ at a reader
  liveliness_changed,
  liveliness_lost,
  writable,         ///< a write that would have blocked can go on now
  write_timed_out,  ///< max_blocking_time has passed
};
std::string_view name_of(EventKind kind);

struct Event {
  EventKind kind = EventKind::matched;
  sim::LocalTime at;
  std::uint32_t entity = 0;  ///< number of the writer's or reader's handle; 0: the participant
  Guid remote{};             ///< whom it is about
  InstanceKey instance{};
  std::uint64_t count = 0;  ///< the status's total
  PolicyId policy = PolicyId::reliability;
  std::string reason;
};

}  // namespace takt::dds
