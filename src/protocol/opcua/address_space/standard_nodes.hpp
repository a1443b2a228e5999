// SPDX-License-Identifier: Apache-2.0
// Namespace 0 as far as clients need it: constant tables, made by generate.py of nodeset.json when takt is built.
// nodeset.json is a subset of the core nodeset 1.05.03 that the OPC Foundation publishes (MIT licence), closed under
// its references.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "opcua/services/view.hpp"

namespace takt::opcua {

struct StandardNode {
  std::uint32_t id;
  NodeClass node_class;
  std::string_view name;
  std::string_view inverse_name;
  bool is_abstract;
  bool is_symmetric;
  std::uint8_t event_notifier;
  std::uint32_t data_type;
  std::int32_t value_rank;
  std::int64_t number;  ///< UInt32 value that never changes; -1: none
};

/// Forward ones.
struct StandardReference {
  std::uint32_t from;
  std::uint32_t type;
  std::uint32_t to;
};

/// A field of a structure, or a value of an enumeration.
struct StandardField {
  std::uint32_t of;
  std::string_view name;
  std::uint32_t data_type;
  std::int32_t value_rank;
  std::int64_t value;  ///< of an enumeration; else -1
};

/// An element of a variable's LocalizedText[], in order.
struct StandardText {
  std::uint32_t of;
  std::string_view text;
};

/// By id.
std::span<const StandardNode> standard_nodes();
std::span<const StandardReference> standard_references();
std::span<const StandardField> standard_fields();
std::span<const StandardText> standard_texts();

/// NodeIds in namespace 0 that takt's code speaks of.
namespace ids {
inline constexpr std::uint32_t boolean = 1, uint16 = 5, int32 = 6, uint32 = 7, double_ = 11, string = 12,
                               date_time = 13, byte_string = 15, node_id = 17, status_code = 19, localized_text = 21,
                               base_data_type = 24, integer_id = 288, duration = 290, utc_time = 294, argument = 296,
                               program_diagnostic_2 = 24033;
inline constexpr std::uint32_t references = 31, hierarchical_references = 33, organizes = 35, has_type_definition = 40,
                               has_subtype = 45, has_property = 46, has_component = 47, has_notifier = 48;
inline constexpr std::uint32_t base_object_type = 58, folder_type = 61, base_data_variable_type = 63,
                               property_type = 68;
inline constexpr std::uint32_t objects_folder = 85, server = 2253, base_event_type = 2041,
                               program_state_machine_type = 2391, program_diagnostic_2_type = 15383,
                               finite_state_variable_type = 2760, finite_transition_variable_type = 2767,
                               program_transition_event_type = 2378, audit_program_transition_event_type = 11856,
                               audit_event_type = 2052, event_queue_overflow_event_type = 3035;
inline constexpr std::uint32_t publish_subscribe = 14443, get_security_keys = 15215, get_security_keys_of_type = 15907;
inline constexpr std::uint32_t structure_definition_encoding = 122, enum_definition_encoding = 123;
}  // namespace ids

}  // namespace takt::opcua
