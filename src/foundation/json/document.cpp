// SPDX-License-Identifier: Apache-2.0
#include "json/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "json/syntax.hpp"
#include "sim/check.hpp"

namespace takt::json {

namespace {

/// Builds the tree from the library's events. The library says what comes; where it is, and how it was written, is read
/// from the text: from the end of the previous token to the start of this one there are only separators.
class TreeBuilder {
 public:
  TreeBuilder(std::string_view text, const std::string& file_name, Diagnostics& diagnostics)
      : cursor_(text), file_name_(file_name), diagnostics_(diagnostics) {}

  Node release_root() { return std::move(root_); }

  // The library's interface: false stops the parser.
  bool null() { return scalar(Kind::null); }
  bool boolean(bool value) { return scalar(Kind::boolean, {}, value); }
  bool number_integer(std::int64_t) { return scalar(Kind::number); }
  bool number_unsigned(std::uint64_t) { return scalar(Kind::number); }
  bool number_float(double, const std::string&) { return scalar(Kind::number); }
  bool string(std::string& value) { return scalar(Kind::string, std::move(value)); }
  bool binary(std::vector<std::uint8_t>&) { return false; }  // no JSON text has these
  bool start_object(std::size_t) { return open(Kind::object); }
  bool start_array(std::size_t) { return open(Kind::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name);
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&);

 private:
  /// An array or object whose end has not come yet.
  struct Open {
    Node node;
    std::string key;  ///< of the member that is being read
    Position key_position;
  };

  bool scalar(Kind kind, std::string text = {}, bool boolean = false);
  bool open(Kind kind);
  bool close();
  bool count_value(const Node& value);
  void attach(Node value);
  void drop_duplicates(Node& object);
  std::string pointer() const;
  bool fail(Position position, std::string message, Details details);
  bool report_syntax_error();

  Cursor cursor_;
  const std::string& file_name_;
  Diagnostics& diagnostics_;
  Before before_ = Before::nothing;
  std::size_t memory_ = 0;  // of all values and names
  std::vector<Open> open_;
  Node root_;
};

bool TreeBuilder::scalar(Kind kind, std::string text, bool boolean) {
  const Cursor before_token = cursor_;
  cursor_.skip_to_token();
  Node node;
  node.kind = kind;
  node.boolean = boolean;
  node.position = cursor_.position();
  const std::string_view token = cursor_.read_token();
  // The library reads "01" as 0 and then stumbles over 1; the user wrote one word, and that is what is wrong.
  if (kind != Kind::string && !is_word_of_json(token)) {
    cursor_ = before_token;
    return report_syntax_error();
  }
  node.text = kind == Kind::number ? std::string(token) : std::move(text);
  if (!count_value(node)) return false;
  attach(std::move(node));
  return true;
}

bool TreeBuilder::open(Kind kind) {
  cursor_.skip_to_token();
  Node node;
  node.kind = kind;
  node.position = cursor_.position();
  if (open_.size() == max_depth)
    return fail(node.position, "arrays and objects are nested too deeply",
                {"", fmt::format("at most {} levels", max_depth), ""});
  cursor_.read_token();
  if (!count_value(node)) return false;
  open_.push_back({std::move(node), {}, {}});
  before_ = kind == Kind::object ? Before::object_start : Before::array_start;
  return true;
}

bool TreeBuilder::close() {
  TAKT_CHECK(!open_.empty(), "the parser closes only what it opened");
  cursor_.skip_to_token();
  cursor_.read_token();
  Node node = std::move(open_.back().node);
  if (node.kind == Kind::object) drop_duplicates(node);
  open_.pop_back();
  attach(std::move(node));
  return true;
}

bool TreeBuilder::key(std::string& name) {
  TAKT_CHECK(!open_.empty(), "a name is part of an object");
  cursor_.skip_to_token();
  const Position position = cursor_.position();
  if (name.size() > max_key_length)
    return fail(position, "a name that is too long",
                {quote(name), fmt::format("at most {} octets", max_key_length), ""});
  cursor_.read_token();
  open_.back().key = std::move(name);
  open_.back().key_position = position;
  before_ = Before::key;
  return true;
}

/// What the value takes when it is part of the tree. Longer texts than a string holds in itself are allocations.
bool TreeBuilder::count_value(const Node& value) {
  const auto allocated = [](const std::string& text) { return text.size() > 15 ? text.capacity() : 0; };
  const bool is_member = !open_.empty() && open_.back().node.kind == Kind::object;
  memory_ += is_member ? sizeof(Member) + allocated(open_.back().key) : sizeof(Node);
  memory_ += allocated(value.text);
  if (memory_ <= max_memory) return true;
  return fail(value.position, "values that take too much memory",
              {"", fmt::format("at most {} MiB", max_memory >> 20), ""});
}

void TreeBuilder::attach(Node value) {
  if (open_.empty()) {
    root_ = std::move(value);
    before_ = Before::whole_value;
    return;
  }
  Open& parent = open_.back();
  if (parent.node.kind == Kind::array) {
    parent.node.items.push_back(std::move(value));
    before_ = Before::array_item;
  } else {
    parent.node.members.push_back({std::move(parent.key), parent.key_position, std::move(value)});
    before_ = Before::object_member;
  }
}

/// Reports the names that occur twice and keeps the first of each.
void TreeBuilder::drop_duplicates(Node& object) {
  auto& members = object.members;
  std::vector<std::size_t> order(members.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return members[a].key < members[b].key; });

