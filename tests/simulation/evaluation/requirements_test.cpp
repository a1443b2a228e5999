// SPDX-License-Identifier: Apache-2.0
// Requirements are judged as they read.
#include "evaluation/evaluate.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario::test::requirements_test {
namespace {

using results::RequirementResult;
using results::RunResult;
using results::Verdict;

// a --- sw --- b at 1 Gb/s over 10 m each, 100 B + 28 + 18 = 146 B; last bit in to last bit in without any other delay:
// (8 + 146) x 8 ns = 1.232 us twice, 50 ns of cable twice: 2.564 us for every frame, so no jitter. 11 frames from 0 to
// 10 ms.
std::string frames(const std::string& requirement, const std::string& more = {}) {
  return over_one_switch(
      R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}], "require": [)" +
      requirement + "]" + more);
}

std::string program(const std::string& requirement,
                    const std::string& script = R"({"at": "1ms", "program": "p", "call": "Start"})") {
  return over_one_switch(
      R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "100us", "initialisation": "200us"},
 {"name": "q", "master": "b", "slaves": ["a"], "cycle": "100us"}], "script": [)" +
      script + R"(], "require": [)" + requirement + "]");
}

RunResult run(const std::string& text, std::uint64_t events = ~0ULL) {
  const auto resolved = sound(text);
  LiveRun live(*resolved);
  const bool is_complete = live.advance(events);
  return evaluation::evaluate(live, !is_complete);
}

/// The first requirement of the run.
RequirementResult judged(const std::string& text, std::uint64_t events = ~0ULL) {
  return run(text, events).requirements.at(0);
}

// Of 0 to 10 ms those that are due before 3 ms.
TEST(Requirements, AStreamEnds) {
  std::string text = frames(R"({"stream": "s", "delivered": 3})");
  text.insert(text.find(R"("every": "1ms")"), R"("until": "3ms", )");
  const RunResult ended = run(text);
  EXPECT_EQ(ended.streams.at(0).sent, 3u);
  EXPECT_EQ(ended.streams.at(0).delivered, 3u);
  EXPECT_EQ(ended.verdict, Verdict::pass);
  text.replace(text.find(R"("until": "3ms")"), 14, R"("until": "3000000001ps")");
  EXPECT_EQ(run(text).streams.at(0).sent, 4u);
}

TEST(Requirements, Latency) {
  const RequirementResult exact = judged(frames(R"({"stream": "s", "latency": "2564ns"})"));
  EXPECT_EQ(exact.verdict, Verdict::pass);
  EXPECT_EQ(exact.text, "stream s latency at most 2.564us");
  EXPECT_EQ(exact.measured->ps(), 2'564'000);
  EXPECT_EQ(exact.limit->ps(), 2'564'000);
  EXPECT_EQ(judged(frames(R"({"stream": "s", "latency": "2563999ps"})")).verdict, Verdict::fail);
}

TEST(Requirements, Jitter) {
  EXPECT_EQ(judged(frames(R"({"stream": "s", "jitter": "0s"})")).verdict, Verdict::pass);
  const std::string jittery = R"(network.nodes.b.os={"receive": {"uniform": {"from": "1us", "to": "3us"}}})";
  const auto resolved =
      sound(frames(R"({"stream": "s", "jitter": "10ns"}, {"stream": "s", "jitter": "2us"})"), {jittery});
  LiveRun live(*resolved);
  live.advance();
  const RunResult result = evaluation::evaluate(live, false);
  EXPECT_EQ(result.requirements[0].verdict, Verdict::fail);
  EXPECT_EQ(result.requirements[1].verdict, Verdict::pass);
  EXPECT_EQ(result.verdict, Verdict::fail);
}

TEST(Requirements, DeliveredAndDropped) {
  // The frame of 10 ms is produced but not yet delivered.
  EXPECT_EQ(judged(frames(R"({"stream": "s", "delivered": 10})")).verdict, Verdict::pass);
  EXPECT_EQ(judged(frames(R"({"stream": "s", "delivered": 11})")).verdict, Verdict::fail);
  EXPECT_EQ(judged(frames(R"({"stream": "s", "dropped": 0})")).verdict, Verdict::pass);
  // A queue of one frame loses two of each burst of four: one is being sent, one waits.
  const std::string burst = over_one_switch(
      R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "burst": {"frames": 4, "every": "6ms"}}], "require": [{"stream": "s", "dropped": %}])");
  const auto with = [&](const char* limit) {
    std::string text = burst;
    return text.replace(text.find('%'), 1, limit)
        .insert(text.find(R"("kind": "host"})") + 14, R"(, "queues": {"frames": 1})");
  };
  EXPECT_EQ(judged(with("4")).verdict, Verdict::pass);
  EXPECT_EQ(judged(with("3")).verdict, Verdict::fail);
}

