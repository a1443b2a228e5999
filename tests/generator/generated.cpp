// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/generated.hpp"

#include <algorithm>
#include <optional>

#include "scenario/resolve.hpp"
#include "tests/generator/maker.hpp"
#include "tests/generator/odd_names.hpp"

namespace takt::generator {
namespace {

constexpr unsigned most_repairs = 100;

/// The steps of a pointer without escapes, which generated names have none of.
std::vector<std::string> steps_of(const std::string& pointer) {
  std::vector<std::string> steps;
  for (std::size_t begin = 1; begin <= pointer.size() && !pointer.empty();) {
    const std::size_t end = std::min(pointer.find('/', begin), pointer.size());
    steps.push_back(pointer.substr(begin, end - begin));
    begin = end + 1;
  }
  return steps;
}

/// Leaves out the last `up` steps' part of what the pointer names. False if there is no such part.
bool leave_out(Node& root, const std::string& pointer, std::size_t up) {
  std::vector<std::string> steps = steps_of(pointer);
  if (steps.size() <= up) return false;
  steps.resize(steps.size() - up);
  Node* at = &root;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if (at->kind == json::Kind::array) {
      const std::size_t index = std::stoul(steps[i]);
      if (index >= at->items.size()) return false;
      at = &at->items[index];
    } else if (at = at->find(steps[i]); at == nullptr) {
      return false;
    }
  }
  if (at->kind == json::Kind::array) {
    const std::size_t index = std::stoul(steps.back());
    if (index >= at->items.size()) return false;
    at->items.erase(at->items.begin() + static_cast<std::ptrdiff_t>(index));
    return true;
  }
  return std::erase_if(at->members, [&](const json::Member& member) { return member.key == steps.back(); }) > 0;
}

/// What the diagnostics name is left out, or what is around it: a member that may not be missing is named again, and
/// then more of it goes.
class Repair {
 public:
  explicit Repair(Node& root) : root_(root) {}

  bool operator()(const json::Diagnostics& diagnostics) {
    for (const json::Diagnostic& each : diagnostics.kept()) {
      if (each.severity != json::Severity::error) continue;
      const std::string& pointer = each.place.pointer;
      if (pointer == "/network" && root_.find("allow_overload") == nullptr) {  // more load than the links carry
        root_.add("allow_overload", Node::of_bool(true));
        return true;
      }
      const std::size_t up = pointer == last_ ? ++times_ : (times_ = 0);
      last_ = pointer;
      for (std::size_t more = up; more < up + 6; ++more)
        if (leave_out(root_, pointer, more)) return true;
      return false;
    }
    return false;
  }

 private:
  Node& root_;
  std::string last_;
  std::size_t times_ = 0;
};

std::set<Feature> asked_by(std::uint64_t number) {
  static const std::vector<std::pair<Feature, Feature>> all = pairs();
  // A step that has no factor in common with the number of pairs goes through all of them, and neighbours differ.
  const auto& [a, b] = all[number * 7919 % all.size()];
  std::set<Feature> asked = {a, b};
  Draw draw(number ^ 0x5DEECE66DULL);
  for (std::size_t more = draw.below(4); more > 0; --more) {
    const Feature next = features()[draw.below(features().size())].feature;
    if (std::ranges::none_of(asked, [&](Feature each) { return excludes(each, next); })) asked.insert(next);
  }
  return asked;
}

/// Every third scenario, whatever its features.
bool has_odd_names(std::uint64_t number) { return number % 3 == 2; }

/// That is another scenario, since chance rests on names; but it is sound if this one is.
void rename(Generated& made, Node& root, std::uint64_t number) {
  Draw draw(number ^ 0x6E616D65ULL);
  give_odd_names(root, draw);
  made.text = json::pretty(root);
  json::Diagnostics diagnostics;
  made.resolved = scenario::load_text(made.text, file_name(), {}, diagnostics);
  if (!made.resolved) made.problem = "refused with other names: " + diagnostics.to_text();
}

}  // namespace

const std::string& file_name() {
  static const std::string name = std::string(TAKT_SOURCE_DIR) + "/tests/generator/traces/generated.json";
  return name;
}

Generated generate(std::uint64_t number) {
  Generated made;
  const std::set<Feature> asked = asked_by(number);
  made.asked.assign(asked.begin(), asked.end());
  Maker maker(number, asked);
  Node root = maker.scenario();
  Repair repair(root);
  for (;; ++made.repairs) {
    made.text = json::pretty(root);
    json::Diagnostics diagnostics;
    made.resolved = scenario::load_text(made.text, file_name(), {}, diagnostics);
    if (made.resolved) {
      if (has_odd_names(number)) rename(made, root, number);
      return made;
    }
    if (made.repairs == 0) made.first_refusal = diagnostics.to_text();
    if (made.repairs == most_repairs || !repair(diagnostics)) {
      made.problem = diagnostics.has_errors() ? diagnostics.to_text() : "refused without a reason";
      return made;
    }
  }
}

}  // namespace takt::generator
