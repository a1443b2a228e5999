// SPDX-License-Identifier: Apache-2.0
#include "interchange/linux/shell.hpp"

#include <algorithm>

#include "interchange/linux/shell_lexer.hpp"
#include "json/node.hpp"

namespace takt::interchange::linux_tc {
namespace {

constexpr std::uint32_t deepest_shell = 64;

class ShellParser {
 public:
  ShellParser(std::string_view text, const std::string& file, json::Diagnostics& diagnostics)
      : lexer_(text, file), diagnostics_(diagnostics) {
    step();
  }

  ShellNode run() {
    ShellNode all = sequence({});
    while (token_.kind != ShellToken::Kind::end && !failed_) {
      fail("what begins no command");
      step();
    }
    return all;
  }

 private:
  using Kind = ShellNode::Kind;

  void step() { token_ = lexer_.next(); }
  bool is_sign(std::string_view sign) const { return token_.kind == ShellToken::Kind::sign && token_.sign == sign; }
  bool is_word(std::string_view text) const {
    return token_.kind == ShellToken::Kind::word && token_.word.plain() == text;
  }
  bool is_line() const { return token_.kind == ShellToken::Kind::line; }
  void skip_lines() {
    while (is_line() || is_sign(";")) step();
  }
  void fail(const std::string& what) {
    if (failed_) return;
    failed_ = true;
    const std::string found = token_.kind == ShellToken::Kind::word   ? token_.word.source
                              : token_.kind == ShellToken::Kind::sign ? token_.sign
                              : is_line()                             ? "the end of the line"
                                                                      : "the end of the file";
    diagnostics_.error(token_.place, what, {json::quote(found), "what a shell understands"});
  }
  void expect(std::string_view word) {
    skip_lines();
    if (is_word(word))
      step();
    else
      fail("no \"" + std::string(word) + "\"");
  }

  ShellNode sequence(std::initializer_list<std::string_view> ends) {
    ShellNode node;
    node.kind = Kind::sequence;
    node.place = token_.place;
    if (++depth_ > deepest_shell) fail("commands within commands, too deep");
    while (!failed_) {
      while (is_line() || is_sign(";") || is_sign("&")) step_after(node);
      if (token_.kind == ShellToken::Kind::end || is_sign(")") || is_sign(";;")) break;
      if (std::ranges::any_of(ends, [&](std::string_view end) { return is_word(end); })) break;
      node.parts.push_back(and_or());
    }
    --depth_;
    return node;
  }
  /// The document of a command stands behind the line's end: the command is in the tree by then.
  void step_after(ShellNode& into) {
    if (is_line()) {
      if (auto document = lexer_.take_document())
        if (ShellNode* const simple = into.parts.empty() ? nullptr : last_of(into.parts.back())) {
          simple->document = std::move(document->text);
          simple->document_line = document->line;
        }
    }
    token_ = lexer_.next();
  }
  static ShellNode* last_of(ShellNode& node) {
    ShellNode* at = &node;
    while (at->kind != Kind::simple && !at->parts.empty())
      at = at->kind == Kind::pipe ? &at->parts.front() : &at->parts.back();
    return at->kind == Kind::simple ? at : nullptr;
  }

  ShellNode and_or() {
    ShellNode left = pipeline();
    while (!failed_ && (is_sign("&&") || is_sign("||"))) {
      ShellNode node;
      node.kind = is_sign("&&") ? Kind::and_then : Kind::or_else;
      node.place = left.place;
      step();
      while (is_line()) step();
      node.parts.push_back(std::move(left));
      node.parts.push_back(pipeline());
      left = std::move(node);
    }
    return left;
  }

  ShellNode pipeline() {
    if (is_word("!")) {
      ShellNode node;
      node.kind = Kind::negation;
      node.place = token_.place;
      step();
      node.parts.push_back(pipeline());
      return node;
    }
    ShellNode first = command();
    if (!is_sign("|") && !is_sign("|&")) return first;
    ShellNode node;
    node.kind = Kind::pipe;
    node.place = first.place;
    node.parts.push_back(std::move(first));
    while (!failed_ && (is_sign("|") || is_sign("|&"))) {
      step();
      while (is_line()) step();
      node.parts.push_back(command());
    }
    return node;
  }

  ShellNode command() {
    ShellNode node;
    node.place = token_.place;
    if (is_sign("((")) {
      lexer_.skip_arithmetic();
      step();
      return node;
    }
    if (is_sign("(")) {
      step();
      node = sequence({});
      if (is_sign(")"))
        step_past_block();
      else
        fail("a parenthesis that does not close");
      return node;
    }
    if (token_.kind != ShellToken::Kind::word) {
      fail("no command");
      return node;
    }
    const std::string_view first = token_.word.plain();
    if (first == "{") return block();
    if (first == "if") return branch();
    if (first == "for" || first == "select") return each();
    if (first == "while" || first == "until") return loop();
    if (first == "case") return choice();
    if (first == "function") {
      step();
      return function();
    }
    if (first == "[[") return double_brackets();
    return simple();
  }

  void step_past_block() {
    while (lexer_.skip_redirection()) {
    }
    step();
  }
  ShellNode block() {
    step();
    ShellNode node = sequence({"}"});
    if (is_word("}"))
      step_past_block();
    else
      fail("a brace that does not close");
    return node;
  }

