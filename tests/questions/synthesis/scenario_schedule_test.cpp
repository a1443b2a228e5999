// SPDX-License-Identifier: Apache-2.0
// Scenarios that get a schedule: by their own paths, by others, or not at all.
#include "synthesis/scenario_schedule.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "json/document.hpp"
#include "json/fields.hpp"
#include "scenario/resolve.hpp"

namespace takt::synthesis {
namespace {

using Verdict = schedule::Decision::Verdict;

/// A ring of four switches; x and h1 are at sw1, y and h2 at sw2. Frames of 1400 octets (1446 with headers, 11.728 us
/// with preamble and gap) each so many us.
std::string two_streams(int every_us, const std::string& more = "") {
  return R"({"name": "two-ways", "duration": "2ms", "network": {"generate": [{"topology": "ring", "switches": 4, "forwarding_delay": "1us"}],
 "nodes": {"x": {"kind": "host"}, "y": {"kind": "host"}}, "links": [{"ends": ["x", "sw1"]}, {"ends": ["y", "sw2"]}]}, "gates": {"plan": "auto", "classes": [6]},
 "streams": [{"name": "a", "from": "h1", "to": "h2", "payload": "1400B", "every": ")" +
         std::to_string(every_us) + R"(us", "offset": "auto", "pcp": 6},
  {"name": "b", "from": "x", "to": "y", "payload": "1400B", "every": ")" +
         std::to_string(every_us) + R"(us", "offset": "auto", "pcp": 6}])" + more + "}";
}

std::optional<ScenarioSchedule> scheduled(const std::string& text, bool may_route, std::uint32_t entries = 1024,
                                          std::string* told = nullptr) {
  json::Diagnostics diagnostics;
  scenario::Scenario wanted;
  const auto document = json::parse(text, "test.json", diagnostics);
  EXPECT_TRUE(document && json::decode(*document, wanted, diagnostics)) << diagnostics.to_text();
  ScenarioOptions options;
  options.may_route = may_route;
  options.entries = entries;
  options.search.attempts = 20;
  auto answer = schedule_scenario(wanted, options, diagnostics);
  if (told != nullptr)
    *told = diagnostics.to_text();
  else
    EXPECT_EQ(diagnostics.errors(), 0u) << diagnostics.to_text();
  EXPECT_TRUE(!answer || answer->wrong.empty()) << answer->wrong.front();
  return answer;
}

TEST(ScenarioSchedule, GivenPathsDoWhereThereIsRoom) {
  const auto answer = scheduled(two_streams(50), false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::scheduled);
  EXPECT_EQ(answer->how, "given paths");
  ASSERT_EQ(answer->streams.size(), 2u);
  for (const JudgedStream& each : answer->streams) {
    EXPECT_EQ(each.simulated, each.planned);
    EXPECT_EQ(each.bound, each.planned);
  }
}

// Two frames of 11.7 us do not fit into 20 us on sw1 to sw2: one has to go round.
TEST(ScenarioSchedule, SearchesPathsWhereGivenOnesDoNot) {
  const auto answer = scheduled(two_streams(20), true);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled);
  EXPECT_EQ(answer->how, "searched paths");
  // What comes out is a scenario that is taken as it is.
  json::Diagnostics diagnostics;
  const auto again = scenario::load_text(json::encode(answer->resolved->scenario), "again.json", {}, diagnostics);
  ASSERT_TRUE(again) << diagnostics.to_text();
  std::size_t longest = 0;
  for (const scenario::Stream& stream : again->scenario.streams) {
    ASSERT_TRUE(stream.path && stream.offset && !stream.offset->is_auto);
    longest = std::max(longest, stream.path->size());
  }
  EXPECT_EQ(longest, 6u);  // x or h1, sw1, sw4, sw3, sw2, and the listener
}

TEST(ScenarioSchedule, ProvesThatGivenPathsAreTooFull) {
  const auto answer = scheduled(two_streams(20), false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::infeasible);
  ASSERT_TRUE(answer->certificate);
  EXPECT_EQ(answer->certificate->kind, schedule::Certificate::Kind::load);
  EXPECT_EQ(answer->instance->links[answer->certificate->links.front()].name, "sw1>sw2");
}

// The way round takes five links, some 63 us: a required latency of 50 us forbids it.
TEST(ScenarioSchedule, RequirementsLimitTheWay) {
  const std::string limit = R"(, "require": [{"stream": "a", "latency": "50us"}, {"stream": "b", "latency": "50us"}])";
  const auto answer = scheduled(two_streams(20, limit), true);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::infeasible);
  EXPECT_TRUE(answer->certificate && answer->certificate->in_time);
}

