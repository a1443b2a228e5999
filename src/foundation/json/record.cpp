// SPDX-License-Identifier: Apache-2.0
#include "json/record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/reference.hpp"
#include "sim/check.hpp"

namespace takt::json {
namespace {

/// The records that one reaches, it first.
void collect(const Record& record, std::vector<const Record*>& all) {
  if (std::ranges::find(all, &record) != all.end()) return;
  all.push_back(&record);
  for (const Output& output : record.outputs) {
    const Shape* shape = output.shape;
    while (shape->item != nullptr) shape = shape->item;
    if (shape->record != nullptr) collect(shape->record(), all);
  }
}

/// What other records have spread into themselves stands there.
bool is_spread_only(const Record& record, const std::vector<const Record*>& all) {
  bool is_spread = false;
  for (const Record* const each : all)
    for (const Output& output : each->outputs) {
      const Shape* shape = output.shape;
      while (shape->item != nullptr) shape = shape->item;
      if (shape->record == nullptr || &shape->record() != &record) continue;
      if (!output.is_spread) return false;
      is_spread = true;
    }
  return is_spread;
}

Node text(std::string_view value) { return Node::of_string(value); }

Node with_description(Node schema, std::string_view help) {
  if (help.empty()) return schema;
  if (schema.find("$ref") != nullptr) {
    // Draft-07 ignores what stands beside a reference.
    Node list = Node::array();
    list.items.push_back(std::move(schema));
    schema = Node::object();
    schema.add("allOf", std::move(list));
  }
  schema.members.insert(schema.members.begin(), Member{"description", {}, text(help)});
  return schema;
}

constexpr std::string_view schema_type(Shape::Kind kind) {
  switch (kind) {
    case Shape::Kind::truth:
      return "boolean";
    case Shape::Kind::integer:
      return "integer";
    case Shape::Kind::real:
      return "number";
    case Shape::Kind::text:
      return "string";
    case Shape::Kind::list:
      return "array";
    case Shape::Kind::record:
    case Shape::Kind::map:
      return "object";
  }
  return "";
}

Node reference_to(const Record& record) {
  Node schema = Node::object();
  schema.add("$ref", text(fmt::format("#/definitions/{}", record.name)));
  return schema;
}

Node shape_schema(const Shape& shape) {
  Node schema;
  if (shape.kind == Shape::Kind::record) {
    schema = reference_to(shape.record());
    if (!shape.may_be_null) return schema;
    Node null = Node::object();
    null.add("type", text("null"));
    Node list = Node::array();
    list.items = {std::move(schema), std::move(null)};
    schema = Node::object();
    schema.add("anyOf", std::move(list));
    return schema;
  }
  schema = Node::object();
  if (shape.may_be_null) {
    Node types = Node::array();
    types.items = {text(schema_type(shape.kind)), text("null")};
    schema.add("type", std::move(types));
  } else {
    schema.add("type", text(schema_type(shape.kind)));
  }
  if (shape.kind == Shape::Kind::list) schema.add("items", shape_schema(*shape.item));
  if (shape.kind == Shape::Kind::map) schema.add("additionalProperties", shape_schema(*shape.item));
  return schema;
}

std::string_view unit_of(const Output& output) {
  if (!output.meaning.unit.empty()) return output.meaning.unit;
  const Shape* shape = output.shape;
  while (shape->item != nullptr) shape = shape->item;
  return shape->unit;
}

/// "How often (ppt; only with gPTP)."
std::string words_of(const Output& output) {
  std::string more(unit_of(output));
  if (!output.only.empty()) more += fmt::format("{}only {}", more.empty() ? "" : "; ", output.only);
  if (more.empty()) return std::string(output.help);
  return fmt::format("{} ({})", output.help, more);
}

/// Calls `use` with each output that stands in a record, those of spread ones among them, which are there only if what
/// was spread is.
template <class Use>
void each_output(const Record& record, Use use, const Output* spread = nullptr) {
  for (Output output : record.outputs) {
    if (spread != nullptr && spread->is_there != nullptr && output.is_there == nullptr) {
      output.is_there = spread->is_there;
      output.only = spread->only;
    }
    if (output.is_spread)
      each_output(output.shape->record(), use, &output);
    else
      use(output);
  }
}

Node row_schema(const Record& record) {
  Node items = Node::array();
  for (const Output& output : record.outputs)
    items.items.push_back(with_description(shape_schema(*output.shape), words_of(output)));
  const auto count = static_cast<sim::int128>(record.outputs.size());
  Node schema = Node::object();
  schema.add("type", text("array"));
  schema.add("items", std::move(items));
  schema.add("minItems", Node::of_integer(count));
  schema.add("maxItems", Node::of_integer(count));
  return with_description(std::move(schema), record.help);
}

Node object_schema(const Record& record) {
  if (record.is_row) return row_schema(record);
  Node properties = Node::object();
  Node required = Node::array();
  each_output(record, [&](const Output& output) {
    properties.add(output.name, with_description(shape_schema(*output.shape), words_of(output)));
    if (output.is_there == nullptr) required.items.push_back(text(output.name));
  });
  Node schema = Node::object();
  schema.add("type", text("object"));
  schema.add("properties", std::move(properties));
  if (!required.items.empty()) schema.add("required", std::move(required));
  schema.add("additionalProperties", Node::of_bool(false));
  return with_description(std::move(schema), record.help);
}

std::string title_of(const Record& record) {
  std::string title(record.name);
  std::ranges::replace(title, '_', ' ');
  return title;
}

std::string link_to(const Record& record) {
  std::string anchor(record.name);
  std::ranges::replace(anchor, '_', '-');
  return fmt::format("[{}](#{})", title_of(record), anchor);
}

std::string type_of(const Shape& shape, std::string_view keys) {
  std::string words;
  if (shape.kind == Shape::Kind::record)
    words = link_to(shape.record());
  else if (shape.kind == Shape::Kind::list)
    words = "list of " + type_of(*shape.item, {});
  else if (shape.kind == Shape::Kind::map)
    words = fmt::format("{} for each {}", type_of(*shape.item, {}), keys.empty() ? "name" : keys);
  else
    words = shape.kind == Shape::Kind::truth  ? "true or false"
            : shape.kind == Shape::Kind::text ? "text"
                                              : std::string(schema_type(shape.kind));
  return shape.may_be_null ? words + " or null" : words;
}

std::string section_of(const Record& record) {
  std::string page = record.help.empty() ? "" : fmt::format("{}\n\n", record.help);
  if (record.is_row) page += "An array of these, in this order.\n\n";
  page += "| key | value | unit | meaning |\n|---|---|---|---|\n";
  each_output(record, [&](const Output& output) {
    const std::string only = output.only.empty() ? "" : fmt::format("Only {}. ", output.only);
    const char* const whole =
        output.meaning.counts_from_start ? " Counts from the start of the run, whatever the warm-up." : "";
    page +=
        fmt::format("| `{}` | {} | {} | {}{}{} |\n", output.name, in_cell(type_of(*output.shape, output.meaning.keys)),
                    in_cell(unit_of(output)), in_cell(only), in_cell(output.help), whole);
  });
  return page + "\n";
}

}  // namespace

Node write_record(const Record& record, const void* object) {
  Node node = record.is_row ? Node::array() : Node::object();
  for (const Output& output : record.outputs) {
    if (output.is_there != nullptr && !output.is_there(object)) continue;
    Node value = output.write(object);
    if (record.is_row)
      node.items.push_back(std::move(value));
    else if (output.is_spread)
      std::ranges::move(value.members, std::back_inserter(node.members));
    else
      node.add(output.name, std::move(value));
  }
  return node;
}

Node record_schema(const Record& record, std::string_view title) {
  std::vector<const Record*> all;
  collect(record, all);
  Node definitions = Node::object();
  for (const Record* const each : all) {
    if (each == &record || is_spread_only(*each, all)) continue;
    TAKT_CHECK(definitions.find(each->name) == nullptr, "two records of one schema have different names");
    definitions.add(each->name, object_schema(*each));
  }
  Node schema = Node::object();
  schema.add("$schema", text("http://json-schema.org/draft-07/schema#"));
  schema.add("title", text(title));
  for (Member& member : object_schema(record).members) schema.members.push_back(std::move(member));
  if (!definitions.members.empty()) schema.add("definitions", std::move(definitions));
  return schema;
}

std::string record_reference(const Record& record, std::string_view title, std::string_view opening) {
  std::vector<const Record*> all;
  collect(record, all);
  std::string page = fmt::format("# {}\n\n{}\n\n{}", title, opening, section_of(record));
  for (const Record* const each : all)
    if (each != &record && !is_spread_only(*each, all))
      page += fmt::format("## {}\n\n{}", title_of(*each), section_of(*each));
  while (page.ends_with("\n\n")) page.pop_back();
  return page;
}

}  // namespace takt::json
