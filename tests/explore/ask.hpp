// How the tests of the explorer ask.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <span>

#include "explore/report/report.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {

/// The question with so many calls, and a fault budget of 1 for these.
inline Question with(Question question, std::uint32_t commands, std::span<const Fault> faults) {
  question.commands = commands;
  for (const Fault each : faults) question.faults.insert(each);
  return question;
}

inline Answer ask(const Question& question) {
  return explore(question, [](const Progress&) { return true; });
}

/// All is searched and holds, and it is as large as it has always been.
struct Case {
  Question question;
  std::uint64_t states = 0;
  std::uint64_t transitions = 0;
};
inline Answer expect_to_hold(const Case& each) {
  SCOPED_TRACE(question_line(each.question));
  const Answer answer = ask(each.question);
  EXPECT_TRUE(answer.exhausted && answer.all_hold()) << text_report(each.question, answer, 0.0);
  EXPECT_EQ(answer.states, each.states);
  EXPECT_EQ(answer.transitions, each.transitions);
  return answer;
}

}  // namespace takt::explore
