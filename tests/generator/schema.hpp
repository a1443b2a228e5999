// SPDX-License-Identifier: Apache-2.0
// The schema of scenarios as the generator walks it: made from the tables of the description, so that a new key is seen
// by itself.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "json/node.hpp"

namespace takt::generator {

using json::Node;

/// An object that scenarios may have.
struct Definition {
  std::string name;     ///< "stream"; of an option of a tagged object the tag: "host", "crash"
  std::string tag_key;  ///< "kind"; empty if it has none
  const Node* properties = nullptr;
  std::set<std::string, std::less<>> required;
  struct Group {
    enum class Rule : std::uint8_t { exactly_one, at_most_one, at_least_one } rule{};
    std::vector<std::string> names;
  };
  std::vector<Group> groups;
  const Node* short_form =
      nullptr;            ///< the schema of a value that stands for an object with one member; null if there is none
  std::string short_key;  ///< the member
};

/// How a value may look.
struct ValueForm {
  enum class Kind : std::uint8_t { boolean, word, number, quantity, text, object, tagged, list, map, other } kind{};
  std::vector<std::string> words;           ///< of an enumeration
  std::string definition;                   ///< of an object, or of the tagged object
  const Node* item = nullptr;               ///< of lists and maps
  std::size_t least = 0, most = 1'000'000;  ///< items
  bool is_duration = false;
};

class Schema {
 public:
  static const Schema& of_scenarios();
  Schema(const Schema&) = delete;
  Schema& operator=(const Schema&) = delete;

  const Node& tree() const { return tree_; }
  const Definition& definition(std::string_view name) const;
  bool has(std::string_view name) const;
  const std::vector<Definition>& definitions() const { return definitions_; }
  /// The options of a tagged object, by tag.
  std::vector<std::string> options(std::string_view tagged) const;
  ValueForm form_of(const Node& schema) const;

 private:
  struct TaggedObject {
    std::string name;
    std::vector<std::string> tags;
  };
  Schema();
  void add(std::string name, const Node& object, std::string tag_key);

  Node tree_;
  std::vector<Definition> definitions_;
  std::vector<TaggedObject> tagged_;
};

}  // namespace takt::generator
