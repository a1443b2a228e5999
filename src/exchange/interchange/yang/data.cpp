// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/data.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "json/node.hpp"
#include "json/suggest.hpp"
#include "sim/check.hpp"

namespace takt::interchange::yang {
namespace {

constexpr std::array<std::string_view, 8> digits = {"zero", "one", "two", "three", "four", "five", "six", "seven"};

struct Range {
  std::uint64_t most;
  bool is_signed;
};

std::optional<Range> range_of(Type type) {
  switch (type) {
    case Type::uint8:
      return Range{0xFF, false};
    case Type::uint16:
      return Range{0xFFFF, false};
    case Type::uint32:
      return Range{0xFFFF'FFFF, false};
    case Type::uint64:
      return Range{~std::uint64_t{0}, false};
    case Type::int8:
      return Range{0x7F, true};
    case Type::int16:
      return Range{0x7FFF, true};
    case Type::int32:
      return Range{0x7FFF'FFFF, true};
    case Type::int64:
      return Range{0x7FFF'FFFF'FFFF'FFFF, true};
    default:
      return std::nullopt;
  }
}

std::vector<std::string_view> split(std::string_view choices) {
  std::vector<std::string_view> parts;
  while (!choices.empty()) {
    const std::size_t bar = choices.find('|');
    parts.push_back(choices.substr(0, bar));
    choices.remove_prefix(bar == std::string_view::npos ? choices.size() : bar + 1);
  }
  return parts;
}

bool is_mac(std::string_view text) {
  if (text.size() != 17) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i % 3 == 2 ? text[i] != '-'
                   : std::string_view("0123456789abcdefABCDEF").find(text[i]) == std::string_view::npos)
      return false;
  return true;
}

template <class Number>
std::optional<Number> number_of(const Data* leaf) {
  if (leaf == nullptr) return std::nullopt;
  Number number = 0;
  const auto [stop, error] = std::from_chars(leaf->text.data(), leaf->text.data() + leaf->text.size(), number);
  return error == std::errc() && stop == leaf->text.data() + leaf->text.size() ? std::optional(number) : std::nullopt;
}

const Schema& child_schema(const Schema& schema, std::string_view module, std::string_view name) {
  const auto found = std::ranges::find_if(schema.children, [&](const Schema& each) {
    return each.name == name && (module.empty() || each.module == module);
  });
  TAKT_CHECK(found != schema.children.end(), "only what the schema has is written");
  return *found;
}

}  // namespace

std::string_view digit_word(unsigned digit) { return digits[digit & 7]; }
std::optional<unsigned> word_digit(std::string_view word) {
  const auto found = std::ranges::find(digits, word);
  return found == digits.end() ? std::nullopt : std::optional(static_cast<unsigned>(found - digits.begin()));
}

const Data* Data::find(std::string_view name) const {
  const auto found = std::ranges::find_if(children, [&](const Data& each) { return each.schema->name == name; });
  return found == children.end() ? nullptr : &*found;
}
const Data* Data::find(std::string_view module, std::string_view name) const {
  const auto found = std::ranges::find_if(
      children, [&](const Data& each) { return each.schema->name == name && each.schema->module == module; });
  return found == children.end() ? nullptr : &*found;
}
std::optional<std::string> Data::value(std::string_view name) const {
  const Data* const found = find(name);
  return found == nullptr ? std::nullopt : std::optional(found->text);
}
std::optional<std::uint64_t> Data::number(std::string_view name) const { return number_of<std::uint64_t>(find(name)); }
std::optional<std::int64_t> Data::signed_number(std::string_view name) const {
  return number_of<std::int64_t>(find(name));
}
bool Data::is_true(std::string_view name) const { return value(name) == "true"; }

Data& Data::add(std::string_view name, std::string_view module) {
  children.push_back({&child_schema(*schema, module, name), {}, {}, {}, false});
  return children.back();
}
Data& Data::make(std::string_view name, std::string_view module) {
  const Schema& wanted = child_schema(*schema, module, name);
  for (Data& child : children)
    if (child.schema == &wanted) return child;
  return add(name, module);
}
void Data::set(std::string_view name, std::string value, std::string_view module) {
  make(name, module).text = std::move(value);
}

bool LeafCheck::check(const Schema& schema, const std::string& text, const json::Place& place) {
  const auto refuse = [&](std::string message, std::string expected, std::string suggestion = {}) {
    diagnostics_.error(
        place, std::move(message),
        {json::quote(text) + " for " + std::string(schema.name), std::move(expected), std::move(suggestion)});
    return false;
  };
  if (const auto range = range_of(schema.type)) {
    if (range->is_signed) {
      std::int64_t value = 0;
      const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      const bool fits = error == std::errc() && stop == text.data() + text.size() && !text.empty() &&
                        value <= static_cast<std::int64_t>(range->most) &&
                        value >= -static_cast<std::int64_t>(range->most) - 1;
      return fits || refuse("not a number that fits", "a whole number");
    }
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::uint64_t most = std::min(range->most, schema.most);
    if (error == std::errc() && stop == text.data() + text.size() && !text.empty() && value <= most &&
        value >= schema.least)
      return true;
    return refuse("not a number that fits",
                  "a whole number from " + std::to_string(schema.least) + " to " + std::to_string(most));
  }
  switch (schema.type) {
    case Type::boolean:
      return text == "true" || text == "false" || refuse("not a truth value", "true or false");
    case Type::mac:
      return is_mac(text) || refuse("not a MAC address", "six octets in hexadecimal with dashes, 02-00-5e-00-00-01");
    case Type::choice:
    case Type::identity: {
      const std::vector<std::string_view> choices = split(schema.choices);
      if (choices.empty()) return true;  // one of many that mean nothing here
      if (std::ranges::find(choices, text) != choices.end()) return true;
      std::string known;
      for (const std::string_view each : choices) known += (known.empty() ? "" : ", ") + std::string(each);
      return refuse(schema.type == Type::choice ? "not one of the values" : "not an identity that takt knows", known,
                    json::suggest(text, choices));
    }
    default:
      return true;
  }
}

void LeafCheck::check_children(const Data& data) {
  for (const Schema& schema : data.schema->children)
    if (schema.is_mandatory && data.find(schema.module, schema.name) == nullptr && !data.is_deleted)
      diagnostics_.error(data.place, "something that must be said is not",
                         {"no " + json::quote(schema.name) + " in " +
                              json::quote(data.schema->name.empty() ? "the file" : data.schema->name),
                          "one"});
  std::set<std::pair<const Schema*, std::string>> keys;
  std::set<const Schema*> seen;
  for (const Data& child : data.children) {
    if (child.schema->type == Type::list) {
      std::string key;
      bool is_whole = true;
      for (const Schema& leaf : child.schema->children) {
        if (!child.schema->is_key(leaf.name)) continue;
        const auto value = child.value(leaf.name);
        is_whole = is_whole && value;
        key += (key.empty() ? "" : " ") + value.value_or("");
      }
      if (is_whole && !keys.emplace(child.schema, key).second)
        diagnostics_.error(child.place, "two entries with one key",
                           {std::string(child.schema->key) + " " + json::quote(key) + " of " +
                                std::string(child.schema->name) + " a second time",
                            "a key of its own for each entry"});
    } else if (!child.schema->is_leaf_list && !seen.insert(child.schema).second) {
      diagnostics_.error(child.place, "said twice", {json::quote(child.schema->name) + " a second time", "one"});
    }
  }
}

}  // namespace takt::interchange::yang