std::string with_limits(std::string text, const std::string& limits) {
  const std::string at = "\"forwarding_delay\": \"1us\"";
  text.insert(text.find(at) + at.size(), ", \"gate_limits\": " + limits);
  return text;
}

// sw1 to sw2 carries both frames. Without limits: closed for the guard, a, closed, b, and the other classes twice; with
// the guard in the window a list of 4 does.
TEST(ScenarioSchedule, ListsAreAsShortAsDevicesAsk) {
  const auto free = scheduled(two_streams(50), false);
  const auto answer = scheduled(with_limits(two_streams(50), R"({"entries": 4})"), false);
  ASSERT_TRUE(free && answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled);
  EXPECT_GT(free->most_entries, 4u);
  EXPECT_LE(answer->most_entries, 4u);
  for (const JudgedStream& each : answer->streams) {
    EXPECT_EQ(each.delivered, 40u);
    EXPECT_EQ(each.simulated, each.planned);
  }
  // What comes out keeps its limits, and is taken with them.
  json::Diagnostics diagnostics;
  EXPECT_TRUE(scenario::load_text(json::encode(answer->resolved->scenario), "again.json", {}, diagnostics))
      << diagnostics.to_text();
}

// Frames of 11.7 us, so that windows and all between them become longer than 13 us and multiples of 1 us.
TEST(ScenarioSchedule, IntervalsAreAsDevicesAsk) {
  const auto answer =
      scheduled(with_limits(two_streams(100), R"({"least_interval": "13us", "granularity": "1us"})"), false);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  std::size_t seen = 0;
  for (std::size_t p = 0; p < answer->resolved->gates->problem.ports.size(); ++p) {
    if (answer->resolved->gates->problem.ports[p].limits == scenario::ListLimits{}) continue;  // of a host
    for (const auto& entry : answer->resolved->gates->schedule.lists[p].entries) {
      ++seen;
      EXPECT_GE(entry.interval.ps(), 13'000'000);
      EXPECT_EQ(entry.interval.ps() % 1'000'000, 0);
    }
  }
  EXPECT_GT(seen, 4u);
}

TEST(ScenarioSchedule, ListsThatAreTooLongAreSaid) {
  const auto answer = scheduled(two_streams(50), false, 2);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::undecided);
  EXPECT_NE(answer->how.find("entries, "), std::string::npos) << answer->how;
  EXPECT_NE(answer->how.find("2"), std::string::npos) << answer->how;
}

// Cycles of 50 us are no multiples of 3 us; a scenario without any schedule would be refused, too.
TEST(ScenarioSchedule, CyclesAreAsDevicesAsk) {
  const auto answer = scheduled(with_limits(two_streams(50), R"({"granularity": "3us"})"), false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::undecided);
  EXPECT_NE(answer->how.find("no multiple of the granularity of 3us"), std::string::npos) << answer->how;
}

std::optional<ScenarioSchedule> with_slack(const std::string& text) {
  json::Diagnostics diagnostics;
  scenario::Scenario wanted;
  const auto document = json::parse(text, "test.json", diagnostics);
  EXPECT_TRUE(document && json::decode(*document, wanted, diagnostics)) << diagnostics.to_text();
  ScenarioOptions options;
  options.may_route = false;
  options.wants_slack = true;
  options.search.attempts = 20;
  auto answer = schedule_scenario(wanted, options, diagnostics);
  EXPECT_TRUE(!answer || answer->wrong.empty()) << answer->wrong.front();
  return answer;
}

/// Ends of windows and lists with that margin.
bool is_schedule_with(const ScenarioSchedule& answer, sim::Duration margin) {
  return why_not_with(margin, *answer.resolved->gates, answer.resolved->scenario).empty();
}

