// SPDX-License-Identifier: Apache-2.0
// Wave forms, read back by a parser of IEEE 1364 clause 18.2 that refuses what the grammar does not know.
#include "output/vcd_recorder.hpp"

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "output/playback.hpp"
#include "tests/presentation/output/recording.hpp"

namespace takt::output {
namespace {

using namespace test;

struct Wave {
  unsigned bits = 0;
  std::vector<std::pair<std::int64_t, std::uint64_t>> changes;
  std::uint64_t at(std::int64_t time) const {
    std::uint64_t value = changes.front().second;
    for (const auto& [when, then] : changes)
      if (when <= time) value = then;
    return value;
  }
};

struct Dump {
  std::map<std::string, Wave> waves;  // by scope.scope.name
  std::int64_t last = 0;
};

Dump parse(const std::string& text) {
  const auto require = [](bool condition, const std::string& what) {
    if (!condition) throw std::runtime_error("not a VCD: " + what);
  };
  std::istringstream in(text);
  std::string token;
  Dump dump;
  std::vector<std::string> scopes;
  std::map<std::string, std::string> name_of_code;
  const auto words_until_end = [&] {
    std::vector<std::string> words;
    while (in >> token && token != "$end") words.push_back(token);
    require(token == "$end", "$end");
    return words;
  };
  bool timescale = false;
  while (in >> token && token != "$enddefinitions") {
    const std::string command = token;
    const std::vector<std::string> words = words_until_end();
    if (command == "$timescale") {
      require(words == std::vector<std::string>{"1", "ps"}, "time scale");
      timescale = true;
    } else if (command == "$scope") {
      require(words.size() == 2 && words[0] == "module", "scope");
      scopes.push_back(words[1]);
    } else if (command == "$upscope") {
      require(words.empty() && !scopes.empty(), "upscope");
      scopes.pop_back();
    } else if (command == "$var") {
      require((words.size() == 4 || words.size() == 5) && words[0] == "wire", "var");
      std::string name;
      for (const std::string& scope : scopes) name += scope + ".";
      name += words[3];
      require(name_of_code.emplace(words[2], name).second, "a code is used once");
      require(dump.waves.emplace(name, Wave{static_cast<unsigned>(std::stoul(words[1])), {}}).second,
              "a name is used once: " + name);
      require(words.size() == (words[1] == "1" ? 4u : 5u), "range");
    } else {
      require(command == "$version", command);
    }
  }
  require(words_until_end().empty() && scopes.empty() && timescale, "definitions");
  std::int64_t time = -1;
  bool dumping = false;
  while (in >> token) {
    if (token[0] == '#') {
      const std::int64_t next = std::stoll(token.substr(1));
      require(next > time, "time ascends");
      dump.last = time = next;
    } else if (token == "$dumpvars") {
      dumping = true;
    } else if (token == "$end") {
      require(dumping, "$end");
      dumping = false;
      for (const auto& [name, wave] : dump.waves) require(wave.changes.size() == 1, "all have a first value");
    } else {
      const bool vector = token[0] == 'b';
      std::string digits = vector ? token.substr(1) : token.substr(0, 1);
      std::string code = token.substr(1);
      if (vector) in >> code;
      require(name_of_code.contains(code), "code " + code);
      require(!digits.empty() && digits.find_first_not_of("01") == std::string::npos, "value");
      Wave& wave = dump.waves[name_of_code[code]];
      require(digits.size() <= wave.bits && vector == (wave.bits > 1), "width");
      wave.changes.emplace_back(time, std::stoull(digits, nullptr, 2));
    }
  }
  return dump;
}

TEST(VcdRecorder, BusyAndQueueFollowTheFrames) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  VcdRecorder recorder(*run.network, folder / "waves.vcd");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(at(2_ms)), "");
  const Dump dump = parse(content_of(folder / "waves.vcd"));
  EXPECT_EQ(dump.last, 2'000'000'000);
  EXPECT_EQ(dump.waves.size(), 8u * 3u);

  // b sends three camera frames at once: 84.32 us each (1046 + 8 octets at 80 ns), 0.96 us gaps; the fourth at 1 ms.
  const Wave& busy = dump.waves.at("b.port0_to_sw.busy");
  const std::vector<std::pair<std::int64_t, std::uint64_t>> expected = {
      {0, 0},           {0, 1},           {84'320'000, 0},    {85'280'000, 1},   {169'600'000, 0},
      {170'560'000, 1}, {254'880'000, 0}, {1'000'000'000, 1}, {1'084'320'000, 0}};
  EXPECT_EQ(busy.changes, expected);
  const Wave& queue = dump.waves.at("b.port0_to_sw.queued_frames");
  EXPECT_EQ(queue.at(1), 2u);
  EXPECT_EQ(queue.at(85'280'000), 1u);
  EXPECT_EQ(queue.at(170'560'000), 0u);
  EXPECT_EQ(dump.waves.at("cell__A_.port0_to_sw.busy").changes.size(), 1u);  // never busy: its sender is not installed
  EXPECT_EQ(dump.waves.at("sw.port0_to_cell__A_.gates").at(0), 0xFFu);
}

TEST(VcdRecorder, FurtherSignalsAndGates) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  VcdRecorder recorder(*run.network, folder / "waves.vcd");
  const auto state = recorder.add_signal("programs\ntrajectory", "robot state", 4, 11);
  Playback playback(recorder);
  recorder.look_at(playback.moment());
  Tape tape(*run.network, 0, {.gates = true});
  playback.add(tape);
  run.simulation.set_trace(&tape);
  models::GateConfig gates;
  gates.admin_control_list = {{models::GateOperation::set_gate_states, 0x7F, 20_us},
                              {models::GateOperation::set_gate_states, 0x80, 20_us}};
  gates.admin_cycle_time = 40_us;
  run.network->request_gates(plant.sw, 1, gates);
  playback.play(at(0_us));
  playback.play(at(20_us));
  recorder.set(state, at(20_us), 12);
  EXPECT_THROW(recorder.add_signal("late", "x", 1, 0), sim::InvariantBroken);
  recorder.set(state, at(30_us), 12);  // no change
  playback.play(at(40_us));
  recorder.set(state, at(40_us), 13);
  EXPECT_THROW(recorder.set(state, at(39_us), 14), sim::InvariantBroken);
  playback.play(at(60_us));
  ASSERT_EQ(recorder.close(at(60_us)), "");
  const Dump dump = parse(content_of(folder / "waves.vcd"));
  using Changes = std::vector<std::pair<std::int64_t, std::uint64_t>>;
  EXPECT_EQ(dump.waves.at("sw.port1_to_b.gates").changes,
            (Changes{{0, 0x7F}, {20'000'000, 0x80}, {40'000'000, 0x7F}, {60'000'000, 0x80}}));
  EXPECT_EQ(dump.waves.at("programs.trajectory.robot_state").changes,
            (Changes{{0, 11}, {20'000'000, 12}, {40'000'000, 13}}));
}