  std::vector<bool> is_duplicate(members.size());
  std::size_t first = 0;  // into order: the first member of this name
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Member& member = members[order[i]];
    if (member.key != members[order[first]].key) {
      first = i;
      continue;
    }
    is_duplicate[order[i]] = true;
    const Position earlier = members[order[first]].key_position;
    open_.back().key = member.key;
    diagnostics_.error(
        {file_name_, member.key_position.line, member.key_position.column, pointer()},
        fmt::format("the name {} occurs twice", quote(member.key)),
        {"", fmt::format("one value (the first is in line {}, column {})", earlier.line, earlier.column), ""});
  }
  std::size_t index = 0;
  std::erase_if(members, [&](const Member&) { return is_duplicate[index++]; });
}

/// Of the member or item that is being read.
std::string TreeBuilder::pointer() const {
  std::string text;
  for (const Open& level : open_) {
    if (level.node.kind == Kind::array)
      text += pointer_step(level.node.items.size());
    else if (&level != &open_.back() || before_ != Before::object_start)
      text += pointer_step(level.key);
  }
  return text;
}

bool TreeBuilder::fail(Position position, std::string message, Details details) {
  diagnostics_.error({file_name_, position.line, position.column, pointer()}, std::move(message), std::move(details));
  return false;
}

bool TreeBuilder::parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) {
  return report_syntax_error();
}

bool TreeBuilder::report_syntax_error() {
  SyntaxError error = explain(cursor_, before_);
  // A syntax error is a matter of the text, not of a value: it has no pointer.
  diagnostics_.error({file_name_, error.position.line, error.position.column, ""}, std::move(error.message),
                     std::move(error.details));
  return false;
}

void link_parents(Node& node) {
  for (Node& item : node.items) {
    item.parent = &node;
    link_parents(item);
  }
  for (Member& member : node.members) {
    member.value.parent = &node;
    link_parents(member.value);
  }
}

}  // namespace

std::optional<Document> parse(std::string_view text, std::string file_name, Diagnostics& diagnostics) {
  if (text.size() > max_text_size) {
    diagnostics.error({file_name, 0, 0, ""}, "the text is too large",
                      {fmt::format("{} octets", text.size()), fmt::format("at most {}", max_text_size), ""});
    return std::nullopt;
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // editors of Windows put it there
  if (auto error = find_bad_octet(text)) {
    diagnostics.error({file_name, error->position.line, error->position.column, ""}, std::move(error->message),
                      std::move(error->details));
    return std::nullopt;
  }
  const auto without = without_trailing_commas(text);
  if (without) text = *without;
  TreeBuilder builder(text, file_name, diagnostics);
  if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder, nlohmann::json::input_format_t::json, true, true))
    return std::nullopt;
  return Document(builder.release_root(), std::move(file_name));
}

