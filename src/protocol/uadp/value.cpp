// SPDX-License-Identifier: Apache-2.0
#include "uadp/value.hpp"

#include "uadp/variant.hpp"

namespace takt::uadp {
namespace {

void skip_string(Reader& reader) { get_length_and_octets(reader); }

/// What stands behind the encoding octet of a NodeId (OPC 10000-6, 5.2.2.9).
void skip_node_id_body(Reader& reader, unsigned encoding) {
  switch (encoding) {
    case 0:
      reader.take(1);
      break;
    case 1:
      reader.take(3);
      break;
    case 2:
      reader.take(6);
      break;
    case 3:
    case 5:
      reader.take(2);
      skip_string(reader);
      break;
    case 4:
      reader.take(18);
      break;
    default:
      reader.fail();
  }
}

void skip_expanded_node_id(Reader& reader) {
  const auto encoding = reader.get<std::uint8_t>();
  skip_node_id_body(reader, encoding & 0x3FU);
  if ((encoding & 0x80U) != 0) skip_string(reader);
  if ((encoding & 0x40U) != 0) reader.take(4);
}

void skip_localized_text(Reader& reader) {
  const auto mask = reader.get<std::uint8_t>();
  if ((mask & ~0x03U) != 0) reader.fail();
  if ((mask & 0x01U) != 0) skip_string(reader);
  if ((mask & 0x02U) != 0) skip_string(reader);
}

void skip_extension_object(Reader& reader) {
  skip_node_id_body(reader, reader.get<std::uint8_t>());
  const auto encoding = reader.get<std::uint8_t>();
  if (encoding > 2) reader.fail();
  if (encoding != 0) skip_string(reader);
}

void skip_data_value(Reader& reader, int depth) {
  const auto mask = reader.get<std::uint8_t>();
  if ((mask & ~0x3FU) != 0) reader.fail();
  if ((mask & 0x01U) != 0) skip_value(reader, BuiltInType::Variant, depth + 1);
  constexpr std::array<std::uint8_t, 5> octets{4, 8, 8, 2, 2};  // by bit, from 0x02 on; the order does not matter here
  for (std::size_t i = 0; i < octets.size(); ++i)
    if ((mask >> (i + 1) & 1U) != 0) reader.take(octets[i]);
}

void skip_diagnostic_info(Reader& reader, int depth) {
  const auto mask = reader.get<std::uint8_t>();
  if ((mask & 0x80U) != 0) reader.fail();
  for (unsigned bit = 0; bit < 4; ++bit)
    if ((mask >> bit & 1U) != 0) reader.take(4);
  if ((mask & 0x10U) != 0) skip_string(reader);
  if ((mask & 0x20U) != 0) reader.take(4);
  if ((mask & 0x40U) != 0) skip_value(reader, BuiltInType::DiagnosticInfo, depth + 1);
}

}  // namespace

Octets get_length_and_octets(Reader& reader) {
  const auto length = reader.get<std::int32_t>();
  if (length == -1) return {};
  if (length < 0) {
    reader.fail();
    return {};
  }
  return reader.take(static_cast<std::size_t>(length));
}

void skip_value(Reader& reader, BuiltInType type, int depth) {
  if (depth > most_nested) return reader.fail();
  if (const std::size_t octets = fixed_octets(type); octets != 0) {
    reader.take(octets);
    return;
  }
  switch (type) {
    case BuiltInType::String:
    case BuiltInType::ByteString:
    case BuiltInType::XmlElement:
      return skip_string(reader);
    case BuiltInType::NodeId:
      return skip_node_id_body(reader, reader.get<std::uint8_t>());
    case BuiltInType::ExpandedNodeId:
      return skip_expanded_node_id(reader);
    case BuiltInType::QualifiedName:
      reader.take(2);
      return skip_string(reader);
    case BuiltInType::LocalizedText:
      return skip_localized_text(reader);
    case BuiltInType::ExtensionObject:
      return skip_extension_object(reader);
    case BuiltInType::DataValue:
      return skip_data_value(reader, depth);
    case BuiltInType::Variant:
      get_variant(reader, depth);
      return;
    case BuiltInType::DiagnosticInfo:
      return skip_diagnostic_info(reader, depth);
    default:
      reader.fail();
  }
}

}  // namespace takt::uadp
