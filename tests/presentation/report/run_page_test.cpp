// SPDX-License-Identifier: Apache-2.0
// The page of a run shows what happened, and needs nothing else.
#include "report/run_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "evaluation/evaluate.hpp"
#include "scenario/resolve.hpp"

namespace takt::report {
namespace {

struct Made {
  std::unique_ptr<scenario::Resolved> resolved;
  results::RunResult result;
  std::unique_ptr<Replay> replay;
  std::string page;
};

Made page_of(const std::string& file, const std::vector<std::string>& settings = {}) {
  json::Diagnostics diagnostics;
  Made made;
  made.resolved = scenario::load_file(std::string(TAKT_SOURCE_DIR "/scenarios/") + file, settings, diagnostics);
  EXPECT_TRUE(made.resolved) << diagnostics.to_text();
  scenario::Run run(*made.resolved);
  run.advance();
  made.result = evaluation::evaluate(run, false);
  made.replay = std::make_unique<Replay>(*made.resolved, made.result);
  EXPECT_TRUE(made.replay->advance([] { return false; }));
  made.page = run_page(*made.resolved, made.result, *made.replay);
  return made;
}

std::size_t count(const std::string& text, const std::string& piece) {
  std::size_t found = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + piece.size())) ++found;
  return found;
}

/// Nothing is fetched and nothing is run: the only addresses are the names of XML.
void expect_self_contained(const std::string& page) {
  EXPECT_EQ(count(page, "://"), count(page, "xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_EQ(count(page, "<script"), 0u);
  EXPECT_EQ(count(page, "<svg"), count(page, "</svg>"));
}

TEST(RunPage, SaysTheVerdictAndShowsEachRequirementAndEachKindOfReaction) {
  const Made made = page_of("robot-arm.json");
  expect_self_contained(made.page);
  EXPECT_NE(made.page.find("robot-arm: pass, all 8 requirements hold in this run"), std::string::npos);
  for (const results::RequirementResult& requirement : made.result.requirements)
    EXPECT_NE(made.page.find(requirement.text), std::string::npos) << requirement.text;
  const auto sequences = made.replay->sequences();
  ASSERT_EQ(sequences.size(), 4u) << "start, suspend, resume, halt";
  // Suspended by the robot at 4.00007 s. The generator receives it 163.103 us later (docs/results.md).
  const chart::SequenceChart& suspend = sequences[1];
  ASSERT_EQ(suspend.steps.size(), 2u);
  EXPECT_EQ(suspend.steps[0].text, "called: Suspended");
  EXPECT_EQ(suspend.steps[1].time - suspend.steps[0].time, 163'103'000) << "docs/results.md: +163.103 us";
  ASSERT_FALSE(suspend.messages.empty());
  EXPECT_EQ(suspend.messages[0].from, 1u);
  EXPECT_EQ(suspend.messages[0].received, suspend.steps[1].time);
}

TEST(RunPage, GatesAndFramesOfOneCycle) {
  // Class 6 is open for 100 us of 1 ms; its frame is on the wire of sw1 when the line says so.
  const Made made = page_of("tsn/gates-on-a-line.json");
  const auto gates = made.replay->gates();
  ASSERT_TRUE(gates);
  EXPECT_DOUBLE_EQ(gates->to, 1000);
  ASSERT_EQ(gates->rows.size(), 5u);
  const chart::GanttRow& control = gates->rows.front();
  EXPECT_EQ(control.name, "sw1:0 to sw2, class 6");
  ASSERT_EQ(control.stretches.size(), 1u);
  EXPECT_DOUBLE_EQ(control.stretches[0].from, 0);
  EXPECT_DOUBLE_EQ(control.stretches[0].to, 100);
  ASSERT_EQ(control.bars.size(), 1u);
  for (const chart::GanttRow& row : gates->rows)
    for (const chart::GanttBar& bar : row.bars)
      EXPECT_TRUE(std::any_of(row.stretches.begin(), row.stretches.end(),
                              [&](const auto& open) { return open.from <= bar.from && bar.to <= open.to; }))
          << row.name << " at " << bar.from;
}

/// A page of a scenario that is written here.
Made page_of_text(const std::string& text) {
  json::Diagnostics diagnostics;
  Made made;
  made.resolved = scenario::load_text(text, "test.json", {}, diagnostics);
  EXPECT_TRUE(made.resolved) << diagnostics.to_text();
  scenario::Run run(*made.resolved);
  run.advance();
  made.result = evaluation::evaluate(run, false);
  made.replay = std::make_unique<Replay>(*made.resolved, made.result);
  EXPECT_TRUE(made.replay->advance([] { return false; }));
  made.page = run_page(*made.resolved, made.result, *made.replay);
  return made;
}

/// Two hosts at a switch whose port to b has the gates `first`, and from `at` on `then`.
std::string with_set_gates(const std::string& first, const std::string& at, const std::string& then,
                           const std::string& more = {}) {
  return R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch")" +
         (first.empty() ? "" : R"(, "egress": [{"to": "b", "gates": )" + first + "}]") + R"(}},
    "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}]},
    "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "100us", "pcp": 6}],
    "script": [{"at": ")" +
         at + R"(", "set_gates": {"node": "sw", "to": "b", "gates": )" + then + "}}]" + more + "}";
}

