// SPDX-License-Identifier: Apache-2.0
// The messages of a Program as who configures another subscriber or publisher must know them: ids, versions, and which
// field stands where.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "wire/program_format.hpp"
#include "wire/role_format.hpp"

namespace takt::wire {

struct FieldOnWire {
  std::string name;
  std::string_view type;     ///< as OPC UA calls it
  std::uint32_t count = 1;   ///< so many of them, one behind the other
  std::uint32_t offset = 0;  ///< in the NetworkMessage, in octets
};

struct MessageOnWire {
  std::string name;       ///< "state", "announcement", "bindings" or that of the data set
  std::string publisher;  ///< participant or candidate
  std::uint16_t publisher_id = 0;
  std::uint16_t writer_group_id = 0;
  std::uint32_t octets = 0;  ///< of the NetworkMessage
  std::vector<FieldOnWire> fields;
};

/// States of all participants, then the data sets.
std::vector<MessageOnWire> messages_of(const ProgramFormat& format);
/// The table of bindings, then the announcements of all candidates. Those of the Program's participants are not among
/// them.
std::vector<MessageOnWire> messages_of(const RoleFormat& format);

}  // namespace takt::wire
