// The scenario file that the studio edits, and the draft beside it: what was typed and not saved outlives the engine.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace takt::studio {

class Document {
 public:
  /// A file that is not there is empty until it is saved.
  explicit Document(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  std::string draft_path() const { return path_ + ".draft"; }
  /// What the file holds, or nothing if it cannot be read; `problem` says why, and is empty if it is only not there.
  std::optional<std::string> saved(std::string& problem) const;
  /// What was typed last and not saved; nothing if that is so of nothing.
  std::optional<std::string> draft() const;
  /// Written whole or not at all; what is as the file leaves no draft. An empty text, or what went wrong.
  [[nodiscard]] std::string keep_draft(std::string_view text);
  /// The same of the file; the draft is gone then.
  [[nodiscard]] std::string save(std::string_view text);

 private:
  std::string path_;
  std::mutex mutex_;   // writes of several requests follow each other
};

}  // namespace takt::studio
