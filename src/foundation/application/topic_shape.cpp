// SPDX-License-Identifier: Apache-2.0
#include "application/topic_shape.hpp"

#include <algorithm>

#include "gateway/field_values.hpp"
#include "plant/keys.hpp"
#include "plant/protocol.hpp"
#include "sim/check.hpp"
#include "uadp/variant.hpp"

namespace takt::application {

using gateway::DataSetField;
using gateway::Direction;

namespace {

/// Of zeros, and of empty texts.
std::size_t octets_of(const DataSetField& field) {
  const std::size_t fixed = uadp::fixed_octets(field.type.type);
  return (fixed != 0 ? fixed : sizeof(std::int32_t)) * (field.type.is_array ? field.type.array_length : 1);
}

/// Before the values of a Variant: its type, and the length of an array.
std::size_t header_of(const DataSetField& field) { return field.type.is_array ? 5 : 1; }

}  // namespace

std::size_t TopicShape::octets() const {
  std::size_t sum = 0;
  for (const DataSetField& field : fields) sum += octets_of(field);
  return sum;
}

std::vector<std::byte> TopicShape::zeros() const {
  const gateway::FieldValues values(fields);
  const uadp::Octets octets = values.octets();
  return {octets.begin(), octets.end()};
}

std::vector<std::byte> TopicShape::longest() const {
  std::size_t most = 0;
  for (const DataSetField& field : fields)
    most += header_of(field) + octets_of(field) + std::max(1U, field.type.array_length) * field.type.max_string_length;
  std::vector<std::byte> octets(most);
  uadp::Writer writer(octets);
  for (const DataSetField& field : fields) {
    writer.put(static_cast<std::uint8_t>(uadp::index_of(field.type.type) |
                                         (field.type.is_array ? uadp::detail::array_flag : 0U)));
    if (field.type.is_array) writer.put(static_cast<std::int32_t>(field.type.array_length));
    for (std::uint32_t i = 0; i < (field.type.is_array ? field.type.array_length : 1); ++i) {
      const std::size_t fixed = uadp::fixed_octets(field.type.type);
      if (fixed == 0) writer.put(static_cast<std::int32_t>(field.type.max_string_length));
      writer.put_zeros(fixed != 0 ? fixed : field.type.max_string_length);
    }
  }
  return octets;
}

bool TopicShape::is_zero(uadp::Octets value_of_topic) const {
  // What was received is shorter where a field is Bad, so that its places are not those of zeros().
  uadp::Reader reader(value_of_topic);
  uadp::Variant found;
  std::size_t at = 0;
  for (const DataSetField& field : fields) {
    found = uadp::get_variant(reader);
    if (at + header_of(field) == value.offset) break;
    at += header_of(field) + octets_of(field);
  }
  if (reader.failed() || found.type != value.type) return true;
  const uadp::Octets first = found.octets.first(std::min(found.octets.size(), uadp::fixed_octets(value.type)));
  return std::all_of(first.begin(), first.end(), [](std::byte octet) { return octet == std::byte{0}; });
}

TopicShape shape_of(const plant::Topic& topic, const std::vector<std::string>& keys) {
  TopicShape shape;
  shape.is_dds = topic.protocol == plant::Protocol::dds;
  shape.type.name = topic.type.value_or(topic.name);
  if (topic.uadp) shape.layout = *topic.uadp;
  const std::size_t value_field = plant::value_field(topic.fields, keys);
  std::size_t at = 0;
  for (std::size_t f = 0; f < topic.fields.size(); ++f) {
    const auto& [name, field] = topic.fields[f];
    const bool is_array = field.count > 1;
    shape.fields.push_back(
        {name,
         {plant::built_in_type_of(field.type), is_array, is_array ? field.count : 0U, field.max_length.value_or(0)}});
    const DataSetField& made = shape.fields.back();
    std::string problem;
    if (const auto member = gateway::idl_member_of(made, problem))
      shape.type.members.push_back(*member);  // an array of ByteStrings has none, and is of OPC UA
    const TopicShape::Place place{at + header_of(made), made.type.type};
    if (f == value_field) shape.value = place;
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) shape.keys.push_back(place);
    at += header_of(made) + octets_of(made);
  }
  if (!keys.empty()) shape.key = gateway::KeyLayout(shape.type, keys);
  return shape;
}

bool have_same_types(const TopicShape& one, const TopicShape& other) {
  return std::ranges::equal(one.fields, other.fields, {}, &DataSetField::type, &DataSetField::type);
}

std::optional<gateway::TypeMapping> own_mapping(const TopicShape& topic, Direction direction) {
  if (!topic.is_dds) return std::nullopt;
  std::vector<std::string> problems;
  auto mapping = gateway::TypeMapping::make(direction, topic.fields, topic.type, {}, problems);
  TAKT_CHECK(mapping.has_value(), "the members of a topic are made from its fields");
  return mapping;
}

std::optional<gateway::TypeMapping> mapping_between(const TopicShape& from, const TopicShape& to,
                                                    std::vector<std::string>& problems) {
  return gateway::TypeMapping::make(to.is_dds ? Direction::to_dds : Direction::to_opc_ua,
                                    (to.is_dds ? from : to).fields, (to.is_dds ? to : from).type, {}, problems);
}

}  // namespace takt::application
