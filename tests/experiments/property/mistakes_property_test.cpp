// SPDX-License-Identifier: Apache-2.0
// All mistakes of a file are told at once, and nothing but mistakes: whatever is broken in a shipped scenario, one
// thing or two that have nothing to do with each other, each is told where it stands, and no consequence is told
// beside.
//
// The number of breaks a scenario is small, for the test's sake; TAKT_MISTAKES=100000 tries them all.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "json/document.hpp"
#include "json/node.hpp"
#include "tests/simulation/scenario/support.hpp"
#include "tests/support/case_count.hpp"

namespace takt::scenario::test {
namespace {

using json::Kind;
using json::Node;

/// Where a value is: the number of the member or item at each depth.
using Route = std::vector<std::size_t>;

struct Break {
  Route route;
  std::string pointer;
  std::string key;  ///< the last step, or that of the array around it
  Node instead;
  bool holds_more;  ///< an array or an object
};

Node& at(Node& root, const Route& route) {
  Node* node = &root;
  for (const std::size_t step : route)
    node = node->kind == Kind::array ? &node->items[step] : &node->members[step].value;
  return *node;
}

/// Texts that may be anything: nobody can tell that they are wrong. Names are told by what refers to them.
bool is_free(const std::string& pointer, std::string_view key) {
  constexpr std::array<std::string_view, 10> keys = {"signal", "type",  "name",          "description", "$schema",
                                                     "skill",  "trace", "switch_prefix", "host_prefix", "unit"};
  return std::find(keys.begin(), keys.end(), key) != keys.end() || pointer.find("/offers") != std::string::npos ||
         pointer.find("/skills") != std::string::npos;
}

void collect(const Node& node, Route& route, const std::string& pointer, const std::string& key,
             std::vector<Break>& breaks) {
  const auto add = [&](Node instead) {
    breaks.push_back({route, pointer, key, std::move(instead), node.kind == Kind::array || node.kind == Kind::object});
  };
  if (!route.empty()) {
    const std::string nothing = "no such thing as " + std::to_string(breaks.size());  // no two are the same
    if (node.kind == Kind::string && !is_free(pointer, key)) add(Node::of_string(nothing));
    if (node.kind == Kind::string)
      add(Node::of_bool(true));
    else
      add(Node::of_string(nothing));
  }
  if (node.kind == Kind::array)
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      route.push_back(i);
      collect(node.items[i], route, pointer + json::pointer_step(i), key, breaks);
      route.pop_back();
    }
  if (node.kind == Kind::object)
    for (std::size_t i = 0; i < node.members.size(); ++i) {
      route.push_back(i);
      collect(node.members[i].value, route, pointer + json::pointer_step(node.members[i].key), node.members[i].key,
              breaks);
      route.pop_back();
    }
}

/// Whether a name or a kind goes with it, so that others rest on it: a list that is none, a node of no kind, a
/// generator of no shape.
bool is_foundation(const Break& each) {
  constexpr std::array<std::string_view, 16> keys = {"name",          "kind",        "topology",
                                                     "switches",      "depth",       "fanout",
                                                     "rows",          "columns",     "hosts_per_switch",
                                                     "switch_prefix", "host_prefix", "teeth",
                                                     "degree",        "seed",        "ends",
                                                     "generate"};
  return each.holds_more || std::find(keys.begin(), keys.end(), each.key) != keys.end();
}

std::vector<Break> breaks_of(const Node& root) {
  std::vector<Break> breaks;
  Route route;
  collect(root, route, "", "", breaks);
  return breaks;
}

bool is_within(std::string_view inner, std::string_view outer) {
  return inner == outer || (inner.starts_with(outer) && inner[outer.size()] == '/');
}

std::string text_of(const Node& root, const std::vector<const Break*>& breaks) {
  Node broken = root;
  for (const Break* each : breaks) at(broken, each->route) = each->instead;
  return json::pretty(broken);
}

/// Whether the sound scenario is warned of, too.
bool warns(const std::string& name, const std::string& message) {
  json::Diagnostics diagnostics;
  load_file(shipped_path(name), {}, diagnostics);
  return std::any_of(diagnostics.kept().begin(), diagnostics.kept().end(),
                     [&](const json::Diagnostic& each) { return each.message == message; });
}

/// What is wrong with what is said about a scenario with these mistakes; empty if each is told and nothing else.
std::string judge(const std::string& name, const Node& root, const std::vector<const Break*>& breaks) {
  json::Diagnostics diagnostics;
  load_text(text_of(root, breaks), shipped_path(name), {}, diagnostics);  // files that it names lie beside it
  std::string wrong;
  for (const Break* each : breaks)
    if (std::none_of(diagnostics.kept().begin(), diagnostics.kept().end(), [&](const json::Diagnostic& d) {
          return d.severity == json::Severity::error && is_within(d.place.pointer, each->pointer);
        }))
      wrong += "  not told: " + each->pointer + " = " + json::compact(each->instead) + "\n";
  // A warning that is true of the sound scenario may be told of the broken one.
  for (const json::Diagnostic& diagnostic : diagnostics.kept())
    if (!(diagnostic.severity == json::Severity::warning && warns(name, diagnostic.message)) &&
        std::none_of(breaks.begin(), breaks.end(),
                     [&](const Break* each) { return is_within(diagnostic.place.pointer, each->pointer); }))
      wrong += "  a consequence: " + json::to_text(diagnostic) + "\n";
  if (!wrong.empty())
    for (const Break* each : breaks) wrong = "  " + each->pointer + " = " + json::compact(each->instead) + "\n" + wrong;
  return wrong;
}

std::size_t most() { return support::case_count("TAKT_MISTAKES", 12); }

/// A number that looks like chance, the same in every run.
std::uint64_t scattered(std::uint64_t value) {
  value ^= value >> 31;
  value *= 0x9E37'79B9'7F4A'7C15ULL;
  return value ^ value >> 29;
}

Node root_of(const std::string& name) {
  json::Diagnostics diagnostics;
  const auto document = json::parse_file(shipped_path(name), diagnostics);
  EXPECT_TRUE(document) << diagnostics.to_text();
  return document ? document->root() : Node{};
}

/// Those of references: what a figure's object shows ("only") is none.
std::vector<Break> breaks_of_references(const Node& root) {
  std::vector<Break> breaks = breaks_of(root);
  std::erase_if(breaks, [](const Break& each) { return each.pointer.find("/only/") != std::string::npos; });
  return breaks;
}

TEST(Mistakes, OneIsToldAndItsConsequencesAreNot) {
  for (const std::string& name : shipped_names()) {
    const Node root = root_of(name);
    const std::vector<Break> breaks = breaks_of_references(root);
    const std::size_t stride = std::max<std::size_t>(1, breaks.size() / most());
    for (std::size_t i = scattered(name.size() + 1) % stride; i < breaks.size(); i += stride)
      EXPECT_EQ(judge(name, root, {&breaks[i]}), "") << name;
  }
}

TEST(Mistakes, TwoThatHaveNothingToDoWithEachOtherAreBothTold) {
  for (const std::string& name : shipped_names()) {
    const Node root = root_of(name);
    const std::vector<Break> breaks = breaks_of_references(root);
    for (std::size_t n = 0; n < most(); ++n) {
      const Break& first = breaks[scattered(n * 2 + name.size()) % breaks.size()];
      const Break& second = breaks[scattered(n * 2 + 1 + name.size()) % breaks.size()];
      if (is_foundation(first) || is_foundation(second) || first.pointer == second.pointer) continue;
      EXPECT_EQ(judge(name, root, {&first, &second}), "") << name;
    }
  }
}

/// The pointers of what is told, in the order of the file.
std::vector<std::string> told(const std::string& text) {
  std::vector<std::string> pointers;
  for (const json::Diagnostic& diagnostic : load(text).diagnostics.sorted())
    pointers.push_back(diagnostic.place.pointer);
  return pointers;
}
using Pointers = std::vector<std::string>;

std::string cell(const std::string& program, const std::string& more) {
  return over_one_switch(", \"programs\": [{\"name\": \"stamping\", \"master\": \"a\", " + program + "}], " + more);
}

// As in the finding hidden-reference: a cycle without a unit hid the slave that is no node.
TEST(Mistakes, OfAProgramDoNotHideEachOther) {
  const std::string data =
      R"("process_data": [{"name": "setpoint", "from": "a", "fields": {"x": "Double"}}, {"name": "measured", "from": "b", "fields": {"x": "Double"}}])";
  const std::string rest =
      R"("script": [{"at": "1ms", "program": "stamping", "call": "Start"}, {"at": "2ms", "program": "stamping", "call": "Halt", "on": "a"}],
"require": [{"reaction": "start", "within": "10ms"}, {"stream": "stamping/setpoint", "latency": "100us"}])";
  EXPECT_EQ(told(cell(R"("slaves": ["bb"], "cycle": "500u", )" + data, rest)),
            (Pointers{"/programs/0/slaves/0", "/programs/0/cycle"}));
  EXPECT_EQ(
      told(cell(R"("slaves": ["b"], "cycle": "500u", "replies": [{"to": "setpoin", "with": "measured"}], )" + data,
                rest)),
      (Pointers{"/programs/0/cycle", "/programs/0/replies/0/to"}));
  // What a refused program would have sent is known by name, and so is what it would not.
  const std::string wrong = R"("require": [{"stream": "stamping/setpont", "latency": "100us"}])";
  EXPECT_EQ(told(cell(R"("slaves": ["b"], "cycle": "500u", )" + data, wrong)),
            (Pointers{"/programs/0/cycle", "/require/0/stream"}));
  EXPECT_EQ(told(cell(R"("slaves": ["b"], "cycl": "500us", )" + data, wrong)),
            (Pointers{"/programs/0", "/programs/0/cycl", "/require/0/stream"}));
}

