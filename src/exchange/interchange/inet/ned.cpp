// SPDX-License-Identifier: Apache-2.0
#include "interchange/inet/ned.hpp"

#include <algorithm>
#include <array>

#include "json/node.hpp"

namespace takt::interchange::inet {
namespace {

constexpr std::uint32_t deepest_brackets = 64;

struct Token {
  std::string text;
  json::Place place;
};

std::vector<Token> tokens_of(const InputFile& file, json::Diagnostics& diagnostics) {
  std::vector<Token> tokens;
  const std::string& text = file.text;
  std::uint32_t line = 1, column = 1;
  std::size_t at = 0;
  const auto advance = [&](std::size_t count) {
    for (; count > 0 && at < text.size(); --count, ++at) {
      if (text[at] == '\n') {
        ++line;
        column = 1;
      } else
        ++column;
    }
  };
  const auto is_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  while (at < text.size()) {
    const char c = text[at];
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
      advance(1);
      continue;
    }
    if (text.compare(at, 2, "//") == 0) {
      while (at < text.size() && text[at] != '\n') advance(1);
      continue;
    }
    Token token{"", {file.name, line, column, ""}};
    if (is_word(c)) {
      // "1.5ms" is one word, "a.b" three, "0..3" three.
      const bool is_number = c >= '0' && c <= '9';
      while (at < text.size() && (is_word(text[at]) || (is_number && text[at] == '.' && at + 1 < text.size() &&
                                                        text[at + 1] >= '0' && text[at + 1] <= '9'))) {
        token.text += text[at];
        advance(1);
      }
    } else if (c == '"') {
      do {
        if (text[at] == '\\' && at + 1 < text.size()) {
          token.text += text[at];
          advance(1);
        }
        token.text += text[at];
        advance(1);
      } while (at < text.size() && text[at] != '"' && text[at] != '\n');
      if (at >= text.size() || text[at] != '"')
        diagnostics.error(token.place, "a text that does not end",
                          {json::quote(token.text), "a quote on the same line"});
      else {
        token.text += '"';
        advance(1);
      }
    } else {
      std::string_view sign;
      for (const std::string_view each : {"<-->", "-->", "<--", "++", "..", "**", "==", "!=", "<=", ">=", "&&", "||"})
        if (sign.empty() && text.compare(at, each.size(), each) == 0) sign = each;
      token.text = sign.empty() ? std::string(1, c) : std::string(sign);
      advance(token.text.size());
    }
    tokens.push_back(std::move(token));
  }
  return tokens;
}

class Parser {
 public:
  Parser(const InputFile& file, json::Diagnostics& diagnostics)
      : tokens_(tokens_of(file, diagnostics)),
        diagnostics_(diagnostics),
        end_{"", {file.name, tokens_.empty() ? 1u : tokens_.back().place.line, 1, ""}} {}

  std::vector<NedType> run() {
    while (!at_end() && !failed_) {
      if (is("package")) {
        take();
        package_ = dotted();
        expect(";");
      } else if (is("import")) {
        skip_to(";");
      } else if (is("@")) {
        skip_property();
      } else if (is("property")) {
        skip_to(";");
      } else if (!read_type())
        refuse(take(), "not of NED", "package, import, network, module or channel");
    }
    return std::move(types_);
  }