TEST(Requirements, NothingDelivered) {
  const std::string text = frames(R"({"stream": "s", "latency": "1s"}, {"stream": "s", "jitter": "1s"})", "");
  const auto resolved = sound(text, {"streams.0.offset=1s"});
  LiveRun live(*resolved);
  live.advance();
  for (const RequirementResult& one : evaluation::evaluate(live, false).requirements) {
    EXPECT_EQ(one.verdict, Verdict::fail);
    EXPECT_EQ(one.remark, "nothing delivered");
    EXPECT_FALSE(one.measured);
  }
}

TEST(Requirements, Reaction) {
  const RequirementResult pass = judged(program(R"({"reaction": "start", "within": "2ms"})"));
  EXPECT_EQ(pass.verdict, Verdict::pass);
  EXPECT_EQ(pass.text, "reaction start within 2ms");
  EXPECT_EQ(pass.remark, "1 reaction");
  EXPECT_EQ(judged(program(R"({"reaction": "start", "within": "200us"})")).verdict,
            Verdict::fail);  // INIT alone takes as long
}

TEST(Requirements, AReactionThatDidNotOccurFails) {
  const RequirementResult missing = judged(program(R"({"reaction": "halt", "within": "2ms"})"));
  EXPECT_EQ(missing.verdict, Verdict::fail);
  EXPECT_EQ(missing.remark, "no such reaction");
  EXPECT_EQ(judged(program(R"({"reaction": "start", "program": "q", "within": "2ms"})")).verdict, Verdict::fail);
  EXPECT_EQ(judged(program(R"({"reaction": "start", "program": "p", "within": "2ms"})")).verdict, Verdict::pass);
}

TEST(Requirements, AnIncompleteReactionFails) {
  const RequirementResult incomplete = judged(
      program(R"({"reaction": "start", "within": "2ms"})", R"({"at": "9.9ms", "program": "p", "call": "Start"})"));
  EXPECT_EQ(incomplete.verdict, Verdict::fail);
  EXPECT_EQ(incomplete.remark, "1 of 1 not complete at the end");
}

// As with frames that are under way: beside one that is complete, one that is younger than the limit at the end is no
// failure; one that is older is.
TEST(Requirements, AYoungReactionIsNoFailure) {
  const std::string calls =
      R"({"at": "1ms", "program": "p", "call": "Start"}, {"at": "5ms", "program": "p", "call": "Halt"}, {"at": "7ms", "program": "p", "call": "Reset"}, {"at": "9.9ms", "program": "p", "call": "Start"})";
  const RequirementResult young = judged(program(R"({"reaction": "start", "within": "2ms"})", calls));
  EXPECT_EQ(young.verdict, Verdict::pass);
  EXPECT_EQ(young.remark, "1 of 2 not complete at the end");
  const RequirementResult old = judged(
      program(R"({"reaction": "start", "within": "99us"})", R"({"at": "9.9ms", "program": "p", "call": "Start"})"));
  EXPECT_EQ(old.verdict, Verdict::fail);
  EXPECT_EQ(old.measured, 100_us);
}

TEST(Requirements, EveryProgramKeepsItsInvariants) {
  const RunResult result = run(program(""));
  ASSERT_EQ(result.requirements.size(), 2u);
  EXPECT_EQ(result.requirements[0].text, "program p keeps S1 to S5");
  EXPECT_EQ(result.verdict, Verdict::pass);
}

// After an interruption only what has failed is decided.
TEST(Requirements, OfAPartialRunStayOpen) {
  const std::string text = frames(R"({"stream": "s", "latency": "3us"}, {"stream": "s", "delivered": 10})");
  const RunResult open = run(text, 12);
  ASSERT_TRUE(open.partial);
  EXPECT_EQ(open.verdict, Verdict::undecided);
  EXPECT_EQ(open.requirements[0].verdict, Verdict::undecided);
  EXPECT_EQ(open.requirements[1].verdict, Verdict::undecided);
  EXPECT_EQ(run(frames(R"({"stream": "s", "latency": "1us"})"), 12).verdict, Verdict::fail);
}

}  // namespace
}  // namespace takt::scenario::test::requirements_test