// The middle of the run is 5 ms. Lists of 400 us begin at 0; one of 1 ms that is set at 1 ms with base time 0 runs from
// 2 ms on, and its cycle from 5 ms to 6 ms is shown.
TEST(RunPage, GatesThatTheScriptHasSet) {
  const std::string short_list = R"({"entries": [{"open": [6], "for": "100us"}, {"open": [0], "for": "300us"}]})";
  const std::string long_list = R"({"entries": [{"open": [6], "for": "250us"}, {"open": [0], "for": "750us"}]})";
  for (const std::string& before : {short_list, std::string()}) {
    const Made made = page_of_text(with_set_gates(before, "1ms", long_list));
    const auto gates = made.replay->gates();
    ASSERT_TRUE(gates) << before;
    EXPECT_NE(gates->title.find("from 5 ms on, one cycle of 1 ms"), std::string::npos) << gates->title;
    ASSERT_EQ(gates->rows.size(), 1u);
    ASSERT_EQ(gates->rows[0].stretches.size(), 1u);
    EXPECT_DOUBLE_EQ(gates->rows[0].stretches[0].from, 0);
    EXPECT_DOUBLE_EQ(gates->rows[0].stretches[0].to, 250);
  }
}

// Cycles of 400 us: the one that 5 ms lies in is from 4.8 to 5.2 ms. A list that is set at 5.05 ms with a base time
// of 5.1 ms begins in it: class 6 was open from 4.8 to 4.9 ms, and is from 5.1 ms on.
TEST(RunPage, GatesAsTheyWereWhereTheyChangeInTheCycleThatIsShown) {
  const std::string before = R"({"entries": [{"open": [6], "for": "100us"}, {"open": [0], "for": "300us"}]})";
  const Made made = page_of_text(with_set_gates(
      before, "5.05ms",
      R"({"base_time": "5.1ms", "entries": [{"open": [6], "for": "150us"}, {"open": [0], "for": "250us"}]})"));
  const auto gates = made.replay->gates();
  ASSERT_TRUE(gates);
  std::vector<std::pair<double, double>> open;
  for (const chart::GanttStretch& stretch : gates->rows.at(0).stretches) open.emplace_back(stretch.from, stretch.to);
  EXPECT_NE(gates->title.find("from 4.8 ms on"), std::string::npos)
      << gates->title << ": of the list that is in force at 5 ms";
  EXPECT_EQ(open, (std::vector<std::pair<double, double>>{{0, 100}, {300, 400}}));
  // A gate that is stuck from 5.1 ms to 5.15 ms.
  const Made stuck = page_of_text(with_set_gates(
      before, "9ms", before,
      R"(, "faults": [{"kind": "stuck-gate", "node": "sw", "to": "b", "class": 6, "state": "open", "at": "5.1ms", "for": "50us"}])"));
  const auto drawn = stuck.replay->gates();
  ASSERT_TRUE(drawn);
  EXPECT_NE(drawn->title.find("from 4.8 ms on, one cycle of 400 us"), std::string::npos) << drawn->title;
  open.clear();
  for (const chart::GanttStretch& stretch : drawn->rows.at(0).stretches) open.emplace_back(stretch.from, stretch.to);
  EXPECT_EQ(open, (std::vector<std::pair<double, double>>{{0, 100}, {300, 350}}));
}

