// SPDX-License-Identifier: Apache-2.0
// A file that is written piece by piece and appears whole or not at all: to a temporary name beside it, renamed at the
// end.
#pragma once

#include <string>
#include <string_view>

namespace takt::output {

/// Opens a new file `temporary` that is to replace `target`, and never one that somebody has put there. It is as
/// private as what it replaces. Below 0 if that fails (errno).
int open_part(const std::string& temporary, const std::string& target);

class StreamingFile {
 public:
  /// Opens path + ".part".
  explicit StreamingFile(std::string path);
  /// Without close() nothing stays behind.
  ~StreamingFile();
  StreamingFile(const StreamingFile&) = delete;
  StreamingFile& operator=(const StreamingFile&) = delete;

  /// After a failure nothing more is written; close() tells.
  void write(std::string_view text);
  /// Gives the file its name. Returns an empty text, or the first thing that went wrong since the beginning.
  std::string close();
  /// The first thing that went wrong so far, or an empty text.
  const std::string& problem() const { return problem_; }

 private:
  void flush();
  void fail(const std::string& path);

  static constexpr std::size_t buffer_size = std::size_t{1} << 16;
  std::string path_;
  std::string temporary_;
  std::string buffer_;
  std::string problem_;
  int file_ = -1;
};

}  // namespace takt::output
