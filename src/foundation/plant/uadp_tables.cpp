// SPDX-License-Identifier: Apache-2.0
// The words of topics' fields and of how UADP lays them out. See json/fields.hpp.
#include "plant/uadp.hpp"

namespace takt::plant {
namespace {

using json::name;
using json::optional;
using json::required;

constexpr std::uint16_t longest_string = 1400;

}  // namespace

const json::Enumeration& describe(json::Type<TopicType>) {
  static constexpr json::EnumName names[] = {
      name(TopicType::boolean, "Boolean", "1 octet"),
      name(TopicType::sbyte, "SByte", "1 octet"),
      name(TopicType::byte, "Byte", "1 octet"),
      name(TopicType::int16, "Int16", "2 octets"),
      name(TopicType::uint16, "UInt16", "2 octets"),
      name(TopicType::int32, "Int32", "4 octets"),
      name(TopicType::uint32, "UInt32", "4 octets"),
      name(TopicType::int64, "Int64", "8 octets"),
      name(TopicType::uint64, "UInt64", "8 octets"),
      name(TopicType::float32, "Float", "4 octets"),
      name(TopicType::float64, "Double", "8 octets"),
      name(TopicType::string, "String", "UTF-8 text of at most max_length octets, behind its length of 4 octets"),
      name(TopicType::date_time, "DateTime", "8 octets: 100 ns since 1601-01-01 UTC"),
      name(TopicType::guid, "Guid", "16 octets"),
      name(TopicType::byte_string, "ByteString", "at most max_length octets, behind their length of 4 octets"),
  };
  static constexpr json::Enumeration table = json::enumeration<TopicType>("a type of a topic's field", names);
  return table;
}

const json::Object& describe(json::Type<TopicField>) {
  static constexpr json::Field fields[] = {
      required<&TopicField::type>("type",
                                  "OPC UA built-in type; String, DateTime, Guid and ByteString are of OPC UA only."),
      optional<&TopicField::count>("count", "Number of values.", {.min = 1, .max = 1500}),
      optional<&TopicField::max_length>("max_length",
                                        "MaxStringLength: most octets of a String or ByteString, which need it.",
                                        {.min = 1, .max = longest_string}),
  };
  static constexpr json::Object table =
      json::object<TopicField>("topic_field", "One field of a topic.", fields, {.shorthand = "type"});
  return table;
}

const json::Object& describe(json::Type<UadpPublisher>) {
  static constexpr json::Field fields[] = {
      optional<&UadpPublisher::byte>("byte", "A Byte."),
      optional<&UadpPublisher::uint32>("uint32", "A UInt32."),
      optional<&UadpPublisher::uint64>("uint64", "A UInt64."),
      optional<&UadpPublisher::string>("string", "A String.", {.min_length = 1, .max_length = 200}),
  };
  static constexpr std::string_view types[] = {"byte", "uint32", "uint64", "string"};
  static constexpr json::Group groups[] = {json::exactly_one_of(types)};
  static constexpr json::Object table = json::object<UadpPublisher>(
      "uadp_publisher", "A PublisherId of another type than UInt16.", fields, {.groups = groups});
  return table;
}

const json::Enumeration& describe(json::Type<UadpEncoding>) {
  static constexpr json::EnumName names[] = {
      name(UadpEncoding::variant, "Variant", "each field with its type"),
      name(UadpEncoding::raw_data, "RawData",
           "values alone, at fixed offsets; strings and arrays with their length and as much room as they may need"),
      name(UadpEncoding::data_value, "DataValue", "each field with its type and what `data_value` says"),
  };
  static constexpr json::Enumeration table = json::enumeration<UadpEncoding>("an encoding of fields", names);
  return table;
}

const json::Enumeration& describe(json::Type<NetworkMessagePart>) {
  static constexpr json::EnumName names[] = {
      name(NetworkMessagePart::publisher_id, "PublisherId", "who publishes"),
      name(NetworkMessagePart::group_header, "GroupHeader", "the next four need it"),
      name(NetworkMessagePart::writer_group_id, "WriterGroupId", "which WriterGroup"),
      name(NetworkMessagePart::group_version, "GroupVersion", "`group_version`"),
      name(NetworkMessagePart::network_message_number, "NetworkMessageNumber", "always 1"),
      name(NetworkMessagePart::sequence_number, "SequenceNumber", "of the NetworkMessages of the WriterGroup"),
      name(NetworkMessagePart::payload_header, "PayloadHeader", "which DataSetWriter"),
      name(NetworkMessagePart::timestamp, "Timestamp", "when the message was made"),
      name(NetworkMessagePart::pico_seconds, "PicoSeconds", "always 0; needs Timestamp"),
  };
  static constexpr json::Enumeration table = json::enumeration<NetworkMessagePart>("a part of NetworkMessages", names);
  return table;
}

const json::Enumeration& describe(json::Type<DataSetMessagePart>) {
  static constexpr json::EnumName names[] = {
      name(DataSetMessagePart::timestamp, "Timestamp", "when the message was made"),
      name(DataSetMessagePart::pico_seconds, "PicoSeconds", "always 0; needs Timestamp"),
      name(DataSetMessagePart::status, "Status", "always Good"),
      name(DataSetMessagePart::major_version, "MajorVersion", "`major_version`"),
      name(DataSetMessagePart::minor_version, "MinorVersion", "`minor_version`"),
      name(DataSetMessagePart::sequence_number, "SequenceNumber",
           "of the DataSetMessages of the DataSetWriter; without it losses are not seen"),
  };
  static constexpr json::Enumeration table = json::enumeration<DataSetMessagePart>("a part of DataSetMessages", names);
  return table;
}

const json::Enumeration& describe(json::Type<DataValuePart>) {
  static constexpr json::EnumName names[] = {
      name(DataValuePart::status_code, "StatusCode", "left out where it is Good, and what takt publishes is"),
      name(DataValuePart::source_timestamp, "SourceTimestamp", "when the message was made"),
      name(DataValuePart::server_timestamp, "ServerTimestamp", "the same"),
      name(DataValuePart::source_pico_seconds, "SourcePicoSeconds", "always 0; needs SourceTimestamp"),
      name(DataValuePart::server_pico_seconds, "ServerPicoSeconds", "always 0; needs ServerTimestamp"),
  };
  static constexpr json::Enumeration table = json::enumeration<DataValuePart>("a part of DataValues", names);
  return table;
}

const json::Object& describe(json::Type<UadpLayout>) {
  static constexpr json::Field fields[] = {
      optional<&UadpLayout::publisher>("publisher",
                                       "PublisherId of another type than UInt16, instead of `publisher_id`."),
      optional<&UadpLayout::writer_group_id>(
          "writer_group_id", "WriterGroupId of the first publication of the topic; the others have the next ones.",
          {.min = 1}),
      optional<&UadpLayout::data_set_writer_id>("data_set_writer_id", "DataSetWriterId, of all publications.",
                                                {.min = 1}),
      optional<&UadpLayout::network_message>("network_message",
                                             "UadpNetworkMessageContentMask: what each NetworkMessage has. Without "
                                             "\"PublisherId\" messages with one are not heard.",
                                             {.max_items = 9, .unique = true}),
      optional<&UadpLayout::data_set_message>("data_set_message",
                                              "UadpDataSetMessageContentMask: what each DataSetMessage has.",
                                              {.max_items = 6, .unique = true}),
      optional<&UadpLayout::encoding>("encoding", "How fields are published. Those of all three are heard."),
      optional<&UadpLayout::data_value>("data_value",
                                        "DataSetFieldContentMask of the encoding DataValue: what each field has beside "
                                        "its value; StatusCode if absent.",
                                        {.min_items = 1, .max_items = 5, .unique = true}),
      optional<&UadpLayout::key_frame_count>("key_frame_count",
                                             "At least every so many publications all fields are published, between "
                                             "them those that have changed, and nothing if none has.",
                                             {.min = 1, .max = 1'000'000}),
      optional<&UadpLayout::group_version>(
          "group_version",
          "GroupVersion, in seconds since 2000-01-01 UTC; messages with another one are not heard, with 0 all are."),
      optional<&UadpLayout::major_version>("major_version",
                                           "MajorVersion of the ConfigurationVersion, in seconds since 2000-01-01 UTC; "
                                           "messages with another one are not heard, with 0 all are."),
      optional<&UadpLayout::minor_version>("minor_version", "MinorVersion of the ConfigurationVersion."),
      optional<&UadpLayout::configured_size>(
          "configured_size",
          "ConfiguredSize: octets of each DataSetMessage, shorter ones end with zeros; as long as they are if absent.",
          {.min = 1, .max = longest_string}),
  };
  static constexpr json::Object table =
      json::object<UadpLayout>("uadp", "How messages of a topic of OPC UA are laid out.", fields);
  return table;
}

}  // namespace takt::plant
