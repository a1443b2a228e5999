// SPDX-License-Identifier: Apache-2.0
// A JSON text with the place of every value: what parse() makes and what decoding reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json/diagnostics.hpp"
#include "json/node.hpp"

namespace takt::json {

/// What bounds memory and time for hostile input. More is a diagnostic.
constexpr std::size_t max_text_size = std::size_t{64} << 20;  ///< octets of one text
constexpr std::size_t max_depth = 64;                         ///< arrays and objects within each other
constexpr std::size_t max_memory = std::size_t{1} << 30;      ///< octets that the values of one text take
constexpr std::size_t max_key_length = 1024;                  ///< octets of the name of a member

struct Tree {
  Node root;
  std::vector<std::string> sources;  ///< names by Position::source: the file, then each override
  std::string prefix = {};           ///< JSON pointer of the root in the file, if it is a part of it only
};

/// A parsed text. Immutable: copies share the tree, and an override (override.hpp) makes a new document.
class Document {
 public:
  /// `prefix` is the JSON pointer of the root in the file.
  Document(Node root, std::string file_name, std::string prefix = {});
  explicit Document(Tree tree);

  const Node& root() const { return tree_->root; }
  const std::string& file_name() const { return tree_->sources.front(); }
  const std::shared_ptr<const Tree>& tree() const { return tree_; }

 private:
  std::shared_ptr<const Tree> tree_;
};

/// The JSON pointer (RFC 6901) of a node of a document; "" is the root.
std::string pointer_of(const Node& node);
/// "/" + key with ~ and / escaped: one step of a pointer.
std::string pointer_step(std::string_view key);
std::string pointer_step(std::size_t index);
/// Where a node of the tree is written.
Place place_of(const Tree& tree, const Node& node);
Place place_of(const Tree& tree, Position position, std::string pointer);

/// Reads one JSON text (RFC 8259; // and /* */ comments, a byte order mark and a comma after the last element are
/// allowed). A text that is not JSON or exceeds a limit is one diagnostic, and nothing is returned. A key that occurs
/// twice in one object is a diagnostic too, but the document is returned (with the first value), so that the rest can
/// be checked.
std::optional<Document> parse(std::string_view text, std::string file_name, Diagnostics& diagnostics);

/// Reads a whole file and parses it. A file that cannot be read is a diagnostic.
std::optional<Document> parse_file(const std::string& path, Diagnostics& diagnostics);

/// Where a decoded value was written. Checks of meaning use it to report; it keeps the tree alive that it points into.
/// It takes no part in comparisons: values that were read from different places are equal if they mean the same.
class Source {
 public:
  Source() = default;
  Source(std::shared_ptr<const Tree> tree, const Node& node) : tree_(std::move(tree)), node_(&node) {}

  /// The value itself.
  Place place() const;
  /// A member's value, or one item of a member that is an array. If it was not written (a default), the place of the
  /// value around it, with the pointer that it would have. Of a shorthand, the shorthand.
  Place at(std::string_view member) const;
  Place at(std::string_view member, std::size_t index) const;
  /// One item of a value that is an array.
  Place item(std::size_t index) const;
  /// Where the name of a member is written.
  Place key(std::string_view member) const;
  /// Whether the member was written (in the file or by an override), so is not a default. False for a shorthand.
  bool has(std::string_view member) const;
  /// False for a value that a program made.
  bool is_known() const { return node_ != nullptr; }

  friend constexpr bool operator==(const Source&, const Source&) { return true; }

 private:
  std::shared_ptr<const Tree> tree_;  ///< null: the value was made by a program, not read
  const Node* node_ = nullptr;
};

}  // namespace takt::json
