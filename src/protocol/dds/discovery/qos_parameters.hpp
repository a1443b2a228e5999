// SPDX-License-Identifier: Apache-2.0
// QoS policies as parameters (DDSI-RTPS 9.6.2.2.2, table 9.14).
#pragma once

#include <string>
#include <string_view>

#include "dds/message/parameter_list.hpp"
#include "dds/qos/policies.hpp"

namespace takt::dds {

/// Policies that are not the default.
void put_qos(ParameterWriter& list, const DataWriterQos& qos);
void put_qos(ParameterWriter& list, const DataReaderQos& qos);

enum class Taken : std::uint8_t {
  no,  ///< no policy, or none that such an entity has
  yes,
  malformed,  ///< a value that the standard does not know
};
Taken decode_qos(const Parameter& parameter, DataWriterQos& qos);
Taken decode_qos(const Parameter& parameter, DataReaderQos& qos);

/// A string with its length, which counts the octet 0 at its end.
void put_string(Writer& writer, std::string_view text);
/// Fails if there is no such string.
std::string get_string(Reader& reader);
void put_opaque(Writer& writer, const OpaqueData& data);
void get_opaque(Reader& reader, OpaqueData& data);

}  // namespace takt::dds