TEST(Mistakes, OfTheFinding) {
  json::Diagnostics diagnostics;
  EXPECT_EQ(load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/hidden-reference.json", {}, diagnostics),
            nullptr);
  Pointers pointers;
  for (const json::Diagnostic& diagnostic : diagnostics.sorted()) pointers.push_back(diagnostic.place.pointer);
  EXPECT_EQ(pointers, (Pointers{"/programs/0/slaves/1", "/programs/0/cycle"})) << diagnostics.to_text();
}

// A data set from a slave whose name is wrong is a consequence if it names a node, and a mistake if it names none.
TEST(Mistakes, OfASlaveAreToldOnce) {
  EXPECT_EQ(
      told(cell(
          R"("slaves": ["bb"], "cycle": "1ms", "process_data": [{"name": "measured", "from": "b", "fields": {"x": "Double"}}])",
          R"("require": [])")),
      (Pointers{"/programs/0/slaves/0"}));
  EXPECT_EQ(
      told(cell(
          R"("slaves": ["bb"], "cycle": "1ms", "process_data": [{"name": "measured", "from": "c", "fields": {"x": "Double"}}])",
          R"("require": [])")),
      (Pointers{"/programs/0/slaves/0", "/programs/0/process_data/0/from"}));
}

TEST(Mistakes, OfStreamsDoNotHideTheirNames) {
  const std::string streams =
      R"(, "streams": [{"name": "s", "from": "aa", "to": "b", "payload": "1B", "every": "1m"}], "require": [{"stream": "s", "latency": "1ms"}],
"faults": [{"kind": "babble", "stream": "s", "at": "1ms"}, {"kind": "babble", "stream": "t", "at": "1ms"}])";
  EXPECT_EQ(told(over_one_switch(streams)), (Pointers{"/streams/0/from", "/streams/0/every", "/faults/1/stream"}));
}

}  // namespace
}  // namespace takt::scenario::test
