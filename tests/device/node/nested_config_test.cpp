// SPDX-License-Identifier: Apache-2.0
// Files of nodes in several Programs: what is hosted, what is joined, and what is refused.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "node/clock.hpp"
#include "node/config.hpp"
#include "plant/protocol.hpp"
#include "scenario/resolve.hpp"

namespace takt::node::nested_config_test {
namespace {

std::string file(const std::string& node, const std::string& programs, const std::string& more = {}) {
  return R"({"node": ")" + node + R"(", "programs": [)" + programs +
         R"(], "transport": {"kind": "ethernet", "interface": "eth0"})" + more + "}";
}

const std::string cell =
    R"({"name": "cell", "master": "plc", "slaves": ["m", "n"], "cycle": "5ms", "process_data": [{"name": "d", "from": "m", "fields": {"x": "Double"}}]})";
const std::string axes = R"({"name": "axes", "within": "cell", "master": "m", "slaves": ["x", "y"], "cycle": "3ms",
 "process_data": [{"name": "d", "from": "m", "fields": {"x": {"type": "Double", "count": 3}}}, {"name": "e", "from": "m", "fields": {"y": "Int16"}}]})";
const std::string drives =
    R"({"name": "drives", "within": "axes", "master": "x", "slaves": ["u", "v"], "cycle": "1ms"})";
const std::string other = R"({"name": "other", "master": "z", "slaves": ["m"], "cycle": "1ms"})";

struct Load {
  explicit Load(const std::string& text) {
    const std::string path = std::string(::testing::TempDir()) + "takt-node-nested.json";
    std::ofstream(path) << text;
    loaded = load_config(path, diagnostics);
    std::filesystem::remove(path);
  }
  json::Diagnostics diagnostics;
  std::unique_ptr<LoadedConfig> loaded;
};

const std::string tree = cell + ", " + axes + ", " + drives;

TEST(NestedConfig, OneListServesAllNodes) {
  struct Case {
    std::string node;
    std::vector<std::string> programs;
    std::vector<int> indices;
    std::vector<bool> nested;
  };
  for (const Case& each : {Case{"plc", {"cell"}, {0}, {false}}, Case{"m", {"cell", "axes"}, {1, 0}, {true, true}},
                           Case{"n", {"cell"}, {2}, {false}}, Case{"x", {"axes", "drives"}, {1, 0}, {true, true}},
                           Case{"v", {"drives"}, {2}, {false}}}) {
    const Load load(file(each.node, tree));
    ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
    const auto& programs = load.loaded->programs;
    ASSERT_EQ(programs.size(), each.programs.size()) << each.node;
    for (std::size_t i = 0; i < programs.size(); ++i) {
      EXPECT_EQ(programs[i].program.name, each.programs[i]);
      EXPECT_EQ(programs[i].endpoint.handshake.index, each.indices[i]);
      EXPECT_EQ(programs[i].endpoint.handshake.nested, each.nested[i]) << each.node;
      EXPECT_EQ(programs[i].outer, i == 1 ? std::optional<std::size_t>(0) : std::nullopt);
    }
    EXPECT_EQ(outermost(programs), 0u);
  }
}

TEST(NestedConfig, TheInnerProgramMayStandFirst) {
  const Load load(file("m", axes + ", " + cell));
  ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
  EXPECT_EQ(load.loaded->programs[0].outer, 1u);
  EXPECT_EQ(load.loaded->programs[1].outer, std::nullopt);
  EXPECT_EQ(outermost(load.loaded->programs), 1u);
}

TEST(NestedConfig, ProgramsSideBySide) {
  const Load load(file("m", cell + ", " + other, R"(, "script": [{"at": "1s", "program": "other", "call": "Halt"}])"));
  ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
  EXPECT_FALSE(load.loaded->programs[0].endpoint.handshake.nested);
  EXPECT_EQ(outermost(load.loaded->programs), std::nullopt);
  EXPECT_EQ(load.loaded->script[0].program, 1u);
}

TEST(NestedConfig, SourcesFindTheirProgram) {
  const Load load(file(
      "m", tree,
      R"(, "sources": [{"data_set": "e", "kind": "counter"}, {"program": "axes", "data_set": "d", "kind": "counter"}])"));
  ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
  EXPECT_EQ(load.loaded->config.sources[0].program, "axes");
  const Load ambiguous(file("m", tree, R"(, "sources": [{"data_set": "d", "kind": "counter"}])"));
  EXPECT_NE(ambiguous.diagnostics.to_text().find("a data set of several programs"), std::string::npos)
      << ambiguous.diagnostics.to_text();
}

struct Mistake {
  std::string text;
  std::string message;
};