// A stream gate that is shut for half of the cycle, a filter that takes no SDU above 900 octets, and a queue, of class
// 1 as priority 0 has it, that takes none above 500.
TEST(RunPage, WhatIsDiscardedIsACross) {
  const Made made = page_of_text(
      R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host", "egress": [{"gates": {"entries": [{"open": [0, 1, 2, 3, 4, 5, 6, 7], "for": "1ms"}]}}]}, "b": {"kind": "host"},
    "sw": {"kind": "switch", "forwarding_delay": "1us", "egress": [{"to": "b", "gates": {"entries": [{"open": [0, 1, 2, 3, 4, 5, 6, 7], "for": "1ms"}]}, "max_sdu": [{"class": 1, "size": "500B"}]}],
      "ingress": {"filters": [{"stream": "gated", "gate": "g"}, {"stream": "long", "max_sdu": "900B"}], "gates": [{"name": "g", "entries": [{"open": true, "for": "500us"}, {"open": false, "for": "500us"}]}]}}},
    "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}]},
    "streams": [{"name": "gated", "from": "a", "to": "b", "payload": "100B", "every": "250us", "offset": "10us", "pcp": 6},
                {"name": "long", "from": "a", "to": "b", "payload": "1000B", "every": "1ms", "offset": "100us", "pcp": 5},
                {"name": "longer-than-the-queue", "from": "a", "to": "b", "payload": "600B", "every": "1ms", "offset": "200us"}]})");
  const auto gates = made.replay->gates();
  ASSERT_TRUE(gates);
  std::vector<std::string> crosses;
  for (const chart::GanttRow& row : gates->rows)
    for (const chart::GanttCross& cross : row.crosses) crosses.push_back(row.name + ": " + cross.title);
  // From 5 ms on: frames 20 to 23 of the gated stream, two of which come to a closed gate; frame 5 of the others.
  EXPECT_EQ(crosses,
            (std::vector<std::string>{"a:0 to sw, class 5: long #5 discarded at sw: stream_max_sdu",
                                      "a:0 to sw, class 6: gated #22 discarded at sw: stream_gate",
                                      "a:0 to sw, class 6: gated #23 discarded at sw: stream_gate",
                                      "sw:1 to b, class 1: longer-than-the-queue #5 discarded at sw: queue_max_sdu"}));
  EXPECT_EQ(count(made.page, "discarded at sw: "), crosses.size());
}

// Without gates the frames around the first one that was discarded: a camera that sends every 150 us, twice what its
// meter lets pass (scenarios/tsn/policing.json).
TEST(RunPage, WithoutGatesTheFramesAroundTheFirstThatWasDiscarded) {
  const Made made = page_of("tsn/policing.json");
  const auto frames = made.replay->gates();
  ASSERT_TRUE(frames);
  EXPECT_NE(made.page.find("<h2>Discarded frames</h2>"), std::string::npos);
  ASSERT_EQ(frames->rows.size(), 1u);
  const chart::GanttRow& camera = frames->rows[0];
  EXPECT_EQ(camera.name, "camera:0 to switch, class 6");
  EXPECT_GE(camera.bars.size(), 12u);
  EXPECT_GE(camera.crosses.size(), 3u);
  EXPECT_LT(camera.crosses.size(), camera.bars.size());
  EXPECT_NE(camera.crosses[0].title.find("discarded at switch: flow_meter"), std::string::npos)
      << camera.crosses[0].title;
  // Each cross is behind the bar of its frame: 1400 octets and headers, a cable and the forwarding delay.
  for (const chart::GanttCross& cross : camera.crosses)
    EXPECT_TRUE(std::ranges::any_of(camera.bars, [&](const chart::GanttBar& bar) {
      return bar.to <= cross.at && cross.at - bar.to < 10;
    })) << cross.at;
  EXPECT_FALSE(page_of("robot-arm.json", {"/duration=100ms"}).replay->gates())
      << "neither gates nor frames that are discarded";
}

TEST(RunPage, ACrashMarksItsNodeAndTheReplayIsTheSameRun) {
  const Made made = page_of("daisy-chain.json");
  EXPECT_NE(made.page.find("red: failed in this run"), std::string::npos);
  for (const chart::SequenceChart& sequence : made.replay->sequences()) EXPECT_EQ(sequence.participants.size(), 13u);
}

sim::Duration sum_of(const explain::ExplainedFrame& frame) {
  sim::Duration sum;
  for (const explain::ExplainedHop& hop : frame.hops)
    for (const explain::ExplainedPart& part : hop.parts) sum += part.takes;
  return sum;
}

