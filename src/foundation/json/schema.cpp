// SPDX-License-Identifier: Apache-2.0
// The JSON Schema (draft-07) of the tables (see table.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "json/table.hpp"
#include "sim/check.hpp"

namespace takt::json {

namespace {

Node of_type(std::string_view type) {
  Node schema = Node::object();
  schema.add("type", Node::of_string(type));
  return schema;
}

Node of_count(std::size_t count) { return Node::of_integer(static_cast<sim::int128>(count)); }

/// Adds text to the description, which stands first.
void describe_with(Node& schema, std::string_view text) {
  if (text.empty()) return;
  if (Node* description = schema.find("description")) {
    description->text = fmt::format("{} {}", text, description->text);
    return;
  }
  schema.members.insert(schema.members.begin(), Member{"description", {}, Node::of_string(text)});
}

Node any_of(std::vector<Node> schemas) {
  Node list = Node::array();
  list.items = std::move(schemas);
  Node schema = Node::object();
  schema.add("anyOf", std::move(list));
  return schema;
}

Node required_only(std::string_view name) {
  Node names = Node::array();
  names.items.push_back(Node::of_string(name));
  Node schema = Node::object();
  schema.add("required", std::move(names));
  return schema;
}

/// A rule about fields that may stand together, as a schema beside the others of its object.
Node group_schema(const Group& group) {
  Node list = Node::array();
  for (const std::string_view name : group.names) list.items.push_back(required_only(name));
  Node schema = Node::object();
  if (group.rule == Group::Rule::at_most_one) {
    // One of them, or none: "not any of them" is the further alternative.
    Node any = Node::object();
    any.add("anyOf", list);
    Node none = Node::object();
    none.add("not", std::move(any));
    list.items.push_back(std::move(none));
  }
  schema.add(group.rule == Group::Rule::at_least_one ? "anyOf" : "oneOf", std::move(list));
  return schema;
}

bool is_worth_showing(const Node& value) { return value.kind != Kind::object || value.members.empty(); }

/// The schema of a field's value with its description and, if it may be left out, its default.
Node field_schema(const Field& field, const void* prototype, SchemaBuilder& builder) {
  Node schema = field.codec->schema(field.bounds, builder);
  if (schema.find("$ref") != nullptr) {
    // Draft-07 ignores what stands beside a reference.
    Node list = Node::array();
    list.items.push_back(std::move(schema));
    schema = Node::object();
    schema.add("allOf", std::move(list));
  }
  describe_with(schema, field.help);
  const void* member = field.member(const_cast<void*>(prototype));
  const bool is_absent = field.codec->is_absent != nullptr && field.codec->is_absent(member);
  if (!field.is_required && !is_absent) {
    Node value = field.codec->encode(member);
    if (is_worth_showing(value)) schema.add("default", std::move(value));
  }
  return schema;
}

/// The schema of an object, in full. A tag, if any, is a further required member with one possible value.
Node object_schema(const Object& table, std::string_view tag_key, std::string_view tag, SchemaBuilder& builder) {
  check_table(table);
  struct Context {
    const Object& table;
    SchemaBuilder& builder;
    Node properties = Node::object();
    Node required = Node::array();
  };
  Context context{table, builder};
  if (!tag_key.empty()) {
    Node constant = Node::object();
    constant.add("const", Node::of_string(tag));
    context.properties.add(tag_key, std::move(constant));
    context.required.items.push_back(Node::of_string(tag_key));
  }
  const auto add_fields = [](const void* prototype, void* opaque) {
    auto& to = *static_cast<Context*>(opaque);
    for (const Field& field : to.table.fields) {
      to.properties.add(field.name, field_schema(field, prototype, to.builder));
      if (field.is_required) to.required.items.push_back(Node::of_string(field.name));
    }
  };
  table.with_prototype(add_fields, &context);

  Node schema = of_type("object");
  describe_with(schema, table.help);
  schema.add("properties", std::move(context.properties));
  if (!context.required.items.empty()) schema.add("required", std::move(context.required));
  schema.add("additionalProperties", Node::of_bool(false));
  if (!table.groups.empty()) {
    Node list = Node::array();
    for (const Group& group : table.groups) list.items.push_back(group_schema(group));
    schema.add("allOf", std::move(list));
  }
  return schema;
}

/// The schema of an object or of its shorthand.
Node full_schema(const Object& table, SchemaBuilder& builder) {
  Node schema = object_schema(table, "", "", builder);
  if (table.shorthand.empty()) return schema;
  const auto field = std::ranges::find(table.fields, table.shorthand, &Field::name);
  Node either = any_of({field->codec->schema(field->bounds, builder), std::move(schema)});
  describe_with(either, table.help);
  return either;
}

}  // namespace

bool SchemaBuilder::define(std::string_view name, const void* table) {
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    if (definitions_.members[i].key != name) continue;
    TAKT_CHECK(tables_[i] == table, "two tables of one schema have different names");
    return false;
  }
  definitions_.add(name, Node::object());  // holds the place while the table may refer to itself
  tables_.push_back(table);
  return true;
}

