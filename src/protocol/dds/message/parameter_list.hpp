// SPDX-License-Identifier: Apache-2.0
// Lists of parameters (DDSI-RTPS 9.4.2.11): inline QoS and the data of discovery. Each is an id, a length and a value
// that fills up to a multiple of 4.
#pragma once

#include <optional>

#include "dds/message/octets.hpp"

namespace takt::dds {

/// Ids of 9.6.2.2.2 and of the inline QoS (9.6.3).
enum class ParameterId : std::uint16_t {
  pad = 0x0000,
  sentinel = 0x0001,
  participant_lease_duration = 0x0002,
  time_based_filter = 0x0004,
  topic_name = 0x0005,
  ownership_strength = 0x0006,
  type_name = 0x0007,
  metatraffic_multicast_ip_address = 0x000B,
  default_unicast_ip_address = 0x000C,
  metatraffic_unicast_port = 0x000D,
  default_unicast_port = 0x000E,
  domain_id = 0x000F,
  multicast_ip_address = 0x0011,
  protocol_version = 0x0015,
  vendor_id = 0x0016,
  reliability = 0x001A,
  liveliness = 0x001B,
  durability = 0x001D,
  durability_service = 0x001E,
  ownership = 0x001F,
  presentation = 0x0021,
  deadline = 0x0023,
  destination_order = 0x0025,
  latency_budget = 0x0027,
  partition = 0x0029,
  lifespan = 0x002B,
  user_data = 0x002C,
  group_data = 0x002D,
  topic_data = 0x002E,
  unicast_locator = 0x002F,
  multicast_locator = 0x0030,
  default_unicast_locator = 0x0031,
  metatraffic_unicast_locator = 0x0032,
  metatraffic_multicast_locator = 0x0033,
  participant_manual_liveliness_count = 0x0034,
  content_filter_property = 0x0035,
  history = 0x0040,
  resource_limits = 0x0041,
  expects_inline_qos = 0x0043,
  metatraffic_unicast_ip_address = 0x0045,
  default_multicast_locator = 0x0048,
  transport_priority = 0x0049,
  participant_guid = 0x0050,
  group_guid = 0x0052,
  builtin_endpoint_set = 0x0058,
  property_list = 0x0059,
  endpoint_guid = 0x005A,
  type_max_size_serialized = 0x0060,
  original_writer_info = 0x0061,
  entity_name = 0x0062,
  key_hash = 0x0070,
  status_info = 0x0071,
  data_representation = 0x0073,
  type_information = 0x0075,
  persistence_guid = 0x8002,  ///< vendors' by its bit, but several use it alike
};

/// "Whoever does not know this parameter must not take what it stands with" (9.6.2.2.1); bit 15 marks vendors'
/// parameters.
inline constexpr std::uint16_t must_understand = 0x4000;
inline constexpr std::uint16_t vendor_specific = 0x8000;

struct Parameter {
  std::uint16_t id = 0;  ///< as on the wire, with its flags
  Octets value;
  ByteOrder order = ByteOrder::little;
  bool is(ParameterId wanted) const { return known() == wanted; }
  /// The id without "must understand".
  ParameterId known() const { return static_cast<ParameterId>(id & ~must_understand); }
  bool must_be_understood() const { return (id & must_understand) != 0 && (id & vendor_specific) == 0; }
  Reader reader() const { return {value, order}; }
};

/// Reads a list up to its sentinel.
class ParameterReader {
 public:
  explicit ParameterReader(Reader& reader) : reader_(&reader) {}

  /// Nothing at the sentinel, or when the octets end before (then the reader failed). A pad parameter is passed over.
  std::optional<Parameter> next() {
    while (!reader_->failed()) {
      const auto id = reader_->get<std::uint16_t>();
      const auto length = reader_->get<std::uint16_t>();
      if (reader_->failed() || id == static_cast<std::uint16_t>(ParameterId::sentinel)) return std::nullopt;
      if (length % 4 != 0) reader_->fail();
      const Octets value = reader_->take(length);
      if (reader_->failed()) return std::nullopt;
      if (id != static_cast<std::uint16_t>(ParameterId::pad)) return Parameter{id, value, reader_->order()};
    }
    return std::nullopt;
  }

 private:
  Reader* reader_;
};

/// Writes a list. Use: parameter(id, [](Writer&) { value }) for each; finish.
class ParameterWriter {
 public:
  explicit ParameterWriter(Writer& writer) : writer_(&writer) {}

  template <class PutValue>
  void parameter(ParameterId id, PutValue put_value) {
    writer_->put(static_cast<std::uint16_t>(id));
    const std::size_t length_at = writer_->position();
    writer_->put(std::uint16_t{0});
    const std::size_t begin = writer_->position();
    put_value(*writer_);
    writer_->align(4, begin);
    const std::size_t length = writer_->position() - begin;
    // 65532 is the greatest multiple of 4 that the length can say.
    if (length > 65'532) is_too_long_ = true;
    if (!writer_->overflowed()) writer_->patch(length_at, static_cast<std::uint16_t>(length));
  }
  /// The sentinel. False if a value was too long for its length.
  bool finish() {
    writer_->put(static_cast<std::uint16_t>(ParameterId::sentinel));
    writer_->put(std::uint16_t{0});
    return !is_too_long_;
  }

 private:
  Writer* writer_;
  bool is_too_long_ = false;
};

}  // namespace takt::dds
