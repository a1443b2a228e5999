// SPDX-License-Identifier: Apache-2.0
// Writing values by tables (see table.hpp): every member, with the defaults filled in.
#include <algorithm>
#include <utility>

#include "json/table.hpp"
#include "sim/check.hpp"

namespace takt::json {

namespace {

void encode_members(const Object& table, const void* value, Node& json) {
  // The tables' accessors serve reading too, hence not const; nothing is changed here.
  void* object = const_cast<void*>(value);
  for (const Field& field : table.fields) {
    const void* member = field.member(object);
    if (field.codec->is_absent != nullptr && field.codec->is_absent(member)) continue;
    Node encoded = field.codec->encode(member);
    // An empty array where some items are asked for stands for "absent"; written, it would be refused.
    if (!field.is_required && field.bounds.min_items > 0 && encoded.kind == Kind::array && encoded.items.empty())
      continue;
    json.add(field.name, std::move(encoded));
  }
}

}  // namespace

Node encode_sequence(const void* value, const Sequence& sequence) {
  Node json = Node::array();
  for (std::size_t i = 0; i < sequence.size(value); ++i)
    json.items.push_back(sequence.item->encode(sequence.at(value, i)));
  return json;
}

Node encode_mapping(const void* value, const Mapping& mapping) {
  Node json = Node::object();
  for (std::size_t i = 0; i < mapping.size(value); ++i)
    json.add(mapping.name_at(value, i), mapping.value->encode(mapping.value_at(value, i)));
  return json;
}

Node encode_quantity(sim::int128 value, const Dimension& dimension) {
  std::string text = quantity_text(dimension, value);
  return &dimension == &probability_dimension ? Node::of_literal(std::move(text)) : Node::of_string(text);
}

Node encode_by(const Object& table, const void* value) {
  Node json = Node::object();
  encode_members(table, value, json);
  return json;
}

Node encode_by(const Enumeration& table, const void* value) {
  const auto found = std::ranges::find(table.names, table.get(value), &EnumName::value);
  TAKT_CHECK(found != table.names.end(), "every value of an enum has a name in its table");
  return Node::of_string(found->name);
}

Node encode_by(const Tagged& table, const void* value) {
  const std::size_t index = table.index(value);
  TAKT_CHECK(index < table.options.size(), "a variant holds one of its alternatives");
  const Option& option = table.options[index];
  Node json = Node::object();
  json.add(table.key, Node::of_string(option.tag));
  encode_members(option.object(), table.get(value), json);
  return json;
}

Node encode_by(const Custom& table, const void* value) { return table.encode(value); }

}  // namespace takt::json
