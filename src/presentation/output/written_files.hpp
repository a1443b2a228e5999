// SPDX-License-Identifier: Apache-2.0
// What takt has written into the folder of --out, by command: DIR/files.json remembers it, so that a later run can take
// away what it does not write itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/behaviour.hpp"

namespace takt::output {

/// The files of one command in one folder. Nothing else is ever removed: what files.json does not name, what other
/// commands wrote, what the command reads.
class WrittenFiles {
 public:
  /// Reads files.json, if it is there; one that is broken counts as none.
  WrittenFiles(std::string folder, std::string command, std::string input);

  /// Before the first file: takes away the older result.json, so that a run that is broken off does not look complete.
  /// Returns an empty text, or what went wrong.
  [[nodiscard]] std::string begin();
  /// A file of the folder that was written, or is about to be.
  void add(std::string name);
  /// The same for a file that may lie in the folder; whether it does.
  bool add_if_inside(const std::string& path);
  /// When all files but result.json are there: removes the older files that were not written again, and writes
  /// files.json. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string end(const std::string& scenario, std::optional<std::uint64_t> digest = {});

  const std::string& folder() const { return folder_; }
  std::string path_of(const std::string& name) const;
  /// Up to three lines for people: what was written, what to open with what, what was removed. Empty without files.
  std::string summary() const;

  /// What one command wrote.
  struct Entry {
    std::string command;
    results::Maker maker;
    std::string scenario;
    std::string digest;  ///< empty: it has none
    std::vector<std::string> files;
  };
  /// What files.json of a folder says; nothing if there is none, or a broken one.
  static std::vector<Entry> entries_in(const std::string& folder);

 private:
  void read();
  std::string remove(const std::string& name) const;
  bool is_input(const std::string& name) const;

  std::string folder_;
  std::string command_;
  std::string input_;
  std::vector<Entry> others_;
  std::vector<std::string> older_;
  std::vector<std::string> files_;
  std::vector<std::string> removed_;
};

/// A sentence with both numbers of behaviour if files.json beside the file says that another takt wrote it. Empty: this
/// one did, or nothing is known.
std::string made_by_another(const std::string& file);

/// How people look at a file, by its name: "in ui.perfetto.dev". Empty: in no way of its own.
std::string_view opened_in(std::string_view name);

}  // namespace takt::output
