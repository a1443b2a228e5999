// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/coverage.hpp"

#include <algorithm>

namespace takt::generator {
namespace {

class Walk {
 public:
  explicit Walk(Keys& keys) : keys_(keys) {}

  void object(const Node& node, const Definition& definition) {
    if (definition.short_form != nullptr && node.kind != json::Kind::object) {
      keys_.insert(definition.name + ":short");
      return value(node, *definition.short_form, definition.name + "." + definition.short_key);
    }
    for (const json::Member& member : node.members) {
      const std::string key = definition.name + "." + member.key;
      keys_.insert(key);
      if (member.key == definition.tag_key) continue;
      if (const Node* const schema = definition.properties->find(member.key)) value(member.value, *schema, key);
    }
  }

 private:
  void value(const Node& node, const Node& schema, const std::string& key) {
    const ValueForm form = schema_.form_of(schema);
    switch (form.kind) {
      case ValueForm::Kind::word:
        keys_.insert(key + "=" + node.text);
        break;
      case ValueForm::Kind::object:
        object(node, schema_.definition(form.definition));
        break;
      case ValueForm::Kind::tagged:
        tagged(node, form.definition);
        break;
      case ValueForm::Kind::list:
        for (const Node& item : node.items) value(item, *form.item, key);
        break;
      case ValueForm::Kind::map:
        for (const json::Member& member : node.members) value(member.value, *form.item, key);
        break;
      case ValueForm::Kind::other:  // one name, or several
        if (node.kind == json::Kind::array && node.items.size() > 1) keys_.insert(key + ":several");
        break;
      default:
        break;
    }
  }

  void tagged(const Node& node, const std::string& name) {
    for (const std::string& tag : schema_.options(name)) {
      const Definition& option = schema_.definition(tag == "clock" ? "clock-fault" : tag);
      if (const Node* const kind = node.find(option.tag_key); kind != nullptr && kind->text == tag) {
        keys_.insert(name + "=" + tag);
        return object(node, option);
      }
    }
  }

  const Schema& schema_ = Schema::of_scenarios();
  Keys& keys_;
};

/// The words of an enumeration, of a value or of the items of a list.
void add_words(const Node& schema, const std::string& key, Keys& keys) {
  const ValueForm form = Schema::of_scenarios().form_of(schema);
  for (const std::string& word : form.words) keys.insert(key + "=" + word);
  if (form.item != nullptr) add_words(*form.item, key, keys);
}

}  // namespace

Keys keys_of(const Node& scenario) {
  Keys keys;
  Walk(keys).object(scenario, Schema::of_scenarios().definition("scenario"));
  return keys;
}

Keys all_keys() {
  Keys keys;
  for (const Definition& definition : Schema::of_scenarios().definitions()) {
    if (definition.short_form != nullptr) keys.insert(definition.name + ":short");
    for (const json::Member& property : definition.properties->members) {
      keys.insert(definition.name + "." + property.key);
      add_words(property.value, definition.name + "." + property.key, keys);
    }
  }
  keys.erase("link.medium=10BASE-T1S");  // refused wherever it stands
  return keys;
}

}  // namespace takt::generator
