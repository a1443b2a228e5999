// SPDX-License-Identifier: Apache-2.0
#include "scenario/description/traffic_classes.hpp"

#include <string>

namespace takt::scenario {
namespace {

using ClassesByPriority = std::array<std::uint8_t, 8>;

/// IEEE 802.1Q Table 8-5, a column a row: of so many classes that of each priority.
constexpr std::array<ClassesByPriority, 8> table_8_5 = {{
    {0, 0, 0, 0, 0, 0, 0, 0},
    {0, 0, 0, 0, 1, 1, 1, 1},
    {0, 0, 0, 0, 1, 1, 2, 2},
    {0, 0, 1, 1, 2, 2, 3, 3},
    {0, 0, 1, 1, 2, 2, 3, 4},
    {1, 0, 2, 2, 3, 3, 4, 5},
    {1, 0, 2, 3, 4, 4, 5, 6},
    {1, 0, 2, 3, 4, 5, 6, 7},
}};
constexpr ClassesByPriority identity_column = {0, 1, 2, 3, 4, 5, 6, 7};

const json::Enumeration& names_of_eight() {
  static constexpr json::EnumName names[] = {
      json::name(TrafficClasses::standard, "standard", "IEEE 802.1Q Table 8-5: priority 1 lies below priority 0"),
      json::name(TrafficClasses::identity, "identity", "priority n is sent in class n"),
  };
  static constexpr json::Enumeration table =
      json::enumeration<TrafficClasses>("a priority to traffic class mapping", names);
  return table;
}

TrafficClasses classes_of_count(std::uint8_t count) {
  return count == 8 ? TrafficClasses::standard
                    : static_cast<TrafficClasses>(static_cast<std::uint8_t>(TrafficClasses::one) + count - 1);
}

void decode_classes(const json::Node& node, TrafficClasses& value, json::Reader& reader) {
  if (node.kind != json::Kind::number) return json::decode_by(names_of_eight(), node, &value, reader);
  std::uint8_t count = 8;
  json::decode_value(node, count, reader, {.min = 1, .max = 8});
  value = classes_of_count(count);
}

json::Node encode_classes(const TrafficClasses& value) {
  if (value == TrafficClasses::standard || value == TrafficClasses::identity)
    return json::encode_by(names_of_eight(), &value);
  return json::encode_value(count_of(value));
}

json::Node schema_classes(json::SchemaBuilder& builder) {
  json::Node any = json::Node::array();
  any.items.push_back(json::schema_by(names_of_eight(), builder));
  any.items.push_back(json::schema_value<std::uint8_t>(builder, {.min = 1, .max = 8}));
  json::Node schema = json::Node::object();
  schema.add("anyOf", std::move(any));
  return schema;
}

}  // namespace

std::uint8_t count_of(TrafficClasses classes) {
  if (classes == TrafficClasses::standard || classes == TrafficClasses::identity) return 8;
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(classes) - static_cast<std::uint8_t>(TrafficClasses::one) +
                                   1);
}

std::array<std::uint8_t, 8> class_of_priorities(TrafficClasses classes) {
  return classes == TrafficClasses::identity ? identity_column : table_8_5[count_of(classes) - std::size_t{1}];
}

const json::Custom& describe(json::Type<TrafficClasses>) {
  static constexpr json::Custom table = json::custom<TrafficClasses, decode_classes, encode_classes, schema_classes>();
  return table;
}

}  // namespace takt::scenario
