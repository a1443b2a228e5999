// SPDX-License-Identifier: Apache-2.0
// What is recorded of a run is the same, octet for octet, on one thread and divided.
#include "output/recording.hpp"

#include <array>

#include "tests/presentation/output/recorded_run.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::output {
namespace {

using namespace test;
using scenario::Division;
using scenario::Resolved;
using scenario::test::shipped;
using scenario::test::shipped_names;
using scenario::test::sound;

/// A mesh of switches with two hosts each; every host sends to another one, so often that ports are busy, and every
/// third to three, so that one record is shared at many nodes at once.
std::string plant(const std::string& duration, const std::string& more = {}, const std::string& of_switches = {},
                  const std::string& every = "250us") {
  constexpr unsigned hosts = 32;
  std::string text = R"({"name": "plant", "duration": ")" + duration +
                     R"(", "network": {"generate": [{"topology": "mesh", "rows": 4, "columns": 4,
    "hosts_per_switch": 2, "rate": "100Mbps", "length": "10m", "forwarding_delay": "5us")" +
                     of_switches + R"(}]}, "streams": [)";
  const auto host = [](unsigned h) { return "\"h" + std::to_string(h % hosts + 1) + "\""; };
  for (unsigned h = 0; h < hosts; ++h)
    text += (h > 0 ? "," : "") + std::string(R"({"name": "s)") + std::to_string(h + 1) + R"(", "from": )" + host(h) +
            R"(, "to": )" +
            (h % 3 == 0 ? "[" + host(h + 7) + ", " + host(h + 8) + ", " + host(h + 20) + "]" : host(h + 11)) +
            R"(, "payload": "200B", "pcp": )" + std::to_string(h % 4) + R"(, "every": ")" + every +
            R"(", "offset": ")" + std::to_string(h % 4 * 10) + R"(us"})";
  return text + "]" + more + "}";
}