// More than 94 signals: codes of two characters, none used twice.
TEST(VcdRecorder, ManySignals) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  VcdRecorder recorder(*run.network, folder / "waves.vcd");
  std::vector<VcdRecorder::SignalId> signals;
  for (int i = 0; i < 10'000; ++i) signals.push_back(recorder.add_signal("many", "s" + std::to_string(i), 64, ~0ULL));
  recorder.set(signals[9'999], at(1_ps), 5);
  ASSERT_EQ(recorder.close(at(1_us)), "");
  const Dump dump = parse(content_of(folder / "waves.vcd"));
  EXPECT_EQ(dump.waves.at("many.s9999").at(1), 5u);
  EXPECT_EQ(dump.waves.at("many.s9998").at(1), ~0ULL);
}

TEST(VcdRecorder, ChangesNoRun) {
  Folder folder;
  Plant plant;
  NetworkRun plain(plant.plan);
  plain.until(2_ms);
  for (const std::uint64_t shuffle : {0u, 99u}) {
    NetworkRun recorded(plant.plan, 1, shuffle);
    VcdRecorder recorder(*recorded.network, folder / "waves.vcd");
    recorded.simulation.set_trace(&recorder);
    recorded.until(2_ms);
    ASSERT_EQ(recorder.close(at(2_ms)), "");
    EXPECT_EQ(recorded.digest(), plain.digest());
  }
}

// "a b" and "a/b" are both a_b to a wave form: the second one gets a number, and the save file of GTKWave knows it.
TEST(VcdRecorder, NamesAreUniqueAndTheSaveFileHasThem) {
  Folder folder;
  PlanBuilder builder;
  builder.link(builder.host("a b"), builder.host("a/b"), 1_Gbps, 0_ns);
  NetworkRun run(builder.plan);
  VcdRecorder recorder(*run.network, folder / "waves.vcd");
  run.simulation.set_trace(&recorder);
  run.until(1_us);
  run.simulation.set_trace(nullptr);
  ASSERT_EQ(recorder.close(at(1_us)), "");
  const Dump dump = parse(content_of(folder / "waves.vcd"));
  EXPECT_TRUE(dump.waves.contains("a_b.port0_to_a_b.busy"));
  EXPECT_TRUE(dump.waves.contains("a_b_2.port0_to_a_b.busy"));
  EXPECT_EQ(dump.waves.size(), 6u);
  const std::string save = content_of(folder / "waves.gtkw");
  EXPECT_NE(save.find("[dumpfile] \"waves.vcd\""), std::string::npos);
  for (const char* const line : {"@28\na_b.port0_to_a_b.busy\n", "@22\na_b_2.port0_to_a_b.gates[7:0]\n"})
    EXPECT_NE(save.find(line), std::string::npos) << line;
}

}  // namespace
}  // namespace takt::output
