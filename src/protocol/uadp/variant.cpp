// SPDX-License-Identifier: Apache-2.0
#include "uadp/variant.hpp"

namespace takt::uadp {
namespace {

Variant malformed(Reader& reader) {
  reader.fail();
  return {};
}

/// The elements of an array; each takes at least one octet, so a length cannot make the loop long.
bool skip_elements(Reader& reader, BuiltInType type, std::int32_t length, int depth) {
  if (length < 0) return length == -1;
  const auto count = static_cast<std::size_t>(length);
  if (count > reader.left()) return false;
  if (const std::size_t octets = fixed_octets(type); octets != 0) {
    reader.take(count * octets);
  } else {
    for (std::size_t i = 0; i < count && !reader.failed(); ++i) skip_value(reader, type, depth + 1);
  }
  return !reader.failed();
}

/// Int32 count and Int32[]: their product is the length of the array (OPC 10000-6, 5.2.2.16).
Octets get_dimensions(Reader& reader, std::int32_t length) {
  const std::size_t begin = reader.position();
  const auto count = reader.get<std::int32_t>();
  if (count < 0 || static_cast<std::size_t>(count) > reader.left() / sizeof(std::int32_t)) {
    reader.fail();
    return {};
  }
  std::uint64_t product = 1;
  for (std::int32_t i = 0; i < count; ++i) {
    const auto dimension = reader.get<std::int32_t>();
    if (dimension < 0) reader.fail();
    product *= static_cast<std::uint64_t>(dimension < 0 ? 0 : dimension);
    if (product > 0x7FFFFFFFU) reader.fail();
    if (reader.failed()) return {};
  }
  if (count > 0 && product != static_cast<std::uint64_t>(length < 0 ? 0 : length)) reader.fail();
  return reader.failed() ? Octets() : reader.since(begin);
}

}  // namespace

Variant get_variant(Reader& reader, int depth) {
  const unsigned encoding = reader.get<std::uint8_t>();
  const auto type = built_in_type_from_id(encoding & 0x3FU);
  Variant variant;
  variant.is_array = (encoding & detail::array_flag) != 0;
  const bool has_dimensions = (encoding & detail::dimensions_flag) != 0;
  if (reader.failed() || !type || depth > most_nested || (has_dimensions && !variant.is_array))
    return malformed(reader);
  variant.type = *type;
  if (variant.is_null()) return variant.is_array ? malformed(reader) : variant;
  if (!variant.is_array) {
    if (*type == BuiltInType::Variant) return malformed(reader);  // only arrays may hold Variants
    const std::size_t begin = reader.position();
    skip_value(reader, *type, depth);
    if (reader.failed()) return {};
    variant.octets = reader.since(begin);
    return variant;
  }
  variant.length = reader.get<std::int32_t>();
  const std::size_t begin = reader.position();
  if (reader.failed() || !skip_elements(reader, *type, variant.length, depth)) return malformed(reader);
  variant.octets = reader.since(begin);
  if (has_dimensions) variant.dimensions = get_dimensions(reader, variant.length);
  return reader.failed() ? Variant() : variant;
}

DataValue get_data_value(Reader& reader) {
  const auto mask = reader.get<std::uint8_t>();
  if ((mask & ~0x3FU) != 0) reader.fail();
  DataValue value;
  if (reader.failed()) return value;
  if ((mask & 0x01U) != 0) value.value = get_variant(reader);
  if ((mask & 0x02U) != 0) value.status = reader.get<std::uint32_t>();
  if ((mask & 0x04U) != 0) value.source_timestamp = get_value<DateTime>(reader);
  if ((mask & 0x10U) != 0) value.source_picoseconds = reader.get<std::uint16_t>();
  if ((mask & 0x08U) != 0) value.server_timestamp = get_value<DateTime>(reader);
  if ((mask & 0x20U) != 0) value.server_picoseconds = reader.get<std::uint16_t>();
  return reader.failed() ? DataValue() : value;
}

void put_variant(Writer& writer, const Variant& variant) {
  unsigned encoding = static_cast<unsigned>(index_of(variant.type));
  if (variant.is_array) encoding |= detail::array_flag;
  if (!variant.dimensions.empty()) encoding |= detail::dimensions_flag;
  writer.put(static_cast<std::uint8_t>(encoding));
  if (variant.is_array) writer.put(variant.length);
  if (variant.stride == 0) {
    writer.put_octets(variant.octets);
  } else {
    for (std::size_t i = 0; i < variant.size(); ++i) {
      Reader reader(variant.octets.subspan(i * variant.stride, variant.stride));
      put_length_and_octets(writer, get_length_and_octets(reader));
    }
  }
  writer.put_octets(variant.dimensions);
}

void put_data_value(Writer& writer, const DataValue& value) {
  unsigned mask = 0;
  if (value.value) mask |= 0x01U;
  if (value.status) mask |= 0x02U;
  if (value.source_timestamp) mask |= 0x04U;
  if (value.server_timestamp) mask |= 0x08U;
  if (value.source_picoseconds) mask |= 0x10U;
  if (value.server_picoseconds) mask |= 0x20U;
  writer.put(static_cast<std::uint8_t>(mask));
  if (value.value) put_variant(writer, *value.value);
  if (value.status) writer.put(*value.status);
  if (value.source_timestamp) put_value(writer, *value.source_timestamp);
  if (value.source_picoseconds) writer.put(*value.source_picoseconds);
  if (value.server_timestamp) put_value(writer, *value.server_timestamp);
  if (value.server_picoseconds) writer.put(*value.server_picoseconds);
}

}  // namespace takt::uadp
