// SPDX-License-Identifier: Apache-2.0
// What a folder remembers of the runs that wrote into it, and what a later run takes away.
#include "output/written_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "tests/presentation/output/recording.hpp"

namespace takt::output {
namespace {

using namespace test;

void put(const std::string& path, const std::string& text = "x") { std::ofstream(path) << text; }

std::set<std::string> names_in(const Folder& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "."))
    names.insert(entry.path().filename().string());
  return names;
}
using Names = std::set<std::string>;

/// A run that writes these; result.json goes last, as that of a real one.
std::string write(const Folder& folder, const std::string& command, const std::vector<std::string>& files,
                  const std::string& input = "") {
  WrittenFiles written(folder / ".", command, input);
  EXPECT_EQ(written.begin(), "");
  for (const std::string& name : files) {
    if (name != "result.json") put(folder / name);
    written.add(name);
  }
  EXPECT_EQ(written.end("s", 7), "");
  for (const std::string& name : files) put(folder / name);
  return written.summary();
}

TEST(WrittenFiles, OfAnOlderRunGo) {
  Folder folder;
  put(folder / "mine.txt");
  write(folder, "run", {"all.pcapng", "timeline.json", "result.json"});
  EXPECT_EQ(names_in(folder), (Names{"mine.txt", "all.pcapng", "timeline.json", "result.json", "files.json"}));
  const std::string said = write(folder, "run", {"waves.vcd", "waves.gtkw", "a.csv", "b.csv", "result.json"});
  EXPECT_EQ(names_in(folder),
            (Names{"mine.txt", "waves.vcd", "waves.gtkw", "a.csv", "b.csv", "result.json", "files.json"}));
  EXPECT_EQ(said, "Written to " + (folder / ".") +
                      ": waves.vcd, waves.gtkw, result.json, 2 tables (.csv)\nTo open: waves.gtkw in GTKWave\nRemoved, "
                      "of an older run: all.pcapng, timeline.json\n");
  const std::string content = content_of(folder / "files.json");
  EXPECT_NE(content.find("\"digest\": \"0000000000000007\""), std::string::npos) << content;
  EXPECT_EQ(content.find("timeline"), std::string::npos) << content;
}

// The result of the older run is gone, and the next run still knows what else that one wrote.
TEST(WrittenFiles, ARunThatIsBrokenOffDoesNotLookComplete) {
  Folder folder;
  write(folder, "run", {"timeline.json", "result.json"});
  {
    WrittenFiles broken(folder / ".", "run", "");
    EXPECT_EQ(broken.begin(), "");
  }
  EXPECT_EQ(names_in(folder), (Names{"timeline.json", "files.json"}));
  write(folder, "run", {"result.json"});
  EXPECT_EQ(names_in(folder), (Names{"result.json", "files.json"}));
}

TEST(WrittenFiles, OfOtherCommandsAndWhatIsReadStay) {
  Folder folder;
  write(folder, "run", {"scenario.json", "shared.json", "result.json"});
  write(folder, "verify", {"1-latency.json", "2-latency.json", "shared.json"});
  EXPECT_EQ(names_in(folder),
            (Names{"scenario.json", "shared.json", "result.json", "1-latency.json", "2-latency.json", "files.json"}));
  write(folder, "verify", {"1-latency.json"}, folder / "2-latency.json");
  EXPECT_EQ(names_in(folder),
            (Names{"scenario.json", "shared.json", "result.json", "1-latency.json", "2-latency.json", "files.json"}));
  EXPECT_EQ(write(folder, "verify", {}), "Removed from " + (folder / ".") + ", of an older run: 1-latency.json\n");
  EXPECT_EQ(names_in(folder), (Names{"scenario.json", "shared.json", "result.json", "2-latency.json", "files.json"}));
}

// files.json may say anything: only files of the folder itself go, and a folder or a name of elsewhere never does.
TEST(WrittenFiles, AForgedListReachesNothingElse) {
  Folder folder;
  std::filesystem::create_directories(folder / "run/inner");
  put(folder / "outside");
  put(folder / "run/inner/file");
  put(folder / "run/plain");
  for (const char* const text :
       {"", "{", "[]", "{\"written\": 3}", "{\"written\": [3, {\"command\": \"run\", \"files\": [1, {}]}]}"}) {
    put(folder / "run/files.json", text);
    WrittenFiles written(folder / "run", "run", "");
    EXPECT_EQ(written.begin(), "");
    EXPECT_EQ(written.end("s"), "") << text;
  }
  put(folder / "run/files.json",
      "{\"written\": [{\"command\": \"run\", \"files\": [\"../outside\", \"inner/file\", \"..\", \".\", \"\", "
      "\"files.json\", \"" +
          (folder / "outside") + "\", \"gone\", \"plain\"]}]}");
  WrittenFiles written(folder / "run", "run", "");
  EXPECT_EQ(written.begin(), "");
  EXPECT_EQ(written.end("s"), "");
  EXPECT_TRUE(std::filesystem::exists(folder / "outside"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run/inner/file"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run/files.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run/plain"));
  put(folder / "run/files.json", "{\"written\": [{\"command\": \"run\", \"files\": [\"inner\"]}]}");
  WrittenFiles again(folder / "run", "run", "");
  EXPECT_EQ(again.end("s"), "");  // a folder is in the place of a file
  EXPECT_TRUE(std::filesystem::exists(folder / "run/inner/file"));
}

TEST(WrittenFiles, APageMayLieInTheFolder) {
  Folder folder;
  WrittenFiles written(folder / ".", "run", "");
  EXPECT_TRUE(written.add_if_inside(folder / "page.html"));
  EXPECT_FALSE(
      written.add_if_inside((std::filesystem::path(folder / ".").parent_path().parent_path() / "page.html").string()));
  EXPECT_FALSE(written.add_if_inside("/nowhere/page.html"));
  EXPECT_EQ(written.summary(), "Written to " + (folder / ".") + ": page.html\nTo open: page.html in a browser\n");
}

}  // namespace
}  // namespace takt::output
