// SPDX-License-Identifier: Apache-2.0
#include "uadp/message_json.hpp"

#include <stdexcept>

namespace takt::uadp {
namespace {

using nlohmann::json;

template <class T>
json read(const Variant& variant, std::size_t index) {
  const auto value = variant.is_array ? variant.at<T>(index) : variant.get<T>();
  if (!value) throw std::runtime_error("a decoded value cannot be read");
  if constexpr (std::same_as<T, DateTime>) {
    return value->ticks;
  } else if constexpr (std::same_as<T, Status>) {
    return value->code;
  } else if constexpr (std::same_as<T, std::string_view>) {
    return std::string(*value);
  } else {
    return *value;
  }
}

json element(const Variant& variant, std::size_t index) {
  switch (variant.type) {
    case BuiltInType::Boolean:
      return read<bool>(variant, index);
    case BuiltInType::SByte:
      return read<std::int8_t>(variant, index);
    case BuiltInType::Byte:
      return read<std::uint8_t>(variant, index);
    case BuiltInType::Int16:
      return read<std::int16_t>(variant, index);
    case BuiltInType::UInt16:
      return read<std::uint16_t>(variant, index);
    case BuiltInType::Int32:
      return read<std::int32_t>(variant, index);
    case BuiltInType::UInt32:
      return read<std::uint32_t>(variant, index);
    case BuiltInType::Int64:
      return read<std::int64_t>(variant, index);
    case BuiltInType::UInt64:
      return read<std::uint64_t>(variant, index);
    case BuiltInType::Float:
      return read<float>(variant, index);
    case BuiltInType::Double:
      return read<double>(variant, index);
    case BuiltInType::String:
      return read<std::string_view>(variant, index);
    case BuiltInType::DateTime:
      return read<DateTime>(variant, index);
    case BuiltInType::StatusCode:
      return read<Status>(variant, index);
    default:
      return nullptr;
  }
}

json to_json(const DataValue& value) {
  json result = value.value ? to_json(*value.value) : json::object();
  if (value.status) result["status"] = *value.status;
  if (value.source_timestamp) result["sourceTimestamp"] = value.source_timestamp->ticks;
  if (value.source_picoseconds) result["sourcePicoseconds"] = *value.source_picoseconds;
  if (value.server_timestamp) result["serverTimestamp"] = value.server_timestamp->ticks;
  if (value.server_picoseconds) result["serverPicoseconds"] = *value.server_picoseconds;
  return result;
}

json to_json(const PublisherId& id) {
  constexpr std::array<const char*, 5> names{"Byte", "UInt16", "UInt32", "UInt64", "String"};
  json result = {{"type", names[static_cast<std::size_t>(id.type)]}};
  if (id.type == PublisherIdType::String)
    result["value"] = std::string(id.text);
  else
    result["value"] = id.number;
  return result;
}

std::string guid_text(const Guid& guid) {
  constexpr std::array<int, 16> order{3, 2, 1, 0, 5, 4, 7, 6, 8, 9, 10, 11, 12, 13, 14, 15};
  std::string text;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
    text += hex_of(Octets(guid.octets).subspan(static_cast<std::size_t>(order[i]), 1));
  }
  return text;
}

template <class T>
void set_if(json& object, const char* key, const std::optional<T>& value) {
  if (value) object[key] = *value;
}

/// Adds the fields and says how many octets of the body they take.
std::size_t add_fields(json& result, const DataSetMessage& message, const json& expected) {
  json fields = json::array();
  std::size_t used = 0;
  if (message.header.encoding == FieldEncoding::RawData) {
    const RawLayout layout = raw_layout_of(expected.at("fields"));
    for (std::size_t i = 0; i < layout.count(); ++i) fields.push_back(to_json(layout.at(message.body, i).value()));
    used = layout.size();
  } else {
    FieldReader reader(message);
    while (const auto field = reader.next()) {
      const json value = to_json(field->value);
      const bool is_delta = message.header.type == DataSetMessageType::DeltaFrame;
      fields.push_back(is_delta ? json{{"index", field->index}, {"field", value}} : value);
    }
    if (reader.failed()) throw std::runtime_error("a body is malformed");
    if (message.header.type != DataSetMessageType::KeepAlive) result["fieldCount"] = reader.count();
    used = reader.position();
  }
  result["fields"] = fields;
  return used;
}

json to_json(const DataSetMessage& message, const json& expected, std::size_t& used) {
  constexpr std::array<const char*, 3> encodings{"Variant", "RawData", "DataValue"};
  constexpr std::array<const char*, 4> types{"KeyFrame", "DeltaFrame", "Event", "KeepAlive"};
  const DataSetMessageHeader& header = message.header;
  json result = {{"valid", header.valid},
                 {"fieldEncoding", encodings[static_cast<std::size_t>(header.encoding)]},
                 {"type", types[static_cast<std::size_t>(header.type)]}};
  set_if(result, "sequenceNumber", header.sequence_number);
  if (header.timestamp) result["timestamp"] = header.timestamp->ticks;
  set_if(result, "picoseconds", header.picoseconds);
  set_if(result, "status", header.status);
  set_if(result, "majorVersion", header.major_version);
  set_if(result, "minorVersion", header.minor_version);
  used = message.body_offset + (header.valid ? add_fields(result, message, expected) : message.body.size());
  return result;
}

}  // namespace

