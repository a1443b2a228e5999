// SPDX-License-Identifier: Apache-2.0
// What decoding carries along: the document that is read, and where mistakes go.
#pragma once

#include <string>

#include "json/diagnostics.hpp"
#include "json/document.hpp"
#include "json/node.hpp"

namespace takt::json {

/// One decoding of one document. Both must outlive it. Every node that it is asked about is one of the document.
class Reader {
 public:
  Reader(const Document& document, Diagnostics& diagnostics) : document_(document), diagnostics_(diagnostics) {}
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Reports at a value.
  void error(const Node& node, std::string message, Details details = {});
  /// Reports at the name of a member.
  void error_at_key(const Member& member, std::string message, Details details = {});
  /// Reports that a value is of the wrong kind: found is what it is, expected as said ("a string").
  void wrong_type(const Node& node, std::string expected);

  Diagnostics& diagnostics() { return diagnostics_; }
  Source source(const Node& node) const { return Source(document_.tree(), node); }
  bool is_root(const Node& node) const { return &node == &document_.root(); }

 private:
  const Document& document_;
  Diagnostics& diagnostics_;
};

}  // namespace takt::json
