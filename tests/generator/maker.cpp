// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/maker.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::generator {

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}
std::string Draw::word(std::string_view words) { return any(words_of(words)); }

Node text(std::string_view value) { return Node::of_string(value); }
Node number(std::uint64_t value) { return Node::of_integer(value); }
Node list(std::vector<Node> items) {
  Node node = Node::array();
  node.items = std::move(items);
  return node;
}

std::string Scope::text(std::string_view key) const {
  const Node* const found = made->find(key);
  return found == nullptr ? std::string() : found->text;
}
const Scope* Scope::around(std::string_view kind) const {
  for (const Scope* each = outer; each != nullptr; each = each->outer)
    if (each->definition == kind) return each;
  return nullptr;
}

const RuleBook& RuleBook::get() {
  static const RuleBook book = [] {
    RuleBook made;
    const Keys known = all_keys();
    for (const auto& part : {network_rules(), port_rules(), ingress_rules(), traffic_rules(), fault_rules(),
                             clock_rules(), program_rules(), application_rules(), requirement_rules()}) {
      for (const Rule& rule : part) {
        if (!known.contains(rule.key) || !made.rules.emplace(rule.key, &rule).second)
          made.strays.emplace_back(rule.key);
      }
    }
    return made;
  }();
  return book;
}

namespace {

bool needs_rule(const ValueForm& form) {
  using Kind = ValueForm::Kind;
  return form.kind == Kind::text || form.kind == Kind::other || form.kind == Kind::number || form.kind == Kind::list ||
         form.kind == Kind::map || form.kind == Kind::tagged || (form.kind == Kind::quantity && !form.is_duration);
}

}  // namespace

std::vector<std::string> keys_without_rule() {
  std::vector<std::string> missing;
  for (const Definition& definition : Schema::of_scenarios().definitions()) {
    for (const json::Member& property : definition.properties->members) {
      const std::string key = definition.name + "." + property.key;
      if (property.key != definition.tag_key && !RuleBook::get().rules.contains(key) &&
          needs_rule(Schema::of_scenarios().form_of(property.value)))
        missing.push_back(key);
    }
  }
  return missing;
}

/// Makes the members of one object.
class Members {
 public:
  Members(Maker& maker, const Definition& definition, Node& object, const Scope& scope)
      : maker_(maker), definition_(definition), object_(object), scope_(scope) {}

  void make() {
    std::set<std::string, std::less<>> grouped;
    for (const Definition::Group& group : definition_.groups) grouped.insert(group.names.begin(), group.names.end());
    // What is the only one of its group, first: others depend on it.
    for (const Definition::Group& group : definition_.groups)
      if (group.rule != Definition::Group::Rule::at_most_one) one_of(group);
    for (const json::Member& property : definition_.properties->members) {
      if (property.key == definition_.tag_key || grouped.contains(property.key)) continue;
      add(property.key, property.value, definition_.required.contains(property.key));
    }
    for (const Definition::Group& group : definition_.groups) {
      if (group.rule != Definition::Group::Rule::at_most_one) continue;
      std::vector<std::string> names = group.names;
      maker_.draw.shuffle(names);
      for (const std::string& name : names)
        if (add(name, *definition_.properties->find(name), false)) break;
    }
  }

 private:
  /// The first whose rule wants it: in the order of chance, those with a greater share sooner.
  void one_of(const Definition::Group& group) {
    std::vector<std::string> names = group.names;
    maker_.draw.shuffle(names);
    for (const bool is_urgent : {false, true})
      for (const std::string& name : names)
        if (add(name, *definition_.properties->find(name), false, is_urgent)) return;
  }

  bool add(const std::string& key, const Node& schema, bool is_required, bool is_urgent = false) {
    const std::string full = definition_.name + "." + key;
    const auto found = RuleBook::get().rules.find(full);
    const Rule* const rule = found == RuleBook::get().rules.end() ? nullptr : found->second;
    if (!is_required && rule != nullptr && !maker_.wants(rule->feature)) return false;
    if (!is_required && !is_urgent && !maker_.draw.percent(rule != nullptr ? rule->percent : 30)) return false;
    std::optional<Node> made = maker_.by_rule(schema, full, rule, scope_);
    if (!made) return false;
    object_.add(key, std::move(*made));
    return true;
  }

