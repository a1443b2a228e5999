// SPDX-License-Identifier: Apache-2.0
// The search finds worst cases that can be worked out by hand, and what it finds can be replayed.
#include "verify/adversary.hpp"

#include <gtest/gtest.h>

#include "sim/time.hpp"
#include "tests/questions/verify/support.hpp"
#include "verify/probe.hpp"
#include "verify/shortened.hpp"

namespace takt::verify::adversary_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

// urgent and bulk come from hosts of their own and share the way from the switch to b.
std::string two_talkers(const std::string& bulk = {}) {
  return R"({"name": "two", "duration": "20ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch"}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
    "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"},
                {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms")" +
         bulk + R"(}],
    "require": [{"stream": "urgent", "latency": "1ms"}]})";
}

TEST(Adversary, MeetsAFrameThatHasJustBegun) {
  const auto scenario = resolved(two_talkers());
  const Search found = search(*scenario, analysis::bound(*scenario), {});
  ASSERT_EQ(found.findings.size(), 1u);
  const Finding& finding = found.findings[0];
  // As it is both begin at 0 and the long one comes later. At worst it has begun 1 ps before: 8 + 1400 + 28 + 18 + 4 +
  // 12 octets of 8 ns.
  const Duration alone = *finding.simulated;
  EXPECT_EQ(*finding.worst.measured, alone + 1470 * 8_ns - 1_ps);
  EXPECT_EQ(finding.ended, Ended::bound_reached);
  const std::optional<Probe> again = probe(finding.worst.run.scenario(), {}, {});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->requirements[0].measured, finding.worst.measured);
}

TEST(Adversary, LeavesAloneWhatThePlantPromises) {
  const auto scenario = resolved(two_talkers(R"(, "offset": "500us")"));
  const Search found = search(*scenario, analysis::bound(*scenario), {});
  ASSERT_EQ(found.variables.size(), 1u);
  EXPECT_EQ(found.variables[0].name, "phase of urgent");
  EXPECT_EQ(found.findings[0].worst.run.scenario().streams[1].offset, 500_us);
  // The other one moves instead, and meets it.
  EXPECT_EQ(*found.findings[0].worst.measured, *found.findings[0].simulated + 1470 * 8_ns - 1_ps);
}

// A host's latencies are free within their supports, and so are the instants of cuts: each choice is a scenario that
// replays.
TEST(Adversary, ChoosesLatenciesAndInstantsOfFaults) {
  const auto scenario = resolved(R"({"name": "slow", "duration": "20ms",
    "network": {"nodes": {"a": {"kind": "host", "os": {"transmit": {"uniform": {"from": "1us", "to": "9us"}}, "receive": "2us"}}, "b": {"kind": "host"}},
      "links": [{"ends": ["a", "b"]}]},
    "streams": [{"name": "frames", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "offset": "0us"}],
    "faults": [{"kind": "link-down", "link": ["a", "b"], "at": "5ms", "for": "2ms"}, {"kind": "crash", "node": "b", "at": "7500us", "for": "1ms"}],
    "require": [{"stream": "frames", "latency": "1ms"}, {"stream": "frames", "dropped": 9}]})");
  ASSERT_TRUE(scenario);
  const std::vector<FreeVariable> variables = free_variables_of(*scenario);
  ASSERT_EQ(variables.size(), 3u);
  EXPECT_EQ(variables[0].name, "instant of fault 1");
  EXPECT_EQ(variables[0].range, 500_us);  // until the crash
  EXPECT_EQ(variables[1].name, "instant of fault 2");
  EXPECT_EQ(variables[1].range, 1_ms);  // a period
  EXPECT_EQ(variables[2].name, "transmit latency of a");
  EXPECT_EQ(variables[2].least, 1_us);
  EXPECT_EQ(variables[2].greatest, 9_us);
  const Search found = search(*scenario, analysis::bound(*scenario), {});
  // 9 us, 154 octets of 8 ns, the cable of 10 m.
  EXPECT_EQ(*found.findings[0].worst.measured, 9_us + 154 * 8_ns + 50_ns);
  EXPECT_EQ(probe(found.findings[0].worst.run.scenario(), {}, {})->requirements[0].measured,
            found.findings[0].worst.measured);
}

// A halt waits for the master's next publishing at most, then for the network: nothing else is in the way.
const char* const halted = R"({"name": "halted", "duration": "1s",
  "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host"}}, "links": [{"ends": ["m", "s"]}]},
  "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "200us", "initialisation": "1ms"}],
  "script": [{"at": "10ms", "program": "p", "call": "Start"}, {"at": "500ms", "program": "p", "call": "Halt"}],
  "require": [{"reaction": "halt", "within": "300us"}]})";

