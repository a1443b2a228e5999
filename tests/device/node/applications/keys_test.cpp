// SPDX-License-Identifier: Apache-2.0
// Instances and partitions over Cyclone DDS, and the file for the statistics.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "node/applications/host.hpp"
#include "node/applications/statistics_file.hpp"

namespace takt::node {
namespace {

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("takt-keys-" + std::to_string(::getpid()) + name);
}

std::unique_ptr<LoadedApplications> load(const std::string& text, json::Diagnostics& diagnostics) {
  const auto path = temporary(".json");
  std::ofstream(path) << text;
  auto loaded = load_applications(path.string(), diagnostics);
  std::filesystem::remove(path);
  return loaded;
}

std::vector<ApplicationStatistics> run(const std::string& text) {
  json::Diagnostics diagnostics;
  const auto loaded = load(text, diagnostics);
  EXPECT_TRUE(loaded) << diagnostics.to_text();
  if (!loaded) return {};
  std::string problem;
  std::string warnings;
  const auto host = ApplicationHost::make(*loaded, problem, warnings);
  EXPECT_TRUE(host) << problem;
  if (!host) return {};
  host->run([](const void*) { return false; }, nullptr);
  return host->statistics();
}

// A reader keeps one sample of each instance: a call that comes after many finds as many as there are instances.
TEST(Instances, EachHasAHistoryOfItsOwn) {
  if (!has_dds()) GTEST_SKIP() << "this build has no DDS";
  const auto topic = [](const std::string& keys) {
    return R"({"node": "n", "duration": "3s", "dds": "lo",
      "topics": [{"name": "x", "protocol": "dds", "domain": 71, "fields": {"level": "UInt32", "part": "UInt16", "axes": {"type": "Double", "count": 2}},
                  "qos": {"reliability": "reliable", "durability": "transient-local"})" +
           keys + R"(}],
      "applications": [{"name": "p", "on": "n", "threads": [{"name": "publish", "publish": "x", "every": "2ms")" +
           (keys.empty() ? "" : R"(, "payload": {"pattern": "counter", "instance": 40, "instances": 3})") +
           R"(}]}, {"name": "s", "on": "n", "threads": [{"name": "subscribe", "subscribe": "x", "every": "1s", "offset": "500ms", "buffer": 10, "qos": {"depth": 1}}]}]})";
  };
  const auto keyed = run(topic(R"(, "keys": ["part"])"));
  const auto keyless = run(topic(""));
  const auto long_keyed =
      run(topic(R"(, "keys": ["part", "axes"])"));  // 24 octets: what tells instances apart is an MD5
  ASSERT_EQ(long_keyed.size(), 2u);
  EXPECT_GT(long_keyed[1].threads[0].taken, long_keyed[1].threads[0].calls + 1);
  ASSERT_EQ(keyed.size(), 2u);
  ASSERT_EQ(keyless.size(), 2u);
  const ThreadStatistics& of_keyed = keyed[1].threads[0];
  const ThreadStatistics& of_keyless = keyless[1].threads[0];
  // What came after the last call is taken at the end.
  EXPECT_GT(of_keyed.taken, of_keyed.calls + 1) << "some call finds more than one instance";
  EXPECT_LE(of_keyed.taken, 3 * (of_keyed.calls + 1));
  EXPECT_GT(of_keyless.taken, 0u);
  EXPECT_LE(of_keyless.taken, of_keyless.calls + 1);
}

TEST(Partitions, KeepApart) {
  if (!has_dds()) GTEST_SKIP() << "this build has no DDS";
  const auto statistics = run(R"({"node": "n", "duration": "2s", "dds": "lo",
    "topics": [{"name": "x", "protocol": "dds", "domain": 72, "fields": {"level": "UInt32"}, "qos": {"reliability": "reliable", "partition": ["left-1"]}}],
    "applications": [{"name": "p", "on": "n", "threads": [{"name": "publish", "publish": "x", "every": "5ms"}]},
                     {"name": "same", "on": "n", "threads": [{"name": "subscribe", "subscribe": "x", "every": "5ms", "buffer": 100, "qos": {"partition": ["right", "left-*"]}}]},
                     {"name": "other", "on": "n", "threads": [{"name": "subscribe", "subscribe": "x", "every": "5ms", "buffer": 100, "qos": {"partition": ["right"]}}]}]})");
  ASSERT_EQ(statistics.size(), 3u);
  EXPECT_GT(statistics[1].threads[0].taken, 0u);
  EXPECT_EQ(statistics[2].threads[0].taken, 0u);
}

TEST(Keys, MistakesAreNamed) {
  if (!has_dds()) GTEST_SKIP() << "this build has no DDS";
  json::Diagnostics diagnostics;
  EXPECT_FALSE(load(R"({"node": "n", "transport": {"kind": "udp", "destinations": ["239.0.0.1"]},
    "topics": [{"name": "a", "protocol": "opc-ua", "fields": {"n": "UInt32"}, "keys": ["n"]}, {"name": "b", "protocol": "dds", "fields": {"n": "UInt32", "v": "Double"}, "keys": ["m"]},
               {"name": "c", "protocol": "dds", "fields": {"n": "UInt32"}, "keys": ["n"]},
               {"name": "d", "protocol": "dds", "fields": {"n": {"type": "UInt64", "count": 3}, "v": "Double"}, "keys": ["n"]},
               {"name": "e", "protocol": "opc-ua", "fields": {"n": "UInt32"}}],
    "applications": [{"name": "p", "on": "n", "threads": [{"name": "one", "publish": "e", "every": "1ms", "payload": {"pattern": "counter", "instances": 2}}]}]})",
                    diagnostics));
  std::vector<std::string> said;
  for (const auto& each : diagnostics.sorted()) said.push_back(each.place.pointer + ": " + each.message);
  EXPECT_EQ(said, (std::vector<std::string>{
                      "/topics/0/keys: not of OPC UA", "/topics/1/keys/0: a key that is no field",
                      "/topics/2/keys: keys and nothing else",
                      "/applications/0/threads/0/payload/instances: an instance of a topic without keys"}));
}

TEST(StatisticsFile, ThatCannotBeWrittenIsFoundBeforehand) {
  const auto folder = temporary("-folder");
  std::filesystem::create_directory(folder);
  EXPECT_EQ(statistics_problem((folder / "s.json").string()), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder)) << "looking leaves nothing behind";
  EXPECT_NE(statistics_problem((folder / "none" / "s.json").string()), "");
  EXPECT_NE(statistics_problem(folder.string()), "") << "a folder";
  EXPECT_EQ(statistics_problem("/dev/null"), "");
  EXPECT_EQ(write_statistics("/dev/null", "x"), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_EQ(write_statistics((folder / "s.json").string(), "{}\n"), "");
  EXPECT_EQ(std::filesystem::file_size(folder / "s.json"), 3u);
  ApplicationsConfig config;
  json::Diagnostics diagnostics;
  EXPECT_TRUE(check_statistics(config, diagnostics));
  config.statistics = (folder / "none" / "s.json").string();
  EXPECT_FALSE(check_statistics(config, diagnostics));
  EXPECT_EQ(diagnostics.errors(), 1u);
  EXPECT_NE(diagnostics.to_text().find("No such file or directory"), std::string::npos) << diagnostics.to_text();
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace takt::node
