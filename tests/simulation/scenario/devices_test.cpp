// SPDX-License-Identifier: Apache-2.0
// Types of devices: what a node takes from its file, what it says itself, and what it asks for that the device has not.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scenario/description/device.hpp"
#include "support.hpp"

namespace takt::scenario::test::devices_test {
namespace {

/// A folder with the files of a test.
class Devices : public testing::Test {
 protected:
  Devices() : folder_(std::filesystem::temp_directory_path() / ("takt-devices-" + std::to_string(getpid()))) {
    std::filesystem::create_directory(folder_);
  }
  ~Devices() override { std::filesystem::remove_all(folder_); }

  void device(const std::string& name, const std::string& members) const {
    std::ofstream(folder_ / name) << R"({"name": "X1", "source": "a data sheet", )" << members << "}";
  }
  /// Two hosts at a switch; `node` are members of the switch.
  Loaded load_with(const std::string& node, const std::string& more = "", const std::string& links = "") const {
    const std::string both =
        links.empty() ? R"({"ends": ["a", "sw"]}, {"ends": ["b", "sw"], "rate": "100Mbps"})" : links;
    Loaded loaded;
    loaded.resolved = load_text(
        R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"},
"sw": {"kind": "switch", )" +
            node + "}}, \"links\": [" + both + "]}" + more + "}",
        (folder_ / "s.json").string(), {}, loaded.diagnostics);
    return loaded;
  }
  std::string told(const Loaded& loaded) const {
    std::string text = loaded.diagnostics.to_text();
    const std::string path = folder_.string() + "/";
    for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path, at))
      text.erase(at, path.size());
    return text;
  }
  static const SwitchNode& switch_of(const Loaded& loaded) {
    if (!loaded.resolved) throw std::runtime_error(loaded.diagnostics.to_text());
    return std::get<SwitchNode>(loaded.resolved->topology.nodes[2].description.get());
  }

  std::filesystem::path folder_;
};

