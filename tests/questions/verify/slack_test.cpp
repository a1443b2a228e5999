// SPDX-License-Identifier: Apache-2.0
// Where a bound gives away what a run does not take: places and figures that can be worked out by hand.
#include "verify/slack.hpp"

#include <gtest/gtest.h>

#include "evaluation/evaluate.hpp"
#include "tests/questions/verify/support.hpp"
#include "verify/report.hpp"

namespace takt::verify::slack_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

struct Replay {
  results::RequirementResult requirement;
  Duration bound;
  std::vector<SlackPart> parts;
};

/// The first requirement of the scenario as it is.
Replay replay(const std::string& text) {
  const auto scenario = resolved(text);
  const analysis::Bounds bounds = analysis::bound(*scenario);
  scenario::Run run(*scenario);
  run.advance();
  Replay made;
  made.requirement = evaluation::evaluate(run, false).requirements.front();
  made.bound = bounds.requirements.front().duration.value_or(Duration());
  made.parts = slack_of({made.requirement, *made.requirement.measured, made.bound, scenario->scenario}, bounds, {});
  Duration of_run;
  Duration of_bound;
  for (const SlackPart& part : made.parts) {
    of_run += part.run;
    of_bound += part.bound;
  }
  EXPECT_EQ(of_run, *made.requirement.measured);
  EXPECT_EQ(of_bound, made.bound);
  return made;
}

std::string two_talkers(const std::string& rest) {
  return R"({"name": "two", "duration": "20ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host", "os": {"receive": {"uniform": {"from": "1us", "to": "5us"}}}}, "c": {"kind": "host"}, "sw": {"kind": "switch"}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
    "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"},
                {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms"}],
    )" + rest +
         "}";
}

// As it is the long frame of 8 + 1400 + 28 + 18 + 4 + 12 octets comes to the switch behind the short one, and the bound
// has it in front.
TEST(Slack, NamesThePortWhereNobodyWaited) {
  const Replay found = replay(two_talkers(R"("require": [{"stream": "urgent", "latency": "1ms"}])"));
  ASSERT_EQ(found.parts.size(), 3u);
  EXPECT_EQ(found.parts[0].where, "sw:1");
  EXPECT_EQ(found.parts[0].what, "blocking and other frames");
  EXPECT_EQ(found.parts[0].given_away(), 1470 * 8_ns);
  EXPECT_EQ(found.parts[1].where, "b");  // what its operating system did not take of 5 us
  EXPECT_EQ(found.parts[1].bound, 5_us + 50_ns);
  EXPECT_LT(found.parts[1].run, found.parts[1].bound);
  EXPECT_EQ(found.parts[2].where, "a:0");
  EXPECT_EQ(found.parts[2].given_away(), Duration());
}

// The jitter of a run is less by what its fastest frame took beyond the least.
TEST(Slack, OfAJitterHasAPartForTheFastestFrame) {
  const Replay found = replay(two_talkers(R"("require": [{"stream": "urgent", "jitter": "1ms"}])"));
  ASSERT_EQ(found.parts.size(), 4u);
  EXPECT_TRUE(std::any_of(found.parts.begin(), found.parts.end(), [](const SlackPart& part) {
    return part.where == "the fastest frame" && part.bound < Duration() && part.given_away() >= Duration();
  }));
}

// Called 300 us behind a publication of the 1 ms cycle, the word waits for 700 us. It is alone on its way, so that
// nothing else is given away.
TEST(Slack, NamesTheWaitForTheNextPublication) {
  const Replay found = replay(R"({"name": "pair", "duration": "60ms",
    "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host"}}, "links": [{"ends": ["m", "s"]}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms", "phases": {"m": "0us", "s": "500us"}}],
    "script": [{"at": "2ms", "program": "p", "call": "Start"}, {"at": "40300us", "program": "p", "call": "Halt", "on": "m"}],
    "require": [{"reaction": "halt", "within": "5ms"}]})");
  ASSERT_EQ(found.parts.size(), 2u);
  EXPECT_EQ(found.parts[0].where, "m");
  EXPECT_EQ(found.parts[0].what, "wait for the next publication");
  EXPECT_EQ(found.parts[0].bound, 1_ms);
  EXPECT_EQ(found.parts[0].run, 700_us);
  EXPECT_EQ(found.parts[1].where, "m to s");
  EXPECT_EQ(found.parts[1].given_away(), Duration());
}

