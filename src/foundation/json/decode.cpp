// SPDX-License-Identifier: Apache-2.0
// Reading values by tables (see table.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "json/printable.hpp"
#include "json/prose.hpp"
#include "json/suggest.hpp"
#include "json/table.hpp"
#include "sim/check.hpp"

namespace takt::json {

namespace {

constexpr const char* control_in_a_name = "a control character in a name";
constexpr const char* printable_name = "characters that are seen: names stand in scripts, tables and terminals";

/// What is printed, or written into a script or table, must not act there.
bool has_only_printable(const Node& node, Reader& reader) {
  if (find_control(node.text) == std::string_view::npos) return true;
  reader.error(node, control_in_a_name, {excerpt(node), printable_name, ""});
  return false;
}

std::string joined(std::string_view what, const std::string& range) {
  return range.empty() ? std::string(what) : fmt::format("{} {}", what, range);
}

std::string items_text(const Bounds& bounds, std::string_view what) {
  const bool has_max = bounds.max_items != std::numeric_limits<std::size_t>::max();
  if (has_max && bounds.min_items == bounds.max_items) return fmt::format("exactly {} {}", bounds.min_items, what);
  if (has_max && bounds.min_items > 0) return fmt::format("{} to {} {}", bounds.min_items, bounds.max_items, what);
  return has_max ? fmt::format("at most {} {}", bounds.max_items, what)
                 : fmt::format("at least {} {}", bounds.min_items, what);
}

void check_number_of_items(const Node& node, std::size_t count, std::string_view what, const Bounds& bounds,
                           Reader& reader) {
  if (count < bounds.min_items)
    reader.error(node, fmt::format("too few {}", what), {std::to_string(count), items_text(bounds, what), ""});
  else if (count > bounds.max_items)
    reader.error(node, fmt::format("too many {}", what), {std::to_string(count), items_text(bounds, what), ""});
}

/// Reports each item that is written like an earlier one.
void check_unique(const Node& array, Reader& reader) {
  struct Written {
    std::string text;
    std::size_t index;
  };
  std::vector<Written> all;
  for (const Node& item : array.items) all.push_back({compact(item), all.size()});
  std::ranges::sort(
      all, [](const Written& a, const Written& b) { return std::tie(a.text, a.index) < std::tie(b.text, b.index); });
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].text == all[i - 1].text)
      reader.error(array.items[all[i].index], "occurs twice",
                   {excerpt(array.items[all[i].index]), "items that differ", ""});
}

std::string range_or_kind(std::string_view what, const Bounds& bounds) {
  return joined(what, range_text(nullptr, bounds));
}

bool within(sim::int128 value, const Bounds& bounds) {
  if (bounds.has_min && (value < bounds.min || (bounds.above_min && value == bounds.min))) return false;
  return !bounds.has_max || value <= bounds.max;
}

/// The field of a name, or null.
const Field* find_field(const Object& table, std::string_view name) {
  const auto found = std::ranges::find(table.fields, name, &Field::name);
  return found == table.fields.end() ? nullptr : &*found;
}

void report_unknown(const Object& table, const Member& member, std::string_view tag_key, Reader& reader) {
  // Nobody will see what is near to the millionth wrong name.
  if (reader.diagnostics().full()) return reader.error_at_key(member, "unknown field");
  std::vector<std::string_view> names;
  if (!tag_key.empty()) names.push_back(tag_key);
  for (const Field& field : table.fields) names.push_back(field.name);
  const std::string nearest = suggest(member.key, names);
  // A near name says enough; without one the user sees what there is.
  reader.error_at_key(member, "unknown field " + quote(member.key),
                      {"", nearest.empty() ? "one of " + list_text(names) : "", nearest});
}

void check_group(const Group& group, const Node& node, Reader& reader) {
  std::vector<std::string_view> present;
  for (const std::string_view name : group.names)
    if (node.find(name) != nullptr) present.push_back(name);
  const bool too_few = present.empty() && group.rule != Group::Rule::at_most_one;
  const bool too_many = present.size() > 1 && group.rule != Group::Rule::at_least_one;
  if (!too_few && !too_many) return;

  const std::string_view number = group.rule == Group::Rule::exactly_one   ? "exactly one"
                                  : group.rule == Group::Rule::at_most_one ? "at most one"
                                                                           : "at least one";
  const std::string expected = fmt::format("{} of {}", number, list_text(group.names));
  if (too_few) {
    for (const std::string_view name : group.names)
      reader.diagnostics().note_refused(reader.source(node).at(name).pointer);
    return reader.error(node, "a field is missing", {"", expected, ""});
  }
  reader.error(*node.find(present[1]), "fields that exclude each other",
               {fmt::format("\"{}\" beside \"{}\"", present[1], present[0]), expected, ""});
}

void decode_shorthand(const Object& table, const Node& node, void* value, Reader& reader) {
  const Field* field = find_field(table, table.shorthand);
  TAKT_CHECK(field != nullptr, "the shorthand of a table is one of its fields");
  field->codec->decode(node, field->member(value), field->bounds, reader);
}