// Each stream's slowest frame is the one of the result, and its parts are all of its latency.
TEST(RunPage, WhereTheTimeOfTheSlowestFramesWent) {
  const Made made = page_of("tsn/preemption-on-a-line.json");
  expect_self_contained(made.page);
  const auto frames = made.replay->ways().frames();
  ASSERT_EQ(frames.size(), made.result.streams.size());
  EXPECT_TRUE(made.replay->ways().is_complete());
  for (const results::StreamResult& stream : made.result.streams) {
    const auto found = std::ranges::find(frames, stream.name, &explain::ExplainedFrame::stream);
    ASSERT_NE(found, frames.end()) << stream.name;
    EXPECT_EQ((*found)->takes, stream.latency->max) << stream.name;
    EXPECT_EQ(sum_of(**found), stream.latency->max) << stream.name;
  }
  EXPECT_TRUE(std::ranges::is_sorted(frames, std::ranges::greater(), &explain::ExplainedFrame::takes));
  EXPECT_EQ(count(made.page, "<div class=\"stack\" role=\"img\" aria-label=\""), frames.size());
  EXPECT_EQ(count(made.page, "Its figures, hop by hop"), frames.size());
  // docs of the scenario: backup is behind its own class, cuts of express frames cost it time.
  EXPECT_NE(made.page.find("<h3>backup1: 1.908542 ms</h3>"), std::string::npos);
  EXPECT_NE(made.page.find("preemption: cuts, hold"), std::string::npos);
  EXPECT_EQ(made.page.find("gate closed"), std::string::npos) << "the legend has what occurs";
}

// A warm-up hides the slow frames of the beginning from the figures, and from the page.
TEST(RunPage, TheSlowestFrameIsOneThatCounts) {
  const Made made = page_of("robot-arm.json", {"/duration=2s", "/warm_up=1500ms", "/require=[]"});
  for (const explain::ExplainedFrame* const frame : made.replay->ways().frames()) {
    const auto found = std::ranges::find(made.result.streams, frame->stream, &results::StreamResult::name);
    ASSERT_NE(found, made.result.streams.end());
    EXPECT_EQ(frame->takes, found->latency->max);
  }
  EXPECT_TRUE(made.replay->ways().is_complete());
}

TEST(RunPage, SlowestStreamsOnlyAndTheRestInWords) {
  // All frames at once: each waits for those before it, so stream 0 is the soonest. The Program's four streams are
  // slower than some.
  std::string streams;
  for (int i = 0; i < 60; ++i)
    streams += (i == 0 ? "{" : ",{") + std::string(R"("name": "s)") + std::to_string(i) +
               R"(", "from": "camera", "to": "generator", "every": "10ms", "payload": "1000B"})";
  const Made made =
      page_of("robot-arm.json", {"/duration=30ms", "/require=[]", "/script=[]", "/streams=[" + streams + "]"});
  const auto delivering = static_cast<std::size_t>(
      std::ranges::count_if(made.result.streams, [](const auto& stream) { return stream.latency.has_value(); }));
  ASSERT_GE(delivering, 60u);
  EXPECT_EQ(made.replay->ways().frames().size(), WorstWays::most_streams);
  EXPECT_EQ(made.replay->ways().left_out(), delivering - WorstWays::most_streams);
  EXPECT_EQ(made.page.find("<h3>s0: "), std::string::npos);
  EXPECT_NE(made.page.find("and " + std::to_string(delivering - WorstWays::most_streams) +
                           " more streams, none of them slower"),
            std::string::npos);
}

TEST(RunPage, FailuresAreOnTop) {
  const Made made = page_of("robot-arm.json", {"/require/0/within=1ms"});
  EXPECT_NE(made.page.find("robot-arm: fail, 1 of 8 requirements failed in this run"), std::string::npos);
  EXPECT_NE(made.page.find("<p class=\"verdict fail\">"), std::string::npos);
}

// h1 is lost at 20 s, and h4 leads a moment later: both are marked over the offsets of the clocks, whose greatest
// stands in the table with its instant.
TEST(RunPage, ShowsOffsetsOfClocksOverTimeAndWhoLeads) {
  const Made made = page_of("clocks/grandmaster-fail-over.json",
                            {"/duration=25s", "require=[{\"sync\": \"1us\", \"after\": \"15s\"}]"});
  expect_self_contained(made.page);
  const auto curves = made.replay->clocks();
  ASSERT_TRUE(curves);
  ASSERT_EQ(curves->series.size(), 8u);
  for (const chart::Series& series : curves->series) EXPECT_GT(series.samples.size(), 100u) << series.name;
  ASSERT_EQ(curves->moments.size(), 3u);
  EXPECT_EQ(curves->moments[1].text, "h1 lost");
  EXPECT_DOUBLE_EQ(curves->moments[1].x, 20);
  EXPECT_EQ(curves->moments[2].text, "h4 leads");
  EXPECT_NE(made.page.find("Offsets from the grandmaster that most nodes follow"), std::string::npos);
  EXPECT_NE(made.page.find("h4 leads"), std::string::npos);
  EXPECT_EQ(made.page.find(">never<"), std::string::npos) << "a grandmaster is locked to nobody else";
}

}  // namespace
}  // namespace takt::report
