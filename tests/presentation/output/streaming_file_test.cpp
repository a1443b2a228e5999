// SPDX-License-Identifier: Apache-2.0
#include "output/streaming_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/presentation/output/recording.hpp"

namespace takt::output {
namespace {

using namespace test;

TEST(StreamingFile, AppearsWhole) {
  Folder folder;
  std::string expected;
  {
    StreamingFile file(folder / "text");
    for (int i = 0; i < 50'000; ++i) {
      const std::string line = std::to_string(i) + "\n";
      file.write(line);
      expected += line;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "text"));
    EXPECT_EQ(file.close(), "");
    EXPECT_EQ(file.close(), "");
  }
  EXPECT_EQ(content_of(folder / "text"), expected);
  EXPECT_FALSE(std::filesystem::exists(folder / "text.part"));
}

TEST(StreamingFile, WithoutCloseNothingStays) {
  Folder folder;
  { StreamingFile(folder / "text").write("half"); }
  EXPECT_TRUE(folder.empty());
}

TEST(StreamingFile, SaysWhatWentWrong) {
  Folder folder;
  StreamingFile file(folder / "no/such/text");
  file.write("x");
  EXPECT_NE(file.problem().find("no/such/text"), std::string::npos);
  EXPECT_EQ(file.close(), file.problem());
}

TEST(StreamingFile, AFullDiskIsAnError) {
  Folder folder;
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little = {100, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &little), 0);
  StreamingFile file(folder / "text");
  file.write(std::string(1000, 'x'));
  EXPECT_NE(file.close(), "");
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_TRUE(folder.empty());
}

// What somebody has put in the place of the part is not written through.
TEST(StreamingFile, ALinkIsNotFollowed) {
  Folder folder;
  std::ofstream(folder / "other") << "of somebody";
  std::filesystem::create_symlink(folder / "other", folder / "text.part");
  StreamingFile file(folder / "text");
  file.write("x");
  EXPECT_EQ(file.close(), "");
  EXPECT_EQ(content_of(folder / "text"), "x");
  EXPECT_EQ(content_of(folder / "other"), "of somebody");
}

TEST(StreamingFile, APrivateFileStaysPrivate) {
  namespace fs = std::filesystem;
  Folder folder;
  std::ofstream(folder / "text") << "before";
  fs::permissions(folder / "text", fs::perms::owner_read | fs::perms::owner_write);
  StreamingFile file(folder / "text");
  EXPECT_EQ(fs::status(folder / "text.part").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  file.write("behind");
  EXPECT_EQ(file.close(), "");
  EXPECT_EQ(fs::status(folder / "text").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace
}  // namespace takt::output