void report_missing(std::string_view name, const Node& node, Reader& reader) {
  reader.diagnostics().note_refused(reader.source(node).at(name).pointer);
  reader.error(node, fmt::format("the field \"{}\" is missing", name));
}

/// The members of an object by a table; the member tag_key, if any, has been read already.
void decode_members(const Object& table, const Node& node, std::string_view tag_key, void* value, Reader& reader) {
  if (table.where != nullptr) *table.where(value) = reader.source(node);
  std::vector<bool> is_present(table.fields.size());
  for (const Member& member : node.members) {
    if (!tag_key.empty() && member.key == tag_key) continue;
    if (const Field* field = find_field(table, member.key)) {
      is_present[static_cast<std::size_t>(field - table.fields.data())] = true;
      field->codec->decode(member.value, field->member(value), field->bounds, reader);
    } else if (reader.is_root(node) && member.key == "$schema") {
      if (member.value.kind != Kind::string) reader.wrong_type(member.value, "a string that names a JSON Schema");
    } else {
      report_unknown(table, member, tag_key, reader);
    }
  }
  for (const Field& field : table.fields)
    if (field.is_required && !is_present[static_cast<std::size_t>(&field - table.fields.data())])
      report_missing(field.name, node, reader);
  for (const Group& group : table.groups) check_group(group, node, reader);
}

}  // namespace

std::string list_text(std::span<const std::string_view> names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
    list += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == names.size() ? " or " : ", ", names[i]);
  return list;
}

std::string range_text(const Dimension* dimension, const Bounds& bounds) {
  const auto text = [dimension](sim::int128 value) {
    return dimension == nullptr ? to_text(value) : quantity_text(*dimension, value);
  };
  const std::string_view above = bounds.above_min ? "above" : "from";
  if (bounds.has_min && bounds.has_max)
    return fmt::format("{} {} {} {}", above, text(bounds.min), bounds.above_min ? "and up to" : "to", text(bounds.max));
  if (bounds.has_min) return fmt::format("{} {}", bounds.above_min ? "above" : "of at least", text(bounds.min));
  return bounds.has_max ? "of at most " + text(bounds.max) : "";
}

std::string range_text_of_double(const Bounds& bounds) {
  const std::string_view above = bounds.above_min ? "above" : "from";
  if (bounds.has_min && bounds.has_max)
    return fmt::format("{} {} {} {}", above, bounds.min_real, bounds.above_min ? "and up to" : "to", bounds.max_real);
  if (bounds.has_min) return fmt::format("{} {}", bounds.above_min ? "above" : "of at least", bounds.min_real);
  return bounds.has_max ? fmt::format("of at most {}", bounds.max_real) : "";
}

void decode_bool(const Node& node, bool& value, Reader& reader) {
  if (node.kind != Kind::boolean) return reader.wrong_type(node, "true or false");
  value = node.boolean;
}

void decode_string(const Node& node, std::string& value, const Bounds& bounds, Reader& reader) {
  if (node.kind != Kind::string) return reader.wrong_type(node, "a string");
  if (node.text.size() < bounds.min_length)
    return reader.error(node, node.text.empty() ? "an empty string" : "a string that is too short",
                        {excerpt(node), fmt::format("at least {} octets", bounds.min_length), ""});
  if (node.text.size() > bounds.max_length)
    return reader.error(node, "a string that is too long",
                        {fmt::format("{} octets", node.text.size()), fmt::format("at most {}", bounds.max_length), ""});
  if (!has_only_printable(node, reader)) return;
  value = node.text;
}

void decode_prose(const Node& node, std::string& value, Reader& reader) {
  if (node.kind != Kind::string) return reader.wrong_type(node, "a string");
  for (std::string_view rest = node.text; !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of("\n\t"), rest.size());
    if (find_control(rest.substr(0, end)) != std::string_view::npos)
      return reader.error(node, "a control character",
                          {excerpt(node), "a text of characters that are seen, line feeds and tabs", ""});
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  value = node.text;
}

void decode_double(const Node& node, double& value, const Bounds& bounds, Reader& reader) {
  const std::string expected = joined("a number", range_text_of_double(bounds));
  if (node.kind != Kind::number) return reader.wrong_type(node, expected);
  const double number = double_of(node);
  const bool is_below = bounds.has_min && (number < bounds.min_real || (bounds.above_min && number == bounds.min_real));
  if (is_below || (bounds.has_max && number > bounds.max_real))
    return reader.error(node, "out of range", {node.text, expected, ""});
  value = number;
}

bool decode_integer(const Node& node, sim::int128& value, const Bounds& bounds, Reader& reader) {
  if (node.kind != Kind::number) {
    reader.wrong_type(node, range_or_kind("an integer", bounds));
    return false;
  }
  const bool is_literal_integer = node.text.find_first_of(".eE") == std::string::npos;
  const auto number = integer_of(node);
  if (!is_literal_integer || !number || !within(*number, bounds)) {
    reader.error(node, is_literal_integer ? "out of range" : "not an integer",
                 {excerpt(node), range_or_kind("an integer", bounds), ""});
    return false;
  }
  value = *number;
  return true;
}

