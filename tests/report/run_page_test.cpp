// The page of a run shows what happened, and needs nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "evaluation/evaluate.hpp"
#include "report/run_page.hpp"
#include "scenario/resolve/resolve.hpp"

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
  for (const results::RequirementResult& requirement : made.result.requirements) EXPECT_NE(made.page.find(requirement.text), std::string::npos) << requirement.text;
  const auto sequences = made.replay->sequences();
  ASSERT_EQ(sequences.size(), 4u) << "start, suspend, resume, halt";
  // Suspended by the robot at 4.00007 s; the generator hears it 163.103 us later (README.md) by the message that arrives then.
  const chart::SequenceChart& suspend = sequences[1];
  ASSERT_EQ(suspend.steps.size(), 2u);
  EXPECT_EQ(suspend.steps[0].text, "called: Suspended");
  EXPECT_EQ(suspend.steps[1].time - suspend.steps[0].time, 163'103'000) << "README.md: +163.103 us";
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
      EXPECT_TRUE(std::any_of(row.stretches.begin(), row.stretches.end(), [&](const auto& open) { return open.from <= bar.from && bar.to <= open.to; })) << row.name << " at " << bar.from;
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
  // All frames at once: each waits for those before it, so stream 0 is the soonest. The Program's four streams are slower than some.
  std::string streams;
  for (int i = 0; i < 60; ++i) streams += (i == 0 ? "{" : ",{") + std::string(R"("name": "s)") + std::to_string(i) + R"(", "from": "camera", "to": "generator", "every": "10ms", "payload": "1000B"})";
  const Made made = page_of("robot-arm.json", {"/duration=30ms", "/require=[]", "/script=[]", "/streams=[" + streams + "]"});
  const auto delivering = static_cast<std::size_t>(std::ranges::count_if(made.result.streams, [](const auto& stream) { return stream.latency.has_value(); }));
  ASSERT_GE(delivering, 60u);
  EXPECT_EQ(made.replay->ways().frames().size(), WorstWays::most_streams);
  EXPECT_EQ(made.replay->ways().left_out(), delivering - WorstWays::most_streams);
  EXPECT_EQ(made.page.find("<h3>s0: "), std::string::npos);
  EXPECT_NE(made.page.find("and " + std::to_string(delivering - WorstWays::most_streams) + " more streams, none of them slower"), std::string::npos);
}

TEST(RunPage, FailuresAreOnTop) {
  const Made made = page_of("robot-arm.json", {"/require/0/within=1ms"});
  EXPECT_NE(made.page.find("robot-arm: fail, 1 of 8 requirements failed in this run"), std::string::npos);
  EXPECT_NE(made.page.find("<p class=\"verdict fail\">"), std::string::npos);
}

// h1 is lost at 20 s, and h4 leads a moment later: both are marked over the offsets of the clocks, whose greatest stands in the table with its instant.
TEST(RunPage, ShowsOffsetsOfClocksOverTimeAndWhoLeads) {
  const Made made = page_of("clocks/grandmaster-fail-over.json", {"/duration=25s", "require=[{\"sync\": \"1us\", \"after\": \"15s\"}]"});
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