TEST(Adversary, CallsJustBehindAPublication) {
  const auto scenario = resolved(halted);
  const Search found = search(*scenario, analysis::bound(*scenario), {});
  const Duration network = *found.findings[0].simulated;  // as it is, the call comes with the publication
  EXPECT_LT(network, 10_us);
  EXPECT_GE(*found.findings[0].worst.measured, 200_us - 1_ns);
  EXPECT_LE(*found.findings[0].worst.measured, 200_us + network);
  EXPECT_FALSE(found.findings[0].worst.failed);
}

TEST(Adversary, TheSameForAnyNumberOfJobs) {
  const auto scenario = resolved(halted);
  SearchOptions options;
  options.events = 400'000;
  const Search alone = search(*scenario, analysis::bound(*scenario), options);
  options.jobs = 3;
  const Search together = search(*scenario, analysis::bound(*scenario), options);
  EXPECT_EQ(alone.runs, together.runs);
  for (std::size_t i = 0; i < alone.findings.size(); ++i) {
    EXPECT_EQ(alone.findings[i].worst.measured, together.findings[i].worst.measured);
    EXPECT_EQ(alone.findings[i].worst.run.scenario(), together.findings[i].worst.run.scenario());
  }
}

TEST(Adversary, CanBeInterrupted) {
  const auto scenario = resolved(halted);
  SearchOptions options;
  int asked = 0;
  options.interrupted = [&] { return ++asked > 5; };
  const Search found = search(*scenario, analysis::bound(*scenario), options);
  EXPECT_TRUE(found.partial);
  EXPECT_EQ(found.findings.size(), 2u);
}

TEST(Shortened, KeepsThePhaseOfCallsAndTheirOrder) {
  const auto scenario = resolved(halted);
  const scenario::Scenario made = shortened(scenario->scenario, 1_ms);
  EXPECT_LT(made.duration, 100_ms);
  ASSERT_EQ(made.script.size(), 2u);
  EXPECT_GT(made.script[1].at, made.script[0].at + 1_ms);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ((made.script[i].at - scenario->scenario.script[i].at).ps() % (200_us).ps(), 0);
}

// Cuts and crashes are events as calls are; what happens while a link is down stays as it is.
TEST(Shortened, KeepsCutsAsTheyAre) {
  std::string text = halted;
  text.insert(text.rfind("\"require\""),
              R"("faults": [{"kind": "link-down", "link": ["m", "s"], "at": "600.05ms", "for": "50ms"}], )");
  const auto scenario = resolved(text);
  const scenario::Scenario made = shortened(scenario->scenario, 1_ms);
  EXPECT_LT(made.duration, 200_ms);
  const auto& cut = std::get<scenario::LinkDown>(made.faults[0]);
  EXPECT_EQ(cut.lasts, 50_ms);
  EXPECT_GT(cut.at, made.script[1].at + 8_ms);
  EXPECT_EQ(cut.at.ps() % (200_us).ps(), (50_us).ps());
  EXPECT_GT(made.duration, cut.at + 50_ms);
}

TEST(Shortened, LeavesAloneWhatDependsOnItsTimes) {
  std::string text = halted;
  text.insert(text.rfind("\"require\""), R"("clocks": {"all": {"offset": "5ppm"}}, )");
  const auto scenario = resolved(text);
  EXPECT_EQ(shortened(scenario->scenario, 1_ms), scenario->scenario);
  // So does what counts from an instant on.
  std::string late = halted;
  late.insert(late.rfind("\"require\""), R"("warm_up": "1ms", )");
  const auto warm = resolved(late);
  EXPECT_EQ(shortened(warm->scenario, 1_ms), warm->scenario);
}

