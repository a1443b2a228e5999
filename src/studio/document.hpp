// The scenario file that the studio edits, and the draft beside it: what was typed and not saved outlives the engine.
#pragma once

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
  /// What was typed last and not saved; nothing if that is so of nothing.
  std::optional<std::string> draft() const;
  /// Written whole or not at all; what is as the file leaves no draft. An empty text, or what went wrong.
  [[nodiscard]] std::string keep_draft(std::string_view text);
  /// The same of the file; the draft is gone then.
  [[nodiscard]] std::string save(std::string_view text);

  /// Where nodes were dragged to, JSON; it stands beside the scenario, not in it. Empty if there is none.
  std::string layout() const;
  /// Nothing dragged leaves no file. An empty text, or what went wrong.
  [[nodiscard]] std::string keep_layout(std::string_view text);

  /// A copy of a text beside the scenario, where the files that it names are found, for a command that wants a file. Gone with the last who holds it; null if it cannot
  /// be written.
  std::shared_ptr<const std::string> aside(std::string_view text);
  /// Study files beside the scenario and in studies/ there, by their names from there on.
  std::vector<std::string> studies() const;
  std::string path_of(std::string_view beside) const;

 private:
  std::string path_;
  std::mutex mutex_;   // writes of several requests follow each other
  unsigned asides_ = 0;
};

}  // namespace takt::studio
