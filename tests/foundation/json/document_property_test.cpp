// SPDX-License-Identifier: Apache-2.0
// Texts of random values with random space and comments between the tokens: every value comes back, at its place.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "json/document.hpp"

namespace takt::json {
namespace {

/// Writes a value with noise and notes where each token was put: an oracle that counts while it writes.
class Writer {
 public:
  explicit Writer(std::vector<std::uint8_t> noise) : noise_(std::move(noise)) {}

  void write(Node& node) {
    put_noise();
    node.position = here_;
    if (node.kind == Kind::array) {
      put("[");
      for (Node& item : node.items) {
        if (&item != &node.items.front()) put_noise(), put(",");
        write(item);
      }
      put_noise(), put("]");
    } else if (node.kind == Kind::object) {
      put("{");
      for (Member& member : node.members) {
        if (&member != &node.members.front()) put_noise(), put(",");
        put_noise();
        member.key_position = here_;
        put(compact(Node::of_string(member.key)));
        put_noise(), put(":");
        write(member.value);
      }
      put_noise(), put("}");
    } else {
      put(compact(node));
    }
  }
  const std::string& text() const { return text_; }

 private:
  void put_noise() {
    static constexpr std::string_view pieces[] = {
        "", "", "", " ", "\n", "\t", "\r\n", "/* , : \" { */", "// ] \"\u00e4\n", "/*\n*/", " \u002f* \u20ac *\u002f "};
    if (!noise_.empty()) put(pieces[noise_[next_++ % noise_.size()] % std::size(pieces)]);
  }
  void put(std::string_view text) {
    text_ += text;
    for (const char c : text) {
      if (c == '\n')
        ++here_.line, here_.column = 1;
      else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U)
        ++here_.column;
    }
  }

  std::vector<std::uint8_t> noise_;
  std::size_t next_ = 0;
  std::string text_;
  Position here_{0, 1, 1};
};

std::string random_text() {
  static constexpr std::string_view pieces[] = {"a",          "\"", "\\", "/", "\n",   "\u00e4", "\u20ac",
                                                "\U0001F600", "~",  ",",  "]", "\x01", "//"};
  std::string text;
  for (const int piece : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 13))) text += pieces[piece];
  return text;
}

Node random_value(int depth) {
  switch (*rc::gen::inRange(0, depth > 0 ? 7 : 5)) {
    case 0:
      return {};
    case 1:
      return Node::of_bool(*rc::gen::arbitrary<bool>());
    case 2:
      return Node::of_integer(*rc::gen::arbitrary<std::int64_t>());
    case 3:
      return Node::of_double(*rc::gen::arbitrary<std::int16_t>() / 64.0);
    case 4:
      return Node::of_string(random_text());
    case 5: {
      Node node = Node::array();
      for (int count = *rc::gen::inRange(0, 4); count > 0; --count) node.items.push_back(random_value(depth - 1));
      return node;
    }
    default: {
      Node node = Node::object();
      for (int count = *rc::gen::inRange(0, 4); count > 0; --count)
        node.add(random_text() + std::to_string(count), random_value(depth - 1));
      return node;
    }
  }
}

void expect_same_places(const Node& a, const Node& b) {
  RC_ASSERT(a.position == b.position);
  for (std::size_t i = 0; i < a.items.size(); ++i) expect_same_places(a.items[i], b.items[i]);
  for (std::size_t i = 0; i < a.members.size(); ++i) {
    RC_ASSERT(a.members[i].key_position == b.members[i].key_position);
    expect_same_places(a.members[i].value, b.members[i].value);
  }
}

RC_GTEST_PROP(Parse, ReadsEveryValueAtItsPlace, (const std::vector<std::uint8_t>& noise)) {
  Node value = random_value(4);
  Writer writer(noise);
  writer.write(value);
  Diagnostics diagnostics;
  const auto document = parse(writer.text(), "a.json", diagnostics);
  RC_ASSERT(document.has_value() && !diagnostics.has_errors());
  RC_ASSERT(equal(document->root(), value));
  expect_same_places(document->root(), value);
}

RC_GTEST_PROP(Parse, ReadsBackItsOwnText, ()) {
  const Node value = random_value(4);
  Diagnostics diagnostics;
  for (const std::string& text : {pretty(value), compact(value)}) {
    const auto document = parse(text, "a.json", diagnostics);
    RC_ASSERT(document && equal(document->root(), value));
    // The library agrees on what the text means.
    RC_ASSERT(nlohmann::json::parse(text) == nlohmann::json::parse(compact(document->root())));
  }
}

RC_GTEST_PROP(Parse, RefusesDamagedTextAtAPlaceInIt, (const std::vector<std::uint8_t>& noise)) {
  Node value = random_value(3);
  Writer writer(noise);
  writer.write(value);
  std::string text = writer.text();
  auto position = *rc::gen::inRange<std::size_t>(0, text.size() + 1);
  while (position < text.size() && (static_cast<unsigned char>(text[position]) & 0xC0U) == 0x80U) ++position;
  static constexpr std::string_view damage = "\",:[]{}'x0-\\/#\n\xC3";
  text.insert(position, 1, damage[*rc::gen::inRange<std::size_t>(0, damage.size())]);

  Diagnostics diagnostics;
  const auto document = parse(text, "a.json", diagnostics);
  // The library is the oracle, except that it takes any octets in comments.
  if (document) {
    RC_ASSERT(nlohmann::json::accept(text, true));
    return;
  }
  RC_ASSERT(diagnostics.errors() == 1U);
  const Place& place = diagnostics.kept().front().place;
  const auto lines = static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  RC_ASSERT(place.line >= 1U && place.line <= lines && place.column >= 1U && place.column <= text.size() + 1);
  if (text[position] != '\xC3') RC_ASSERT(!nlohmann::json::accept(text, true));
}

}  // namespace
}  // namespace takt::json