TEST_F(Devices, DelaysAreThoseOfThePortsThatTheNodeHas) {
  device("x.json", R"("delays": [
    {"from": "1Gbps", "to": "1Gbps", "least": "500ns", "greatest": "600ns"},
    {"from": "1Gbps", "to": "100Mbps", "least": "700ns", "greatest": "800ns", "greatest_per_octet": "1ns"},
    {"from": "100Mbps", "least": "900ns", "greatest": "1us"},
    {"from": "10Gbps", "least": "100ns", "greatest": "100us"}])");
  const Loaded loaded = load_with(R"("device": "x.json")");
  const SwitchNode& node = switch_of(loaded);
  // The least of all pairs, and of the greatest 800 ns and 1522 octets of 1 ns.
  EXPECT_EQ(node.forwarding_delay, Duration::from_ps(500'000));
  ASSERT_TRUE(node.forwarding_jitter && node.forwarding_jitter->uniform);
  EXPECT_EQ(node.forwarding_jitter->uniform->to, Duration::from_ps(800'000 + 1'522'000 - 500'000));
  EXPECT_EQ(loaded.resolved->plan.nodes[2].greatest_forwarding_delay(), Duration::from_ps(2'322'000));
}

TEST_F(Devices, WhatTheNodeSaysWins) {
  device("x.json", R"("delays": [{"least": "500ns", "greatest": "600ns"}], "traffic_classes": 4, "mtu": "9000B",
    "queues": {"frames": 7}, "gate_limits": {"entries": 16})");
  const Loaded taken = load_with(R"("device": "x.json")");
  EXPECT_EQ(switch_of(taken).traffic_classes, TrafficClasses::four);
  EXPECT_EQ(switch_of(taken).mtu, Octets{9000});
  EXPECT_EQ(switch_of(taken).queues.frames, 7u);
  ASSERT_TRUE(switch_of(taken).gate_limits);
  EXPECT_EQ(switch_of(taken).gate_limits->entries, 16u);
  const Loaded own =
      load_with(R"("device": "x.json", "forwarding_delay": "2us", "traffic_classes": "identity", "mtu": "1500B",
    "queues": {}, "gate_limits": {})");
  EXPECT_EQ(switch_of(own).forwarding_delay, Duration::from_ps(2'000'000));
  EXPECT_FALSE(switch_of(own).forwarding_jitter);
  EXPECT_EQ(switch_of(own).traffic_classes, TrafficClasses::identity);
  EXPECT_EQ(switch_of(own).mtu, Octets{1500});
  EXPECT_FALSE(switch_of(own).queues.frames);
  EXPECT_FALSE(switch_of(own).gate_limits->entries);
}

TEST_F(Devices, TheResolvedCopyNeedsNoFile) {
  device("x.json", R"("delays": [{"least": "500ns", "greatest": "600ns"}], "features": {"gates": false})");
  const Loaded loaded = load_with(R"("device": "x.json")");
  const SwitchNode before = switch_of(loaded);
  const std::string copy = json::encode(loaded.resolved->scenario);
  EXPECT_EQ(copy.find("x.json"), std::string::npos);
  const auto again = sound(copy);
  EXPECT_EQ(again->scenario, loaded.resolved->scenario);
  EXPECT_EQ(std::get<SwitchNode>(again->topology.nodes[2].description.get()), before);
}

TEST_F(Devices, MistakesOfAFileAreItsOwn) {
  EXPECT_EQ(told(load_with(R"("device": "y.json")")),
            "s.json:2:36: error at /network/nodes/sw/device: cannot read the device: found \"y.json\", expected a file "
            "with a type of device\n");
  device("x.json", R"("delays": [{"least": "700ns", "greatest": "600ns"}], "speed": 1)");
  EXPECT_EQ(
      told(load_with(R"("device": "x.json")")),
      "x.json:1:84: error at /delays/0/greatest: an interval that ends before it begins: found 600ns, expected at "
      "least 700ns\n"
      "x.json:1:95: error at /speed: unknown field \"speed\": expected one of \"$schema\", \"name\", \"vendor\", "
      "\"source\", \"description\", \"delays\", \"phys\", \"ports\", \"rates\", \"traffic_classes\", \"queues\", "
      "\"mtu\", \"gate_limits\", \"time_stamps\", \"gptp_residence\" or \"features\"\n");
  device("x.json", R"("delays": [{"from": "1Gbps", "least": "600ns", "greatest": "600ns"}])");
  EXPECT_EQ(told(load_with(R"("device": "x.json")")),
            "x.json:1:52: error at /delays: a delay that the device does not say: found none from 100Mbps to 1Gbps at "
            "\"sw\", expected an entry that holds for these ports, or \"forwarding_delay\" of the node\n");
}

TEST_F(Devices, WhatTheDeviceHasNotIsRefused) {
  device("x.json", R"("ports": 1, "rates": ["1Gbps"], "features": {"gates": false, "preemption": false, "cut_through":
    false, "credit_based_shaper": false, "ats": false, "ets": false, "policing": false, "gptp": false})");
  const std::string text = told(load_with(R"("device": "x.json", "egress": [{"gates": {"entries": [{"open": [0], "for":
    "1us"}]}, "preemption": {"preemptable": [0]}, "cut_through": [7], "shapers": [{"class": 6, "idle_slope": "1Mbps"}]}])",
                                          R"(, "clocks": {"gptp": {}})"));
  for (const char* const asked :
       {"gates at a node without gates: found a gate list at \"sw\"",
        "found frame preemption at \"sw\", expected no frame preemption", "found cut-through at \"sw\"",
        "found credit-based shapers at \"sw\"", "found gPTP at \"sw\"", "found 2 links at \"sw\", expected at most 1",
        "found a link of 100Mbps at \"sw\", expected ports of 1Gbps"})
    EXPECT_NE(text.find(asked), std::string::npos) << asked << "\n" << text;
  EXPECT_NE(text.find("as \"X1\" in x.json has it"), std::string::npos) << text;
}

