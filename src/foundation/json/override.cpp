// SPDX-License-Identifier: Apache-2.0
#include "json/override.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "json/syntax.hpp"
#include "json/utf8.hpp"

namespace takt::json {

namespace {

/// The parts of an option, or what is wrong with it.
struct Parts {
  std::string_view text;
  std::vector<std::string> steps;
  std::string_view value;
  std::string error;
};

/// One step of an RFC 6901 pointer without its escapes, or nothing if a ~ stands alone.
std::optional<std::string> unescape(std::string_view step) {
  std::string text;
  for (std::size_t i = 0; i < step.size(); ++i) {
    if (step[i] != '~') {
      text += step[i];
      continue;
    }
    const char escaped = ++i < step.size() ? step[i] : '\0';
    if (escaped != '0' && escaped != '1') return std::nullopt;
    text += escaped == '0' ? '~' : '/';
  }
  return text;
}

/// The steps of a pointer of either form; an empty text, or what is wrong with it.
std::string split_pointer(std::string_view pointer, std::vector<std::string>& steps) {
  const bool is_rfc = pointer.starts_with('/');
  if (is_rfc) pointer.remove_prefix(1);
  for (bool is_last = false; !is_last;) {
    const std::size_t end = pointer.find(is_rfc ? '/' : '.');
    is_last = end == std::string_view::npos;
    const std::string_view step = pointer.substr(0, end);
    const auto key = is_rfc ? unescape(step) : std::string(step);
    if (!key) return "a ~ that is neither ~0 nor ~1";
    if (key->empty()) return "an empty step in the pointer";
    if (key->size() > max_key_length || steps.size() == max_depth) return "a pointer that is too long";
    steps.push_back(*key);
    if (!is_last) pointer.remove_prefix(end + 1);
  }
  return {};
}

Parts split(std::string_view text) {
  Parts option;
  option.text = text;
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return option.error = "no \"=\" in it", option;
  option.value = text.substr(equals + 1);
  const std::string_view pointer = text.substr(0, equals);
  if (pointer.empty()) return option.error = "nothing before the \"=\"", option;
  option.error = split_pointer(pointer, option.steps);
  return option;
}

std::size_t depth_of(const Node& node) {
  std::size_t deepest = 0;
  for (const Node& item : node.items) deepest = std::max(deepest, depth_of(item));
  for (const Member& member : node.members) deepest = std::max(deepest, depth_of(member.value));
  return deepest + (node.kind == Kind::array || node.kind == Kind::object ? 1 : 0);
}

void set_position(Node& node, Position position) {
  node.position = position;
  for (Node& item : node.items) set_position(item, position);
  for (Member& member : node.members) {
    member.key_position = position;
    set_position(member.value, position);
  }
}

/// The index that a step names in an array of this size; the size itself means the next item, as does "-".
std::optional<std::size_t> index_of(std::string_view step, std::size_t size) {
  if (step == "-") return size;
  const bool is_index =
      !step.empty() && step.size() <= 9 && std::ranges::all_of(step, [](char c) { return c >= '0' && c <= '9'; });
  if (!is_index || (step.size() > 1 && step.front() == '0')) return std::nullopt;
  std::size_t index = 0;
  for (const char c : step) index = index * 10 + static_cast<std::size_t>(c - '0');
  return index <= size ? std::optional(index) : std::nullopt;
}

/// Overrides under way: knows how to report.
class Override {
 public:
  Override(const Document& document, Diagnostics& diagnostics) : tree_(*document.tree()), diagnostics_(diagnostics) {}

  /// What follows comes from a source of this name, and is written there.
  void begin(std::string name, const Place& place = {}) {
    position_.line = place.line;
    position_.column = place.column;
    name_ = std::move(name);
    pointer_.clear();
    position_.source = static_cast<std::uint32_t>(tree_.sources.size());
    tree_.sources.push_back(name_);
  }
  bool apply(const Parts& option);
  bool replace(const Replacement& replacement);
  Tree release_tree() { return std::move(tree_); }

 private:
  std::optional<Node> read_value(std::string_view text, std::size_t depth);
  bool put(const std::vector<std::string>& steps, Node value);
  Node* enter(Node& node, const std::string& step);
  bool fail(std::string message, Details details);