void SchemaBuilder::set(std::string_view name, Node schema) { *definitions_.find(name) = std::move(schema); }

Node SchemaBuilder::reference(const Object& object) {
  if (define(object.name, &object)) set(object.name, full_schema(object, *this));
  Node schema = Node::object();
  schema.add("$ref", Node::of_string("#/definitions/" + std::string(object.name)));
  return schema;
}

Node SchemaBuilder::reference(const Tagged& tagged) {
  if (define(tagged.name, &tagged)) {
    Node list = Node::array();
    for (const Option& option : tagged.options)
      list.items.push_back(object_schema(option.object(), tagged.key, option.tag, *this));
    Node schema = Node::object();
    describe_with(schema, tagged.help);
    schema.add("oneOf", std::move(list));
    set(tagged.name, std::move(schema));
  }
  Node schema = Node::object();
  schema.add("$ref", Node::of_string("#/definitions/" + std::string(tagged.name)));
  return schema;
}

Node bool_schema() { return of_type("boolean"); }

Node string_schema(const Bounds& bounds) {
  Node schema = of_type("string");
  // Lengths are in octets here and in characters in a schema: a schema that must accept all that decoding does can
  // promise a character for four octets, and one octet at least for a character.
  if (bounds.min_length > 0) schema.add("minLength", of_count((bounds.min_length + 3) / 4));
  if (bounds.max_length != std::numeric_limits<std::size_t>::max())
    schema.add("maxLength", of_count(bounds.max_length));
  return schema;
}

Node double_schema(const Bounds& bounds) {
  Node schema = of_type("number");
  if (bounds.has_min) schema.add(bounds.above_min ? "exclusiveMinimum" : "minimum", Node::of_double(bounds.min_real));
  if (bounds.has_max) schema.add("maximum", Node::of_double(bounds.max_real));
  return schema;
}

Node integer_schema(const Bounds& bounds) {
  // Validators hold numbers as doubles or as signed integers: a limit beyond both would refuse good values.
  constexpr sim::int128 largest_exact = sim::int128{1} << 53;
  Node schema = of_type("integer");
  if (bounds.min >= -largest_exact) schema.add("minimum", Node::of_integer(bounds.min));
  if (bounds.max <= largest_exact) schema.add("maximum", Node::of_integer(bounds.max));
  return schema;
}

Node quantity_schema(const Dimension& dimension, const Bounds& bounds) {
  const Sign sign = bounds.has_min && bounds.min < 0 ? Sign::any : Sign::not_negative;
  Node text = of_type("string");
  text.add("pattern", Node::of_string(quantity_pattern(dimension, sign)));
  // A schema cannot compare quantities: their range is told to the reader only.
  const std::string range = range_text(&dimension, bounds);
  const std::string words = fmt::format("({}{}{})", dimension.what, range.empty() ? "" : " ", range);
  if (&dimension != &probability_dimension) {
    describe_with(text, words);
    return text;
  }
  Bounds whole;
  whole.has_min = whole.has_max = true;
  whole.max_real = 1;
  Node schema = any_of({double_schema(whole), std::move(text)});
  describe_with(schema, words);
  return schema;
}

/// One string in either case, so that a field still has one type.
Node quantity_or_auto_schema(const Dimension& dimension, const Bounds& bounds) {
  Node schema = quantity_schema(dimension, bounds);
  Node& pattern = *schema.find("pattern");
  pattern = Node::of_string("^auto$|" + pattern.text);
  std::string& words = schema.find("description")->text;
  words.insert(words.rfind(')'), ", or \"auto\"");
  return schema;
}