// A start goes there and back twice, and the slave's INIT lasts: five words and INIT in order of what they give away,
// each with its run.
TEST(Slack, FollowsAStartBackToItsCall) {
  const Replay found = replay(R"({"name": "pair", "duration": "60ms",
    "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host"}}, "links": [{"ends": ["m", "s"]}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms", "initialisation": "3ms", "phases": {"m": "0us", "s": "500us"}}],
    "script": [{"at": "2300us", "program": "p", "call": "Start"}],
    "require": [{"reaction": "start", "within": "50ms"}]})");
  const auto sum_of = [&](const std::string& what) {
    Duration sum;
    for (const SlackPart& part : found.parts)
      if (part.what == what) sum += part.run;
    return sum;
  };
  EXPECT_EQ(sum_of("INIT"), 3_ms);
  EXPECT_EQ(std::count_if(found.parts.begin(), found.parts.end(),
                          [](const SlackPart& part) { return part.what == "latency of the word"; }),
            4);
  EXPECT_TRUE(std::is_sorted(found.parts.begin(), found.parts.end(),
                             [](const SlackPart& a, const SlackPart& b) { return a.given_away() > b.given_away(); }));
  EXPECT_EQ(sum_of("noticing the cause"), Duration());
}

// From a crash the bound counts the last word and the time-out; the run's time-out is the same, and its last word was
// older.
TEST(Slack, BeginsAtTheCauseOfAHalt) {
  const Replay found = replay(R"({"name": "pair", "duration": "100ms",
    "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host"}, "sw": {"kind": "switch"}, "t": {"kind": "host"}},
      "links": [{"ends": ["m", "sw"]}, {"ends": ["s", "sw"]}, {"ends": ["t", "sw"]}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s", "t"], "cycle": "1ms", "initialisation": "3ms", "receive_timeout": "5ms", "phases": {"m": "0us", "s": "500us", "t": "250us"}}],
    "script": [{"at": "2ms", "program": "p", "call": "Start"}],
    "faults": [{"kind": "crash", "node": "s", "at": "50100us"}],
    "require": [{"reaction": "halt", "cause": "crash", "within": "50ms"}]})");
  const auto noticing = std::find_if(found.parts.begin(), found.parts.end(),
                                     [](const SlackPart& part) { return part.what == "noticing the cause"; });
  ASSERT_NE(noticing, found.parts.end());
  EXPECT_GT(noticing->given_away(), Duration());  // s published 600 us before it died
  EXPECT_LT(noticing->given_away(), 1_ms);
}

TEST(Slack, IsSilentAboutWhatIsTight) {
  EXPECT_TRUE(is_tight(results::RequirementKind::reaction, 0.9));
  EXPECT_FALSE(is_tight(results::RequirementKind::reaction, 0.899));
  EXPECT_TRUE(is_tight(results::RequirementKind::latency, 0.85));
  EXPECT_FALSE(is_tight(results::RequirementKind::latency, 0.849));
}

// The frame is cut through by the switch, which also has a class that is not: the bound stores it, 8 + 100 + 28 + 18 +
// 4 octets less what its header takes.
TEST(Slack, StandsInTheReport) {
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/validation/cut-through.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  Options options;
  options.search.seeds = 1;
  options.search.events = 100'000;
  const Verification found = verify(*resolved, options);
  const auto line = std::find_if(found.lines.begin(), found.lines.end(), [](const Line& each) {
    return each.requirement.kind == results::RequirementKind::latency;
  });
  ASSERT_NE(line, found.lines.end());
  ASSERT_FALSE(line->slack.empty());
  const std::vector<std::string> files(found.lines.size());
  const std::string text = text_report("cut", found, files);
  EXPECT_NE(text.find("the bound gives away 19.712 us of 30.246 us: 9.856 us at switch1:1 (blocking and other frames)"),
            std::string::npos)
      << text;
  const std::string json = json_report("cut", found, files);
  EXPECT_NE(json.find("\"gives_away\""), std::string::npos);
  EXPECT_NE(json.find("\"where\": \"switch1:1\""), std::string::npos);
}

}  // namespace
}  // namespace takt::verify::slack_test