// Each talker alone has 100 us for windows of 11.664 us; on sw1 to sw2 both share them. The other classes keep 12.336
// us for a frame, and half of what is left is the clocks'.
TEST(ScenarioSchedule, SlackIsTheGreatestClockErrorThatFits) {
  const auto answer = with_slack(two_streams(100));
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled);
  ASSERT_TRUE(answer->slack);
  EXPECT_GT(answer->slack->margin, sim::Duration::from_ps(5'000'000));
  EXPECT_EQ(answer->resolved->gates->problem.margin, answer->slack->margin);
  EXPECT_TRUE(is_schedule_with(*answer, answer->slack->margin));
  EXPECT_FALSE(is_schedule_with(*answer, answer->slack->margin + sim::Duration::from_ps(1'000)));
  EXPECT_FALSE(answer->slack->with_more.empty());
}

TEST(ScenarioSchedule, SlackKeepsToRequiredLatencies) {
  // 11.568 us a link on three links and 1 us in each of two switches take some 36.8 us; up to 38 us a margin has
  // little.
  const auto answer = with_slack(
      two_streams(100, R"(, "require": [{"stream": "a", "latency": "38us"}, {"stream": "b", "latency": "38us"}])"));
  ASSERT_TRUE(answer && answer->slack);
  EXPECT_LT(answer->slack->margin, sim::Duration::from_ps(2'000'000));
  EXPECT_NE(answer->slack->with_more.find("takes longer than 38us"), std::string::npos) << answer->slack->with_more;
}

TEST(ScenarioSchedule, WithoutAutomaticGatesThereIsNothingToDo) {
  std::string text = two_streams(50), told;
  text.replace(text.find("\"plan\": \"auto\", \"classes\": [6]"), 30, "\"plan\": \"none\"               ");
  EXPECT_FALSE(scheduled(text, true, 1024, &told));
  EXPECT_NE(told.find("nothing to schedule"), std::string::npos) << told;
}

/// Two switches with a host each; their clocks are off by up to 50 ppm and are synchronised. Twelve seconds, of which
/// the clocks have eight to settle.
std::string with_clocks(const std::string& clocks, const std::string& more) {
  return R"({"name": "clocks", "duration": "12s", "network": {"generate": [{"topology": "line", "switches": 2, "forwarding_delay": "1us"}]},
 "clocks": {"all": {"offset": {"from": "-50ppm", "to": "50ppm"}, "granularity": "8ns"})" +
         clocks + R"(}, "gates": {"plan": "auto", "classes": [6], "margin": "auto"},
 "streams": [{"name": "a", "from": "h1", "to": "h2", "payload": "100B", "every": "1ms", "offset": "auto", "pcp": 6}])" +
         more + "}";
}
const std::string gptp =
    R"(, "gptp": {"nodes": {"sw1": {"priority1": 100}}, "servo": {"first_step_threshold": "20us"}})";

TEST(ScenarioSchedule, MarginIsMeasuredAndBounded) {
  const auto answer = scheduled(with_clocks(gptp, R"(, "warm_up": "8s")"), false);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  ASSERT_TRUE(answer->clock_margin);
  const ClockMargin& margin = *answer->clock_margin;
  EXPECT_EQ(margin.seeds, 8u);
  EXPECT_EQ(margin.from, sim::Duration::from_ps(8'000'000'000'000));
  EXPECT_GT(margin.measured, sim::Duration());
  EXPECT_LT(margin.measured, sim::Duration::from_ps(1'000'000));
  // Looks each 100 us: at most 50 us to the nearest, in which two oscillators of 50 ppm drift 5 ns apart; in 1 ms and
  // some us on the way some 100 ns.
  EXPECT_NEAR(static_cast<double>(margin.between_looks.ps()), 5'000, 50);
  EXPECT_NEAR(static_cast<double>(margin.on_the_way.ps()), 100'000, 1'000);
  EXPECT_GE(margin.difference, margin.measured + margin.between_looks);
  EXPECT_GE(margin.margin, margin.difference + margin.on_the_way);
  EXPECT_EQ(margin.margin.ps() % 1'000, 0);
  EXPECT_EQ(answer->resolved->gates->problem.margin, margin.margin);
  // The schedule keeps the error as a requirement: bounds rest on it.
  ASSERT_EQ(answer->resolved->scenario.require.size(), 1u);
  ASSERT_TRUE(
      answer->resolved->scenario.require[0].clocks);  // what bounds rest on is the difference between the nodes on ways
  EXPECT_EQ(answer->resolved->scenario.require[0].clocks->names, margin.nodes);
  EXPECT_EQ(answer->resolved->scenario.require[0].within->time, margin.difference);
  EXPECT_EQ(answer->resolved->scenario.require[0].after, margin.from);
  ASSERT_EQ(answer->streams.size(), 1u);
  EXPECT_TRUE(answer->streams[0].bound);
}

/// The lists of the schedule begin when clocks are synchronised, in the phase that they have.
void expect_begun(const ScenarioSchedule& answer, sim::Duration from) {
  ASSERT_EQ(answer.verdict, Verdict::scheduled) << answer.how;
  for (const scenario::SetGates& each : answer.resolved->scenario.gates->lists) {
    EXPECT_GE(each.gates.base_time, from);
    EXPECT_LT(each.gates.base_time, from + *each.gates.cycle);
  }
}

// What is sent before finds all gates open.
TEST(ScenarioSchedule, ListsBeginWhenClocksAreSynchronised) {
  std::string early = with_clocks(gptp, R"(, "warm_up": "8s")");
  early.replace(early.find(R"("offset": "auto")"), 16, R"("offset": "3us")");
  const auto answer = scheduled(early, false);
  ASSERT_TRUE(answer);
  expect_begun(*answer, sim::Duration::from_ps(8'000'000'000'000));
}

// A margin in numbers is no other.
TEST(ScenarioSchedule, SoTheyDoWithAMarginThatIsSaid) {
  std::string early = with_clocks(gptp, R"(, "require": [{"sync": "490ns", "after": "8s"}])");
  early.replace(early.find(R"("offset": "auto")"), 16, R"("offset": "3us")");
  early.replace(early.find(R"("margin": "auto")"), 16, R"("margin": "1100ns")");
  const auto answer = scheduled(early, false);
  ASSERT_TRUE(answer);
  expect_begun(*answer, sim::Duration::from_ps(8'000'000'000'000));
}

TEST(ScenarioSchedule, MarginKeepsToWhatIsRequiredOfClocks) {
  const auto answer = scheduled(with_clocks(gptp, R"(, "require": [{"sync": "2us", "after": "8s"}])"), false);
  ASSERT_TRUE(answer);
  ASSERT_TRUE(answer->clock_margin);
  EXPECT_EQ(answer->clock_margin->difference,
            sim::Duration::from_ps(4'000'000));  // 2 us of each from their grandmaster
  EXPECT_EQ(answer->resolved->scenario.require.size(), 1u);
}

TEST(ScenarioSchedule, NoMarginOfClocksThatAreNotSynchronised) {
  const auto told = [](const std::string& clocks, const std::string& more) {
    std::string text;
    EXPECT_FALSE(scheduled(with_clocks(clocks, more), false, 1024, &text));
    return text;
  };
  const auto has = [](const std::string& text, const char* words) {
    return text.find("/gates/margin: " + std::string(words)) != std::string::npos;
  };
  std::string text = told("", "");
  EXPECT_TRUE(has(text, "a margin of clocks that nothing synchronises: found \"auto\" without gPTP")) << text;
  text = told(R"(, "gptp": {"nodes": {"sw1": {"priority1": 100}}, "without": ["h1"]})", "");
  EXPECT_TRUE(has(
      text, "a margin of clocks that nothing synchronises: found \"h1\" sends scheduled frames and is without gPTP"))
      << text;
  text = told(gptp, R"(, "warm_up": "1ms")");
  EXPECT_TRUE(has(text, "clocks that are not synchronised in time")) << text;
  text = told(gptp, R"(, "require": [{"sync": "1ns", "after": "8s"}])");
  EXPECT_TRUE(has(text, "clocks that are worse than is required")) << text;
  text = told(gptp, R"(, "require": [{"sync": "1us", "after": "20s"}])");
  EXPECT_NE(text.find("error"), std::string::npos);
}

std::string finding(const std::string& name) {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + name + ".json");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Three frames of 115 us each 250 us at 100 Mbit/s: two go one way round the ring, the third the other way. The Program
// beside them cannot be a stream of the instance, and is in nobody's way.
TEST(ScenarioSchedule, SearchesPathsBesideAProgram) {
  const auto answer = scheduled(finding("ways-beside-a-program"), true);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  EXPECT_EQ(answer->streams.size(), 6u);  // two states and the data of the Program are among them
}

// Where the streams alone have no place the proof speaks of them, whatever the Program could do.
TEST(ScenarioSchedule, ProvesBesideAProgram) {
  const auto answer = scheduled(finding("ways-beside-a-program"), false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::infeasible);
  ASSERT_TRUE(answer->certificate);
  for (const schedule::StreamIndex s : answer->certificate->streams)
    EXPECT_EQ(answer->instance->streams[s].name.substr(0, 1), "a");
}

// 3.878 us: a frame of 64 octets and R-less headers over three links; in their own windows from 8 s on.
TEST(ScenarioSchedule, AProgramInWindowsWithGptp) {
  const auto answer = scheduled(finding("program-gptp"), true);
  ASSERT_TRUE(answer);
  expect_begun(*answer, sim::Duration::from_ps(8'000'000'000'000));
  for (const JudgedStream& each : answer->streams)
    EXPECT_LT(each.simulated, sim::Duration::from_ps(5'000'000)) << each.name;
}

// 20 Mbit/s for 1,400 octets each 500 us: the queue only grows, and no bound says more.
TEST(ScenarioSchedule, ItsOwnRunIsPartOfTheVerdict) {
  const auto answer = scheduled(finding("scheduled-but-broken"), true);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::undecided);
  EXPECT_FALSE(answer->resolved);
  EXPECT_NE(answer->how.find("stream video latency at most 1ms: "), std::string::npos) << answer->how;
  EXPECT_NE(answer->how.find(" in its run"), std::string::npos) << answer->how;
}

TEST(ScenarioSchedule, AnInfeasibleOneSaysWhy) {
  const auto answer = scheduled(finding("infeasible-without-reason"), true);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::infeasible);
  EXPECT_EQ(answer->how, "load");
  EXPECT_EQ(answer->proof, "3 streams load \"sw1>sw2\" by 117.60 % (must cross it)");
}

TEST(ScenarioSchedule, EntriesOfGeneratedHosts) {
  const auto answer = scheduled(finding("entries-of-generated-hosts"), true, 4);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  EXPECT_LE(answer->most_entries, 4u);
}

// 600 windows of 0.75 us in 4 ms: with guards and time between them more than 1,024 entries.
TEST(ScenarioSchedule, MoreWindowsThanEntriesAreMerged) {
  std::string text =
      R"({"name": "many", "duration": "20ms", "network": {"generate": [{"topology": "star", "switches": 2, "hosts_per_switch": 3, "forwarding_delay": "1us"}]},
 "gates": {"plan": "auto", "classes": [6]}, "streams": [)";
  for (int i = 0; i < 600; ++i)
    text +=
        (i == 0 ? "" : ", ") + (R"({"name": "a)" + std::to_string(i) + R"(", "from": "h)" + std::to_string(1 + i % 2) +
                                R"(", "to": "h3", "payload": "40B", "every": "4ms", "offset": "auto", "pcp": 6})");
  const auto answer = scheduled(text + "]}", true);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  EXPECT_LE(answer->most_entries, 1024u);
}

