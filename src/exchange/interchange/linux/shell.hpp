// SPDX-License-Identifier: Apache-2.0
// The part of the shell's language that scripts of interfaces are written in, as a tree. What it means: shell_run.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "json/diagnostics.hpp"

namespace takt::interchange::linux_tc {

/// A piece of a word: quoted pieces are not split, and of those in single quotes nothing is worked out.
struct ShellPiece {
  enum class Kind : std::uint8_t { text, variable, arithmetic, command };
  Kind kind = Kind::text;
  std::string text;  ///< of a variable what stands between the braces: "DEV", "DEV:-eth0"
  bool is_quoted = false;
};

struct ShellWord {
  std::vector<ShellPiece> pieces;
  json::Place place;
  std::string source;  ///< as it is written
  /// The text, if there is nothing to work out and nothing is quoted; empty otherwise.
  std::string_view plain() const {
    return pieces.size() == 1 && pieces[0].kind == ShellPiece::Kind::text && !pieces[0].is_quoted
               ? std::string_view(pieces[0].text)
               : std::string_view();
  }
};

struct ShellNode {
  enum class Kind : std::uint8_t {
    simple,    ///< words
    sequence,  ///< parts, one after the other
    and_then,  ///< two parts
    or_else,   ///< two parts
    pipe,      ///< parts
    branch,    ///< parts: condition, body, condition, body, ..., perhaps a last body
    each,      ///< name, words, one part
    loop,      ///< condition, body: while and until
    choice,    ///< words: the subject; clauses: patterns and bodies
    function,  ///< name, one part
    negation,  ///< one part
  };
  Kind kind = Kind::simple;
  json::Place place;
  std::vector<ShellWord> words;
  std::vector<ShellNode> parts;
  std::vector<std::vector<ShellWord>> patterns;  ///< of a choice, for each part
  std::string name;
  std::string document;  ///< what follows a simple command between << END and END
  std::uint32_t document_line = 0;
};

/// The tree of a script. A construct that is not understood is a diagnostic.
ShellNode parse_shell(std::string_view text, const std::string& file, json::Diagnostics& diagnostics);

}  // namespace takt::interchange::linux_tc