 private:
  bool at_end() const { return next_ >= tokens_.size(); }
  const Token& peek(std::size_t ahead = 0) const {
    return next_ + ahead >= tokens_.size() ? end_ : tokens_[next_ + ahead];
  }
  bool is(std::string_view text) const { return !at_end() && tokens_[next_].text == text; }
  Token take() { return at_end() ? end_ : tokens_[next_++]; }
  bool read_if(std::string_view text) {
    if (!is(text)) return false;
    ++next_;
    return true;
  }
  void refuse(const Token& token, std::string message, std::string expected) {
    if (!failed_)
      diagnostics_.error(token.place, std::move(message),
                         {token.text.empty() ? "the end" : json::quote(token.text), std::move(expected)});
    failed_ = true;
  }
  void expect(std::string_view text) {
    const Token token = take();
    if (token.text != text) refuse(token, "not of NED as it is read", json::quote(text));
  }
  void skip_to(std::string_view text) {
    while (!at_end() && !is(text)) take();
    expect(text);
  }
  /// @name[index](...) with nested brackets; ends with a semicolon where it is a statement.
  void skip_property() {
    take();
    take();
    if (is("[")) skip_brackets("[", "]");
    if (is("(")) skip_brackets("(", ")");
    read_if(";");
  }
  void skip_brackets(std::string_view open, std::string_view close) {
    int depth = 0;
    do {
      const Token token = take();
      if (token.text == open) ++depth;
      if (token.text == close) --depth;
      if (at_end() && depth > 0) return refuse(end_, "brackets that do not close", std::string(close));
    } while (depth > 0 && !failed_);
  }
  /// A name with dots.
  std::string dotted() {
    std::string name = take().text;
    while (is(".")) name += take().text + take().text;
    return name;
  }
  static std::string last_part(const std::string& name) {
    return name.substr(name.rfind('.') == std::string::npos ? 0 : name.rfind('.') + 1);
  }
  /// The text of an expression, up to one of the signs that end it outside of brackets.
  std::string expression(std::initializer_list<std::string_view> ends) {
    std::string text;
    int depth = 0;
    while (!at_end()) {
      const std::string& next = peek().text;
      if (depth == 0 && std::ranges::find(ends, std::string_view(next)) != ends.end()) break;
      if (next == "(" || next == "[" || next == "{") ++depth;
      if (next == ")" || next == "]" || next == "}") --depth;
      const Token token = take();
      const bool joins = !text.empty() && (std::isalnum(static_cast<unsigned char>(text.back())) != 0) &&
                         (std::isalnum(static_cast<unsigned char>(token.text[0])) != 0);
      text += (joins ? " " : "") + token.text;
    }
    return text;
  }

  bool read_type() {
    NedType type;
    type.place = peek().place;
    type.package = package_;
    if (is("network"))
      type.kind = NedType::Kind::network;
    else if (is("module") || is("simple"))
      type.kind = NedType::Kind::module;
    else if (is("channel"))
      type.kind = NedType::Kind::channel;
    else if (is("moduleinterface") || is("channelinterface")) {
      while (!at_end() && !is("{")) take();
      skip_brackets("{", "}");
      return true;
    } else
      return false;
    if (++depth_ > deepest_brackets) refuse(peek(), "types within types, too deep", "a few");
    take();
    type.name = take().text;
    if (read_if("extends")) type.base = last_part(dotted());
    while (read_if(",")) dotted();
    if (read_if("like")) do
        dotted();
      while (read_if(","));
    expect("{");
    read_body(type);
    expect("}");
    types_.push_back(std::move(type));
    --depth_;
    return true;
  }

  void read_body(NedType& type) {
    std::string section = "parameters";
    while (!failed_ && !at_end() && !is("}")) {
      static constexpr std::array sections = {"parameters", "submodules", "connections", "gates", "types"};
      const bool begins = std::ranges::find(sections, peek().text) != sections.end() &&
                          (peek(1).text == ":" || peek(1).text == "allowunconnected");
      if (begins) {
        section = take().text;
        read_if("allowunconnected");
        expect(":");
      } else if (is("@"))
        skip_property();
      else if (section == "parameters")
        read_parameter(type.parameters);
      else if (section == "gates")
        skip_to(";");
      else if (section == "types") {
        if (!read_type()) refuse(take(), "not a type", "channel or module");
      } else if (section == "submodules")
        read_submodule(type.submodules);
      else
        read_connections(type.connections, {});
    }
  }

  /// "int n = default(3);", "*.eth[*].bitrate = 1Gbps;", "volatile double d @unit(s);"
  void read_parameter(std::vector<NedAssignment>& into) {
    NedAssignment made;
    made.place = peek().place;
    while (is("volatile") || is("bool") || is("int") || is("double") || is("string") || is("xml") || is("object"))
      take();
    while (!at_end() && !failed_ && !is("=") && !is(";") && !is("@") && !is("}")) made.pattern += take().text;
    while (is("@")) {
      take();
      take();
      if (is("(")) skip_brackets("(", ")");
    }
    if (read_if("=")) {
      made.expression = expression({";", "@"});
      while (is("@")) {
        take();
        take();
        if (is("(")) skip_brackets("(", ")");
      }
      made.is_default = made.expression.starts_with("default(") && made.expression.ends_with(")");
      if (made.is_default) made.expression = made.expression.substr(8, made.expression.size() - 9);
      into.push_back(std::move(made));
    }
    expect(";");
  }

