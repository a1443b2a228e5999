// SPDX-License-Identifier: Apache-2.0
// The scenario file that the studio edits, and the draft beside it: what was typed and not saved outlives the engine.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace takt::studio {

class Document {
 public:
  /// A file that is not there is empty until it is saved.
  explicit Document(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  std::string draft_path() const { return path_ + ".draft"; }
  std::string layout_path() const { return path_ + ".layout"; }
  /// What the file holds, or nothing if it cannot be read; `problem` says why, and is empty if it is only not there.
  std::optional<std::string> saved(std::string& problem) const;
  /// 16 hexadecimal digits of a text, by which two are told apart.
  static std::string digest_of(std::string_view text);
  /// Of what the file holds; empty if there is none. Cheap: the file is read again only if its time, size or number is
  /// another one.
  std::string digest() const;
  /// What was typed last and not saved; nothing if that is so of nothing.
  std::optional<std::string> draft() const;
  /// The file was changed after the draft, or the draft rests on an older one.
  bool is_newer_than_draft() const;
  /// Written whole or not at all; what is as the file leaves no draft, and an empty text leaves the draft as it is.
  /// `base` is the digest of the file that was typed over. An empty text, or what went wrong.
  [[nodiscard]] std::string keep_draft(std::string_view text, std::string_view base);
  struct Saved {
    std::string problem = {};  ///< what went wrong
    bool is_conflict = false;  ///< the file is another one than `base` says: nothing was written
    bool empties = false;      ///< an empty text over a full one, not allowed: likewise
  };
  /// Writes the file, whole or not at all, if it is still the one of the digest `base`; the draft is gone then.
  [[nodiscard]] Saved save(std::string_view text, std::string_view base, bool may_empty = false);

  /// Where nodes were dragged to, JSON; it stands beside the scenario, not in it. Empty if there is none.
  std::string layout() const;
  /// Nothing dragged leaves no file. An empty text, or what went wrong.
  [[nodiscard]] std::string keep_layout(std::string_view text);

  /// A copy of a text beside the scenario, where the files that it names are found, for a command that wants a file.
  /// Gone with the last who holds it; null if it cannot be written.
  std::shared_ptr<const std::string> aside(std::string_view text);
  /// Study files beside the scenario and in studies/ there, by their names from there on.
  std::vector<std::string> studies() const;
  std::string path_of(std::string_view beside) const;

 private:
  /// What stands for the content of the file as long as nobody writes it.
  struct Known {
    std::int64_t time = -1;
    std::uint64_t size = 0;
    std::uint64_t number = 0;
    auto operator<=>(const Known&) const = default;
  };

  std::string path_;
  std::mutex mutex_;  // writes of several requests follow each other
  mutable std::mutex digest_mutex_;
  mutable Known known_;
  mutable std::string digest_;
  unsigned asides_ = 0;
};

}  // namespace takt::studio
