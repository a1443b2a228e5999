// SPDX-License-Identifier: Apache-2.0
#include "json/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "sim/check.hpp"

namespace takt::json {

namespace {

constexpr std::string_view reference_prefix = "#/definitions/";

std::string_view text_of(const Node& node, std::string_view key) {
  const Node* const member = node.find(key);
  return member == nullptr ? std::string_view() : std::string_view(member->text);
}

/// "operating_system" is the section "operating system".
std::string title_of(std::string_view definition) {
  std::string title(definition);
  std::ranges::replace(title, '_', ' ');
  return title;
}

std::string link_to(std::string_view definition) {
  std::string anchor(definition);
  std::ranges::replace(anchor, '_', '-');
  return fmt::format("[{}](#{})", title_of(definition), anchor);
}

/// A cell ends at a bar, wherever it stands.
/// What a schema says of a value: what may stand there, and what that means.
struct Value {
  std::string type;
  std::string meaning;
};

/// A quantity's range stands in parentheses at the end of its description (quantity_schema): here it is the type.
void decode_range(Value& value) {
  if (!value.meaning.ends_with(')')) return;
  const std::size_t begin = value.meaning.rfind('(');
  value.type = value.meaning.substr(begin + 1, value.meaning.size() - begin - 2);
  value.meaning.resize(begin == 0 ? 0 : begin - 1);
}

std::string range_of(const Node& schema, std::string_view least, std::string_view most) {
  const std::string_view low = text_of(schema, least), high = text_of(schema, most);
  if (low.empty() && high.empty()) return "";
  if (low.empty()) return fmt::format(", at most {}", high);
  if (high.empty()) return fmt::format(", at least {}", low);
  return low == high ? fmt::format(", {}", low) : fmt::format(", {} to {}", low, high);
}

std::string type_of(const Node& schema);

std::string list_type(const Node& schema) {
  return fmt::format("list of {}{}", type_of(*schema.find("items")), range_of(schema, "minItems", "maxItems"));
}

std::string choice_of(const Node& list) {
  std::string words;
  for (const Node& item : list.items) words += fmt::format("{}{}", words.empty() ? "" : " or ", type_of(item));
  return words;
}

std::string names_of(const Node& list) {
  std::string words;
  for (const Node& item : list.items) words += fmt::format("{}`{}`", words.empty() ? "" : ", ", compact(item));
  return words;
}

std::string type_of(const Node& schema) {
  if (const Node* const target = schema.find("$ref"))
    return link_to(std::string_view(target->text).substr(reference_prefix.size()));
  if (const Node* const constant = schema.find("const")) return fmt::format("`{}`", compact(*constant));
  if (const Node* const names = schema.find("enum")) return names_of(*names);
  if (const Node* const list = schema.find("anyOf")) return choice_of(*list);
  if (const Node* const list = schema.find("oneOf")) return choice_of(*list);
  if (schema.find("pattern") != nullptr) {
    Value value{.type = {}, .meaning = std::string(text_of(schema, "description"))};
    decode_range(value);
    if (!value.type.empty()) return value.type;
  }
  const std::string_view type = text_of(schema, "type");
  if (type == "array") return list_type(schema);
  if (type == "object") {
    const Node* const each = schema.find("additionalProperties");
    return each != nullptr && each->kind == Kind::object
               ? fmt::format("object: a name, and {} for each", type_of(*each))
               : "object";
  }
  if (type == "integer") return "integer" + range_of(schema, "minimum", "maximum");
  if (type == "number") {
    const std::string_view above = text_of(schema, "exclusiveMinimum");
    return above.empty() ? "number" + range_of(schema, "minimum", "maximum")
                         : fmt::format("number above {}{}", above, range_of(schema, "", "maximum"));
  }
  return type.empty() ? "any value" : std::string(type);
}

Value value_of(const Node& schema) {
  // A reference with a description beside it stands in an "allOf" of one (field_schema).
  const Node* const list = schema.find("allOf");
  const Node& inner = list != nullptr && list->items.size() == 1 && list->items.front().find("$ref") != nullptr
                          ? list->items.front()
                          : schema;
  Value value{.type = {}, .meaning = std::string(text_of(schema, "description"))};
  if (schema.find("pattern") != nullptr || schema.find("anyOf") != nullptr) decode_range(value);
  if (value.type.empty()) value.type = type_of(inner);
  return value;
}

std::string default_of(const Node& schema, bool is_required) {
  if (is_required) return "**required**";
  const Node* const value = schema.find("default");
  return value == nullptr ? "" : fmt::format("`{}`", compact(*value));
}

/// The names in [{"required": ["a"]}, {"required": ["b"]}].
std::string group_names(const Node& list) {
  std::string words;
  for (const Node& item : list.items)
    if (const Node* const names = item.find("required"))
      words += fmt::format("{}`{}`", words.empty() ? "" : ", ", names->items.front().text);
  return words;
}

/// The rules about keys that may stand together (group_schema).
std::string rules_of(const Node& object) {
  const Node* const groups = object.find("allOf");
  if (groups == nullptr) return "";
  std::string text;
  for (const Node& group : groups->items) {
    const Node* const any = group.find("anyOf");
    const Node* const one = group.find("oneOf");
    TAKT_CHECK(any != nullptr || one != nullptr, "a group of keys is a choice");
    const Node& list = any != nullptr ? *any : *one;
    const bool may_be_none = list.items.back().find("not") != nullptr;
    text += fmt::format("{} of {}.\n",
                        any != nullptr ? "At least one"
                        : may_be_none  ? "At most one"
                                       : "Exactly one",
                        group_names(list));
  }
  return text + "\n";
}

std::string table_of(const Node& object) {
  const Node* const required = object.find("required");
  const auto is_required = [&](std::string_view key) {
    return required != nullptr &&
           std::ranges::any_of(required->items, [&](const Node& name) { return name.text == key; });
  };
  std::string text = "| key | value | without it | meaning |\n|---|---|---|---|\n";
  for (const Member& member : object.find("properties")->members) {
    const Value value = value_of(member.value);
    text += fmt::format("| `{}` | {} | {} | {} |\n", member.key, in_cell(value.type),
                        in_cell(default_of(member.value, is_required(member.key))), in_cell(value.meaning));
  }
  return text + "\n" + rules_of(object);
}

/// One of several kinds of object, told apart by a member with one possible value.
const Member* tag_of(const Node& option) {
  const Node* const properties = option.find("properties");
  if (properties == nullptr || properties->members.empty()) return nullptr;
  const Member& first = properties->members.front();
  return first.value.find("const") == nullptr ? nullptr : &first;
}

std::string body_of(const Node& schema) {
  const std::string_view description = text_of(schema, "description");
  std::string text = description.empty() ? "" : fmt::format("{}\n\n", description);
  if (schema.find("properties") != nullptr) return text + table_of(schema);
  if (const Node* const options = schema.find("oneOf");
      options != nullptr && std::ranges::all_of(options->items, tag_of)) {
    for (const Node& option : options->items) {
      const Member& tag = *tag_of(option);
      text += fmt::format("**`\"{}\": {}`** {}\n\n{}", tag.key, compact(*tag.value.find("const")),
                          text_of(option, "description"), table_of(option));
    }
    return text;
  }
  if (const Node* const options = schema.find("anyOf")) {
    // A shorthand, or the object in full (full_schema).
    for (const Node& option : options->items)
      text += option.find("properties") != nullptr ? "Or an object:\n\n" + table_of(option)
                                                   : fmt::format("Either {}.\n\n", type_of(option));
    return text;
  }
  return text + fmt::format("Value: {}.\n\n", type_of(schema));
}

}  // namespace

std::string in_cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string reference(const Node& schema, std::string_view opening) {
  std::string text = fmt::format("# {}\n\n{}\n\n{}", text_of(schema, "title"), opening, body_of(schema));
  if (const Node* const definitions = schema.find("definitions"))
    for (const Member& definition : definitions->members)
      text += fmt::format("## {}\n\n{}", title_of(definition.key), body_of(definition.value));
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace takt::json
