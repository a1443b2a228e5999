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

std::size_t octets_of(const DataSetField& field) { return uadp::fixed_octets(field.type.type) * (field.type.is_array ? field.type.array_length : 1); }

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
  const std::size_t value_field = plant::value_field(topic.fields, keys);
  std::size_t at = 0;
  for (std::size_t f = 0; f < topic.fields.size(); ++f) {
    const auto& [name, field] = topic.fields[f];
    const bool is_array = field.count > 1;
    shape.fields.push_back({name, {plant::built_in_type_of(field.type), is_array, is_array ? field.count : 0U, 0}});
    const DataSetField& made = shape.fields.back();
    std::string problem;
    const auto member = gateway::idl_member_of(made, problem);
    TAKT_CHECK(member.has_value(), "all types of the vocabulary are mapped");
    shape.type.members.push_back(*member);
    const TopicShape::Place place{at + header_of(made), made.type.type};
    if (f == value_field) shape.value = place;
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) shape.keys.push_back(place);
    at += header_of(made) + octets_of(made);
  }
  if (!keys.empty()) shape.key = gateway::KeyLayout(shape.type, keys);
  return shape;
}

bool have_same_types(const TopicShape& one, const TopicShape& other) { return std::ranges::equal(one.fields, other.fields, {}, &DataSetField::type, &DataSetField::type); }

std::optional<gateway::TypeMapping> own_mapping(const TopicShape& topic, Direction direction) {
  if (!topic.is_dds) return std::nullopt;
  std::vector<std::string> problems;
  auto mapping = gateway::TypeMapping::make(direction, topic.fields, topic.type, {}, problems);
  TAKT_CHECK(mapping.has_value(), "the members of a topic are made from its fields");
  return mapping;
}

std::optional<gateway::TypeMapping> mapping_between(const TopicShape& from, const TopicShape& to, std::vector<std::string>& problems) {
  return gateway::TypeMapping::make(to.is_dds ? Direction::to_dds : Direction::to_opc_ua, (to.is_dds ? from : to).fields, (to.is_dds ? to : from).type, {}, problems);
}

}  // namespace takt::application
