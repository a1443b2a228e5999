// SPDX-License-Identifier: Apache-2.0
// What every file and folder of the tree looks like.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "source_tree.hpp"

namespace takt::architecture::tree_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = TAKT_SOURCE_DIR;
constexpr std::size_t most_lines = 600;

std::vector<SourceFile> everything() { return files_below({"sim", "models", "src", "tests", "tools", "cmake"}); }

// A reader finds the entry of each folder by its own short README.md.
TEST(Tree, EveryFolderHasAReadme) {
  std::vector<fs::path> folders = {root / "sim", root / "models"};
  for (const fs::directory_entry& wing : fs::directory_iterator(root / "src")) {
    folders.push_back(wing.path());
    for (const fs::directory_entry& module : fs::directory_iterator(wing.path()))
      if (module.is_directory()) folders.push_back(module.path());
  }
  for (const fs::path& folder : folders) {
    const fs::path readme = folder / "README.md";
    ASSERT_TRUE(fs::is_regular_file(readme)) << readme;
    std::ifstream file(readme);
    std::string first;
    std::getline(file, first);
    EXPECT_TRUE(first.starts_with("# ")) << readme << " begins with its title";
  }
}

TEST(Tree, NoFileHoldsTooMuch) {
  // The tables of one schema, a line a node: there is nothing to divide but lines.
  const std::string table = "src/exchange/interchange/yang/schema.cpp";
  for (const SourceFile& file : everything())
    EXPECT_TRUE(file.path == table || file.lines.size() <= most_lines)
        << file.path << ": a file of this length holds two concepts";
}

TEST(Tree, NoTabsAndNoSpacesAtTheEnds) {
  for (const SourceFile& file : everything()) {
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      const std::string& line = file.lines[i];
      EXPECT_EQ(line.find('\t'), std::string::npos) << file.path << ":" << i + 1 << ": a tab";
      EXPECT_FALSE(line.ends_with(' ') || line.ends_with('\r'))
          << file.path << ":" << i + 1 << ": space at the end of the line";
    }
  }
}

TEST(Tree, HeadersAreIncludedOnce) {
  for (const SourceFile& file : everything()) {
    if (!file.is_header()) continue;
    bool found = false;
    for (const std::string& line : file.code) found = found || line.starts_with("#pragma once");
    EXPECT_TRUE(found) << file.path;
  }
}

TEST(Tree, EveryFileOfTheProductSaysWhatItIs) {
  for (const SourceFile& file : files_below({"sim", "models", "src"})) {
    const bool says_it = !file.is_header() || file.lines.front().starts_with("//");
    EXPECT_TRUE(says_it) << file.path;
  }
}

// An exception that leaves a thread ends the process without a message: threads begin where it is caught and handed on.
TEST(Tree, ThreadsBeginWhereExceptionsAreCaught) {
  const std::vector<std::string> catching = {"src/device/node/applications/thread_group.hpp",
                                             "src/device/node/applications/thread_group.cpp",
                                             "src/device/node/server/name_lookup.cpp",
                                             "src/questions/verify/probe.cpp",
                                             "src/experiments/papers/validation/measure.cpp",
                                             "src/foundation/schedule/search.cpp",
                                             "src/simulation/scenario/division/divided_run.cpp",
                                             "src/frontends/studio/engine.hpp",
                                             "src/frontends/studio/engine.cpp",
                                             "src/frontends/studio/command.hpp",
                                             "src/frontends/studio/command.cpp",
                                             "src/frontends/cli/studio_command.cpp"};
  for (const SourceFile& file : files_below({"sim", "models", "src"})) {
    if (std::find(catching.begin(), catching.end(), file.path) != catching.end()) continue;
    for (std::size_t i = 0; i < file.code.size(); ++i)
      for (const char* const thread :
           {"std::jthread", "std::async", "pthread_create", "std::thread(", "std::thread ", "std::thread>"})
        EXPECT_EQ(file.code[i].find(thread), std::string::npos)
            << file.path << ":" << i + 1 << ": " << thread << "; ThreadGroup catches what a thread throws";
  }
}

// The tree stands for itself: nothing names a place on the machine on which it was written.
TEST(Tree, NoPlacesOutsideTheTree) {
  const std::vector<std::string> outside = {std::string("/wo") + "rk/", std::string("../sha") + "red",
                                            std::string("/ro") + "ot/", std::string("/ho") + "me/"};
  for (const SourceFile& file : files_below({"sim", "models", "src", "tests", "tools", "cmake", "docs"}))
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      for (const std::string& place : outside)
        EXPECT_EQ(file.lines[i].find(place), std::string::npos) << file.path << ":" << i + 1 << ": " << place;
}

}  // namespace
}  // namespace takt::architecture::tree_test
