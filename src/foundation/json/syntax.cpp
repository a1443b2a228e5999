// SPDX-License-Identifier: Apache-2.0
#include "json/syntax.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/quantity.hpp"
#include "json/utf8.hpp"

namespace takt::json {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
/// Of numbers and of words without quotes, right or wrong. Octets beyond ASCII count as letters.
bool is_word(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '+' || c == '-' ||
         c == '.' || static_cast<unsigned char>(c) >= 0x80;
}

std::size_t word_length(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::find_if_not(text, is_word) - text.begin());
}

/// The octets of a comment at the start of the text, 0 if there is none or it does not end.
std::size_t comment_length(std::string_view text) {
  if (text.starts_with("//")) return std::min(text.find_first_of("\r\n"), text.size());
  if (!text.starts_with("/*")) return 0;
  const std::size_t end = text.find("*/", 2);
  return end == std::string_view::npos ? 0 : end + 2;
}

/// The octets of a string token with its quotes; up to the end of the text if it is not closed.
std::size_t string_length(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      return i + 1;
  }
  return text.size();
}

bool is_number(std::string_view word) {
  std::size_t i = 0;
  const auto at = [word](std::size_t k) { return k < word.size() ? word[k] : '\0'; };
  const auto digits = [&] {
    const std::size_t start = i;
    while (is_digit(at(i))) ++i;
    return i > start;
  };
  if (at(i) == '-') ++i;
  if (at(i) == '0')
    ++i;
  else if (!digits())
    return false;
  if (at(i) == '.' && (++i, !digits())) return false;
  if (at(i) == 'e' || at(i) == 'E') {
    ++i;
    if (at(i) == '+' || at(i) == '-') ++i;
    if (!digits()) return false;
  }
  return i == word.size();
}

bool is_literal(std::string_view word) { return word == "true" || word == "false" || word == "null"; }

/// The value of four hexadecimal digits, or -1.
int hex4(std::string_view text) {
  if (text.size() < 4 || !std::ranges::all_of(text.substr(0, 4), is_hex)) return -1;
  int value = 0;
  for (const char c : text.substr(0, 4)) value = value * 16 + (is_digit(c) ? c - '0' : (c | 0x20) - 'a' + 10);
  return value;
}

/// What is wrong inside the string token at the cursor, if anything.
std::optional<SyntaxError> string_error(Cursor cursor) {
  const Position start = cursor.position();
  cursor.advance(1);
  while (!cursor.at_end() && cursor.peek() != '"') {
    const char c = cursor.peek();
    if (c == '\n' || c == '\r')
      return SyntaxError{start,
                         "a string that is not closed on its line",
                         {"the end of the line", "\" at the end of the string (a line break in a text is \\n)", ""}};
    if (static_cast<unsigned char>(c) < 0x20)
      return SyntaxError{
          cursor.position(),
          "a control character in a string",
          {fmt::format("U+{:04X}", static_cast<unsigned>(c)), fmt::format("\\u{:04x}", static_cast<unsigned>(c)), ""}};
    if (c != '\\') {
      cursor.advance(1);
      continue;
    }
    const char escaped = cursor.peek(1);
    if (escaped == 'u') {
      const int unit = hex4(cursor.rest().substr(2));
      const bool is_high = unit >= 0xD800 && unit < 0xDC00;
      if (unit < 0)
        return SyntaxError{cursor.position(),
                           "an incomplete escape in a string",
                           {quote(first_octets(cursor.rest(), 6)), "\\u and four hexadecimal digits", ""}};
      const std::string_view next = cursor.rest().substr(6);
      const int low = is_high && next.starts_with("\\u") ? hex4(next.substr(2)) : 0;
      if ((is_high && (low < 0xDC00 || low > 0xDFFF)) || (unit >= 0xDC00 && unit < 0xE000))
        return SyntaxError{cursor.position(),
                           "half of a surrogate pair in a string",
                           {quote(first_octets(cursor.rest(), 6)),
                            "both halves, \\ud800-\\udbff and \\udc00-\\udfff, or the character itself", ""}};
      cursor.advance(is_high ? 12 : 6);
    } else if (std::string_view("\"\\/bfnrt").find(escaped) != std::string_view::npos && escaped != '\0') {
      cursor.advance(2);
    } else {
      const std::string found = cursor.rest().size() < 2
                                    ? "the end of the text"
                                    : quote(first_octets(cursor.rest(), 1 + character_length(cursor.rest().substr(1))));
      return SyntaxError{cursor.position(),
                         "an unknown escape in a string",
                         {found, R"(one of \" \\ \/ \b \f \n \r \t \uXXXX (a backslash itself is \\))", ""}};
    }
  }
  if (cursor.at_end())
    return SyntaxError{
        start, "a string that is not closed", {"the end of the text", "\" at the end of the string", ""}};
  return std::nullopt;
}