// All at once in many nodes: what is recorded of an instant has an order that no division has a part in.
TEST(Recording, IsTheSameForEveryDivision) {
  const auto resolved = sound(plant("2ms"));
  const RecordingOptions all = all_of(*resolved);
  const Files expected = recorded_whole(*resolved, all);
  EXPECT_EQ(expected.size(), 7u);
  for (const char* const name : {"all.pcapng", "frames.csv", "hops.csv", "timeline.json", "waves.vcd"})
    EXPECT_GT(expected.at(name).size(), 10'000u) << name;
  EXPECT_NE(expected.at("frames.csv").find("under way"), std::string::npos);
  std::size_t most = 0;
  for (const unsigned parts : {1u, 2u, 3u, 4u, 8u}) {
    const Division division = scenario::divide_at_random(*resolved, parts, parts);
    most = std::max<std::size_t>(most, division.parts);
    EXPECT_EQ(difference(expected, recorded_divided(*resolved, division, all)), "") << division.parts << " parts";
  }
  EXPECT_GE(most, 7u);
}

TEST(Recording, IsTheSameHoweverOftenItIsWritten) {
  const auto resolved = sound(plant("1ms"));
  const RecordingOptions all = all_of(*resolved);
  const Files expected = recorded_whole(*resolved, all);
  for (const std::uint64_t events : {1u, 100u, 5'000u})
    EXPECT_EQ(difference(expected, recorded_whole(*resolved, all, 0, events)), "") << events;
  const Division division = scenario::divide_at_random(*resolved, 3, 7);
  for (const int slices : {1, 2, 50, 999})
    EXPECT_EQ(difference(expected, recorded_divided(*resolved, division, all, 0, slices)), "") << slices;
}

// What the gates did before a clock went back is worked out later, and those times come twice.
TEST(Recording, GatesBeforeAClockThatGoesBack) {
  const auto resolved =
      sound(R"({"name": "t", "duration": "4ms", "network": {"generate": [{"topology": "line", "switches": 2}]},
    "streams": [{"name": "s", "from": "h1", "to": "h2", "payload": "200B", "every": "250us"}],
    "gates": {"plan": "listed", "lists": [{"node": "sw1", "gates": {"entries": [{"open": [0, 1, 2], "for": "40us"}, {"open": [0, 1, 2, 3, 4, 5, 6, 7], "for": "60us"}]}}]},
    "clocks": {"all": {"offset": "0ppm"}}, "faults": [{"kind": "clock", "step": "-3ms", "node": "sw1", "at": "3.5ms"}]})");
  RecordingOptions waves;
  waves.waves = true;
  const Files expected = recorded_whole(*resolved, waves, 0, 1);
  const std::string& text = expected.at("waves.vcd");
  EXPECT_NE(text.find("#3440000000\n"), std::string::npos) << "the gates change each 40 and 60 us until then";
  for (const std::uint64_t events : {10u, 100'000u})
    EXPECT_EQ(difference(expected, recorded_whole(*resolved, waves, 0, events)), "") << events;
}

TEST(Recording, IsTheSameForEveryDivisionUnderAnotherOrderOfEqualEvents) {
  const auto resolved = sound(plant("1ms"));
  const RecordingOptions all = all_of(*resolved);
  const Files expected = recorded_whole(*resolved, all, 0xDEAD'BEEF);
  for (const unsigned parts : {2u, 4u})
    EXPECT_EQ(difference(expected, recorded_divided(*resolved, scenario::divide_at_random(*resolved, parts, parts), all,
                                                    0xDEAD'BEEF)),
              "")
        << parts;
}

TEST(Recording, IsTheSameWithFaults) {
  const auto resolved =
      sound(plant("2ms", R"(, "faults": [{"kind": "link-down", "link": ["sw6", "sw7"], "at": "500us", "for": "500us"},
      {"kind": "crash", "node": "sw11", "at": "700us", "for": "500us"}, {"kind": "frame-errors", "link": ["sw2", "sw3"], "loss": 0.1, "duplication": 0.1}])"));
  const RecordingOptions all = all_of(*resolved);
  const Files expected = recorded_whole(*resolved, all);
  for (const char* const reason : {"link_down", "link_loss"})
    EXPECT_NE(expected.at("frames.csv").find(reason), std::string::npos) << reason;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    EXPECT_EQ(difference(expected, recorded_divided(*resolved, scenario::divide_at_random(*resolved, 4, seed), all)),
              "")
        << seed;
}

// Gates go by clocks that servos trim and step: when they change depends on no other node, and neither does what is
// recorded.
TEST(Recording, IsTheSameWithGatesByClocksThatAreSynchronised) {
  const std::string clocks =
      R"(, "clocks": {"all": {"offset": {"from": "-100ppm", "to": "100ppm"}}, "gptp": {"report_every": "700us", "log_sync_interval": -7, "log_pdelay_interval": -7, "log_announce_interval": -7}},
      "faults": [{"kind": "crash", "node": "sw1", "at": "20ms", "for": "20ms"}, {"kind": "stuck-gate", "node": "sw6", "to": "sw7", "class": 0, "state": "open", "at": "30ms", "for": "5ms"}])";
  const std::string gates =
      R"(, "egress": [{"gates": {"entries": [{"open": [0, 1, 2, 3], "for": "300us"}, {"open": [4, 5, 6, 7], "for": "200us"}]}}])";
  const auto resolved = sound(plant("60ms", clocks, gates, "3ms"));
  const RecordingOptions all = all_of(*resolved);
  const Files expected = recorded_whole(*resolved, all);
  EXPECT_GT(expected.at("clocks.csv").size(), 10'000u);
  EXPECT_NE(expected.at("timeline.json").find("open gates"), std::string::npos);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Division division = scenario::divide_at_random(*resolved, 3, seed);
    EXPECT_TRUE(division.is_divided());
    EXPECT_EQ(difference(expected, recorded_divided(*resolved, division, all)), "") << seed;
  }
}

// Two clocks without gPTP between them would show their oscillators alone: each is its own grandmaster for 10 ms, 10
// ppm are 100 ns, and the offset from itself is none. A clock shows whole picoseconds, rounded down: b is 1 ps further
// behind.
TEST(Recording, OffsetsOfClocksAreFromTheGrandmasterAndFromTrueTime) {
  const auto resolved = sound(
      R"({"name": "two", "duration": "25ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
    "clocks": {"nodes": {"a": {"offset": "10ppm"}, "b": {"offset": "-10ppm", "initial": "1ns"}}, "gptp": {}}})");
  RecordingOptions options;
  options.clocks = true;
  EXPECT_EQ(recorded_whole(*resolved, options).at("clocks.csv"),
            "time_s,node,grandmaster,offset_ns,true_offset_ns\n"
            "0.010000000000,a,a,0.000,100.000\n0.010000000000,b,b,0.000,-99.001\n"
            "0.020000000000,a,a,0.000,200.000\n0.020000000000,b,b,0.000,-199.001\n");
  // Of a stretch of time its looks alone, both ends included.
  options.from = "11ms";
  options.to = "20ms";
  EXPECT_EQ(recorded_whole(*resolved, options).at("clocks.csv"),
            "time_s,node,grandmaster,offset_ns,true_offset_ns\n"
            "0.020000000000,a,a,0.000,200.000\n0.020000000000,b,b,0.000,-199.001\n");
  options.to = "19ms";
  EXPECT_EQ(recorded_whole(*resolved, options).at("clocks.csv"), "time_s,node,grandmaster,offset_ns,true_offset_ns\n");
}

TEST(Recording, IsTheSameOfWhatIsSelected) {
  const auto resolved = sound(plant("2ms"));
  std::array<RecordingOptions, 4> each;
  for (RecordingOptions& options : each) {
    options = all_of(*resolved);
    options.from = "600us";
    options.to = "1300us";
  }
  each[1].streams = {"s1", "s4"};
  each[2] = {};
  each[2].pcap = {"sw6:1", "h3", "stream:s1"};
  each[3].timeline = each[3].frames = false;
  for (const RecordingOptions& options : each) {
    const Files expected = recorded_whole(*resolved, options);
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
      EXPECT_EQ(difference(expected,
                           recorded_divided(*resolved, scenario::divide_at_random(*resolved, 4, seed), options, 0, 9)),
                "")
          << &options - each.data();
  }
}

/// The last instant of a waveform.
std::int64_t last_of(const std::string& waves) {
  const std::size_t at = waves.rfind("\n#");
  return at == std::string::npos ? -1 : std::stoll(waves.substr(at + 2));
}

// Gates change each 40 and 60 us and frames are sent each 250 us until 4 ms; what is asked for ends before.
TEST(Recording, WavesEndWithTheStretch) {
  const auto resolved =
      sound(R"({"name": "t", "duration": "4ms", "network": {"generate": [{"topology": "line", "switches": 2}]},
    "streams": [{"name": "s", "from": "h1", "to": "h2", "payload": "200B", "every": "250us"}],
    "gates": {"plan": "listed", "lists": [{"node": "sw1", "gates": {"entries": [{"open": [0, 1, 2], "for": "40us"}, {"open": [0, 1, 2, 3, 4, 5, 6, 7], "for": "60us"}]}}]}})");
  RecordingOptions waves;
  waves.waves = true;
  EXPECT_EQ(last_of(recorded_whole(*resolved, waves).at("waves.vcd")), 4'000'000'000);
  waves.to = "1110us";
  const std::string until = recorded_whole(*resolved, waves).at("waves.vcd");
  EXPECT_EQ(last_of(until), 1'110'000'000);
  EXPECT_NE(until.find("#1100000000\n"), std::string::npos) << "gates change then";
  waves.from = "1050us";
  const std::string both = recorded_whole(*resolved, waves).at("waves.vcd");
  EXPECT_EQ(last_of(both), 1'110'000'000);
  EXPECT_NE(both.find("$enddefinitions $end\n#1050000000\n"), std::string::npos);
  waves.from = "5ms";
  waves.to = "6ms";
  EXPECT_EQ(last_of(recorded_whole(*resolved, waves).at("waves.vcd")), 5'000'000'000)
      << "after the end of the run there is nothing";
}

std::size_t occurrences(const std::string& text, const std::string& piece) {
  std::size_t found = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + piece.size())) ++found;
  return found;
}

// Ten frames of each stream, of which all but the first of "metered" are too long, come to a closed gate, find no
// token, or are longer than their queue takes: each is a row of its reason and a mark.
TEST(Recording, WhatIsDiscardedForEachReasonIsMarked) {
  const auto resolved =
      sound(R"({"name": "t", "duration": "10ms", "network": {"nodes": {"h": {"kind": "host"}, "g": {"kind": "host"},
      "sw": {"kind": "switch", "egress": [{"to": "g", "max_sdu": [{"class": 3, "size": "100B"}]}], "ingress": {
        "filters": [{"stream": "filtered", "max_sdu": "100B"}, {"stream": "gated", "gate": "closed"}, {"stream": "metered", "meter": "small"}],
        "gates": [{"name": "closed", "open": false}],
        "meters": [{"name": "small", "cir": "8bps", "cbs": "300B"}]}}},
      "links": [{"ends": ["h", "sw"]}, {"ends": ["sw", "g"]}]},
    "streams": [{"name": "filtered", "from": "h", "to": "g", "payload": "200B", "pcp": 1, "every": "1ms", "offset": "0us"},
                {"name": "gated", "from": "h", "to": "g", "payload": "200B", "pcp": 1, "every": "1ms", "offset": "100us"},
                {"name": "metered", "from": "h", "to": "g", "payload": "200B", "pcp": 1, "every": "1ms", "offset": "200us"},
                {"name": "queued", "from": "h", "to": "g", "payload": "200B", "pcp": 3, "every": "1ms", "offset": "300us"}]})");
  RecordingOptions options;
  options.timeline = options.frames = true;
  const Files files = recorded_whole(*resolved, options);
  const std::string& timeline = files.at("timeline.json");
  EXPECT_EQ(occurrences(timeline, R"("name":"drop")"), 39u);
  struct Discarded {
    const char* reason;
    std::size_t frames;
  };
  for (const auto& [reason, frames] :
       {Discarded{"stream_max_sdu", 10}, {"stream_gate", 10}, {"flow_meter", 9}, {"queue_max_sdu", 10}}) {
    EXPECT_EQ(occurrences(files.at("frames.csv"), "," + std::string(reason) + "\n"), frames) << reason;
    EXPECT_EQ(occurrences(timeline, "\"" + std::string(reason) + "\""), frames) << reason;
  }
}

// The switch discards 3217 frames of the camera at its meter (docs/tsn.md): each is a mark at the port by which it came
// in, which is that to the camera.
TEST(Recording, WhatIsDiscardedAtANodeIsMarkedAtThePortByWhichItCame) {
  const auto resolved = shipped("tsn/policing", "30ms");
  RecordingOptions timeline;
  timeline.timeline = timeline.frames = true;
  const Files files = recorded_whole(*resolved, timeline);
  const std::size_t discarded = occurrences(files.at("frames.csv"), ",flow_meter\n");
  EXPECT_GT(discarded, 50u);
  const models::NodeIndex node{*resolved->topology.find("switch")};
  const models::NodeIndex camera{*resolved->topology.find("camera")};
  std::string track;
  for (const scenario::Neighbour& neighbour : resolved->topology.neighbours[node.value])
    if (neighbour.node == camera.value)
      track = R"("pid":)" + std::to_string(node.value + 1) + R"(,"tid":)" + std::to_string(neighbour.port + 1);
  const std::string& text = files.at("timeline.json");
  std::size_t marks = 0;
  for (std::size_t at = text.find(R"("name":"drop")"); at != std::string::npos;
       at = text.find(R"("name":"drop")", at + 1)) {
    const std::size_t begin = text.rfind('\n', at);
    const std::string line = text.substr(begin, text.find('\n', at) - begin);
    EXPECT_NE(line.find(track), std::string::npos) << line << track;
    EXPECT_NE(line.find("flow_meter"), std::string::npos) << line;
    ++marks;
  }
  EXPECT_EQ(marks, discarded);
}

// Every shipped scenario, in its beginning, with parts as they come.
TEST(Recording, IsTheSameForEveryDivisionOfWhatIsShipped) {
  std::size_t really_divided = 0;
  for (const std::string& name : shipped_names()) {
    if (name == "ring-1000") continue;  // a thousand nodes
    const auto resolved = shipped(name, "4ms");
    const unsigned parts = really_divided % 2 == 0 ? 2 : 5;
    const Division division = scenario::divide_at_random(*resolved, parts, parts * 100);
    if (!division.is_divided()) continue;
    ++really_divided;
    const RecordingOptions all = all_of(*resolved);
    EXPECT_EQ(difference(recorded_whole(*resolved, all), recorded_divided(*resolved, division, all, 0, 2)), "")
        << name << " in " << division.parts << " parts";
  }
  EXPECT_GT(really_divided, 20u);
}

}  // namespace
}  // namespace takt::output
