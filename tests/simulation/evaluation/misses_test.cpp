// SPDX-License-Identifier: Apache-2.0
// Misses in a row: of sequences by hand, of frames that a link loses or that come late, of reactions.
#include "evaluation/misses.hpp"

#include "evaluation/evaluate.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario::test::misses_test {
namespace {

using evaluation::Misses;
using evaluation::misses_of;
using results::RequirementResult;
using results::Verdict;

TEST(Misses, RowsAndWindowsOfASequence) {
  const std::vector<bool> missed = {false, true, true, false, true, false, false, true};
  const Misses found = misses_of(missed, 3);
  EXPECT_EQ(found.in_a_row, 2u);
  EXPECT_EQ(found.in_window, 2u) << "1 1 0, and 1 0 1";
  EXPECT_EQ(found.missed, 4u);
  EXPECT_EQ(found.counted, 8u);
  EXPECT_EQ(misses_of(missed, 4).in_window, 3u) << "1 1 0 1";
  EXPECT_EQ(misses_of(missed, 100).in_window, 4u) << "a sequence that is shorter than the window";
  EXPECT_EQ(misses_of({}, 3).in_a_row, 0u);
  EXPECT_EQ(misses_of({true, true, true}, 2).in_window, 2u);
}

results::RunResult judged(const std::string& text) {
  const auto resolved = sound(text);
  LiveRun live(*resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}

/// Frames are produced at 0, 1 ... 10 ms, take 2.564 us, and that of 10 ms is under way at the end (judges_test.cpp).
std::string frames(const std::string& require, const std::string& more = {}) {
  return over_one_switch(
      R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}], "require": [)" +
      require + "]" + more);
}
/// Those of 3, 4 and 5 ms are lost.
constexpr const char* cut = R"(, "faults": [{"kind": "link-down", "link": ["sw", "b"], "at": "2500us", "for": "3ms"}])";

struct Expected {
  const char* requirement;
  Verdict verdict;
  double found;
};

TEST(Misses, FramesThatALinkLoses) {
  for (const Expected& each : {Expected{R"({"stream": "s", "lost_in_a_row": 3})", Verdict::pass, 3},
                               Expected{R"({"stream": "s", "lost_in_a_row": 2})", Verdict::fail, 3},
                               Expected{R"({"stream": "s", "met": 7, "of": 10})", Verdict::pass, 7},
                               Expected{R"({"stream": "s", "met": 8, "of": 10})", Verdict::fail, 7},
                               Expected{R"({"stream": "s", "met": 1, "of": 4})", Verdict::pass, 1},
                               Expected{R"({"stream": "s", "deadline": "1ms", "late_in_a_row": 3})", Verdict::pass, 3},
                               Expected{R"({"stream": "s", "lost_in_a_row": 1, "after": "4500us"})", Verdict::pass, 1},
                               Expected{R"({"stream": "s", "lost_in_a_row": 0, "after": "6ms"})", Verdict::pass, 0}}) {
    const RequirementResult found = judged(frames(each.requirement, cut)).requirements.at(0);
    EXPECT_EQ(found.verdict, each.verdict) << each.requirement << ": " << found.remark;
    ASSERT_TRUE(found.figure);
    EXPECT_EQ(found.figure->found, each.found) << each.requirement;
  }
}

// Ten frames come, each after 2.564 us. That of 10 ms has only begun.
TEST(Misses, FramesThatComeLate) {
  EXPECT_EQ(judged(frames(R"({"stream": "s", "deadline": "2564ns", "late_in_a_row": 0})")).requirements.at(0).verdict,
            Verdict::pass);
  const RequirementResult late =
      judged(frames(R"({"stream": "s", "deadline": "2563ns", "late_in_a_row": 9})")).requirements.at(0);
  EXPECT_EQ(late.verdict, Verdict::fail);
  EXPECT_EQ(late.figure->found, 10);
  EXPECT_EQ(late.figure->name, "late in a row");
}

// Losses that a limit allows do not break a latency beside it.
TEST(Misses, SayHowManyFramesMayBeLost) {
  EXPECT_EQ(judged(frames(R"({"stream": "s", "latency": "1ms"})", cut)).verdict, Verdict::fail);
  EXPECT_EQ(judged(frames(R"({"stream": "s", "latency": "1ms", "lost_in_a_row": 3})", cut)).verdict, Verdict::pass);
}

TEST(Misses, NothingSentMeetsNoDeadline) {
  const std::string none = frames(R"({"stream": "s", "deadline": "1ms", "late_in_a_row": 3, "after": "100ms"})");
  EXPECT_EQ(judged(none).requirements.at(0).verdict, Verdict::fail);
  EXPECT_EQ(judged(none).requirements.at(0).remark, "nothing sent");
}

TEST(Misses, OfReactions) {
  const std::string program =
      R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "initialisation": "0ms"}],
        "script": [{"at": "0ms", "program": "p", "call": "Start"}, {"at": "20ms", "program": "p", "call": "Suspend"},
                   {"at": "40ms", "program": "p", "call": "Resume"}, {"at": "60ms", "program": "p", "call": "Suspend"}],
        "require": [{"reaction": "suspend", "deadline": "10ms", "late_in_a_row": 0}, {"reaction": "suspend", "deadline": "1ns", "late_in_a_row": 1},
                    {"reaction": "suspend", "deadline": "1ns", "met": 1, "of": 2}, {"reaction": "reset", "deadline": "1ms", "late_in_a_row": 1}])";
  std::string text = over_one_switch(program);
  text.replace(text.find("10ms"), 4, "90ms");  // the duration
  const results::RunResult result = judged(text);
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::pass) << result.requirements.at(0).remark;
  EXPECT_EQ(result.requirements.at(1).verdict, Verdict::fail);
  EXPECT_EQ(result.requirements.at(1).figure->found, 2);
  EXPECT_EQ(result.requirements.at(2).figure->found, 0);
  EXPECT_EQ(result.requirements.at(3).remark, "no such reaction");
}

struct Mistake {
  const char* requirement;
  const char* message;
};

TEST(Misses, MistakesAreDiagnostics) {
  for (const Mistake& each :
       {Mistake{R"({"stream": "s", "late_in_a_row": 1})", "nothing is late without a deadline"},
        Mistake{R"({"stream": "s", "latency": "1ms", "deadline": "1ms"})", "does not belong to this requirement"},
        Mistake{R"({"stream": "s", "met": 3})", "half of a limit"},
        Mistake{R"({"stream": "s", "latency": "1ms", "of": 3})", "half of a limit"},
        Mistake{R"({"stream": "s", "met": 4, "of": 3})", "more than there are"},
        Mistake{R"({"sync": "1us", "late_in_a_row": 3})", "does not belong to this requirement"}}) {
    json::Diagnostics diagnostics;
    EXPECT_FALSE(load_text(frames(each.requirement), "test", {}, diagnostics)) << each.requirement;
    EXPECT_NE(diagnostics.to_text().find(each.message), std::string::npos) << diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::scenario::test::misses_test
