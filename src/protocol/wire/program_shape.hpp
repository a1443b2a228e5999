// SPDX-License-Identifier: Apache-2.0
// What all participants of a Program must know of it alike, or they do not understand each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "handshake/participant.hpp"
#include "uadp/builtin_type.hpp"

namespace takt::wire {

struct FieldShape {
  std::string name;
  uadp::BuiltInType type = uadp::BuiltInType::Double;  ///< of fixed length
  std::uint16_t count = 1;                             ///< that many fields of the type
};

/// A data set of process data.
struct DataSetShape {
  std::string name;
  std::uint8_t from = 0;  ///< participant that publishes it
  std::vector<FieldShape> fields;
};

struct ProgramShape {
  std::string name;
  handshake::Variant variant = handshake::Variant::robust;
  std::vector<std::string> participants;  ///< names, the master first; 2 to 65
  std::vector<DataSetShape> data_sets;
  std::uint16_t first_publisher_id = 1;  ///< of the master; participant i has i more
};

/// GroupVersion of all its messages: the same for equal shapes on every machine, never 0. PublisherIds have no part in
/// it.
std::uint32_t group_version_of(const ProgramShape& shape);

/// Octets of all user fields of a data set.
std::uint32_t octets_of(const DataSetShape& data_set);

}  // namespace takt::wire
