// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/odd_names.hpp"

#include <algorithm>
#include <map>
#include <vector>

namespace takt::generator {
namespace {

/// What the loader takes in every name: it refuses control characters, '/' and, of nodes, ':'.
const std::vector<std::string>& pieces() {
  static const std::vector<std::string> all = {" ",
                                               "  ",
                                               "\"",
                                               "'",
                                               "\\",
                                               "<b>",
                                               "<!--",
                                               "&amp;",
                                               "&",
                                               ",",
                                               ";",
                                               "$(x)",
                                               "${x}",
                                               "`x`",
                                               "|",
                                               ">",
                                               "*",
                                               "?",
                                               "#",
                                               "%s",
                                               "%",
                                               "=",
                                               "=1+1",
                                               "@",
                                               "-",
                                               "--",
                                               "0",
                                               "17",
                                               ".",
                                               "..",
                                               "~",
                                               "[",
                                               "]",
                                               "{",
                                               "}",
                                               "(",
                                               "!",
                                               "^",
                                               "_x",
                                               "+",
                                               "null",
                                               "true",
                                               "1e9",
                                               "5us",
                                               "$end",
                                               "\xc3\xa4",
                                               "\xe6\xbc\xa2",
                                               "e\xcc\x81",
                                               "\xf0\x9f\x98\x80"};
  return all;
}

void collect(const Node& node, bool is_root, std::set<std::string>& names) {
  for (const Node& each : node.items) collect(each, false, names);
  for (const json::Member& member : node.members) {
    if (member.key == "name" && !is_root && member.value.kind == json::Kind::string) names.insert(member.value.text);
    collect(member.value, false, names);
  }
}

using Renamed = std::map<std::string, std::string>;

const std::string& of_part(const Renamed& renamed, const std::string& part) {
  const auto found = renamed.find(part);
  return found == renamed.end() ? part : found->second;
}

std::string of_text(const Renamed& renamed, const std::string& text) {
  if (const auto whole = renamed.find(text); whole != renamed.end()) return whole->second;
  if (const std::size_t colon = text.rfind(':'); colon != std::string::npos)
    return of_part(renamed, text.substr(0, colon)) + text.substr(colon);
  std::string made;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('/', begin), text.size());
    made += (begin == 0 ? "" : "/") + of_part(renamed, text.substr(begin, end - begin));
    begin = end + 1;
  }
  return made;
}

void rename(Node& node, const Renamed& renamed) {
  if (node.kind == json::Kind::string) node.text = of_text(renamed, node.text);
  for (Node& each : node.items) rename(each, renamed);
  for (json::Member& member : node.members) {
    member.key = of_part(renamed, member.key);
    rename(member.value, renamed);
  }
}

}  // namespace

std::set<std::string> names_in(const Node& root) {
  std::set<std::string> names;
  collect(root, true, names);
  const Node* const network = root.find("network");
  if (const Node* const nodes = network == nullptr ? nullptr : network->find("nodes"))
    for (const json::Member& member : nodes->members) names.insert(member.key);
  return names;
}

void give_odd_names(Node& root, Draw& draw) {
  Renamed renamed;
  for (const std::string& name : names_in(root)) {
    std::string& made = renamed[name];
    if (draw.percent(70)) made += draw.any(pieces());
    made += name;
    if (draw.percent(70)) made += draw.any(pieces());
  }
  rename(root, renamed);
}

}  // namespace takt::generator
