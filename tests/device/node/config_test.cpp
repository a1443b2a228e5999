// SPDX-License-Identifier: Apache-2.0
// The files of nodes: what they come down to, and what is refused.
#include "node/config.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace takt::node::config_test {
namespace {

const std::string udp = R"({"kind": "udp", "destinations": ["127.0.0.1:4841"]})";

std::string file(const std::string& node, const std::string& more_of_program = {}, const std::string& more = {},
                 const std::string& transport = udp) {
  return R"({"node": ")" + node + R"(", "program": {"name": "p", "master": "m", "slaves": ["a", "b"], "cycle": "1ms",
 "process_data": [{"name": "d", "from": "a", "fields": {"x": {"type": "Double", "count": 3}, "b": "Byte"}}])" +
         more_of_program + R"(}, "transport": )" + transport + more + "}";
}

struct Load {
  explicit Load(const std::string& text) {
    const std::string path = std::string(::testing::TempDir()) + "takt-node-config.json";
    std::ofstream(path) << text;
    loaded = load_config(path, diagnostics);
    std::filesystem::remove(path);
  }
  json::Diagnostics diagnostics;
  std::unique_ptr<LoadedConfig> loaded;
};

TEST(Config, OfASlave) {
  const Load load(file("b"));
  ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
  const wire::EndpointSettings& endpoint = load.loaded->programs[0].endpoint;
  EXPECT_EQ(endpoint.handshake.index, 2);
  EXPECT_EQ(endpoint.handshake.role, handshake::Role::slave);
  EXPECT_EQ(endpoint.handshake.slaves, 2);
  EXPECT_EQ(endpoint.receive_timeout, Duration::from_ps(10'000'000'000));
  EXPECT_EQ(endpoint.format->longest(), wire::process_data_octets(25));
}

TEST(Config, OwnPhasesAreTaken) {
  const std::string phases = R"(, "offset": "100us", "phases": {"a": "250us"})";
  EXPECT_EQ(Load(file("a", phases)).loaded->programs[0].endpoint.offset, Duration::from_ps(250'000'000));
  EXPECT_EQ(Load(file("b", phases)).loaded->programs[0].endpoint.offset, Duration::from_ps(100'000'000));
  EXPECT_FALSE(Load(file("b", R"(, "phases": {"stranger": "250us"})")).loaded);
}

TEST(Config, WhatOnlyASimulatorDoesIsRefused) {
  const Load load(file("b", R"(, "replies": [{"to": "d", "with": "e"}])"));
  EXPECT_FALSE(load.loaded);
  EXPECT_NE(load.diagnostics.to_text().find("/program/replies: not on a real node"), std::string::npos)
      << load.diagnostics.to_text();
}

TEST(Config, AnOffsetIsANumber) {
  const Load load(file("b", R"(, "offset": "auto")"));
  EXPECT_FALSE(load.loaded);
  EXPECT_NE(
      load.diagnostics.to_text().find(
          "/program/offset: not on a real node: found \"auto\", which a simulator chooses for its network, expected"),
      std::string::npos)
      << load.diagnostics.to_text();
}

TEST(Config, MistakesAreFound) {
  for (const std::string& text :
       {std::string("{"), std::string("{}"), file("c"), file("a", R"(, "offset": "1ms")"),
        file("a", R"(, "receive_timeout": "1ms")"), file("a", R"(, "variant": "other")"),
        file("a", R"(, "cycle": "1")"), file("a", "", R"(, "surplus": 1)"),
        file("a", "", R"(, "script": [{"at": "1s", "call": "Stop"}])"), file("a", "", "", R"({"kind": "tcp"})"),
        file("a", "", "", R"({"kind": "udp", "destinations": []})"), file("a", "", "", R"({"kind": "ethernet"})")}) {
    const Load load(text);
    EXPECT_FALSE(load.loaded) << text;
    EXPECT_TRUE(load.diagnostics.has_errors()) << text;
  }
}

TEST(Config, AMessageFitsIntoAFrame) {
  const std::string most = R"({"node": "m", "program": {"name": "p", "master": "m", "slaves": ["a"], "cycle": "1ms",
 "process_data": [{"name": "d", "from": "a", "fields": {"x": {"type": "Byte", "count": )";
  const std::string rest = "}}}]}, \"transport\": " + udp + "}";
  EXPECT_TRUE(Load(most + "1448" + rest).loaded);  // 1472 - 24
  EXPECT_FALSE(Load(most + "1449" + rest).loaded);
}

}  // namespace
}  // namespace takt::node::config_test
