#include "interchange/inet/ned.hpp"

#include <algorithm>
#include <charconv>
#include <map>

#include "json/node.hpp"

namespace takt::interchange::inet {
namespace {

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
      if (text[at] == '\n') { ++line; column = 1; } else ++column;
    }
  };
  const auto is_word = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.'; };
  while (at < text.size()) {
    const char c = text[at];
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') { advance(1); continue; }
    if (text.compare(at, 2, "//") == 0) { while (at < text.size() && text[at] != '\n') advance(1); continue; }
    Token token{"", {file.name, line, column, ""}};
    if (is_word(c)) {
      while (at < text.size() && is_word(text[at])) { token.text += text[at]; advance(1); }
    } else if (c == '"') {
      do { token.text += text[at]; advance(1); } while (at < text.size() && text[at] != '"' && text[at] != '\n');
      if (at >= text.size() || text[at] != '"') diagnostics.error(token.place, "a text that does not end", {json::quote(token.text), "a quote on the same line"});
      else advance(1);
    } else if (text.compare(at, 4, "<-->") == 0) { token.text = "<-->"; advance(4); }
    else if (text.compare(at, 2, "++") == 0) { token.text = "++"; advance(2); }
    else if (text.compare(at, 3, "-->") == 0 || text.compare(at, 3, "<--") == 0) { token.text = text.substr(at, 3); advance(3); }
    else { token.text = std::string(1, c); advance(1); }
    tokens.push_back(std::move(token));
  }
  return tokens;
}

class Parser {
 public:
  Parser(const InputFile& file, json::Diagnostics& diagnostics) : tokens_(tokens_of(file, diagnostics)), diagnostics_(diagnostics), end_{"", {file.name, tokens_.empty() ? 1u : tokens_.back().place.line, 1, ""}} {}

  std::vector<Network> run() {
    std::vector<Network> networks;
    std::string package;
    while (!at_end() && !failed_) {
      const Token token = take();
      if (token.text == "package") { package = take().text; expect(";"); }
      else if (token.text == "import") { take(); while (is("*")) take(); expect(";"); }
      else if (token.text == "network") { networks.push_back(read_network(token)); networks.back().package = package; }
      else if (token.text == "@") skip_property();
      else refuse(token, "not of the subset of NED that is read", "package, import or network");
    }
    return networks;
  }

 private:
  bool at_end() const { return next_ >= tokens_.size(); }
  const Token& peek() const { return at_end() ? end_ : tokens_[next_]; }
  bool is(std::string_view text) const { return !at_end() && tokens_[next_].text == text; }
  Token take() { return at_end() ? end_ : tokens_[next_++]; }
  void refuse(const Token& token, std::string message, std::string expected) {
    if (!failed_) diagnostics_.error(token.place, std::move(message), {token.text.empty() ? "the end" : json::quote(token.text), std::move(expected)});
    failed_ = true;
  }
  void expect(std::string_view text) {
    const Token token = take();
    if (token.text != text) refuse(token, "not of the subset of NED that is read", json::quote(text));
  }

  /// @name(...) with nested brackets; ends with a semicolon where it is a statement.
  void skip_property() {
    take();
    if (is("(")) skip_brackets("(", ")");
    if (is(";")) take();
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

  Network read_network(const Token& start) {
    Network network;
    network.place = start.place;
    network.name = take().text;
    if (is("extends")) {
      take();
      const Token base = take();
      if (!base.text.ends_with("TsnNetworkBase") && !base.text.ends_with("WiredNetworkBase")) refuse(base, "a base that is not read", "TsnNetworkBase or WiredNetworkBase");
    }
    expect("{");
    std::string section;
    while (!failed_ && !at_end() && !is("}")) {
      const Token token = take();
      if (token.text == "@") { skip_property(); continue; }
      if (token.text == "submodules" || token.text == "connections" || token.text == "parameters") {
        section = token.text;
        if (is("allowunconnected")) take();
        expect(":");
      } else if (section == "submodules") {
        read_submodule(token, network);
      } else if (section == "connections") {
        read_connection(token, network);
      } else {
        refuse(token, "not of the subset of NED that is read", "submodules and connections; parameters stand in the ini file");
      }
    }
    expect("}");
    return network;
  }

  void read_submodule(const Token& name, Network& network) {
    expect(":");
    const Token type = take();
    network.submodules.push_back({name.text, type.text.substr(type.text.rfind('.') + 1), name.place});
    if (is(";")) { take(); return; }
    if (!is("{")) return refuse(take(), "not of the subset of NED that is read", "\";\" or a body with properties");
    take();
    while (!failed_ && !at_end() && !is("}")) {
      const Token token = take();
      if (token.text == "@") skip_property();
      else if (token.text == "gates") {
        expect(":");
        if (take().text != "ethg") refuse(token, "gates that are not read", "ethg[N]");
        expect("[");
        take();
        expect("]");
        expect(";");
      } else {
        refuse(token, "not of the subset of NED that is read", "properties; parameters stand in the ini file");
      }
    }
    expect("}");
    if (is(";")) take();
  }

  /// NODE.ethg++ or NODE.ethg[2]
  std::uint32_t read_gate(const Token& end, std::string& node) {
    const std::size_t dot = end.text.find('.');
    node = end.text.substr(0, dot);
    if (dot == std::string::npos || end.text.substr(dot) != ".ethg") {
      refuse(end, "an end of a connection that is not read", "NODE.ethg++ or NODE.ethg[N]");
      return 0;
    }
    if (is("++")) {
      take();
      return next_eth_[node]++;
    }
    expect("[");
    const Token index = take();
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(index.text.data(), index.text.data() + index.text.size(), number);
    if (error != std::errc() || stop != index.text.data() + index.text.size() || number > 4095) refuse(index, "not an index", "a number");
    expect("]");
    return number;
  }

  void read_connection(const Token& first, Network& network) {
    if (first.text == "for" || first.text == "if") return refuse(first, "not of the subset of NED that is read", "connections written out, without loops and conditions");
    Connection connection;
    connection.place = first.place;
    connection.a_eth = read_gate(first, connection.a);
    expect("<-->");
    if (!(tokens_.size() > next_ + 1 && peek().text.ends_with(".ethg"))) {
      const Token channel = take();
      connection.channel = channel.text.substr(channel.text.rfind('.') + 1);
      if (is("{")) read_channel_body(connection);
      expect("<-->");
    }
    if (failed_) return;
    connection.b_eth = read_gate(take(), connection.b);
    expect(";");
    network.connections.push_back(std::move(connection));
  }

  void read_channel_body(Connection& connection) {
    take();
    while (!failed_ && !at_end() && !is("}")) {
      const Token key = take();
      if (key.text == "@") { skip_property(); continue; }
      expect("=");
      const Token value = take();
      expect(";");
      if (key.text == "datarate") connection.datarate = value.text;
      else if (key.text == "length") connection.length = value.text;
      else if (key.text == "delay") connection.delay = value.text;
      else refuse(key, "a parameter of a channel that is not read", "datarate, length or delay");
    }
    expect("}");
  }

  std::vector<Token> tokens_;
  json::Diagnostics& diagnostics_;
  Token end_;
  std::size_t next_ = 0;
  bool failed_ = false;
  std::map<std::string, std::uint32_t> next_eth_;
};

}  // namespace

std::vector<Network> read_ned(const InputFile& file, json::Diagnostics& diagnostics) { return Parser(file, diagnostics).run(); }

}  // namespace takt::interchange::inet
