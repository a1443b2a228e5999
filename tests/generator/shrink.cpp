// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/shrink.hpp"

#include <algorithm>
#include <vector>

#include "json/document.hpp"

namespace takt::generator {
namespace {

using json::Node;

/// Steps by number: items and members alike.
using Place = std::vector<std::size_t>;

std::size_t size_of(const Node& node) {
  return node.kind == json::Kind::array ? node.items.size() : node.kind == json::Kind::object ? node.members.size() : 0;
}
const Node& child(const Node& node, std::size_t n) {
  return node.kind == json::Kind::array ? node.items[n] : node.members[n].value;
}

/// All parts, those near the root first.
std::vector<Place> places_of(const Node& root) {
  std::vector<Place> all = {{}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Node* at = &root;
    for (const std::size_t step : all[i]) at = &child(*at, step);
    const Place from = all[i];
    for (std::size_t n = size_of(*at); n > 0; --n) {  // later ones first, so that the places of the others stay
      all.push_back(from);
      all.back().push_back(n - 1);
    }
  }
  all.erase(all.begin());
  return all;
}

bool leave_out(Node& root, const Place& place) {
  Node* at = &root;
  for (std::size_t i = 0; i + 1 < place.size(); ++i) {
    if (place[i] >= size_of(*at)) return false;
    at = const_cast<Node*>(&child(*at, place[i]));
  }
  const std::size_t last = place.back();
  if (last >= size_of(*at)) return false;
  if (at->kind == json::Kind::array)
    at->items.erase(at->items.begin() + static_cast<std::ptrdiff_t>(last));
  else
    at->members.erase(at->members.begin() + static_cast<std::ptrdiff_t>(last));
  return true;
}

class Shrinker {
 public:
  Shrinker(Node root, const std::function<bool(const std::string&)>& still, unsigned questions)
      : root_(std::move(root)), still_(still), left_(questions) {}

  std::string run() {
    drop_hosts();
    for (bool is_less = true; is_less && left_ > 0;) {
      is_less = leave_out_parts();
      is_less |= shorten();
    }
    return json::pretty(root_);
  }

 private:
  bool keep_if_still(Node candidate) {
    if (left_ == 0) return false;
    --left_;
    if (!still_(json::pretty(candidate))) return false;
    root_ = std::move(candidate);
    return true;
  }

  /// A node goes with its links only.
  void drop_hosts() {
    const Node* const nodes = root_.find("network") == nullptr ? nullptr : root_.find("network")->find("nodes");
    if (nodes == nullptr) return;
    std::vector<std::string> names;
    for (const json::Member& each : nodes->members) names.push_back(each.key);
    for (const std::string& name : names) {
      Node candidate = root_;
      Node& network = *candidate.find("network");
      std::erase_if(network.find("nodes")->members, [&](const json::Member& each) { return each.key == name; });
      if (Node* const links = network.find("links"))
        std::erase_if(links->items, [&](const Node& each) {
          const Node* const ends = each.find("ends");
          return ends != nullptr && std::ranges::any_of(ends->items, [&](const Node& end) { return end.text == name; });
        });
      keep_if_still(std::move(candidate));
    }
  }

  bool leave_out_parts() {
    bool is_less = false;
    for (const Place& place : places_of(root_)) {
      Node candidate = root_;
      if (leave_out(candidate, place)) is_less |= keep_if_still(std::move(candidate));
      if (left_ == 0) break;
    }
    return is_less;
  }

  bool shorten() {
    bool is_less = false;
    for (;;) {
      const Node* const duration = root_.find("duration");
      if (duration == nullptr || !duration->text.ends_with("us")) return is_less;
      const unsigned long us = std::stoul(duration->text);
      if (us < 20) return is_less;
      Node candidate = root_;
      candidate.find("duration")->text = std::to_string(us / 2) + "us";
      if (!keep_if_still(std::move(candidate))) return is_less;
      is_less = true;
    }
  }

  Node root_;
  const std::function<bool(const std::string&)>& still_;
  unsigned left_;
};

}  // namespace

std::string shrink(const std::string& text, const std::function<bool(const std::string& text)>& still,
                   unsigned most_questions) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(text, "s.json", diagnostics);
  if (!document) return text;
  return Shrinker(document->root(), still, most_questions).run();
}

}  // namespace takt::generator