// The camera may take 300 us and is bounded by 253.67 us without a margin: each ns of it makes a window, and what is
// closed before it, two ns longer.
TEST(ScenarioSchedule, SlackLeavesTheOtherTrafficWhatItNeeds) {
  const auto answer = with_slack(finding("slack-camera"));
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  ASSERT_TRUE(answer->slack);
  EXPECT_NEAR(static_cast<double>(answer->slack->margin.ps()), 23'165'000, 10'000);
  EXPECT_NE(answer->slack->with_more.find("stream camera latency at most 300us"), std::string::npos)
      << answer->slack->with_more;
}

// Both classes are open in one entry where a device has limits; their frames still do not meet.
TEST(ScenarioSchedule, TwoClassesHaveTheSameBoundWithLimits) {
  const std::string limited = finding("two-classes-limits");
  std::string free = limited;
  const std::string limits = R"(,"gate_limits":{"granularity":"8ns"})";
  free.erase(free.find(limits), limits.size());
  const auto with = scheduled(limited, true), without = scheduled(free, true);
  ASSERT_TRUE(with && without);
  ASSERT_EQ(with->verdict, Verdict::scheduled) << with->how;
  ASSERT_EQ(with->streams.size(), without->streams.size());
  for (std::size_t s = 0; s < with->streams.size(); ++s) EXPECT_EQ(with->streams[s].bound, without->streams[s].bound);
}

// 250 octets with preamble take 2.064 us; of 26 octets, 208 ns, the header is there. Over five switches with 500 ns and
// six cables with 50 ns each: 5 (208 + 50 + 500) ns + 2.064 us + 50 ns.
TEST(ScenarioSchedule, FramesThatAreCutThrough) {
  const auto answer = scheduled(finding("scheduled-cut-through"), true);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  ASSERT_EQ(answer->streams.size(), 2u);
  for (const JudgedStream& each : answer->streams) {
    EXPECT_EQ(each.planned, sim::Duration::from_ps(5'904'000));
    EXPECT_EQ(each.simulated, each.planned);
    EXPECT_EQ(each.bound, each.planned);
  }
}

}  // namespace
}  // namespace takt::synthesis
