// SPDX-License-Identifier: Apache-2.0
// Makes a scenario at random by walking the schema: for each object its members, by a rule for each key.
//
// A key without a rule is made from what the schema says of it, where that is enough (truth values, words, durations,
// objects); of the others the generator's test says that a rule is missing.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/generator/draw.hpp"
#include "tests/generator/features.hpp"
#include "tests/generator/schema.hpp"

namespace takt::generator {

class Maker;

/// Where something is made: the object, as far as it is there, and those around it.
struct Scope {
  const Scope* outer = nullptr;
  std::string definition;      ///< "stream"
  const Node* made = nullptr;  ///< the object
  std::string name;            ///< of a member of a map: its key
  std::size_t number = 0;      ///< of an item of a list

  bool has(std::string_view key) const { return made->find(key) != nullptr; }
  /// Of a member that is a text; "" if it is not there.
  std::string text(std::string_view key) const;
  /// The nearest object of that kind around this one; null if there is none.
  const Scope* around(std::string_view kind) const;
};

/// How a key is made.
struct Rule {
  std::string_view key;                                         ///< "stream.payload"
  Feature feature = Feature::any;                               ///< only where this is asked for
  int percent = 30;                                             ///< how often, if the key is optional
  std::string_view words = {};                                  ///< one of them, if there is no `make`
  std::optional<Node> (*make)(Maker&, const Scope&) = nullptr;  ///< nothing: not this time
};
std::span<const Rule> network_rules();
std::span<const Rule> port_rules();
std::span<const Rule> ingress_rules();
std::span<const Rule> traffic_rules();
std::span<const Rule> fault_rules();
std::span<const Rule> clock_rules();
std::span<const Rule> program_rules();
std::span<const Rule> application_rules();
std::span<const Rule> requirement_rules();

/// The rules of all keys, and what is wrong with them: rules for keys that the schema does not have.
struct RuleBook {
  std::map<std::string_view, const Rule*> rules;
  std::vector<std::string> strays;
  static const RuleBook& get();
};
/// Keys that neither have a rule nor can be made without one.
std::vector<std::string> keys_without_rule();

/// The ports of a link beside another one between the same two switches.
inline constexpr const char* second_link = ":40";

/// The nodes and links of the scenario, generated ones too.
struct World {
  std::vector<std::string> switches, hosts;  ///< stations are in both
  std::vector<std::pair<std::string, std::string>> links;
  std::map<std::string, std::vector<std::string>> neighbours;
  std::vector<std::string> nodes() const;
  bool forwards(const std::string& node) const;
  /// A path without loops; empty if `from` and `to` are not connected. `avoid` are nodes that it leaves out.
  std::vector<std::string> path(Draw& draw, const std::string& from, const std::string& to,
                                const std::set<std::string>& avoid = {}) const;
};

Node text(std::string_view value);
Node number(std::uint64_t value);
Node list(std::vector<Node> items);

class Maker {
 public:
  Maker(std::uint64_t seed, std::set<Feature> wishes);
  Node scenario();

  bool wants(Feature feature) const { return feature == Feature::any || wishes_.contains(feature); }
  Node object(std::string_view definition, const Scope* outer, std::string name = {}, std::size_t number = 0);
  /// So many objects of a kind.
  Node objects(std::string_view definition, std::size_t count, const Scope& outer);
  Node short_or_object(std::string_view definition, const Scope* outer, std::string name = {});
  /// An option of a tagged object.
  Node option(std::string_view tagged, std::string_view tag, const Scope* outer, std::string name = {},
              std::size_t number = 0);
  /// "1234us" within the run.
  Node instant();
  /// One of the words; a number if it looks like one.
  Node word(std::string_view words);
  /// Some of the traffic classes 0 to 7, each with 1/n, without some; none may come out.
  std::vector<int> classes(std::size_t n, const std::vector<int>& without = {});

  Draw draw;
  World world;
  Node skeleton;  ///< of "network": what of it was needed to know the world
  std::uint64_t duration_us = 0;
  std::size_t streams = 0, topics = 0;
  enum class Group : std::uint8_t { plain, outer, inner, roles };
  std::vector<Group> groups;                     ///< the programs: what each is
  bool inner_has_roles = false;                  ///< instead of a group of its own with roles
  std::vector<std::string> skills;               ///< that are offered
  std::map<std::string, std::string> shaped_at;  ///< streams that a talker shapes, and the talker
  std::map<std::string, Node> kept;              ///< what rules make once for the whole scenario
  /// The scenario as far as it has been made.
  const Node& root() const { return *root_; }
  bool is_slow() const { return is_slow_; }  ///< frames take long: gates and slopes must leave room
  bool is_long() const { return is_long_; }  ///< simulates long: streams send seldom

 private:
  friend class Members;
  std::optional<Node> value(const Node& schema, const std::string& key, const Scope& scope);
  std::optional<Node> by_rule(const Node& schema, const std::string& key, const Rule* rule, const Scope& scope);
  Node fill(const Definition& definition, const Scope* outer, std::string name, std::size_t number,
            std::string_view tag);
  void lay_out();

  std::set<Feature> wishes_;
  const Node* root_ = nullptr;
  bool is_slow_ = false, is_long_ = false;
};

}  // namespace takt::generator