TEST(NestedConfig, MistakesAreFound) {
  const auto within = [](const std::string& name, const std::string& outer, const std::string& master,
                         const std::string& slave, const std::string& more = {}) {
    return R"({"name": ")" + name + R"(", "within": ")" + outer + R"(", "master": ")" + master + R"(", "slaves": [")" +
           slave + R"("], "cycle": "1ms")" + more + "}";
  };
  for (const Mistake& each : {
           Mistake{file("m", axes), "unknown program"},
           Mistake{file("m", cell + ", " + within("b", "cel", "m", "x")), "did you mean"},
           Mistake{file("m", cell + ", " + within("b", "cell", "plc", "x")),
                   "the master of a nested program is no slave of the outer one"},
           Mistake{file("m", cell + ", " + axes + ", " + within("b", "cell", "m", "w")),
                   "two programs nested at one slave"},
           Mistake{file("m", within("a", "b", "m", "x") + ", " + within("b", "a", "x", "m")),
                   "programs nested in a circle"},
           Mistake{file("m", within("a", "a", "m", "x")), "programs nested in a circle"},
           Mistake{file("m", cell + ", " + within("b", "cell", "m", "x", R"(, "variant": "paper")")),
                   "nesting with the handshake of the paper"},
           Mistake{file("m", cell + ", " + within("b", "cell", "m", "m")),
                   "a node twice in one program"},  // a third level on one node would be that
           Mistake{file("m", cell + ", " + cell), "duplicate name"},
           Mistake{file("w", tree), "not a participant of any program"},
           Mistake{file("m", cell + ", " + within("b", "cell", "m", "x", R"(, "publisher_id": 3)")),
                   "PublisherIds of two programs"},
           Mistake{file("m", ""), "1 to 256"},
           Mistake{file("m", tree, R"(, "program": )" + cell), "\"programs\""},
           Mistake{file("m", tree, R"(, "script": [{"at": "1s", "program": "drives", "call": "Halt"}])"),
                   "no program of this node"},
           Mistake{file("m", tree, R"(, "script": [{"at": "1s", "program": "axes", "call": "Start"}])"),
                   "Start of a nested program"},
           Mistake{file("m", cell + ", " + other, R"(, "script": [{"at": "1s", "call": "Halt"}])"),
                   "a call without a program"},
           Mistake{file("m", tree, R"(, "launch_lead": "4ms")"), "a lead of more than the cycle"},
       }) {
    const Load load(each.text);
    EXPECT_FALSE(load.loaded) << each.text;
    EXPECT_NE(load.diagnostics.to_text().find(each.message), std::string::npos) << each.message << ":\n"
                                                                                << load.diagnostics.to_text();
  }
}

/// The frames of all Programs that a node hosts are those of the simulator, PublisherIds and all: so they are told
/// apart in the same way.
TEST(NestedConfig, TheOctetsAreThoseOfTheSimulator) {
  std::string hosts;
  std::string links;
  for (const std::string name : {"plc", "m", "n", "x", "y", "u", "v"}) {
    hosts += "\"" + name + R"(": {"kind": "host"}, )";
    links += (links.empty() ? "" : ", ") + (R"({"ends": [")" + name + R"(", "w"]})");
  }
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_text(R"({"name": "s", "duration": "1ms", "network": {"nodes": {)" + hosts +
                              R"("w": {"kind": "switch"}}, "links": [)" + links + "]}, \"programs\": [" + tree + "]}",
                          "s.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const Load plc(file("plc", tree));
  const Load m(file("m", tree));
  const Load x(file("x", tree));
  ASSERT_TRUE(plc.loaded && m.loaded && x.loaded);
  std::array<std::byte, 1500> buffer{};
  std::array<std::byte, 1500> buffer_there{};
  const std::array<const wire::ProgramFormat*, 5> formats = {
      plc.loaded->programs[0].endpoint.format.get(), m.loaded->programs[0].endpoint.format.get(),
      m.loaded->programs[1].endpoint.format.get(), x.loaded->programs[0].endpoint.format.get(),
      x.loaded->programs[1].endpoint.format.get()};
  const std::array<std::size_t, 5> numbers = {0, 0, 1, 1, 2};
  for (std::size_t i = 0; i < formats.size(); ++i) {
    const wire::ProgramFormat there(plant::shape_of(*resolved->programs[numbers[i]].description,
                                                    resolved->programs[numbers[i]].first_publisher_id));
    for (std::uint8_t sender = 0; sender < 3; ++sender) {
      const wire::StateMessage message{sender,
                                       77,
                                       {5,
                                        handshake::PublishedState::Running,
                                        {3, handshake::IntentKind::Start, 0, handshake::run_of(5, 3)},
                                        handshake::run_of(5, 3)}};
      const uadp::Octets first = there.encode(message, buffer_there);
      const uadp::Octets second = formats[i]->encode(message, buffer);
      EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end())) << i;
      for (std::size_t j = 0; j < formats.size(); ++j)
        EXPECT_EQ(formats[j]->decode(second).has_value(), numbers[i] == numbers[j]) << i << " " << j;
    }
    for (std::uint8_t d = 0; d < there.shape().data_sets.size(); ++d) {
      const wire::ProcessDataMessage message{there.shape().data_sets[d].from, d, 5, 9, {}};
      const uadp::Octets first = there.encode(message, buffer_there);
      const uadp::Octets second = formats[i]->encode(message, buffer);
      EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end())) << i;
    }
  }
}

/// Cycles of any length begin at their multiples on the clock, wherever local time begins.
TEST(Clock, SaysHowFarIntoACycleItsEpochIs) {
  const Clock clock(ClockName::monotonic, Duration::from_ps(5'000'000'000));
  const std::int64_t epoch_ns = clock.nanoseconds_at(sim::LocalTime());
  EXPECT_EQ(clock.phase_in(Duration::from_ps(5'000'000'000)), Duration());
  for (const std::int64_t ns : {3'000'000, 7'000'000, 11'000'003})
    EXPECT_EQ(clock.phase_in(Duration::from_ps(ns * 1000)).ps(), epoch_ns % ns * 1000);
}

}  // namespace
}  // namespace takt::node::nested_config_test
