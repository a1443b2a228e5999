// SPDX-License-Identifier: Apache-2.0
// The communication statuses of DDS (DDS 1.4, 2.2.4.1), with their counts since the entity was made.
#pragma once

#include <cstdint>

#include "dds/history/instance_key.hpp"

namespace takt::dds {

enum class RejectedBy : std::uint8_t { not_rejected, samples_limit, instances_limit, samples_per_instance_limit };

struct SampleRejectedStatus {
  std::uint64_t total_count = 0;
  RejectedBy last_reason = RejectedBy::not_rejected;
  InstanceKey last_instance{};
};
/// Samples that will never come: a best-effort one that was missing, or a reliable one that the writer no longer had.
struct SampleLostStatus {
  std::uint64_t total_count = 0;
};
/// OFFERED_ at a writer, REQUESTED_ at a reader.
struct DeadlineMissedStatus {
  std::uint64_t total_count = 0;
  InstanceKey last_instance{};
};
/// Of a writer: how often it was not alive for its readers any more.
struct LivelinessLostStatus {
  std::uint64_t total_count = 0;
};
/// Of a reader: its matched writers.
struct LivelinessChangedStatus {
  std::uint32_t alive_count = 0;
  std::uint32_t not_alive_count = 0;
  std::uint64_t changes = 0;
};
/// PUBLICATION_MATCHED and SUBSCRIPTION_MATCHED.
struct MatchedStatus {
  std::uint32_t current_count = 0;
  std::uint64_t total_count = 0;
};
/// OFFERED_ and REQUESTED_INCOMPATIBLE_QOS: pairs that did not match.
struct IncompatibleQosStatus {
  std::uint64_t total_count = 0;
};

}  // namespace takt::dds
