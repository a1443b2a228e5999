// SPDX-License-Identifier: Apache-2.0
// Everything that reads octets of others is in the list of docs/security.md, with a fuzz target that there is.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "source_tree.hpp"

namespace takt::architecture::parsers_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = TAKT_SOURCE_DIR;

struct Row {
  std::string folder;
  std::vector<std::string> targets;  ///< "none": it reads nothing of others
};

std::vector<std::string> quoted(const std::string& text) {
  static const std::regex word("`([^`]+)`");
  std::vector<std::string> all;
  for (auto match = std::sregex_iterator(text.begin(), text.end(), word); match != std::sregex_iterator(); ++match)
    all.push_back((*match)[1]);
  return all;
}

std::vector<Row> listed() {
  std::ifstream page(root / "docs/security.md");
  static const std::regex row(R"(^\| (`[^|]+`) \| [^|]+ \| ([^|]+) \|$)");
  std::vector<Row> rows;
  bool is_there = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) is_there = line == "## What parses octets";
    std::smatch match;
    if (!is_there || !std::regex_match(line, match, row)) continue;
    for (const std::string& folder : quoted(match[1]))
      rows.push_back({folder, match[2] == "none" ? std::vector<std::string>{"none"} : quoted(match[2])});
  }
  return rows;
}

TEST(Parsers, AreListedWithTheirFuzzTargets) {
  const std::vector<Row> rows = listed();
  ASSERT_GE(rows.size(), 10u) << "the list has been found";
  for (const Row& row : rows) {
    EXPECT_TRUE(fs::exists(root / row.folder)) << row.folder;
    EXPECT_FALSE(row.targets.empty()) << row.folder;
    for (const std::string& target : row.targets)
      EXPECT_TRUE(target == "none" || fs::exists(root / "tests/fuzz" / (target + "_fuzz.cpp")))
          << row.folder << ": " << target;
  }
  const std::regex reads(R"(\b[A-Za-z:]*Reader(<[A-Za-z:]+>)? [a-z_]+[({]|::recv\(|::recvmsg\(|::recvfrom\()");
  std::size_t seen = 0;
  for (const SourceFile& file : files_below({"src", "models"})) {
    bool parses = false;
    for (const std::string& line : file.code) parses = parses || std::regex_search(line, reads);
    if (!file.is_cpp() || !parses) continue;
    ++seen;
    bool is_listed = false;
    for (const Row& row : rows) is_listed = is_listed || is_below(file.path, row.folder);
    EXPECT_TRUE(is_listed)
        << file.path << " reads octets: name it in docs/security.md, \"What parses octets\", with its fuzz target";
  }
  EXPECT_GE(seen, 20u) << "the test still finds them";
}

// A fuzz target that nobody runs finds nothing.
TEST(Parsers, TargetsAreBuiltAndRun) {
  std::ifstream list(root / "tests/fuzz/CMakeLists.txt");
  const std::string text((std::istreambuf_iterator<char>(list)), {});
  for (const fs::directory_entry& entry : fs::directory_iterator(root / "tests/fuzz")) {
    const std::string name = entry.path().filename();
    if (!name.ends_with("_fuzz.cpp")) continue;
    const std::string target = name.substr(0, name.size() - std::string("_fuzz.cpp").size());
    EXPECT_NE(text.find("takt_fuzz(" + target + " "), std::string::npos) << target;
    EXPECT_FALSE(fs::is_empty(root / "tests/fuzz/corpus" / target)) << target;
  }
}

}  // namespace
}  // namespace takt::architecture::parsers_test
