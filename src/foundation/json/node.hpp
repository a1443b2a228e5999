// SPDX-License-Identifier: Apache-2.0
// A JSON value as it was written: order of members, literal text of numbers and the place of every token are kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/time.hpp"

namespace takt::json {

enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

/// "an object", "a number", ... for messages.
std::string_view with_article(Kind kind);

/// Where a token starts. Lines and columns count from 1, columns in characters (code points), 0 = nowhere.
struct Position {
  std::uint32_t source = 0;  ///< index into the document's sources: 0 is the file, others are overrides
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  bool operator==(const Position&) const = default;
};

struct Member;

/// One value. Only the parts that belong to its kind are used.
struct Node {
  Kind kind = Kind::null;
  bool boolean = false;
  Position position;
  std::string text;              ///< string: its value; number: its literal, as written
  std::vector<Node> items;       ///< array
  std::vector<Member> members;   ///< object, in the order of the file; keys are unique
  const Node* parent = nullptr;  ///< set within a Document only

  static Node of_bool(bool value);
  static Node of_string(std::string_view value);
  static Node of_integer(sim::int128 value);
  /// Shortest literal that reads back as the same double. CHECKs that it is finite.
  static Node of_double(double value);
  static Node of_literal(std::string literal);
  static Node array();
  static Node object();

  /// The member's value, or nullptr. Linear in the number of members.
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);
  /// Appends a member; the caller sees to it that the key is new.
  Node& add(std::string_view key, Node value);
};

struct Member {
  std::string key;
  Position key_position;
  Node value;
};

/// The value of a number that is written without fraction and exponent and fits into 127 bits.
std::optional<sim::int128> integer_of(const Node& number);
/// The double nearest to the literal.
double double_of(const Node& number);
std::string to_text(sim::int128 value);

/// Equal in value, whatever the positions; numbers are compared by their literals, members in order.
bool equal(const Node& a, const Node& b);

/// How a value looks in a message: strings quoted and cut to a few words, `an object`, `an array of 3`.
std::string excerpt(const Node& node);
/// A text in quotes, control characters escaped, cut after 40 characters.
std::string quote(std::string_view text);

/// JSON text with two spaces of indentation; short arrays of scalars stay on one line. Ends with a newline.
std::string pretty(const Node& node);
/// JSON text on one line, without a newline.
std::string compact(const Node& node);

}  // namespace takt::json
