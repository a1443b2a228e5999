// SPDX-License-Identifier: Apache-2.0
// What the pages of the repository point at is there: files, and sections of them.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace takt::architecture::links_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = TAKT_SOURCE_DIR;

std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const char* const folder : {"docs", "sim", "models", "src", "tests", "tools", "scenarios"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") found.push_back(entry.path());
  for (const fs::directory_entry& entry : fs::directory_iterator(root))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

/// The lines of a page that are text, not examples.
std::vector<std::string> prose_of(const fs::path& page) {
  std::vector<std::string> lines;
  std::ifstream file(page);
  bool in_example = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```"))
      in_example = !in_example;
    else if (!in_example)
      lines.push_back(line);
  }
  return lines;
}

/// How a heading is pointed at: lower case, hyphens for spaces, without punctuation.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    if (c == ' ' || c == '-')
      anchor += '-';
    else if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return anchor;
}

std::set<std::string> anchors_of(const fs::path& page) {
  std::set<std::string> anchors;
  for (const std::string& line : prose_of(page))
    if (line.starts_with('#') && line.find(' ') != std::string::npos)
      anchors.insert(anchor_of(line.substr(line.find(' ') + 1)));
  return anchors;
}

TEST(Links, PointAtSomething) {
  const std::regex link(R"(\]\(([^)\s]+)\))");
  std::size_t seen = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& line : prose_of(page)) {
      for (auto match = std::sregex_iterator(line.begin(), line.end(), link); match != std::sregex_iterator();
           ++match) {
        const std::string target = (*match)[1];
        if (target.find("://") != std::string::npos) continue;
        ++seen;
        const std::size_t mark = target.find('#');
        const fs::path file = mark == 0 ? page : page.parent_path() / target.substr(0, mark);
        ASSERT_TRUE(fs::exists(file)) << fs::relative(page, root) << " points at " << target;
        if (mark != std::string::npos) {
          EXPECT_TRUE(anchors_of(file).contains(target.substr(mark + 1)))
              << fs::relative(page, root) << " points at " << target;
        }
      }
    }
  }
  EXPECT_GT(seen, 100u);
}

}  // namespace
}  // namespace takt::architecture::links_test
