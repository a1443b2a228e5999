// SPDX-License-Identifier: Apache-2.0
// The configuration of PubSub as OPC UA has it in files: a PubSubConfigurationDataType in a UABinaryFileDataType (OPC
// 10000-14, 6.2; OPC 10000-5, 12.24), in the encoding of OPC UA Binary. That is what open62541 loads
// (UA_ENABLE_PUBSUB_FILE_CONFIG).
#pragma once

#include "opcua/encoding/encoder.hpp"

namespace takt::interchange::uadp_configuration {

using opcua::Bytes;
using opcua::ExtensionObject;
using opcua::Guid;
using opcua::List;
using opcua::LocalizedText;
using opcua::NodeId;
using opcua::QualifiedName;
using opcua::Text;
using opcua::Variant;

/// No value of these is written: their arrays are null.
struct Nothing {
  static constexpr auto members() { return std::tuple<>(); }
};

struct FieldMetaData {
  Text name;
  LocalizedText description;
  std::uint16_t field_flags = 0;
  std::uint8_t built_in_type = 0;
  NodeId data_type;
  std::int32_t value_rank = -1;  ///< a scalar
  List<std::uint32_t> array_dimensions;
  std::uint32_t max_string_length = 0;
  Guid data_set_field_id;
  List<Nothing> properties;
  static constexpr auto members() {
    using T = FieldMetaData;
    return std::tuple(&T::name, &T::description, &T::field_flags, &T::built_in_type, &T::data_type, &T::value_rank,
                      &T::array_dimensions, &T::max_string_length, &T::data_set_field_id, &T::properties);
  }
};

struct DataSetMetaData {
  List<Text> namespaces;
  List<Nothing> structures, enumerations, simple_types;
  Text name;
  LocalizedText description;
  List<FieldMetaData> fields;
  Guid data_set_class_id;
  std::uint32_t major_version = 0, minor_version = 0;
  static constexpr auto members() {
    using T = DataSetMetaData;
    return std::tuple(&T::namespaces, &T::structures, &T::enumerations, &T::simple_types, &T::name, &T::description,
                      &T::fields, &T::data_set_class_id, &T::major_version, &T::minor_version);
  }
};

struct PublishedVariable {
  NodeId variable;
  std::uint32_t attribute = 13;  ///< Value
  double sampling_interval_hint = 0;
  std::uint32_t deadband_type = 0;
  double deadband_value = 0;
  Text index_range;
  Variant substitute_value;
  List<QualifiedName> meta_data_properties;
  static constexpr auto members() {
    using T = PublishedVariable;
    return std::tuple(&T::variable, &T::attribute, &T::sampling_interval_hint, &T::deadband_type, &T::deadband_value,
                      &T::index_range, &T::substitute_value, &T::meta_data_properties);
  }
};

struct PublishedDataItems {
  static constexpr std::uint32_t encoding_id = 15679;
  List<PublishedVariable> variables;
  static constexpr auto members() { return std::tuple(&PublishedDataItems::variables); }
};

struct PublishedDataSet {
  Text name;
  List<Text> folder;
  DataSetMetaData meta_data;
  List<Nothing> extension_fields;
  ExtensionObject source;  ///< PublishedDataItems
  static constexpr auto members() {
    using T = PublishedDataSet;
    return std::tuple(&T::name, &T::folder, &T::meta_data, &T::extension_fields, &T::source);
  }
};

struct UadpDataSetWriterMessage {
  static constexpr std::uint32_t encoding_id = 15717;
  std::uint32_t data_set_message_content_mask = 0;
  std::uint16_t configured_size = 0;
  std::uint16_t network_message_number = 0;
  std::uint16_t data_set_offset = 0;
  static constexpr auto members() {
    using T = UadpDataSetWriterMessage;
    return std::tuple(&T::data_set_message_content_mask, &T::configured_size, &T::network_message_number,
                      &T::data_set_offset);
  }
};

struct DataSetWriter {
  Text name;
  bool enabled = true;
  std::uint16_t data_set_writer_id = 0;
  std::uint32_t data_set_field_content_mask = 0;
  std::uint32_t key_frame_count = 1;
  Text data_set_name;
  List<Nothing> properties;
  ExtensionObject transport_settings, message_settings;
  static constexpr auto members() {
    using T = DataSetWriter;
    return std::tuple(&T::name, &T::enabled, &T::data_set_writer_id, &T::data_set_field_content_mask,
                      &T::key_frame_count, &T::data_set_name, &T::properties, &T::transport_settings,
                      &T::message_settings);
  }
};

struct UadpWriterGroupMessage {
  static constexpr std::uint32_t encoding_id = 15715;
  std::uint32_t group_version = 0;
  std::int32_t data_set_ordering = 1;  ///< AscendingWriterId
  std::uint32_t network_message_content_mask = 0;
  double sampling_offset = -1;     ///< none
  List<double> publishing_offset;  ///< ms
  static constexpr auto members() {
    using T = UadpWriterGroupMessage;
    return std::tuple(&T::group_version, &T::data_set_ordering, &T::network_message_content_mask, &T::sampling_offset,
                      &T::publishing_offset);
  }
};

struct WriterGroup {
  Text name;
  bool enabled = true;
  std::int32_t security_mode = 1;  ///< 1 none, 2 sign, 3 sign and encrypt
  Text security_group;
  List<Nothing> key_services;
  std::uint32_t max_network_message_size = 0;
  List<Nothing> properties;
  std::uint16_t writer_group_id = 0;
  double publishing_interval = 0;  ///< ms
  double keep_alive_time = 0;      ///< ms
  std::uint8_t priority = 0;
  List<Text> locales;
  Text header_layout;
  ExtensionObject transport_settings, message_settings;
  List<DataSetWriter> writers;
  static constexpr auto members() {
    using T = WriterGroup;
    return std::tuple(&T::name, &T::enabled, &T::security_mode, &T::security_group, &T::key_services,
                      &T::max_network_message_size, &T::properties, &T::writer_group_id, &T::publishing_interval,
                      &T::keep_alive_time, &T::priority, &T::locales, &T::header_layout, &T::transport_settings,
                      &T::message_settings, &T::writers);
  }
};

struct UadpDataSetReaderMessage {
  static constexpr std::uint32_t encoding_id = 15718;
  std::uint32_t group_version = 0;
  std::uint16_t network_message_number = 0;
  std::uint16_t data_set_offset = 0;
  Guid data_set_class_id;
  std::uint32_t network_message_content_mask = 0;
  std::uint32_t data_set_message_content_mask = 0;
  double publishing_interval = 0;  ///< ms
  double receive_offset = 0;
  double processing_offset = 0;
  static constexpr auto members() {
    using T = UadpDataSetReaderMessage;
    return std::tuple(&T::group_version, &T::network_message_number, &T::data_set_offset, &T::data_set_class_id,
                      &T::network_message_content_mask, &T::data_set_message_content_mask, &T::publishing_interval,
                      &T::receive_offset, &T::processing_offset);
  }
};

struct FieldTarget {
  Guid data_set_field_id;
  Text receiver_index_range;
  NodeId target;
  std::uint32_t attribute = 13;  ///< Value
  Text write_index_range;
  std::int32_t override_value_handling = 1;  ///< LastUsableValue
  Variant override_value;
  static constexpr auto members() {
    using T = FieldTarget;
    return std::tuple(&T::data_set_field_id, &T::receiver_index_range, &T::target, &T::attribute, &T::write_index_range,
                      &T::override_value_handling, &T::override_value);
  }
};

struct TargetVariables {
  static constexpr std::uint32_t encoding_id = 15712;
  List<FieldTarget> targets;
  static constexpr auto members() { return std::tuple(&TargetVariables::targets); }
};

struct DataSetReader {
  Text name;
  bool enabled = true;
  Variant publisher_id;
  std::uint16_t writer_group_id = 0;
  std::uint16_t data_set_writer_id = 0;
  DataSetMetaData meta_data;
  std::uint32_t data_set_field_content_mask = 0;
  double message_receive_timeout = 0;  ///< ms
  std::uint32_t key_frame_count = 1;
  Text header_layout;
  std::int32_t security_mode = 1;
  Text security_group;
  List<Nothing> key_services;
  List<Nothing> properties;
  ExtensionObject transport_settings, message_settings, subscribed_data_set;
  static constexpr auto members() {
    using T = DataSetReader;
    return std::tuple(&T::name, &T::enabled, &T::publisher_id, &T::writer_group_id, &T::data_set_writer_id,
                      &T::meta_data, &T::data_set_field_content_mask, &T::message_receive_timeout, &T::key_frame_count,
                      &T::header_layout, &T::security_mode, &T::security_group, &T::key_services, &T::properties,
                      &T::transport_settings, &T::message_settings, &T::subscribed_data_set);
  }
};

struct ReaderGroup {
  Text name;
  bool enabled = true;
  std::int32_t security_mode = 1;
  Text security_group;
  List<Nothing> key_services;
  std::uint32_t max_network_message_size = 0;
  List<Nothing> properties;
  ExtensionObject transport_settings, message_settings;
  List<DataSetReader> readers;
  static constexpr auto members() {
    using T = ReaderGroup;
    return std::tuple(&T::name, &T::enabled, &T::security_mode, &T::security_group, &T::key_services,
                      &T::max_network_message_size, &T::properties, &T::transport_settings, &T::message_settings,
                      &T::readers);
  }
};

struct NetworkAddressUrl {
  static constexpr std::uint32_t encoding_id = 21152;
  Text network_interface;
  Text url;
  static constexpr auto members() { return std::tuple(&NetworkAddressUrl::network_interface, &NetworkAddressUrl::url); }
};

struct Connection {
  Text name;
  bool enabled = true;
  Variant publisher_id;
  Text transport_profile;
  ExtensionObject address;  ///< NetworkAddressUrl
  List<Nothing> properties;
  ExtensionObject transport_settings;
  List<WriterGroup> writer_groups;
  List<ReaderGroup> reader_groups;
  static constexpr auto members() {
    using T = Connection;
    return std::tuple(&T::name, &T::enabled, &T::publisher_id, &T::transport_profile, &T::address, &T::properties,
                      &T::transport_settings, &T::writer_groups, &T::reader_groups);
  }
};

struct Configuration {
  static constexpr std::uint32_t encoding_id = 21154;
  List<PublishedDataSet> published_data_sets;
  List<Connection> connections;
  bool enabled = true;
  static constexpr auto members() {
    return std::tuple(&Configuration::published_data_sets, &Configuration::connections, &Configuration::enabled);
  }
};

struct BinaryFile {
  static constexpr std::uint32_t encoding_id = 15422;
  List<Text> namespaces;
  List<Nothing> structures, enumerations, simple_types;
  Text schema_location;
  List<Nothing> file_header;
  Variant body;
  static constexpr auto members() {
    using T = BinaryFile;
    return std::tuple(&T::namespaces, &T::structures, &T::enumerations, &T::simple_types, &T::schema_location,
                      &T::file_header, &T::body);
  }
};

/// The octets of the file: a BinaryFile as an ExtensionObject, the configuration in its body.
inline std::vector<std::byte> file_of(const Configuration& configuration) {
  BinaryFile file;
  file.body = Variant(opcua::extension_of(configuration));
  opcua::Encoder encoder;
  encode(encoder, opcua::extension_of(file));
  return encoder.take();
}

}  // namespace takt::interchange::uadp_configuration
