// SPDX-License-Identifier: Apache-2.0
// What JSON files say of how a topic of OPC UA is laid out in messages (OPC 10000-14, 6.2 and 6.3.1), so that
// publishers and subscribers of any make can be met.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"

namespace takt::plant {

enum class TopicType : std::uint8_t {
  boolean,
  sbyte,
  byte,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  date_time,
  guid,
  byte_string
};

/// A field of a topic.
struct TopicField {
  TopicType type = TopicType::float64;
  std::uint16_t count = 1;
  std::optional<std::uint16_t> max_length = {};  ///< octets, of String and ByteString
  json::Source where = {};
  bool operator==(const TopicField&) const = default;
};

/// A PublisherId that is no UInt16. Exactly one is there.
struct UadpPublisher {
  json::Source where;
  std::optional<std::uint8_t> byte;
  std::optional<std::uint32_t> uint32;
  std::optional<std::uint64_t> uint64;
  std::optional<std::string> string;
  bool operator==(const UadpPublisher&) const = default;
};

enum class UadpEncoding : std::uint8_t { variant, raw_data, data_value };
/// Parts of messages; the value is the number of the bit in the content mask.
enum class NetworkMessagePart : std::uint8_t {
  publisher_id,
  group_header,
  writer_group_id,
  group_version,
  network_message_number,
  sequence_number,
  payload_header,
  timestamp,
  pico_seconds
};
enum class DataSetMessagePart : std::uint8_t {
  timestamp,
  pico_seconds,
  status,
  major_version,
  minor_version,
  sequence_number
};
enum class DataValuePart : std::uint8_t {
  status_code,
  source_timestamp,
  server_timestamp,
  source_pico_seconds,
  server_pico_seconds
};

struct UadpLayout {
  json::Source where;
  std::optional<UadpPublisher> publisher;
  std::uint16_t writer_group_id = 1;  ///< of the first publication; those of others follow
  std::uint16_t data_set_writer_id = 1;
  std::vector<NetworkMessagePart> network_message = {NetworkMessagePart::publisher_id, NetworkMessagePart::group_header,
                                                     NetworkMessagePart::writer_group_id,
                                                     NetworkMessagePart::payload_header};
  std::vector<DataSetMessagePart> data_set_message = {DataSetMessagePart::sequence_number};
  UadpEncoding encoding = UadpEncoding::variant;
  std::optional<std::vector<DataValuePart>> data_value;  ///< of that encoding; the status if absent
  std::uint32_t key_frame_count = 1;
  std::uint32_t group_version = 0;
  std::uint32_t major_version = 0;
  std::uint32_t minor_version = 0;
  std::optional<std::uint16_t> configured_size;  ///< octets of each DataSetMessage
  bool operator==(const UadpLayout&) const = default;
};

const json::Enumeration& describe(json::Type<TopicType>);
const json::Object& describe(json::Type<TopicField>);
const json::Object& describe(json::Type<UadpPublisher>);
const json::Enumeration& describe(json::Type<UadpEncoding>);
const json::Enumeration& describe(json::Type<NetworkMessagePart>);
const json::Enumeration& describe(json::Type<DataSetMessagePart>);
const json::Enumeration& describe(json::Type<DataValuePart>);
const json::Object& describe(json::Type<UadpLayout>);

}  // namespace takt::plant