Node sequence_schema(const Codec& item, const Bounds& bounds, SchemaBuilder& builder) {
  Bounds item_bounds = bounds;
  item_bounds.min_items = 0;
  item_bounds.max_items = std::numeric_limits<std::size_t>::max();
  item_bounds.unique_items = false;
  Node schema = of_type("array");
  schema.add("items", item.schema(item_bounds, builder));
  if (bounds.min_items > 0) schema.add("minItems", of_count(bounds.min_items));
  if (bounds.max_items != std::numeric_limits<std::size_t>::max()) schema.add("maxItems", of_count(bounds.max_items));
  if (bounds.unique_items) schema.add("uniqueItems", Node::of_bool(true));
  return schema;
}

Node mapping_schema(const Codec& value, const Bounds& bounds, SchemaBuilder& builder) {
  Bounds item_bounds = bounds;
  item_bounds.min_items = 0;
  item_bounds.max_items = std::numeric_limits<std::size_t>::max();
  Node names = Node::object();
  names.add("minLength", Node::of_integer(1));
  Node schema = of_type("object");
  schema.add("propertyNames", std::move(names));
  schema.add("additionalProperties", value.schema(item_bounds, builder));
  if (bounds.min_items > 0) schema.add("minProperties", of_count(bounds.min_items));
  if (bounds.max_items != std::numeric_limits<std::size_t>::max())
    schema.add("maxProperties", of_count(bounds.max_items));
  return schema;
}

Node schema_by(const Object& table, SchemaBuilder& builder) { return builder.reference(table); }

Node schema_by(const Tagged& table, SchemaBuilder& builder) { return builder.reference(table); }

Node schema_by(const Custom& table, SchemaBuilder& builder) { return table.schema(builder); }

Node schema_by(const Enumeration& table, SchemaBuilder&) {
  Node names = Node::array();
  std::string words;
  for (const EnumName& name : table.names) {
    names.items.push_back(Node::of_string(name.name));
    if (!name.help.empty()) words += fmt::format("{}\"{}\": {}", words.empty() ? "" : " ", name.name, name.help);
  }
  Node schema = of_type("string");
  describe_with(schema, words);
  schema.add("enum", std::move(names));
  return schema;
}

Node root_schema(const Object& table, std::string_view title) {
  SchemaBuilder builder;
  Node body = object_schema(table, "", "", builder);
  Node schema = Node::object();
  schema.add("$schema", Node::of_string("http://json-schema.org/draft-07/schema#"));
  schema.add("title", Node::of_string(title));
  Node& properties = *body.find("properties");
  if (properties.find("$schema") == nullptr) {
    Node link = of_type("string");
    describe_with(link, "The JSON Schema of this file, for editors; takt ignores it.");
    properties.members.insert(properties.members.begin(), Member{"$schema", {}, std::move(link)});
  }
  for (Member& member : body.members) schema.members.push_back(std::move(member));
  Node definitions = builder.release_definitions();
  if (!definitions.members.empty()) schema.add("definitions", std::move(definitions));
  return schema;
}

void check_table(const Object& table) {
  std::vector<std::string_view> names;
  for (const Field& field : table.fields) names.push_back(field.name);
  const auto is_field = [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); };
  for (const Group& group : table.groups)
    TAKT_CHECK(std::ranges::all_of(group.names, is_field), "a group names fields of its table");
  for (const Field& field : table.fields) {
    TAKT_CHECK(!field.help.empty(), "every field is documented");
    for (const Group& group : table.groups)
      TAKT_CHECK(!field.is_required || std::ranges::find(group.names, field.name) == group.names.end(),
                 "the fields of a group are optional");
    TAKT_CHECK(table.shorthand.empty() || !field.is_required || field.name == table.shorthand,
               "a shorthand leaves no required field open");
  }
  TAKT_CHECK(table.shorthand.empty() || is_field(table.shorthand), "the shorthand of a table is one of its fields");
  std::ranges::sort(names);
  TAKT_CHECK(std::ranges::adjacent_find(names) == names.end(), "the names of a table's fields differ");
}

}  // namespace takt::json
