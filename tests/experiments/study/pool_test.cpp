// SPDX-License-Identifier: Apache-2.0
// Worker processes: answers come back, crashes stay where they are.
#include "study/pool.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <map>
#include <stdexcept>

#include "study/cpu_time.hpp"

namespace takt::study {
namespace {

std::map<std::uint64_t, Answer> run(Pool& pool, std::uint64_t jobs) {
  std::map<std::uint64_t, Answer> answers;
  std::uint64_t next = 0;
  const std::string problem =
      pool.run([&]() -> std::optional<std::uint64_t> { return next < jobs ? std::optional(next++) : std::nullopt; },
               [&](std::uint64_t job, const Answer& answer) { return answers.emplace(job, answer).second; },
               [] { return true; });
  EXPECT_EQ(problem, "");
  return answers;
}

const JobLimits roomy{sim::Duration::from_ps(60'000'000'000'000), std::uint64_t{1} << 30};

TEST(Pool, EveryJobIsAnsweredOnce) {
  for (const unsigned jobs : {1u, 2u, 5u}) {
    Pool pool(jobs, roomy, [](std::uint64_t job) { return std::string(job * 1000, 'x') + std::to_string(job); });
    const auto answers = run(pool, 40);
    ASSERT_EQ(answers.size(), 40u);
    for (const auto& [job, answer] : answers)
      EXPECT_EQ(answer.text, std::string(job * 1000, 'x') + std::to_string(job));
  }
}

TEST(Pool, ACrashIsAnAnswer) {
  Pool pool(2, roomy, [](std::uint64_t job) -> std::string {
    if (job == 3) std::raise(SIGSEGV);
    if (job == 5) throw std::runtime_error("broken");
    if (job == 7) ::_exit(9);
    return "fine";
  });
  auto answers = run(pool, 10);
  ASSERT_EQ(answers.size(), 10u);
  EXPECT_EQ(answers[3].kind, Answer::Kind::died);
  EXPECT_NE(answers[3].text.find("signal 11"), std::string::npos) << answers[3].text;
  EXPECT_EQ(answers[5].text, "broken");
  EXPECT_NE(answers[7].text.find("status 9"), std::string::npos) << answers[7].text;
  EXPECT_EQ(answers[8].text, "fine");
  EXPECT_EQ(answers[9].kind, Answer::Kind::answered);
}

TEST(Pool, TooMuchTimeIsAnAnswer) {
  Pool pool(1, {sim::Duration::from_ps(50'000'000'000), std::uint64_t{1} << 30}, [](std::uint64_t job) {
    volatile bool goes_on = job == 1;
    while (goes_on) {
    }
    return std::string("fine");
  });
  auto answers = run(pool, 3);
  EXPECT_EQ(answers[1].kind, Answer::Kind::too_long);
  EXPECT_NE(answers[1].text.find("0.05 s"), std::string::npos) << answers[1].text;
  EXPECT_EQ(answers[2].text, "fine");
}

// Linux brings the clock of a process up to date with its ticks only while a limit of its CPU time is set; a point is
// told its time to the microsecond.
TEST(Pool, TheTimeOfAShortJobIsSeenThoughItIsLimited) {
  Pool pool(1, roomy, [](std::uint64_t) {
    const auto thread_us = [] {
      timespec now{};
      ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000 + static_cast<std::uint64_t>(now.tv_nsec) / 1000;
    };
    // Asking for the time of the thread brings that of the process up to date as well, so it is asked outside.
    for (std::uint64_t steps = 10'000;; steps *= 2) {
      const std::uint64_t thread_began = thread_us();
      const std::uint64_t began = cpu_time_us();
      for (std::uint64_t left = steps; left > 0; --left) asm volatile("");  // the optimiser leaves it
      const std::uint64_t took = cpu_time_us() - began;
      const std::uint64_t thread_took = thread_us() - thread_began;
      if (thread_took >= 500)
        return std::string(2 * took >= thread_took
                               ? "seen"
                               : "only " + std::to_string(took) + " us of " + std::to_string(thread_took));
    }
  });
  for (const auto& [job, answer] : run(pool, 20)) EXPECT_EQ(answer.text, "seen") << job;
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(Pool, TooMuchMemoryIsAnAnswer) {
  Pool pool(1, {roomy.cpu, std::uint64_t{64} << 20}, [](std::uint64_t job) {
    std::string much;
    if (job == 1) much.resize(std::size_t{500} << 20, 'x');
    return std::to_string(much.size());
  });
  auto answers = run(pool, 3);
  EXPECT_EQ(answers[0].text, "0");
  EXPECT_EQ(answers[1].kind, Answer::Kind::too_large);
  EXPECT_EQ(answers[2].text, "0");
}
#endif

TEST(Pool, EndsWhenIdleSaysSo) {
  Pool pool(2, roomy, [](std::uint64_t) { return std::string(); });
  std::uint64_t answers = 0;
  pool.run([]() -> std::optional<std::uint64_t> { return 1; },
           [&](std::uint64_t, const Answer&) { return ++answers < 5; }, [] { return true; });
  EXPECT_EQ(answers, 5u);
}

}  // namespace
}  // namespace takt::study