// A talker that is late by up to 12 us in its promised phase meets the long frame that is on its way 12 us after the
// start; chance would have to hit the nanosecond.
TEST(Adversary, ChoosesProductionJitterWithinItsSupport) {
  const auto scenario = resolved(R"({"name": "late", "duration": "20ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch"}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
    "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms", "offset": "0us", "jitter": "40us"},
                {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms", "offset": "0us"}],
    "require": [{"stream": "urgent", "latency": "1ms"}]})");
  ASSERT_TRUE(scenario);
  const std::vector<FreeVariable> variables = free_variables_of(*scenario);
  ASSERT_EQ(variables.size(), 1u);
  EXPECT_EQ(variables[0].name, "jitter of urgent");
  const analysis::Bounds bounds = analysis::bound(*scenario);
  const Search found = search(*scenario, bounds, {});
  // The whole long frame but 1 ns, and no more than the bound has.
  const Duration alone = 2 * (154 * 8_ns + 50_ns);
  EXPECT_GE(*found.findings[0].worst.measured, alone + 1470 * 8_ns - 1_ns);
  EXPECT_LE(*found.findings[0].worst.measured, *bounds.streams[0].latency);
  EXPECT_EQ(found.findings[0].worst.run.scenario().streams[0].jitter, Duration());
  EXPECT_EQ(probe(found.findings[0].worst.run.scenario(), {}, {})->requirements[0].measured,
            found.findings[0].worst.measured);
}

// Which frames a link loses is chosen, as far as "dropped" leaves room: one period of losses and no others, replayed by
// a fault of its own.
TEST(Adversary, ChoosesLossesWithinWhatIsRequired) {
  const std::string text = R"({"name": "lossy", "duration": "100ms",
    "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host"}}, "links": [{"ends": ["m", "s"]}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms", "receive_timeout": "10ms", "phases": {"m": "0us", "s": "500us"}, "process_data": []}],
    "script": [{"at": "2ms", "program": "p", "call": "Start"}, {"at": "50.1ms", "program": "p", "call": "Halt"}],
    "faults": [{"kind": "frame-errors", "link": ["m", "s"], "towards": "s", "loss": 0.000001, "at": "45ms", "for": "10ms"}],
    "require": [{"reaction": "halt", "within": "5ms"})";
  const auto scenario = resolved(text + "]}");
  ASSERT_TRUE(scenario);
  const std::vector<FreeVariable> variables = free_variables_of(*scenario);
  EXPECT_TRUE(std::any_of(variables.begin(), variables.end(), [](const FreeVariable& each) {
    return each.name == "losses by fault 1" && each.range == 10_ms;
  }));
  const Search found = search(*scenario, analysis::bound(*scenario), {});
  EXPECT_GT(*found.findings[0].worst.measured,
            *found.findings[0].simulated + 900_us);  // the word that tells it is lost, and comes a cycle later
  EXPECT_EQ(probe(found.findings[0].worst.run.scenario(), {}, {})->requirements[0].measured,
            found.findings[0].worst.measured);
  const auto strict = resolved(text + R"(, {"stream": "p/state/m", "dropped": 0}]})");
  ASSERT_TRUE(strict);
  const Search none = search(*strict, analysis::bound(*strict), {});
  EXPECT_LE(*none.findings[0].worst.measured, *none.findings[0].simulated + 900_us);
  EXPECT_FALSE(none.findings[1].worst.failed);
}

// Clocks run at the ends of their range, and the bounds hold for whatever the seed draws.
TEST(Adversary, ChoosesFrequenciesWithinTheirRange) {
  const std::string text = R"({"name": "drifting", "duration": "20ms", "seed": SEED,
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
    "clocks": {"all": {"offset": {"from": "-100ppm", "to": "100ppm"}}},
    "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"}],
    "script": [{"at": "2ms", "program": "p", "call": "Start"}],
    "require": [{"reaction": "start", "within": "10ms"}]})";
  const auto with_seed = [&](const std::string& seed) {
    std::string made = text;
    return resolved(made.replace(made.find("SEED"), 4, seed));
  };
  const auto one = with_seed("1");
  const auto two = with_seed("2");
  ASSERT_TRUE(one && two);
  EXPECT_EQ(analysis::bound(*one).requirements[0].duration, analysis::bound(*two).requirements[0].duration);
  const std::vector<FreeVariable> variables = free_variables_of(*one);
  const auto frequency = std::find_if(variables.begin(), variables.end(), [](const FreeVariable& each) {
    return each.name == "frequency of b, -100ppm to 100ppm";
  });
  ASSERT_NE(frequency, variables.end());
  Choice choice{1, std::vector<Duration>(variables.size())};
  choice.values[static_cast<std::size_t>(frequency - variables.begin())] = always_greatest;
  const scenario::Scenario made = scenario_of(one->scenario, variables, choice);
  ASSERT_EQ(made.clocks.nodes.size(), 1u);
  EXPECT_EQ(made.clocks.nodes[0].second.offset.fixed, sim::FrequencyOffset{100'000'000});
  EXPECT_TRUE(probe(made, {}, {}));
}

}  // namespace
}  // namespace takt::verify::adversary_test
