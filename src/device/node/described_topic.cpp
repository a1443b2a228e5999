// SPDX-License-Identifier: Apache-2.0
#include "node/described_topic.hpp"

#include "json/record.hpp"

namespace takt::node {

const json::Record& describe(json::Type<DescribedField>) {
  static constexpr json::Output outputs[] = {
      json::output<&DescribedField::name>("name", "Its name."),
      json::output<&DescribedField::type>("type", "The built-in type of OPC UA."),
      json::output<&DescribedField::array_length>("array_length",
                                                  "ArrayDimensions of an array of one dimension; null: a scalar."),
      json::output<&DescribedField::max_string_length>(
          "max_string_length", "MaxStringLength of a String or ByteString; null: of another type."),
      json::output<&DescribedField::offset>("offset",
                                            "RawData: where it begins in the NetworkMessage, in octets, an array or "
                                            "text with its length; null: not at a fixed place."),
  };
  static constexpr json::Record record{"described_field", "A field of a topic.", outputs};
  return record;
}

const json::Record& describe(json::Type<DescribedPublication>) {
  static constexpr json::Output outputs[] = {
      json::output<&DescribedPublication::application>("application", "The application or gateway."),
      json::output<&DescribedPublication::thread>("thread", "Its thread."),
      json::output<&DescribedPublication::is_own>("own", "It is on this node."),
      json::output<&DescribedPublication::writer_group_id>("writer_group_id", "WriterGroupId."),
      json::output<&DescribedPublication::every>("every_ps", "PublishingInterval."),
  };
  static constexpr json::Record record{"publication", "Who publishes to a topic: a WriterGroup with one DataSetWriter.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<DescribedTopic>) {
  static constexpr json::Output outputs[] = {
      json::output<&DescribedTopic::name>("name", "Its name, which is not in messages."),
      json::output<&DescribedTopic::publisher_id_type>(
          "publisher_id_type", "`Byte`, `UInt16`, `UInt32`, `UInt64` or `String`; null: messages have no PublisherId."),
      json::output<&DescribedTopic::publisher_id>("publisher_id",
                                                  "PublisherId, numbers as text; null: messages have none."),
      json::output<&DescribedTopic::publications>("publications", "Who publishes to it, as far as the file says."),
      json::output<&DescribedTopic::is_heard>("heard", "This node subscribes to it."),
      json::output<&DescribedTopic::data_set_writer_id>("data_set_writer_id", "DataSetWriterId, of all publications."),
      json::output<&DescribedTopic::network_message_content_mask>("network_message_content_mask",
                                                                  "UadpNetworkMessageContentMask."),
      json::output<&DescribedTopic::data_set_message_content_mask>("data_set_message_content_mask",
                                                                   "UadpDataSetMessageContentMask."),
      json::output<&DescribedTopic::data_set_field_content_mask>(
          "data_set_field_content_mask",
          "DataSetFieldContentMask: 0 is Variant, 32 RawData, all others are DataValue."),
      json::output<&DescribedTopic::key_frame_count>("key_frame_count", "KeyFrameCount; 1: key frames only."),
      json::output<&DescribedTopic::group_version>("group_version", "GroupVersion; 0: any is heard."),
      json::output<&DescribedTopic::major_version>("major_version",
                                                   "MajorVersion of the ConfigurationVersion; 0: any is heard."),
      json::output<&DescribedTopic::minor_version>("minor_version", "MinorVersion of the ConfigurationVersion."),
      json::output<&DescribedTopic::configured_size>(
          "configured_size", "ConfiguredSize: octets of each DataSetMessage; null: as long as it is."),
      json::output<&DescribedTopic::data_set_offset>(
          "data_set_offset",
          "DataSetOffset: where the DataSetMessage begins in the NetworkMessage, in octets, before it is secured."),
      json::output<&DescribedTopic::octets>("octets", "Of the longest NetworkMessage; with RawData of all."),
      json::output<&DescribedTopic::fields>("fields", "The fields of the DataSet, in their order."),
  };
  static constexpr json::Record record{"described_topic", "A topic of OPC UA.", outputs};
  return record;
}

}  // namespace takt::node
