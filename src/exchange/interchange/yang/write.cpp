// SPDX-License-Identifier: Apache-2.0
// Data to JSON (RFC 7951) and XML.
#include <algorithm>

#include "xml/xml.hpp"
#include "interchange/yang/data.hpp"
#include "json/node.hpp"

namespace takt::interchange::yang {
namespace {

json::Node leaf_node(const Data& data) {
  switch (data.schema->type) {
    case Type::boolean:
      return json::Node::of_bool(data.text == "true");
    case Type::uint8:
    case Type::uint16:
    case Type::uint32:
    case Type::int8:
    case Type::int16:
    case Type::int32:
      return json::Node::of_literal(data.text);
    case Type::empty: {
      json::Node array = json::Node::array();
      array.items.emplace_back();
      return array;
    }
    default:
      return json::Node::of_string(data.text);
  }
}

json::Node object_of(const Data& data) {
  json::Node object = json::Node::object();
  for (const Data& child : data.children) {
    const Schema& schema = *child.schema;
    const std::string key =
        (schema.module == data.schema->module ? "" : std::string(schema.module) + ":") + std::string(schema.name);
    json::Node value =
        schema.type == Type::container || schema.type == Type::list ? object_of(child) : leaf_node(child);
    if (schema.type == Type::list || schema.is_leaf_list) {
      json::Node* list = object.find(key);
      if (list == nullptr) list = &object.add(key, json::Node::array());
      list->items.push_back(std::move(value));
    } else {
      object.add(key, std::move(value));
    }
  }
  return object;
}

void write_element(const Data& data, std::string_view outer_module, std::size_t depth, std::string& text) {
  const Schema& schema = *data.schema;
  const std::string indent(2 * depth, ' ');
  text += indent + "<" + std::string(schema.name);
  if (schema.module != outer_module) text += " xmlns=\"" + std::string(namespace_of(schema.module)) + "\"";
  if (schema.type == Type::container || schema.type == Type::list) {
    if (data.children.empty()) {
      text += "/>\n";
      return;
    }
    text += ">\n";
    // The key of a list comes first.
    const auto is_key = [&](const Data& child) {
      return schema.type == Type::list && schema.is_key(child.schema->name);
    };
    for (const Data& child : data.children)
      if (is_key(child)) write_element(child, schema.module, depth + 1, text);
    for (const Data& child : data.children)
      if (!is_key(child)) write_element(child, schema.module, depth + 1, text);
    text += indent + "</" + std::string(schema.name) + ">\n";
    return;
  }
  if (schema.type == Type::empty) {
    text += "/>\n";
    return;
  }
  std::string value = data.text;
  if (const std::size_t colon = value.find(':'); schema.type == Type::identity && colon != std::string::npos) {
    text += " xmlns:id=\"" + std::string(namespace_of(value.substr(0, colon))) + "\"";
    value = "id" + value.substr(colon);
  }
  text += ">" + xml_escaped(value) + "</" + std::string(schema.name) + ">\n";
}

}  // namespace

std::string to_json(const Data& root) { return json::pretty(object_of(root)); }

std::string to_xml(const Data& root) {
  std::string text;
  for (const Data& child : root.children) write_element(child, {}, 0, text);
  return text;
}

}  // namespace takt::interchange::yang
