#include "output/streaming_file.hpp"

#include <gtest/gtest.h>

#include "tests/output/recording.hpp"

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
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  Folder folder;
  std::filesystem::create_symlink("/dev/full", folder / "text.part");
  StreamingFile file(folder / "text");
  file.write("x");
  EXPECT_NE(file.close(), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "text"));
}

}  // namespace
}  // namespace takt::output
