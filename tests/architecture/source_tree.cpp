// SPDX-License-Identifier: Apache-2.0
#include "source_tree.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace takt::architecture {
namespace {

namespace fs = std::filesystem;

const std::string root = TAKT_SOURCE_DIR;

bool is_text(const std::string& path) {
  for (const char* ending : {".hpp", ".cpp", ".h", ".hpp.in", ".txt", ".cmake", ".md", ".py", ".sh"})
    if (path.ends_with(ending)) return true;
  return false;
}

/// The line without comments and without what stands in quotes. `in_comment` goes on from line to line.
std::string code_of(const std::string& line, bool& in_comment) {
  std::string code;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::string_view rest = std::string_view(line).substr(i);
    if (in_comment) {
      if (!rest.starts_with("*/")) continue;
      in_comment = false;
      ++i;
    } else if (quote != 0) {
      if (line[i] == '\\')
        ++i;
      else if (line[i] == quote)
        quote = 0;
    } else if (rest.starts_with("//")) {
      break;
    } else if (rest.starts_with("/*")) {
      in_comment = true;
      ++i;
    } else {
      const bool is_digit_separator =
          line[i] == '\'' && i > 0 && std::isxdigit(static_cast<unsigned char>(line[i - 1])) != 0;
      if (line[i] == '"' || (line[i] == '\'' && !is_digit_separator)) quote = line[i];
      code += line[i];
    }
  }
  return code;
}

SourceFile read(const fs::path& path) {
  SourceFile file;
  file.path = fs::path(path).lexically_relative(root).generic_string();
  std::ifstream stream(path);
  bool in_comment = false;
  for (std::string line; std::getline(stream, line);) {
    file.code.push_back(code_of(line, in_comment));
    file.lines.push_back(std::move(line));
  }
  return file;
}

}  // namespace

std::vector<SourceFile> files_below(const std::vector<std::string>& folders) {
  std::vector<SourceFile> files;
  for (const std::string& folder : folders) {
    if (!fs::is_directory(fs::path(root) / folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(root) / folder))
      if (entry.is_regular_file() && is_text(entry.path().string())) files.push_back(read(entry.path()));
  }
  if (files.empty()) throw std::runtime_error("no sources below " + root);
  std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::vector<Include> includes_of(const SourceFile& file) {
  std::vector<Include> includes;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    std::string_view line = file.lines[i];
    if (!line.starts_with("#include")) continue;
    const std::size_t first = line.find_first_of("\"<");
    const std::size_t last = line.find_last_of("\">");
    if (first != std::string_view::npos && last > first)
      includes.push_back({std::string(line.substr(first + 1, last - first - 1)), i + 1});
  }
  return includes;
}

}  // namespace takt::architecture