bool decode_quantity(const Node& node, sim::int128& value, const Dimension& dimension, const Bounds& bounds,
                     Reader& reader) {
  const bool is_plain_number = node.kind == Kind::number && &dimension == &probability_dimension;
  if (node.kind != Kind::string && !is_plain_number) {
    // The commonest mistake is to leave out quotes and unit.
    reader.wrong_type(node, fmt::format("{} such as {}\"{}\"", dimension.what,
                                        node.kind == Kind::number ? "the string " : "", dimension.example));
    return false;
  }
  const Sign sign = bounds.has_min && bounds.min < 0 ? Sign::any : Sign::not_negative;
  const auto number = parse_quantity(dimension, node.text, sign);
  if (!number) {
    const Reason& reason = number.reason();
    reader.error(node, reason.message,
                 {is_plain_number ? node.text.substr(0, 40) : quote(node.text), reason.expected, reason.suggestion});
    return false;
  }
  if (!within(*number, bounds)) {
    reader.error(node, "out of range", {quote(node.text), joined(dimension.what, range_text(&dimension, bounds)), ""});
    return false;
  }
  value = *number;
  return true;
}

void decode_sequence(const Node& node, void* value, const Sequence& sequence, const Bounds& bounds, Reader& reader) {
  if (node.kind != Kind::array) return reader.wrong_type(node, "an array");
  check_number_of_items(node, node.items.size(), "items", bounds, reader);
  if (bounds.unique_items) check_unique(node, reader);
  Bounds item_bounds = bounds;
  item_bounds.min_items = 0;
  item_bounds.max_items = std::numeric_limits<std::size_t>::max();
  item_bounds.unique_items = false;
  sequence.clear(value);
  for (const Node& item : node.items) sequence.item->decode(item, sequence.append(value), item_bounds, reader);
}

void decode_mapping(const Node& node, void* value, const Mapping& mapping, const Bounds& bounds, Reader& reader) {
  if (node.kind != Kind::object) return reader.wrong_type(node, "an object whose members are named freely");
  check_number_of_items(node, node.members.size(), "members", bounds, reader);
  Bounds item_bounds = bounds;
  item_bounds.min_items = 0;
  item_bounds.max_items = std::numeric_limits<std::size_t>::max();
  mapping.clear(value);
  for (const Member& member : node.members) {
    if (member.key.empty()) reader.error_at_key(member, "an empty name");
    if (find_control(member.key) != std::string_view::npos)
      reader.error_at_key(member, control_in_a_name, {quote(member.key), printable_name, ""});
    mapping.value->decode(member.value, mapping.append(value, member.key), item_bounds, reader);
  }
}

void decode_by(const Object& table, const Node& node, void* value, Reader& reader) {
  if (node.kind == Kind::object) return decode_members(table, node, "", value, reader);
  if (table.shorthand.empty() || node.kind == Kind::null || reader.is_root(node))
    return reader.wrong_type(node, "an object");
  if (table.where != nullptr) *table.where(value) = reader.source(node);
  decode_shorthand(table, node, value, reader);
}

void decode_by(const Enumeration& table, const Node& node, void* value, Reader& reader) {
  std::vector<std::string_view> names;
  for (const EnumName& name : table.names) names.push_back(name.name);
  if (node.kind != Kind::string) return reader.wrong_type(node, fmt::format("{}: {}", table.what, list_text(names)));
  const auto found = std::ranges::find(table.names, std::string_view(node.text), &EnumName::name);
  if (found == table.names.end())
    return reader.error(node, "unknown name for " + std::string(table.what),
                        {quote(node.text), list_text(names), suggest(node.text, names)});
  table.set(value, found->value);
}

void decode_by(const Tagged& table, const Node& node, void* value, Reader& reader) {
  std::vector<std::string_view> tags;
  for (const Option& option : table.options) tags.push_back(option.tag);
  if (node.kind != Kind::object) return reader.wrong_type(node, "an object");
  const Node* tag = node.find(table.key);
  if (tag == nullptr)
    return reader.error(node, fmt::format("the field \"{}\" is missing", table.key), {"", list_text(tags), ""});
  if (tag->kind != Kind::string) return reader.wrong_type(*tag, list_text(tags));
  const auto option = std::ranges::find(table.options, std::string_view(tag->text), &Option::tag);
  if (option == table.options.end())
    return reader.error(*tag, fmt::format("unknown {}", table.key),
                        {quote(tag->text), list_text(tags), suggest(tag->text, tags)});
  decode_members(option->object(), node, table.key, option->emplace(value), reader);
}

void decode_by(const Custom& table, const Node& node, void* value, Reader& reader) {
  table.decode(node, value, reader);
}

}  // namespace takt::json