TEST_F(Devices, ClocksAndGptpTakeTimeStampsAndResidence) {
  device("x.json", R"("phys": [{"rate": "1Gbps", "transmit": "100ns", "receive": "200ns", "variation": "3ns"}, {"rate":
    "10Gbps", "transmit": "9us"}], "time_stamps": {"granularity": "8ns", "error": "4ns"}, "gptp_residence": {"least":
    "1ms", "greatest": "2ms"})");
  const Loaded ideal = load_with(R"("device": "x.json")");
  EXPECT_FALSE(ideal.resolved->plan.nodes[2].clock);
  const Loaded loaded = load_with(R"("device": "x.json")", R"(, "clocks": {"gptp": {}})");
  ASSERT_TRUE(loaded.resolved) << told(loaded);
  const models::TimestampUnit& unit = loaded.resolved->plan.nodes[2].clock->timestamps;
  EXPECT_EQ(unit.granularity, Duration::from_ps(8'000));
  EXPECT_EQ(unit.jitter, Duration::from_ps(7'000));
  EXPECT_EQ(unit.egress_latency, Duration::from_ps(100'000));
  EXPECT_EQ(unit.ingress_latency, Duration::from_ps(200'000));
  EXPECT_EQ(loaded.resolved->plan.nodes[0].clock->timestamps.granularity, Duration::from_ps(1));
  ASSERT_FALSE(loaded.resolved->plan.gptp_stations.empty());
  EXPECT_EQ(loaded.resolved->plan.gptp_stations.front().processing.greatest(), Duration::from_ps(2'000'000'000));
  const Loaded own =
      load_with(R"("device": "x.json")",
                R"(, "clocks": {"gptp": {"processing": "3us"}, "nodes": {"sw": {"granularity": "1ns"}}})");
  ASSERT_TRUE(own.resolved) << told(own);
  EXPECT_EQ(own.resolved->plan.nodes[2].clock->timestamps.granularity, Duration::from_ps(1'000));
  EXPECT_EQ(own.resolved->plan.gptp_stations.front().processing.greatest(), Duration::from_ps(3'000'000));
}

TEST_F(Devices, GeneratedSwitchesHaveOneTypeToo) {
  device("x.json", R"("delays": [{"least": "500ns", "greatest": "500ns"}], "features": {"preemption": false})");
  const auto load_generated = [&](const std::string& more) {
    Loaded loaded;
    loaded.resolved = load_text(
        R"({"name": "t", "duration": "1ms", "network": {"generate": [{"topology": "line", "switches": 3, "device": "x.json")" +
            more + "}]}}",
        (folder_ / "s.json").string(), {}, loaded.diagnostics);
    return loaded;
  };
  const Loaded loaded = load_generated("");
  ASSERT_TRUE(loaded.resolved) << told(loaded);
  EXPECT_EQ(loaded.resolved->plan.nodes[2].forwarding_delay, Duration::from_ps(500'000));
  const Loaded refused = load_generated(R"(, "egress": [{"preemption": {"preemptable": [0]}}])");
  EXPECT_EQ(refused.diagnostics.errors(), 1u) << told(refused);  // once for all three
}

TEST(TrafficClassColumns, AreThoseOfTable85) {
  // IEEE 802.1Q-2018 Table 8-5, by priority.
  const std::pair<const char*, std::array<std::uint8_t, 8>> columns[] = {
      {"1", {0, 0, 0, 0, 0, 0, 0, 0}}, {"2", {0, 0, 0, 0, 1, 1, 1, 1}}, {"3", {0, 0, 0, 0, 1, 1, 2, 2}},
      {"4", {0, 0, 1, 1, 2, 2, 3, 3}}, {"5", {0, 0, 1, 1, 2, 2, 3, 4}}, {"6", {1, 0, 2, 2, 3, 3, 4, 5}},
      {"7", {1, 0, 2, 3, 4, 4, 5, 6}}, {"8", {1, 0, 2, 3, 4, 5, 6, 7}}};
  for (const auto& [count, classes] : columns) {
    const auto resolved =
        sound(R"({"name": "t", "duration": "1ms", "network": {"nodes": {"sw": {"kind": "switch", "traffic_classes": )" +
              std::string(count) + R"(}, "a": {"kind": "host"}}, "links": [{"ends": ["a", "sw"]}]}})");
    EXPECT_EQ(resolved->plan.port_configs[resolved->plan.nodes[0].port_config].traffic_class_of_priority, classes);
    EXPECT_EQ(sound(json::encode(resolved->scenario))->scenario, resolved->scenario);
  }
}

TEST(PublishedDevices, AreAllSound) {
  std::size_t found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/devices")) {
    if (entry.path().extension() != ".json") continue;
    ++found;
    sound(R"({"name": "t", "duration": "1ms", "network": {"nodes": {"sw": {"kind": "switch", "device": ")" +
          entry.path().string() + R"("}, "a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "sw"]},
          {"ends": ["b", "sw"]}]}})");
  }
  EXPECT_GE(found, 6u);
}

}  // namespace
}  // namespace takt::scenario::test::devices_test
