// SPDX-License-Identifier: Apache-2.0
// Sample: what a reader gives its application, with SampleInfo (DDS 1.4, 2.2.2.5.5).
#pragma once

#include <vector>

#include "dds/history/instance_key.hpp"
#include "dds/message/guid.hpp"
#include "dds/message/sequence_number.hpp"
#include "sim/time.hpp"

namespace takt::dds {

enum class InstanceState : std::uint8_t { alive, not_alive_disposed, not_alive_no_writers };

/// The ranks of the standard are left out: samples are taken one by one.
struct SampleInfo {
  Guid writer;
  SequenceNumber number;
  InstanceKey key{};
  sim::LocalTime source_timestamp;
  sim::LocalTime reception_timestamp;
  bool valid_data = true;       ///< false: tells a change of the instance's state only
  bool is_read = false;         ///< SampleState: READ
  bool is_new_instance = true;  ///< ViewState: NEW
  InstanceState instance_state = InstanceState::alive;
  std::uint32_t disposed_generation_count = 0;    ///< how often the instance had come back after being disposed
  std::uint32_t no_writers_generation_count = 0;  ///< the same after having had no writers
  Guid identity{};  ///< under which the writer's numbers count: its persistence GUID if it has one
};

struct Sample {
  SampleInfo info;
  std::vector<std::byte> payload;  ///< serialized payload with its encapsulation header
};

}  // namespace takt::dds