  void read_submodule(std::vector<NedSubmodule>& into) {
    NedSubmodule made;
    const Token name = take();
    made.name = name.text;
    made.place = name.place;
    if (read_if("[")) {
      made.size = expression({"]"});
      expect("]");
    }
    expect(":");
    if (read_if("<")) {
      made.is_chosen = true;
      made.chosen = expression({">"});
      expect(">");
      if (made.chosen.starts_with("default(") && made.chosen.ends_with(")"))
        made.chosen = made.chosen.substr(8, made.chosen.size() - 9);
      expect("like");
      dotted();
    } else {
      made.type = last_part(dotted());
      if (read_if("like")) dotted();
    }
    if (read_if("if")) made.condition = expression({";", "{"});
    if (!read_if(";")) {
      expect("{");
      std::string section = "parameters";
      while (!failed_ && !at_end() && !is("}")) {
        if ((is("parameters") || is("gates")) && peek(1).text == ":") {
          section = take().text;
          take();
        } else if (is("@"))
          skip_property();
        else if (section == "gates")
          skip_to(";");
        else
          read_parameter(made.parameters);
      }
      expect("}");
      read_if(";");
    }
    into.push_back(std::move(made));
  }

  NedEnd read_end() {
    NedEnd end;
    end.node = take().text;
    if (read_if("[")) {
      end.index = expression({"]"});
      expect("]");
    }
    if (!read_if(".")) {  // a gate of the network itself
      end.is_ethernet = false;
      return end;
    }
    end.is_ethernet = take().text == "ethg";
    if (read_if("$")) take();
    if (read_if("++")) return end;
    if (read_if("[")) {
      end.gate = expression({"]"});
      expect("]");
    }
    return end;
  }

  /// "for i=0..n-1, if i > 2 { ... }", or one connection with what stands behind it.
  void read_connections(std::vector<NedConnection>& into, std::vector<NedConnection::Bracket> brackets) {
    if (++depth_ > deepest_brackets) return refuse(peek(), "loops within loops, too deep", "a few");
    if (is("for") || is("if")) {
      read_brackets(brackets);
      expect("{");
      while (!failed_ && !at_end() && !is("}")) read_connections(into, brackets);
      expect("}");
      read_if(";");
    } else {
      read_connection(into, std::move(brackets));
    }
    --depth_;
  }
  void read_brackets(std::vector<NedConnection::Bracket>& brackets) {
    do {
      if (read_if("for")) {
        NedConnection::Bracket loop;
        loop.name = take().text;
        expect("=");
        loop.from = expression({".."});
        expect("..");
        loop.to = expression({",", "{", ";"});
        brackets.push_back(std::move(loop));
      } else if (read_if("if")) {
        brackets.push_back({"", expression({",", "{", ";"}), ""});
      } else {
        return refuse(take(), "neither a loop nor a condition", "for or if");
      }
    } while (read_if(",") && !failed_);
  }
  void read_connection(std::vector<NedConnection>& into, std::vector<NedConnection::Bracket> brackets) {
    NedConnection made;
    made.place = peek().place;
    made.a = read_end();
    const Token arrow = take();
    if (arrow.text != "<-->" && arrow.text != "-->" && arrow.text != "<--")
      return refuse(arrow, "not a connection", "<-->");
    if (is("{") || !is_end_here()) {
      if (!is("{")) made.channel = last_part(dotted());
      if (read_if("{")) {
        while (!failed_ && !at_end() && !is("}")) {
          if (is("@"))
            skip_property();
          else if (is("parameters") && peek(1).text == ":") {
            take();
            take();
          } else
            read_parameter(made.parameters);
        }
        expect("}");
      }
      take();  // the second arrow
    }
    made.b = read_end();
    if (is("for") || is("if")) read_brackets(brackets);
    made.brackets = std::move(brackets);
    expect(";");
    if (!failed_) into.push_back(std::move(made));
  }
  /// Whether an end of a connection comes, and not a channel: no further arrow follows before the semicolon.
  bool is_end_here() const {
    for (std::size_t i = 0; next_ + i < tokens_.size(); ++i) {
      const std::string& text = peek(i).text;
      if (text == "<-->" || text == "-->" || text == "<--" || text == "{") return false;
      if (text == ";" || text == "}") return true;
    }
    return true;
  }

  std::vector<Token> tokens_;
  json::Diagnostics& diagnostics_;
  Token end_;
  std::size_t next_ = 0;
  bool failed_ = false;
  std::uint32_t depth_ = 0;
  std::string package_;
  std::vector<NedType> types_;
};

}  // namespace

std::vector<NedType> read_ned(const InputFile& file, json::Diagnostics& diagnostics) {
  return Parser(file, diagnostics).run();
}

}  // namespace takt::interchange::inet
