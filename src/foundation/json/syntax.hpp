// SPDX-License-Identifier: Apache-2.0
// Where the tokens of a JSON text start, and what is wrong with a text that is not JSON. Internal to document.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "json/diagnostics.hpp"
#include "json/node.hpp"

namespace takt::json {

/// Walks over a text token by token and counts lines and columns. Linear in the text over its whole life.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) { position_.line = position_.column = 1; }

  std::size_t offset() const { return offset_; }
  Position position() const { return position_; }
  std::string_view rest() const { return text_.substr(offset_); }
  bool at_end() const { return offset_ == text_.size(); }
  char peek(std::size_t ahead = 0) const { return offset_ + ahead < text_.size() ? text_[offset_ + ahead] : '\0'; }

  void advance(std::size_t octets);
  /// Skips white space and whole comments, stops at anything else.
  void skip_space();
  /// Skips what may stand between two tokens that carry something: space, comments, commas and colons.
  void skip_to_token();
  /// Skips the token here, a string, number, word or bracket, and returns its text.
  std::string_view read_token();

 private:
  std::string_view text_;
  std::size_t offset_ = 0;
  Position position_;
};

/// Whether a token is a number of JSON, true, false or null.
bool is_word_of_json(std::string_view token);

/// What stood last before the text went wrong.
enum class Before : std::uint8_t { nothing, key, array_start, array_item, object_start, object_member, whole_value };

/// A syntax error in takt's words.
struct SyntaxError {
  Position position;
  std::string message;
  Details details;
};

/// Says what is wrong after the last good token, at whose end the cursor stands. The text must be known to be wrong
/// there.
SyntaxError explain(Cursor cursor, Before before);

/// The text with a space in place of each comma that follows a value and stands before a closing bracket: people leave
/// it there when they take the last line away. Nothing if there is none. Places stay the same.
std::optional<std::string> without_trailing_commas(std::string_view text);

/// A NUL, an octet that is not UTF-8, or UTF-16, if the text has one. A byte order mark of UTF-8 must be gone already.
std::optional<SyntaxError> find_bad_octet(std::string_view text);

}  // namespace takt::json
