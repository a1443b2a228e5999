// SPDX-License-Identifier: Apache-2.0
#include "json/node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "json/printable.hpp"
#include "json/utf8.hpp"
#include "sim/check.hpp"

namespace takt::json {

namespace {

constexpr std::size_t longest_excerpt = 40;  // octets of a text that a message quotes
constexpr std::size_t line_width = 100;      // an array of scalars that is shorter stays on one line

/// Appends a text as it stands in a JSON string. What is not UTF-8 (in the name of a file, perhaps) becomes U+FFFD.
void append_escaped(std::string& out, std::string_view text) {
  while (!text.empty()) {
    const char c = text.front();
    const std::size_t length = character_length(text);
    const std::string_view character = length == 0 ? "\uFFFD" : text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        out += printable(character);
    }
  }
}

void append_string(std::string& out, std::string_view text) {
  out += '"';
  append_escaped(out, text);
  out += '"';
}

void append_compact(std::string& out, const Node& node) {
  switch (node.kind) {
    case Kind::null:
      out += "null";
      break;
    case Kind::boolean:
      out += node.boolean ? "true" : "false";
      break;
    case Kind::number:
      out += node.text;
      break;
    case Kind::string:
      append_string(out, node.text);
      break;
    case Kind::array:
      out += '[';
      for (const Node& item : node.items) {
        if (&item != &node.items.front()) out += ", ";
        append_compact(out, item);
      }
      out += ']';
      break;
    case Kind::object:
      out += '{';
      for (const Member& member : node.members) {
        if (&member != &node.members.front()) out += ", ";
        append_string(out, member.key);
        out += ": ";
        append_compact(out, member.value);
      }
      out += '}';
      break;
  }
}

bool is_scalar(const Node& node) { return node.kind != Kind::array && node.kind != Kind::object; }

void append_pretty(std::string& out, const Node& node, std::size_t indentation) {
  const bool is_open =
      node.kind == Kind::object ? !node.members.empty() : node.kind == Kind::array && !node.items.empty();
  if (!is_open) return append_compact(out, node);
  if (node.kind == Kind::array && std::ranges::all_of(node.items, is_scalar)) {
    const std::string line = compact(node);
    if (line.size() + indentation <= line_width) {
      out += line;
      return;
    }
  }

  const std::string inner(indentation + 2, ' ');
  out += node.kind == Kind::object ? "{\n" : "[\n";
  for (const Node& item : node.items) {
    out += inner;
    append_pretty(out, item, indentation + 2);
    out += &item != &node.items.back() ? ",\n" : "\n";
  }
  for (const Member& member : node.members) {
    out += inner;
    append_string(out, member.key);
    out += ": ";
    append_pretty(out, member.value, indentation + 2);
    out += &member != &node.members.back() ? ",\n" : "\n";
  }
  out.append(indentation, ' ');
  out += node.kind == Kind::object ? '}' : ']';
}

}  // namespace

std::string_view with_article(Kind kind) {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return "a boolean";
    case Kind::number:
      return "a number";
    case Kind::string:
      return "a string";
    case Kind::array:
      return "an array";
    case Kind::object:
      return "an object";
  }
  return "a value";
}

Node Node::of_bool(bool value) {
  Node node;
  node.kind = Kind::boolean;
  node.boolean = value;
  return node;
}

Node Node::of_string(std::string_view value) {
  Node node;
  node.kind = Kind::string;
  node.text = value;
  return node;
}

Node Node::of_literal(std::string literal) {
  Node node;
  node.kind = Kind::number;
  node.text = std::move(literal);
  return node;
}

Node Node::of_integer(sim::int128 value) { return of_literal(json::to_text(value)); }

Node Node::of_double(double value) {
  TAKT_CHECK(std::isfinite(value), "JSON has no infinite numbers and no NaN");
  char buffer[32];
  const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), value);
  TAKT_CHECK(error == std::errc{}, "the shortest form of a double has at most 24 characters");
  return of_literal(std::string(buffer, end));
}

Node Node::array() {
  Node node;
  node.kind = Kind::array;
  return node;
}

Node Node::object() {
  Node node;
  node.kind = Kind::object;
  return node;
}

const Node* Node::find(std::string_view key) const {
  const auto found = std::ranges::find(members, key, &Member::key);
  return found == members.end() ? nullptr : &found->value;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

Node& Node::add(std::string_view key, Node value) {
  return members.emplace_back(Member{std::string(key), {}, std::move(value)}).value;
}

std::optional<sim::int128> integer_of(const Node& number) {
  constexpr std::size_t most_digits = 38;  // 10^38 < 2^127
  std::string_view digits = number.text;
  const bool is_negative = digits.starts_with('-');
  if (is_negative) digits.remove_prefix(1);
  if (digits.empty() || digits.size() > most_digits) return std::nullopt;
  sim::int128 value = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return is_negative ? -value : value;
}

double double_of(const Node& number) {
  double value = 0;
  const char* end = number.text.data() + number.text.size();
  const auto [rest, error] = std::from_chars(number.text.data(), end, value);
  // A literal that is nearer to zero than every double is zero; parse() refuses those beyond the greatest.
  return error == std::errc{} && rest == end ? value : 0.0;
}

std::string to_text(sim::int128 value) {
  if (value == 0) return "0";
  const bool is_negative = value < 0;
  auto rest = is_negative ? -static_cast<sim::uint128>(value) : static_cast<sim::uint128>(value);
  std::string text;
  for (; rest != 0; rest /= 10) text += static_cast<char>('0' + static_cast<int>(rest % 10));
  if (is_negative) text += '-';
  std::ranges::reverse(text);
  return text;
}

bool equal(const Node& a, const Node& b) {
  return a.kind == b.kind && a.boolean == b.boolean && a.text == b.text &&
         std::ranges::equal(a.items, b.items, equal) &&
         std::ranges::equal(a.members, b.members,
                            [](const Member& x, const Member& y) { return x.key == y.key && equal(x.value, y.value); });
}

std::string quote(std::string_view text) {
  const std::string_view start = first_octets(text, longest_excerpt);
  std::string result = "\"";
  append_escaped(result, start);
  return result + (start.size() < text.size() ? "...\"" : "\"");
}

std::string excerpt(const Node& node) {
  switch (node.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::number:
      return "the number " + node.text.substr(0, longest_excerpt);
    case Kind::string:
      return "the string " + quote(node.text);
    case Kind::array:
      return node.items.empty() ? "an empty array" : fmt::format("an array of {}", node.items.size());
    case Kind::object:
      return "an object";
  }
  return "a value";
}

std::string pretty(const Node& node) {
  std::string text;
  append_pretty(text, node, 0);
  return text + "\n";
}

std::string compact(const Node& node) {
  std::string text;
  append_compact(text, node);
  return text;
}

}  // namespace takt::json