/// What is wrong with the token at the cursor in itself, if anything.
std::optional<SyntaxError> token_error(const Cursor& cursor, std::string_view expected) {
  const Position here = cursor.position();
  const char c = cursor.peek();
  if (cursor.at_end()) return std::nullopt;
  if (c == '"') return string_error(cursor);
  if (c == '\'') return SyntaxError{here, "a string in single quotes", {"'", "double quotes, \"...\"", ""}};
  if (c == '/' && cursor.peek(1) == '*')
    return SyntaxError{
        here, "a comment that is not closed", {"the end of the text", "*/ at the end of the comment", ""}};
  if (c == '/' || c == '#')
    return SyntaxError{here, "not a comment", {quote(std::string_view(&c, 1)), "// or /* */ around a comment", ""}};
  if (!is_word(c)) return std::nullopt;

  const std::string_view word = cursor.rest().substr(0, word_length(cursor.rest()));
  if (is_literal(word)) return std::nullopt;
  const bool looks_like_number = is_digit(c) || c == '-' || c == '+' || c == '.';
  if (word == "NaN" || word == "Infinity" || word == "-Infinity" || word == "nan" || word == "inf")
    return SyntaxError{here, "not a JSON number", {std::string(word), "a finite number", ""}};
  if (is_number(word)) {
    if (double_of(Node::of_literal(std::string(word))) == 0.0 &&
        word.find_first_of("123456789") != std::string_view::npos)
      return SyntaxError{here, "a number that is too large", {quote(word), "a number of at most about 1.8e308", ""}};
    return std::nullopt;
  }
  if (looks_like_number)
    return SyntaxError{
        here,
        "not a JSON number",
        {quote(word), "a number such as 12, -0.5 or 1e6 (a quantity with a unit is a string: \"10ms\")", ""}};
  if (word == "True" || word == "False" || word == "None" || word == "Null" || word == "TRUE" || word == "FALSE")
    return SyntaxError{
        here, "a word that JSON does not have", {quote(word), "true, false or null in small letters", ""}};
  return SyntaxError{
      here, "a word without quotes", {quote(word), std::string(expected) + " (texts stand in double quotes)", ""}};
}

/// What the token at the cursor is, for "found".
std::string token_text(const Cursor& cursor) {
  if (cursor.at_end()) return "the end of the text";
  const std::string_view rest = cursor.rest();
  if (cursor.peek() == '"') {
    const std::size_t length = string_length(rest);
    return "the string " + quote(rest.substr(1, length - 2));
  }
  if (is_word(cursor.peek())) return quote(rest.substr(0, word_length(rest)));
  return quote(rest.substr(0, 1));
}

}  // namespace

void Cursor::advance(std::size_t octets) {
  for (const char c : text_.substr(offset_, octets)) {
    if (c == '\n') {
      ++position_.line;
      position_.column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      ++position_.column;
    }
    ++offset_;
  }
}

void Cursor::skip_space() {
  while (!at_end()) {
    const std::size_t length = is_space(peek()) ? 1 : comment_length(rest());
    if (length == 0) return;
    advance(length);
  }
}

void Cursor::skip_to_token() {
  for (skip_space(); peek() == ',' || peek() == ':'; skip_space()) advance(1);
}

std::string_view Cursor::read_token() {
  const std::string_view here = rest();
  std::size_t length = std::min<std::size_t>(here.size(), 1);
  if (peek() == '"')
    length = string_length(here);
  else if (is_word(peek()))
    length = word_length(here);
  advance(length);
  return here.substr(0, length);
}

bool is_word_of_json(std::string_view token) { return is_number(token) || is_literal(token); }

SyntaxError explain(Cursor cursor, Before before) {
  cursor.skip_space();
  std::string expected;
  const auto take = [&cursor](char separator) {
    if (cursor.peek() != separator || cursor.at_end()) return false;
    cursor.advance(1);
    cursor.skip_space();
    return true;
  };
  switch (before) {
    case Before::nothing:
      expected = "a JSON value";
      break;
    case Before::key:
      expected = take(':') ? "a value" : "\":\" after the name";
      break;
    case Before::array_start:
      expected = "a value or \"]\"";
      break;
    case Before::array_item:
      expected = take(',') ? "a value" : "\",\" or \"]\"";
      break;
    case Before::object_start:
      expected = "a name in double quotes or \"}\"";
      break;
    case Before::object_member:
      expected = take(',') ? "a name in double quotes" : "\",\" or \"}\"";
      break;
    case Before::whole_value:
      expected = "the end of the text";
      break;
  }

  if (before != Before::whole_value)
    if (const auto error = token_error(cursor, expected)) return *error;
  std::string message = "not valid JSON";
  if (cursor.at_end())
    message = before == Before::nothing ? "the text is empty" : "the text ends too early";
  else if (before == Before::whole_value)
    message = "text after the JSON value";
  else if (expected.starts_with("\",\""))
    message = "a missing comma";
  return {cursor.position(), message, {token_text(cursor), expected, ""}};
}

std::optional<std::string> without_trailing_commas(std::string_view text) {
  std::optional<std::string> result;
  Cursor cursor(text);
  std::size_t comma = std::string_view::npos;  // the last token, if it is a comma behind a value
  bool is_after_value = false;
  for (cursor.skip_space(); !cursor.at_end(); cursor.skip_space()) {
    const std::size_t here = cursor.offset();
    const char c = cursor.read_token().front();
    const bool closes = c == ']' || c == '}';
    if (closes && comma != std::string_view::npos) {
      if (!result) result.emplace(text);
      (*result)[comma] = ' ';
    }
    comma = c == ',' && is_after_value ? here : std::string_view::npos;
    is_after_value = closes || c == '"' || is_word(c);
  }
  return result;
}

std::optional<SyntaxError> find_bad_octet(std::string_view text) {
  const auto error_at = [text](std::size_t offset, std::string message, std::string expected) {
    Cursor cursor(text);
    cursor.advance(offset);
    return SyntaxError{
        cursor.position(),
        std::move(message),
        {fmt::format("the octet 0x{:02X}", static_cast<unsigned char>(text[offset])), std::move(expected), ""}};
  };
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return error_at(0, "a text in UTF-16", "UTF-8");

  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text.substr(i));
    if (length == 0) return error_at(i, "not UTF-8", "text in UTF-8");
    if (text[i] == '\0') return error_at(i, "a NUL in the text", "text without NUL");
    i += length;
  }
  return std::nullopt;
}

}  // namespace takt::json
