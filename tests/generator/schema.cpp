// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/schema.hpp"

#include <algorithm>

#include "scenario/description/description.hpp"
#include "sim/check.hpp"

namespace takt::generator {
namespace {

std::string text_of(const Node* node) { return node == nullptr ? std::string() : node->text; }

const Node* without_reference(const Node& schema) {
  // {"description", "allOf": [{"$ref"}], "default"} is a reference with something beside it.
  const Node* const all = schema.find("allOf");
  return all != nullptr && all->items.size() == 1 && all->items[0].find("$ref") != nullptr ? &all->items[0] : &schema;
}

std::string referred(const Node& schema) {
  const std::string text = text_of(without_reference(schema)->find("$ref"));
  return text.empty() ? text : text.substr(text.rfind('/') + 1);
}

/// A rule about members that may stand together.
Definition::Group group_of(const Node& rule) {
  Definition::Group group;
  const Node* list = rule.find("anyOf");
  group.rule = Definition::Group::Rule::at_least_one;
  if (list == nullptr) {
    list = rule.find("oneOf");
    group.rule = Definition::Group::Rule::exactly_one;
  }
  for (const Node& each : list->items) {
    if (each.find("not") != nullptr) group.rule = Definition::Group::Rule::at_most_one;
    if (const Node* const required = each.find("required")) group.names.push_back(required->items.at(0).text);
  }
  return group;
}

/// The member whose schema is that of the short form, but for descriptions and defaults.
std::string key_of_short_form(const Definition& definition) {
  const auto bare = [](Node schema) {
    std::erase_if(schema.members,
                  [](const json::Member& member) { return member.key == "description" || member.key == "default"; });
    return json::compact(schema);
  };
  for (const std::string_view first : {"fixed", "offset", "null"})  // where several members look alike
    if (const Node* const property = definition.properties->find(first);
        property != nullptr && bare(*property) == bare(*definition.short_form))
      return std::string(first);
  for (const json::Member& property : definition.properties->members)
    if (bare(property.value) == bare(*definition.short_form)) return property.key;
  TAKT_CHECK(false, "a short form stands for one member");
}

}  // namespace

const Schema& Schema::of_scenarios() {
  static const Schema schema;
  return schema;
}

Schema::Schema() : tree_(json::schema_tree<scenario::Scenario>("takt scenario")) {
  const Node& definitions = *tree_.find("definitions");
  add("scenario", tree_, "");
  for (const json::Member& member : definitions.members) {
    const Node* const options = member.value.find("oneOf");
    if (options == nullptr) {
      add(member.key, member.value, "");
      continue;
    }
    TaggedObject tagged{member.key, {}};
    for (const Node& option : options->items) {
      for (const json::Member& property : option.find("properties")->members) {
        const Node* const tag = property.value.find("const");
        if (tag == nullptr) continue;
        tagged.tags.push_back(tag->text);
        add(tag->text, option, property.key);
      }
    }
    tagged_.push_back(std::move(tagged));
  }
  std::ranges::sort(definitions_, {}, &Definition::name);
  // "clock" is a fault and an oscillator: the fault is called by its tag and its kind.
  for (std::size_t i = 1; i < definitions_.size(); ++i)
    TAKT_CHECK(definitions_[i].name != definitions_[i - 1].name, "definitions have names of their own");
}

void Schema::add(std::string name, const Node& object, std::string tag_key) {
  Definition definition;
  definition.name = tag_key.empty() ? name : name == "clock" ? "clock-fault" : name;
  definition.tag_key = std::move(tag_key);
  const Node* body = &object;
  if (const Node* const either = object.find("anyOf"); either != nullptr && object.find("properties") == nullptr) {
    definition.short_form = &either->items.at(0);
    body = &either->items.at(1);
  }
  definition.properties = body->find("properties");
  TAKT_CHECK(definition.properties != nullptr, "a definition is an object");
  if (const Node* const required = body->find("required"))
    for (const Node& each : required->items) definition.required.insert(each.text);
  if (const Node* const rules = body->find("allOf"))
    for (const Node& rule : rules->items) definition.groups.push_back(group_of(rule));
  if (definition.short_form != nullptr) definition.short_key = key_of_short_form(definition);
  definitions_.push_back(std::move(definition));
}

const Definition& Schema::definition(std::string_view name) const {
  const auto found = std::ranges::lower_bound(definitions_, name, {},
                                              [](const Definition& each) -> std::string_view { return each.name; });
  TAKT_CHECK(found != definitions_.end() && found->name == name, "the schema has the definition");
  return *found;
}

bool Schema::has(std::string_view name) const {
  return std::ranges::any_of(definitions_, [&](const Definition& each) { return each.name == name; });
}

std::vector<std::string> Schema::options(std::string_view tagged) const {
  for (const TaggedObject& each : tagged_)
    if (each.name == tagged) return each.tags;
  TAKT_CHECK(false, "the schema has the tagged object");
}

ValueForm Schema::form_of(const Node& schema) const {
  using Kind = ValueForm::Kind;
  ValueForm form;
  if (const std::string name = referred(schema); !name.empty()) {
    const bool is_tagged = std::ranges::any_of(tagged_, [&](const TaggedObject& each) { return each.name == name; });
    form.kind = is_tagged ? Kind::tagged : Kind::object;
    form.definition = name;
    return form;
  }
  if (const Node* const names = schema.find("enum")) {
    form.kind = Kind::word;
    for (const Node& name : names->items) form.words.push_back(name.text);
    return form;
  }
  const std::string type = text_of(schema.find("type"));
  if (type == "boolean")
    form.kind = Kind::boolean;
  else if (type == "integer" || type == "number")
    form.kind = Kind::number;
  else if (type == "string")
    form.kind = schema.find("pattern") != nullptr ? Kind::quantity : Kind::text;
  else if (type == "array")
    form.kind = Kind::list;
  else if (type == "object")
    form.kind = Kind::map;
  else
    form.kind = Kind::other;
  if (form.kind == Kind::quantity)
    form.is_duration = text_of(schema.find("description")).find("(a duration") != std::string::npos;
  if (form.kind == Kind::list) {
    form.item = schema.find("items");
    if (const Node* const least = schema.find("minItems"))
      form.least = static_cast<std::size_t>(*json::integer_of(*least));
    if (const Node* const most = schema.find("maxItems"))
      form.most = static_cast<std::size_t>(*json::integer_of(*most));
  }
  if (form.kind == Kind::map) form.item = schema.find("additionalProperties");
  return form;
}

}  // namespace takt::generator
