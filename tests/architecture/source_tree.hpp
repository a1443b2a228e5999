// SPDX-License-Identifier: Apache-2.0
// The source tree as the architecture tests see it: files and their lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace takt::architecture {

struct SourceFile {
  std::string path;                ///< from the root of the repository, with '/'
  std::vector<std::string> lines;  ///< as written
  std::vector<std::string> code;   ///< the same with comments and the contents of strings taken out
  bool is_header() const { return path.ends_with(".hpp"); }
  bool is_cpp() const { return is_header() || path.ends_with(".cpp"); }
};

/// All regular text files below these folders of the repository, by path.
std::vector<SourceFile> files_below(const std::vector<std::string>& folders);

/// One #include of a file.
struct Include {
  std::string target;  ///< without quotes or brackets
  std::size_t line = 0;
};
std::vector<Include> includes_of(const SourceFile& file);

inline bool is_below(std::string_view path, std::string_view folder) { return path.starts_with(folder); }

}  // namespace takt::architecture