  Maker& maker_;
  const Definition& definition_;
  Node& object_;
  const Scope& scope_;
};

Node Maker::fill(const Definition& definition, const Scope* outer, std::string name, std::size_t item,
                 std::string_view tag) {
  Node made = Node::object();
  if (!definition.tag_key.empty()) made.add(definition.tag_key, text(tag));
  Scope scope{outer, definition.name, &made, std::move(name), item};
  if (outer == nullptr) root_ = &made;
  Members(*this, definition, made, scope).make();
  return made;
}

Node Maker::object(std::string_view definition, const Scope* outer, std::string name, std::size_t item) {
  return fill(Schema::of_scenarios().definition(definition), outer, std::move(name), item, {});
}

Node Maker::short_or_object(std::string_view definition, const Scope* outer, std::string name) {
  const Definition& table = Schema::of_scenarios().definition(definition);
  Node made = object(definition, outer, std::move(name));
  // An object with only that member is what the short form stands for.
  if (table.short_form != nullptr && made.members.size() == 1 && made.members[0].key == table.short_key &&
      !draw.one_in(4)) {
    Node only = std::move(made.members[0].value);
    return only;
  }
  return made;
}

Node Maker::objects(std::string_view definition, std::size_t count, const Scope& outer) {
  Node items = Node::array();
  for (std::size_t i = 0; i < count; ++i) items.items.push_back(object(definition, &outer, {}, i));
  return items;
}

Node Maker::option(std::string_view tagged, std::string_view tag, const Scope* outer, std::string name,
                   std::size_t item) {
  TAKT_CHECK(std::ranges::count(Schema::of_scenarios().options(tagged), tag) == 1, "a tag of the schema");
  return fill(Schema::of_scenarios().definition(tag == "clock" ? "clock-fault" : tag), outer, std::move(name), item,
              tag);
}

std::optional<Node> Maker::by_rule(const Node& schema, const std::string& key, const Rule* rule, const Scope& scope) {
  if (rule != nullptr && rule->make != nullptr) return rule->make(*this, scope);
  if (rule == nullptr || rule->words.empty()) return value(schema, key, scope);
  const std::string chosen = draw.word(rule->words);
  const ValueForm form = Schema::of_scenarios().form_of(schema);
  if (form.kind == ValueForm::Kind::boolean) return Node::of_bool(chosen == "true");
  const bool is_number =
      form.kind == ValueForm::Kind::number ||
      (form.kind == ValueForm::Kind::other && chosen.find_first_not_of("-+.0123456789e") == std::string::npos);
  return is_number ? Node::of_literal(chosen) : text(chosen);
}

/// What the schema alone can say.
std::optional<Node> Maker::value(const Node& schema, const std::string& key, const Scope& scope) {
  const ValueForm form = Schema::of_scenarios().form_of(schema);
  switch (form.kind) {
    case ValueForm::Kind::boolean:
      return Node::of_bool(draw.one_in(2));
    case ValueForm::Kind::word:
      return text(draw.any(form.words));
    case ValueForm::Kind::object:
      return short_or_object(form.definition, &scope);
    case ValueForm::Kind::quantity:
      if (form.is_duration) return word("1us 10us 100us 1ms");
      break;
    default:
      break;
  }
  TAKT_CHECK(false, ("a rule for the key " + key).c_str());
}

Node Maker::word(std::string_view words) {
  const std::string chosen = draw.word(words);
  return chosen.find_first_not_of("-+.0123456789") == std::string::npos ? Node::of_literal(chosen) : text(chosen);
}

Node Maker::instant() {
  const std::uint64_t us = duration_us * draw.below(16) / 16;
  switch (draw.below(4)) {
    case 0:
      return text(std::to_string(us) + "us");
    case 1:
      return text(std::to_string(us * 1000 + draw.below(1000)) + "ns");
    case 2:
      return text(std::to_string(us / 100 * 100) + "us");
    default:
      return text(std::to_string(us + draw.below(std::max<std::uint64_t>(1, duration_us / 16))) + "us");
  }
}

std::vector<int> Maker::classes(std::size_t n, const std::vector<int>& without) {
  std::vector<int> set;
  for (int q = 0; q < 8; ++q)
    if (draw.one_in(n) && std::ranges::find(without, q) == without.end()) set.push_back(q);
  return set;
}

}  // namespace takt::generator
