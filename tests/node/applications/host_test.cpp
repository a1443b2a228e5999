// Threads of applications over a real socket: what one publishes another copies and a third takes.
#include "node/applications/host.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace takt::node {
namespace {

TEST(ApplicationHost, AChainOfThreeRolesTakesWhatItPublishes) {
  const auto path = std::filesystem::temp_directory_path() / ("takt-host-" + std::to_string(::getpid()) + ".json");
  const std::string port = std::to_string(30'000 + ::getpid() % 10'000);
  std::ofstream(path) << R"({
    "node": "all", "duration": "1s",
    "topics": [{"name": "process", "protocol": "opc-ua", "fields": {"v": {"type": "Double", "count": 4}}}, {"name": "report", "protocol": "opc-ua", "fields": {"v": {"type": "Double", "count": 4}}}],
    "applications": [
      {"name": "update", "threads": [{"name": "publish", "publish": "process", "every": "5ms"}]},
      {"name": "control", "threads": [{"name": "subscribe", "subscribe": "process", "every": "5ms", "offset": "1ms", "buffer": 1000},
                                      {"name": "publish", "publish": "report", "every": "5ms", "offset": "3ms", "payload": {"copy_of": "process"}}]},
      {"name": "diagnose", "threads": [{"name": "subscribe", "subscribe": "report", "every": "5ms", "offset": "4ms", "buffer": 1000}]}],
    "transport": {"kind": "udp", "interface": "lo", "port": )" + port + R"(, "destinations": ["127.0.0.1"]}})";
  json::Diagnostics diagnostics;
  const auto loaded = load_applications(path.string(), diagnostics);
  std::filesystem::remove(path);
  ASSERT_TRUE(loaded) << diagnostics.to_text();
  std::string problem;
  std::string warnings;
  const auto host = ApplicationHost::make(*loaded, problem, warnings);
  ASSERT_TRUE(host) << problem;
  host->run([](const void*) { return false; }, nullptr);
  const auto statistics = host->statistics();
  ASSERT_EQ(statistics.size(), 3u);
  const ThreadStatistics& update = statistics[0].threads[0];
  const ThreadStatistics& control = statistics[1].threads[0];
  const ThreadStatistics& report = statistics[1].threads[1];
  const ThreadStatistics& diagnose = statistics[2].threads[0];
  // How often a thread is let run is this machine's matter. What holds on every machine: nothing is lost within it but what is under way at the end.
  EXPECT_GT(update.sent, 1u);
  EXPECT_EQ(update.sent, update.calls);
  EXPECT_LE(control.taken, update.sent);
  EXPECT_GE(control.taken + 3, update.sent);
  EXPECT_EQ(control.lost + diagnose.lost, 0u);
  EXPECT_LE(report.sent, report.calls);
  EXPECT_GT(diagnose.taken, 0u);
  EXPECT_LE(diagnose.taken, report.sent);
  EXPECT_EQ(update.window_ns, 10'000'000);
  for (const ApplicationStatistics& application : statistics)
    for (const ThreadStatistics& thread : application.threads) {
      EXPECT_EQ(thread.late.count(), thread.calls);
      EXPECT_EQ(thread.call_windows.expected, 2 * thread.call_windows.tests);
      EXPECT_LE(thread.call_windows.counted, thread.call_windows.expected);
    }
  const std::string json = to_json("all", statistics);
  EXPECT_NE(json.find("\"criterion_1\""), std::string::npos);
}

}  // namespace
}  // namespace takt::node