  Tree tree_;
  std::string name_;
  Diagnostics& diagnostics_;
  Position position_;
  std::string pointer_;  ///< of the steps taken so far
};

bool Override::apply(const Parts& option) {
  if (const auto bad = find_bad_octet(option.text)) return fail(bad->message, bad->details);
  if (!option.error.empty())
    return fail("not an override", {option.error, "pointer=value, such as network.links.0.rate=100Mbps", ""});
  auto value = read_value(option.value, option.steps.size());
  return value && put(option.steps, std::move(*value));
}

bool Override::replace(const Replacement& replacement) {
  std::vector<std::string> steps;
  if (const std::string problem = split_pointer(replacement.pointer, steps); !problem.empty())
    return fail("not a pointer", {problem, "a JSON pointer such as /network/links/0/rate", ""});
  Node value = replacement.value;
  if (steps.size() + depth_of(value) > max_depth)
    return fail("arrays and objects are nested too deeply", {"", fmt::format("at most {} levels", max_depth), ""});
  set_position(value, position_);
  return put(steps, std::move(value));
}

bool Override::put(const std::vector<std::string>& steps, Node value) {
  Node* node = &tree_.root;
  for (const std::string& step : steps) {
    node = enter(*node, step);
    if (node == nullptr) return false;
  }
  *node = std::move(value);
  return true;
}

/// The value as JSON if it is JSON, else as a string. Text that begins like JSON but is not is a mistake.
std::optional<Node> Override::read_value(std::string_view text, std::size_t depth) {
  Diagnostics mistakes;
  const auto document = parse(text, name_, mistakes);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const char start = first == std::string_view::npos ? '\0' : text[first];
  const bool is_meant_as_json = start == '{' || start == '[' || start == '"';
  if (mistakes.has_errors() && is_meant_as_json) {
    for (const Diagnostic& mistake : mistakes.kept()) {
      Place place = mistake.place;
      place.line = place.column = 0;
      diagnostics_.error(std::move(place), "in the value: " + mistake.message, mistake.details);
    }
    return std::nullopt;
  }
  Node value = document && !mistakes.has_errors() ? document->root() : Node::of_string(text);
  if (depth + depth_of(value) > max_depth) {
    fail("arrays and objects are nested too deeply", {"", fmt::format("at most {} levels", max_depth), ""});
    return std::nullopt;
  }
  set_position(value, position_);
  return value;
}

/// The member or item that a step names; a new one, an empty object, if it is missing. Null if there can be none.
Node* Override::enter(Node& node, const std::string& step) {
  Node fresh = Node::object();
  fresh.position = position_;
  if (node.kind == Kind::object) {
    pointer_ += pointer_step(step);
    if (Node* member = node.find(step)) return member;
    node.members.push_back({step, position_, std::move(fresh)});
    return &node.members.back().value;
  }
  if (node.kind == Kind::array) {
    const auto index = index_of(step, node.items.size());
    if (!index) {
      fail("no such item",
           {quote(step), fmt::format("an index from 0 to {} ({} appends)", node.items.size(), node.items.size()), ""});
      return nullptr;
    }
    pointer_ += pointer_step(*index);
    if (*index == node.items.size()) node.items.push_back(std::move(fresh));
    return &node.items[*index];
  }
  fail(fmt::format("nothing can be set inside a value that is neither object nor array (step {})", quote(step)),
       {excerpt(node), "an object or an array", ""});
  return nullptr;
}

bool Override::fail(std::string message, Details details) {
  diagnostics_.error({name_, position_.line, position_.column, pointer_}, std::move(message), std::move(details));
  return false;
}

}  // namespace

bool apply(Document& document, std::string_view option, Diagnostics& diagnostics) {
  Override edit(document, diagnostics);
  edit.begin("--set " + std::string(first_octets(option, 200)));
  if (!edit.apply(split(option))) return false;
  document = Document(edit.release_tree());
  return true;
}

bool replace(Document& document, std::span<const Replacement> replacements, Diagnostics& diagnostics) {
  Override edit(document, diagnostics);
  bool is_done = true;
  for (const Replacement& replacement : replacements) {
    edit.begin(replacement.place.line != 0 ? replacement.place.file : replacement.origin, replacement.place);
    is_done = edit.replace(replacement) && is_done;
  }
  if (is_done) document = Document(edit.release_tree());
  return is_done;
}

}  // namespace takt::json
