// SPDX-License-Identifier: Apache-2.0
// A node's file and a scenario that say the same make the same octets, so that a capture of one reads as the other's.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "node/config.hpp"
#include "plant/protocol.hpp"
#include "scenario/resolve.hpp"

namespace takt::node::same_octets_test {
namespace {

const std::string program = R"({"name": "p", "master": "m", "slaves": ["a", "b"], "cycle": "1ms",
 "process_data": [{"name": "d", "from": "m", "fields": {"x": {"type": "Double", "count": 3}, "b": "Byte"}}, {"name": "e", "from": "b", "fields": {"y": "Int16"}}])";

wire::ProgramFormat of_scenario(const std::string& variant) {
  const std::string text =
      R"({"name": "s", "duration": "1ms", "network": {"nodes": {"m": {"kind": "host"}, "a": {"kind": "host"}, "b": {"kind": "host"}, "w": {"kind": "switch"}},
 "links": [{"ends": ["m", "w"]}, {"ends": ["a", "w"]}, {"ends": ["b", "w"]}]}, "programs": [)" +
      program + R"(, "variant": ")" + variant + "\"}]}";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "s.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return wire::ProgramFormat(
      plant::shape_of(*resolved->programs[0].description, resolved->programs[0].first_publisher_id));
}

wire::ProgramFormat of_node(const std::string& variant) {
  const std::string path = std::string(::testing::TempDir()) + "takt-node-same.json";
  std::ofstream(path) << R"({"node": "a", "transport": {"kind": "ethernet", "interface": "eth0"}, "program": )"
                      << program << R"(, "variant": ")" << variant << "\"}}";
  json::Diagnostics diagnostics;
  const auto loaded = load_config(path, diagnostics);
  std::filesystem::remove(path);
  EXPECT_TRUE(loaded) << diagnostics.to_text();
  return *loaded->programs[0].endpoint.format;
}

std::vector<std::byte> copy(uadp::Octets octets) { return {octets.begin(), octets.end()}; }

TEST(SameOctets, OfStatesAndProcessData) {
  std::array<std::byte, 1500> buffer{};
  for (const std::string variant : {"robust", "paper"}) {
    const wire::ProgramFormat there = of_scenario(variant);
    const wire::ProgramFormat here = of_node(variant);
    EXPECT_EQ(there.group_version(), here.group_version());
    for (std::uint8_t sender = 0; sender < 3; ++sender) {
      wire::StateMessage message{
          sender, 77, {5, handshake::PublishedState::Running, {3, handshake::IntentKind::Start, 0, 9}, 9}};
      const auto first = copy(there.encode(message, buffer));
      EXPECT_EQ(first, copy(here.encode(message, buffer)));
    }
    for (const std::uint8_t data_set : {std::uint8_t{0}, std::uint8_t{1}}) {
      const wire::ProcessDataMessage message{static_cast<std::uint8_t>(2 * data_set), data_set, 5, 9, {}};
      const auto first = copy(there.encode(message, buffer));
      EXPECT_EQ(first, copy(here.encode(message, buffer)));
      EXPECT_EQ(first.size(), data_set == 0 ? 49u : 26u);
    }
  }
}

}  // namespace
}  // namespace takt::node::same_octets_test