std::vector<std::byte> octets_of(std::string_view hex) {
  std::vector<std::byte> octets;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    octets.push_back(static_cast<std::byte>(std::stoul(std::string(hex.substr(i, 2)), nullptr, 16)));
  return octets;
}

std::string hex_of(Octets octets) {
  std::string text;
  for (const std::byte octet : octets) {
    text += "0123456789abcdef"[static_cast<unsigned>(octet) >> 4];
    text += "0123456789abcdef"[static_cast<unsigned>(octet) & 15U];
  }
  return text;
}

json to_json(const Variant& variant) {
  json result = {{"type", std::string(name_of(variant.type))}};
  if (!variant.is_array) {
    result["value"] = element(variant, 0);
    return result;
  }
  json values = json::array();
  for (std::size_t i = 0; i < variant.size(); ++i) values.push_back(element(variant, i));
  result["array"] = variant.size();
  result["value"] = values;
  return result;
}

RawLayout raw_layout_of(const json& fields) {
  std::vector<RawField> layout;
  for (const json& field : fields) {
    for (const BuiltInInfo& each : built_in_types)
      if (each.name == field.at("type").get<std::string>())
        layout.push_back({each.type, field.contains("array"), field.value("array", 0U)});
  }
  return RawLayout(layout);
}

json to_json(const NetworkMessage& message, const json& expected) {
  const NetworkMessageHeader& header = message.header;
  json result = {{"version", 1},
                 {"messageType", static_cast<int>(message.type)},
                 {"payloadHeader", message.writer_ids.has_value()}};
  if (header.publisher_id) result["publisherId"] = to_json(*header.publisher_id);
  if (header.data_set_class_id) result["dataSetClassId"] = guid_text(*header.data_set_class_id);
  if (header.group) {
    json group = json::object();
    set_if(group, "writerGroupId", header.group->writer_group_id);
    set_if(group, "groupVersion", header.group->group_version);
    set_if(group, "networkMessageNumber", header.group->network_message_number);
    set_if(group, "sequenceNumber", header.group->sequence_number);
    result["groupHeader"] = group;
  }
  if (header.timestamp) result["timestamp"] = header.timestamp->ticks;
  set_if(result, "picoseconds", header.picoseconds);
  if (header.promoted_fields) {
    result["promotedFields"] = json::array();
    Reader reader(*header.promoted_fields);
    while (reader.left() != 0) result["promotedFields"].push_back(to_json(get_variant(reader)));
  }
  json messages = json::array();
  std::size_t used = 0;
  for (std::size_t i = 0; i < message.count(); ++i) {
    DataSetMessage each;
    if (decode(message.data_set_message(i), each) != DecodeStatus::ok)
      throw std::runtime_error("a DataSetMessage is refused");
    std::size_t octets = 0;
    messages.push_back(to_json(each, expected.at("dataSetMessages").at(i), octets));
    if (const auto id = message.writer_id(i)) messages.back()["dataSetWriterId"] = *id;
    if (!message.sizes.empty()) messages.back()["size"] = message.data_set_message(i).size();
    used += octets;
  }
  result["dataSetMessages"] = messages;
  result["trailingBytes"] = message.payload.size() - used;
  return result;
}

}  // namespace takt::uadp