std::optional<Document> parse_file(const std::string& path, Diagnostics& diagnostics) {
  const auto fail = [&](const char* message, int reason) {
    diagnostics.error({path, 0, 0, ""}, message, {reason != 0 ? std::strerror(reason) : "", "", ""});
    return std::nullopt;
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (file == nullptr) return fail("the file cannot be opened", errno);
  std::string text;
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file.get())) {
    text.append(buffer, count);
    if (text.size() > max_text_size) break;  // parse() says so
  }
  if (std::ferror(file.get()) != 0) return fail("the file cannot be read", errno);
  return parse(text, path, diagnostics);
}

Document::Document(Node root, std::string file_name, std::string prefix)
    : Document(Tree{std::move(root), {std::move(file_name)}, std::move(prefix)}) {}

Document::Document(Tree tree) {
  TAKT_CHECK(!tree.sources.empty(), "the first source is the file");
  const auto owned = std::make_shared<Tree>(std::move(tree));
  owned->root.parent = nullptr;
  link_parents(owned->root);
  tree_ = owned;
}

std::string pointer_step(std::string_view key) {
  std::string text = "/";
  for (const char c : key) {
    if (c == '~')
      text += "~0";
    else if (c == '/')
      text += "~1";
    else
      text += c;
  }
  return text;
}

std::string pointer_step(std::size_t index) { return "/" + std::to_string(index); }

std::string pointer_of(const Node& node) {
  if (node.parent == nullptr) return {};
  const Node& parent = *node.parent;
  std::string text = pointer_of(parent);
  if (parent.kind == Kind::array) return text + pointer_step(static_cast<std::size_t>(&node - parent.items.data()));
  // Parents know their members in order; a member is found by where its value lies.
  const auto member =
      std::ranges::partition_point(parent.members, [&node](const Member& m) { return std::less<>{}(&m.value, &node); });
  TAKT_CHECK(member != parent.members.end() && &member->value == &node, "a node is a member of its parent");
  return text + pointer_step(member->key);
}

Place place_of(const Tree& tree, Position position, std::string pointer) {
  TAKT_CHECK(position.source < tree.sources.size(), "a position's source is one of the tree's");
  // What overrides put there is told by where it stands in the document, as they name it.
  return {tree.sources[position.source], position.line, position.column,
          position.source == 0 ? tree.prefix + pointer : std::move(pointer)};
}

Place place_of(const Tree& tree, const Node& node) { return place_of(tree, node.position, pointer_of(node)); }

Place Source::place() const { return node_ == nullptr ? Place{} : place_of(*tree_, *node_); }

Place Source::at(std::string_view member) const {
  if (node_ == nullptr) return {"", 0, 0, pointer_step(member)};
  if (const Node* value = node_->find(member)) return place_of(*tree_, *value);
  Place around = place();
  if (node_->kind == Kind::object) around.pointer += pointer_step(member);
  return around;
}

Place Source::at(std::string_view member, std::size_t index) const {
  const Node* list = node_ == nullptr ? nullptr : node_->find(member);
  if (list != nullptr && index < list->items.size()) return place_of(*tree_, list->items[index]);
  Place around = at(member);
  around.pointer += pointer_step(index);
  return around;
}

Place Source::item(std::size_t index) const {
  if (node_ != nullptr && index < node_->items.size()) return place_of(*tree_, node_->items[index]);
  Place around = place();
  around.pointer += pointer_step(index);
  return around;
}

Place Source::key(std::string_view member) const {
  if (node_ != nullptr) {
    const auto found = std::ranges::find(node_->members, member, &Member::key);
    if (found != node_->members.end()) return place_of(*tree_, found->key_position, pointer_of(found->value));
  }
  return at(member);
}

bool Source::has(std::string_view member) const { return node_ != nullptr && node_->find(member) != nullptr; }

}  // namespace takt::json
