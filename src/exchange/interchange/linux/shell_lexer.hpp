// SPDX-License-Identifier: Apache-2.0
// The words and signs of a shell's language, one after the other; included by shell.cpp alone.
#pragma once

#include <algorithm>
#include <optional>

#include "interchange/linux/shell.hpp"

namespace takt::interchange::linux_tc {

struct ShellToken {
  enum class Kind : std::uint8_t { word, sign, line, end };
  Kind kind = Kind::end;
  ShellWord word;
  std::string sign;  ///< "&&", ";", "(" ...
  json::Place place;
};

/// What stands between a here-document's redirection and its end. (Outside of the class: clang 14 takes no optional of
/// a nested struct with initialisers.)
struct HereDocument {
  std::string text;
  std::uint32_t line = 0;
};

class ShellLexer {
 public:
  ShellLexer(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  ShellToken next() {
    skip_blanks();
    ShellToken token;
    token.place = here();
    if (at_end()) return token;
    if (peek() == '\n') {
      advance();
      read_documents();
      token.kind = ShellToken::Kind::line;
      return token;
    }
    for (const std::string_view sign : {"&&", "||", ";;", "((", "|&", "&", "|", ";", "(", ")"})
      if (rest().starts_with(sign) && !is_redirection_with_ampersand()) {
        token.kind = ShellToken::Kind::sign;
        token.sign = sign;
        advance(sign.size());
        return token;
      }
    token.kind = ShellToken::Kind::word;
    token.word = read_word();
    return token;
  }

  /// Redirections of the command that was read, and its documents.
  std::optional<HereDocument> take_document() {
    std::optional<HereDocument> taken;
    std::swap(taken, document_);
    return taken;
  }
  /// The text up to the two closing parentheses of "((", as one token.
  void skip_arithmetic() {
    int depth = 2;
    while (!at_end() && depth > 0) {
      if (peek() == '(') ++depth;
      if (peek() == ')') --depth;
      advance();
    }
  }
  json::Place here() const { return {file_, line_, column_, ""}; }

  /// A redirection at this place is read and forgotten; a document is awaited.
  bool skip_redirection() {
    skip_blanks();
    std::size_t at = at_;
    while (at < text_.size() && text_[at] >= '0' && text_[at] <= '9') ++at;
    if (at < text_.size() && text_[at] == '&' && at + 1 < text_.size() && text_[at + 1] == '>') ++at;
    if (at >= text_.size() || (text_[at] != '>' && text_[at] != '<')) return false;
    const std::size_t first = at;
    if (text_.substr(first).starts_with("<(") || text_.substr(first).starts_with(">(")) return false;
    const bool is_document = text_.substr(first).starts_with("<<") && !text_.substr(first).starts_with("<<<");
    while (at < text_.size() && (text_[at] == '>' || text_[at] == '<' || text_[at] == '&' || text_[at] == '|')) ++at;
    const bool strips = is_document && at < text_.size() && text_[at] == '-';
    if (strips) ++at;
    advance(at - at_);
    skip_blanks();
    if (at_end() || peek() == '\n') return true;
    const ShellWord target = read_word();
    if (!is_document) return true;
    std::string mark;
    for (const ShellPiece& piece : target.pieces) mark += piece.text;
    awaited_ = mark;
    awaited_strips_ = strips;
    return true;
  }

 private:
  static bool is_start_of_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
  static bool is_part_of_name(char c) { return is_start_of_name(c) || (c >= '0' && c <= '9'); }
  bool at_end() const { return at_ >= text_.size(); }
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  std::string_view rest() const { return text_.substr(std::min(at_, text_.size())); }
  void advance(std::size_t count = 1) {
    for (; count > 0 && !at_end(); --count, ++at_) {
      if (text_[at_] == '\n') {
        ++line_;
        column_ = 1;
      } else
        ++column_;
    }
  }
  bool is_redirection_with_ampersand() const { return rest().starts_with("&>"); }

  void skip_blanks() {
    while (!at_end()) {
      if (peek() == ' ' || peek() == '\t' || peek() == '\r')
        advance();
      else if (peek() == '\\' && peek(1) == '\n')
        advance(2);
      else if (peek() == '\\' && peek(1) == '\r' && peek(2) == '\n')
        advance(3);
      else if (peek() == '#')
        while (!at_end() && peek() != '\n') advance();
      else
        break;
    }
  }

  void read_documents() {
    if (!awaited_) return;
    document_.emplace();
    document_->line = line_;
    while (!at_end()) {
      const std::size_t end = std::min(rest().find('\n'), rest().size());
      std::string_view line = rest().substr(0, end);
      advance(end + 1);
      std::string_view bare = line;
      if (awaited_strips_) bare.remove_prefix(std::min(bare.find_first_not_of('\t'), bare.size()));
      if (bare.ends_with('\r')) bare.remove_suffix(1);
      if (bare == *awaited_) break;
      document_->text += std::string(line) + "\n";
    }
    awaited_.reset();
  }

  ShellWord read_word() {
    ShellWord word;
    word.place = here();
    const std::size_t first = at_;
    while (!at_end() && std::string_view(" \t\r\n;&|()<>").find(peek()) == std::string_view::npos) {
      const char c = peek();
      if (c == '\\') {
        if (peek(1) == '\n') {
          advance(2);
          continue;
        }
        if (peek(1) == '\r' && peek(2) == '\n') {
          advance(3);
          continue;
        }
        add(word, {ShellPiece::Kind::text, std::string(1, peek(1)), true});
        advance(2);
      } else if (c == '\'') {
        const std::size_t close = std::min(rest().find('\'', 1), rest().size());
        add(word, {ShellPiece::Kind::text, std::string(rest().substr(1, close - 1)), true});
        advance(close + 1);
      } else if (c == '"') {
        read_quoted(word);
      } else if (c == '$' || c == '`') {
        read_expansion(word, false);
      } else {
        add(word, {ShellPiece::Kind::text, std::string(1, c), false});
        advance();
      }
    }
    word.source = std::string(text_.substr(first, at_ - first));
    if (at_ == first) advance();  // a sign that cannot begin a word: "<" of a process
    return word;
  }

  static void add(ShellWord& word, ShellPiece piece) {
    if (piece.kind == ShellPiece::Kind::text && !word.pieces.empty() && word.pieces.back().kind == piece.kind &&
        word.pieces.back().is_quoted == piece.is_quoted)
      word.pieces.back().text += piece.text;
    else
      word.pieces.push_back(std::move(piece));
  }

  void read_quoted(ShellWord& word) {
    advance();
    add(word, {ShellPiece::Kind::text, "", true});
    while (!at_end() && peek() != '"') {
      if (peek() == '\\' && std::string_view("\"\\$`\n").find(peek(1)) != std::string_view::npos) {
        if (peek(1) != '\n') add(word, {ShellPiece::Kind::text, std::string(1, peek(1)), true});
        advance(2);
      } else if (peek() == '$' || peek() == '`') {
        read_expansion(word, true);
      } else {
        add(word, {ShellPiece::Kind::text, std::string(1, peek()), true});
        advance();
      }
    }
    advance();
  }

  /// The text up to the sign that closes what is open here, and past it.
  std::string enclosed(std::size_t opening, char open, char close) {
    advance(opening);
    const std::size_t first = at_;
    for (int depth = 1; !at_end(); advance()) {
      if (peek() == '\\') {
        advance();
        continue;
      }
      if (peek() == open) ++depth;
      if (peek() == close && --depth == 0) break;
    }
    const std::string text(text_.substr(first, at_ - first));
    advance();
    return text;
  }

  void read_expansion(ShellWord& word, bool is_quoted) {
    using enum ShellPiece::Kind;
    if (peek() == '`') {
      advance();
      const std::size_t close = std::min(rest().find('`'), rest().size());
      word.pieces.push_back({command, std::string(rest().substr(0, close)), is_quoted});
      advance(close + 1);
    } else if (rest().starts_with("$((")) {
      std::string text = enclosed(2, '(', ')');
      if (text.starts_with('(')) text.erase(0, 1);
      if (text.ends_with(')')) text.pop_back();
      word.pieces.push_back({arithmetic, text, is_quoted});
    } else if (rest().starts_with("$(")) {
      word.pieces.push_back({command, enclosed(2, '(', ')'), is_quoted});
    } else if (rest().starts_with("${")) {
      word.pieces.push_back({variable, enclosed(2, '{', '}'), is_quoted});
    } else if (is_start_of_name(peek(1))) {
      std::size_t end = 1;
      while (is_part_of_name(peek(end))) ++end;
      word.pieces.push_back({variable, std::string(rest().substr(1, end - 1)), is_quoted});
      advance(end);
    } else if (peek(1) != '\0' && std::string_view("0123456789@*#?$!-").find(peek(1)) != std::string_view::npos) {
      word.pieces.push_back({variable, std::string(1, peek(1)), is_quoted});
      advance(2);
    } else {
      add(word, {text, "$", is_quoted});
      advance();
    }
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1, column_ = 1;
  std::optional<std::string> awaited_;
  bool awaited_strips_ = false;
  std::optional<HereDocument> document_;
};

}  // namespace takt::interchange::linux_tc
