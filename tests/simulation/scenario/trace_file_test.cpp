// SPDX-License-Identifier: Apache-2.0
// CSV traces: what they say, and what is wrong with them, by line.
#include "scenario/resolve/trace_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "support.hpp"

namespace takt::scenario::test::trace_file_test {
namespace {

/// What was read, and what was said about it.
std::pair<std::size_t, std::string> parsed(const std::string& text) {
  json::Diagnostics diagnostics;
  const std::size_t entries = parse_trace(text, "t.csv", diagnostics).size();
  return {entries, diagnostics.to_text()};
}

TEST(TraceFile, ReadsTimesAndPayloads) {
  json::Diagnostics diagnostics;
  const auto entries = parse_trace("time,payload\r\n12.5us,100B\r\n\r\n 13us , 1kB \n13us,1B", "t.csv", diagnostics);
  EXPECT_EQ(diagnostics.to_text(), "");
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].time.ps(), 12'500'000);
  EXPECT_EQ(entries[0].payload.count, 100u);
  EXPECT_EQ(entries[1].payload.count, 1000u);
  EXPECT_EQ(entries[2].time.ps(), 13'000'000);
}

TEST(TraceFile, EveryBadLineIsReported) {
  const auto [entries, text] = parsed("1us,10B\nnonsense\n2us,10\n-3us,1B\n5us,1B\n4us,1B\n2401h,1B\n");
  EXPECT_EQ(entries, 2u);
  EXPECT_EQ(text,
            "t.csv:2:1: error: not a line of a trace: found \"nonsense\", expected time,payload such as 12.5us,100B\n"
            "t.csv:3:5: error: missing unit: found \"10\", expected one of the units B, kB, KiB, MB, MiB, GB, GiB\n"
            "t.csv:4:1: error: negative: found \"-3us\", expected a duration that is not negative\n"
            "t.csv:6:1: error: times must ascend: found 4us, expected at least 5us\n"
            "t.csv:7:1: error: out of range: found 2401h, expected a time of at most 2400h\n");
}

TEST(TraceFile, EmptyOnes) {
  EXPECT_EQ(parsed("").second, "t.csv: error: an empty trace: found no frames, expected lines time,payload\n");
  EXPECT_EQ(parsed("time,payload\n\n").second,
            "t.csv: error: an empty trace: found no frames, expected lines time,payload\n");
}

TEST(TraceFile, AMillionBadLinesAreTold100Times) {
  json::Diagnostics diagnostics;
  std::string text;
  for (int i = 0; i < 1'000'000; ++i) text += "x\n";
  parse_trace(text, "t.csv", diagnostics);
  EXPECT_EQ(diagnostics.kept().size(), 100u);
}

/// A folder that goes with the test.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("takt-trace-" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  void write(const char* name, const std::string& text) const { std::ofstream(path / name) << text; }
};

std::string scenario_with_trace(const std::string& name) {
  return over_one_switch(R"(, "streams": [{"name": "s", "from": "a", "to": "b", "trace": ")" + name +
                         R"(", "offset": "1ms"}])");
}

// Frames of 10 and 20 octets at 1 ms + 5 us and 1 ms + 1 ms; the file lies beside the scenario.
TEST(TraceFile, RunsFromAFileBesideTheScenario) {
  const Folder folder;
  folder.write("s.json", scenario_with_trace("t.csv"));
  folder.write("t.csv", "time,payload\n5us,10B\n1ms,20B\n");
  json::Diagnostics diagnostics;
  const auto resolved = load_file((folder.path / "s.json").string(), {}, diagnostics);
  ASSERT_NE(resolved, nullptr) << diagnostics.to_text();
  LiveRun run(*resolved);
  const auto sent = [&] { return run.network().traffic().streams()[0].sent; };
  run.simulation().run(sim::TrueTime::from_ps(1'004'999'999), ~0ULL);
  EXPECT_EQ(sent(), 0u);
  run.simulation().run(sim::TrueTime::from_ps(1'005'000'000), ~0ULL);
  EXPECT_EQ(sent(), 1u);
  run.advance();
  EXPECT_EQ(sent(), 2u);
  EXPECT_EQ(run.network().traffic().streams()[0].delivered, 2u);
}

TEST(TraceFile, FoldersAndPayloadsBeyondAFrameAreRefused) {
  const Folder folder;
  folder.write("t.csv", "5us,1473B\n");
  for (const auto& [name, message] :
       {std::pair{std::string("t.csv"), "more than one frame"}, {std::string("."), "cannot read the trace"}}) {
    folder.write("s.json", scenario_with_trace(name));
    json::Diagnostics diagnostics;
    EXPECT_EQ(load_file((folder.path / "s.json").string(), {}, diagnostics), nullptr);
    EXPECT_NE(diagnostics.to_text().find(message), std::string::npos) << diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::scenario::test::trace_file_test