  ShellNode branch() {
    ShellNode node;
    node.kind = Kind::branch;
    node.place = token_.place;
    step();
    while (!failed_) {
      node.parts.push_back(sequence({"then"}));
      expect("then");
      node.parts.push_back(sequence({"elif", "else", "fi"}));
      if (is_word("elif")) {
        step();
        continue;
      }
      if (is_word("else")) {
        step();
        node.parts.push_back(sequence({"fi"}));
      }
      if (is_word("fi"))
        step_past_block();
      else
        fail("no \"fi\"");
      break;
    }
    return node;
  }

  ShellNode each() {
    ShellNode node;
    node.kind = Kind::each;
    node.place = token_.place;
    step();
    if (is_sign("((")) {
      lexer_.skip_arithmetic();
      step();
      node.kind = Kind::loop;
      node.parts.emplace_back();
      node.parts.back().kind = Kind::sequence;
    } else {
      if (token_.kind == ShellToken::Kind::word) node.name = token_.word.source;
      step();
      while (is_line()) step();
      if (is_word("in"))
        for (step(); token_.kind == ShellToken::Kind::word && !failed_; step()) node.words.push_back(token_.word);
      else
        node.words.push_back({{{ShellPiece::Kind::variable, "@", true}}, node.place, "\"$@\""});
    }
    expect("do");
    node.parts.push_back(sequence({"done"}));
    if (is_word("done"))
      step_past_block();
    else
      fail("no \"done\"");
    return node;
  }

  ShellNode loop() {
    ShellNode node;
    node.kind = Kind::loop;
    node.place = token_.place;
    step();
    node.parts.push_back(sequence({"do"}));
    expect("do");
    node.parts.push_back(sequence({"done"}));
    if (is_word("done"))
      step_past_block();
    else
      fail("no \"done\"");
    return node;
  }

  ShellNode choice() {
    ShellNode node;
    node.kind = Kind::choice;
    node.place = token_.place;
    step();
    if (token_.kind == ShellToken::Kind::word) node.words.push_back(token_.word);
    step();
    expect("in");
    for (skip_lines(); !failed_ && !is_word("esac") && token_.kind != ShellToken::Kind::end; skip_lines()) {
      if (is_sign("(")) step();
      std::vector<ShellWord> patterns;
      for (; token_.kind == ShellToken::Kind::word || is_sign("|"); step())
        if (token_.kind == ShellToken::Kind::word) patterns.push_back(token_.word);
      if (!is_sign(")")) return fail("no pattern that ends with \")\""), node;
      step();
      node.patterns.push_back(std::move(patterns));
      node.parts.push_back(sequence({"esac"}));
      if (is_sign(";;")) step();
    }
    if (is_word("esac"))
      step_past_block();
    else
      fail("no \"esac\"");
    return node;
  }

  ShellNode function() {
    ShellNode node;
    node.kind = Kind::function;
    node.place = token_.place;
    if (token_.kind == ShellToken::Kind::word) node.name = token_.word.source;
    step();
    if (is_sign("(")) {
      step();
      if (is_sign(")")) step();
    }
    while (is_line()) step();
    node.parts.push_back(command());
    return node;
  }

  ShellNode double_brackets() {
    ShellNode node;
    node.place = token_.place;
    while (token_.kind != ShellToken::Kind::end && !is_line()) {
      if (token_.kind == ShellToken::Kind::word)
        node.words.push_back(token_.word);
      else
        node.words.push_back({{{ShellPiece::Kind::text, token_.sign, true}}, token_.place, token_.sign});
      const bool is_last = is_word("]]");
      step();
      if (is_last) break;
    }
    return node;
  }

  ShellNode simple() {
    ShellNode node;
    node.place = token_.place;
    while (token_.kind == ShellToken::Kind::word && !failed_) {
      node.words.push_back(token_.word);
      while (lexer_.skip_redirection()) {
      }
      step();
      if (node.words.size() == 1 && is_sign("(") && node.words[0].pieces.size() == 1) {  // name() { ... }
        ShellNode made;
        made.kind = Kind::function;
        made.place = node.place;
        made.name = node.words[0].source;
        step();
        if (is_sign(")"))
          step();
        else
          fail("parentheses behind a word that are no function");
        while (is_line()) step();
        made.parts.push_back(command());
        return made;
      }
      if (node.words.size() == 1 && node.words[0].source.ends_with('=') && is_sign("(")) {  // NAME=( ... ): an array
        for (step(); !is_sign(")") && token_.kind != ShellToken::Kind::end; step())
          if (token_.kind == ShellToken::Kind::word) node.words.push_back(token_.word);
        step();
        node.name = "array";
      }
    }
    return node;
  }

  ShellLexer lexer_;
  json::Diagnostics& diagnostics_;
  ShellToken token_;
  bool failed_ = false;
  std::uint32_t depth_ = 0;
};

}  // namespace

ShellNode parse_shell(std::string_view text, const std::string& file, json::Diagnostics& diagnostics) {
  return ShellParser(text, file, diagnostics).run();
}

}  // namespace takt::interchange::linux_tc
