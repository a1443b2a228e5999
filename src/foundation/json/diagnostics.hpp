// SPDX-License-Identifier: Apache-2.0
// A user's mistakes, each with where it is, what was found, what was expected and what to try.
//
// Whoever reads input reports here and goes on, so that all mistakes of a file are seen at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "json/node.hpp"

namespace takt::json {

/// A place in an input. Line 0 means that the whole file (or option) is meant; pointer is RFC 6901, "" is the root.
struct Place {
  std::string file;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::string pointer;
  bool operator==(const Place&) const = default;
};

enum class Severity : std::uint8_t { error, warning };

/// The optional parts of a diagnostic; empty means absent. `found` and `expected` are phrases that follow these words.
struct Details {
  std::string found = {};
  std::string expected = {};
  std::string suggestion = {};  ///< a name to try, without quotes
};

struct Diagnostic {
  Severity severity = Severity::error;
  Place place;
  std::string message;
  Details details;
};

/// `file:line:column: error at /pointer: message: found X, expected Y (did you mean "Z"?)`, without a newline.
std::string to_text(const Diagnostic& diagnostic);
/// An object with severity, file, line, column, pointer, message and the details that are present.
Node to_json(const Diagnostic& diagnostic);

/// Collects diagnostics: all are counted, the first `limit` are kept.
class Diagnostics {
 public:
  explicit Diagnostics(std::size_t limit = 100) : limit_(limit) {}

  /// A mistake. A value that could not be read is wrong already: what else is said of it is a consequence.
  void error(Place place, std::string message, Details details = {});
  /// A value that cannot be read, or lacks something.
  void unreadable(Place place, std::string message, Details details = {});
  /// An error, or a consequence if it rests on something that has been told already.
  void error_unless(bool is_consequence, Place place, std::string message, Details details = {});
  /// Something is wrong only because of what has been told already. It counts, so that nobody takes the rest for sound,
  /// but is not told.
  void consequence() { ++consequences_; }
  void warning(Place place, std::string message, Details details = {});

  bool has_errors() const { return errors() != 0; }
  /// Mistakes and their consequences.
  std::size_t errors() const { return errors_ + consequences_; }
  std::size_t warnings() const { return warnings_; }
  /// Whether something is wrong with the value there or with a part of it. What is read from such a value is a
  /// stand-in: who compares it with others would tell a consequence as if it were a mistake.
  bool is_refused(const Place& place) const;
  /// Counts the value of that pointer as refused, though the error stands elsewhere: a field that is missing.
  void note_refused(std::string pointer);
  /// No further diagnostic will be kept: details need not be worked out.
  bool full() const { return kept_.size() >= limit_; }

  /// Those kept, in the order of report.
  const std::vector<Diagnostic>& kept() const { return kept_; }
  /// Those kept, by file (in order of first report), line and column.
  std::vector<Diagnostic> sorted() const;

  /// All that are kept, sorted, one a line, and a last line that says how many more there are.
  std::string to_text() const;
  /// {"errors": 2, "warnings": 0, "diagnostics": [...]}
  Node to_json() const;

 private:
  void keep(Severity severity, Place place, std::string message, Details details);

  std::size_t limit_;
  std::size_t errors_ = 0;
  std::size_t warnings_ = 0;
  std::size_t consequences_ = 0;
  std::vector<Diagnostic> kept_;
  std::set<std::string, std::less<>> refused_;     // pointers
  std::set<std::string, std::less<>> unreadable_;  // the same
};

/// Whether all entries of a list could be read and have names; only then a name that is not among them is surely a
/// mistake. `list` is where the list is written.
template <class Entry>
bool are_all_named(const std::vector<Entry>& entries, const Place& list, const Diagnostics& diagnostics) {
  if (!diagnostics.is_refused(list)) return true;
  if (entries.empty()) return false;
  for (const Entry& entry : entries)
    if (!entry.where.is_known() || diagnostics.is_refused(entry.where.at("name"))) return false;
  return true;
}

}  // namespace takt::json
