// SPDX-License-Identifier: Apache-2.0
// Random scenarios on 2, 3, 4 and 8 threads, divided at random, beside one thread: results, and all that can be
// recorded.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/division/divided_run.hpp"
#include "tests/generator/generated.hpp"
#include "tests/presentation/output/recorded_run.hpp"
#include "tests/support/case_count.hpp"

namespace takt::generator {
namespace {

std::string result_of(const scenario::Run& run) { return results::run_json(evaluation::evaluate(run, false)); }

/// What makes recordings of some hundred megabytes is left to others.
constexpr std::uint64_t most_events_to_record = 300'000;

// TAKT_DIVIDED=1000: so many scenarios of more than one part instead.
TEST(GeneratedScenarios, HaveTheResultOfOneThread) {
  const std::uint64_t count = support::case_count("TAKT_DIVIDED", 12);
  constexpr std::array<unsigned, 4> threads = {2, 3, 4, 8};
  std::array<std::uint64_t, 9> runs_in_parts = {};
  std::uint64_t divided = 0, recorded = 0;
  for (std::uint64_t number = 100'000; divided < count; ++number) {
    const Generated made = generate(number);
    ASSERT_TRUE(made.resolved) << number << ": " << made.problem;
    const scenario::Resolved& resolved = *made.resolved;
    if (!scenario::divide_at_random(resolved, 2, number).is_divided()) continue;
    ++divided;
    scenario::Run whole(resolved);
    whole.advance();
    const std::string expected = result_of(whole);
    for (const unsigned each : threads) {
      const scenario::Division division = scenario::divide_at_random(resolved, each, number + each);
      // With another order of equal events it is the same run, told of one instant in another order.
      const bool is_shuffled = number % 2 != 0;
      scenario::DividedRun run(resolved, division, is_shuffled ? number : 0);
      run.advance(run.end());
      ++runs_in_parts[division.parts];
      ASSERT_EQ(run.gathered().simulation().digest().value(), whole.simulation().digest().value())
          << "takt_soak --show " << number << ", " << division.parts << " parts";
      if (is_shuffled) continue;
      ASSERT_EQ(result_of(run.gathered()), expected)
          << "takt_soak --show " << number << ", " << division.parts << " parts";
    }
    if (whole.simulation().event_count() > most_events_to_record) continue;
    ++recorded;
    const std::uint64_t shuffle = number % 3 == 0 ? number : 0;
    const scenario::Division division =
        scenario::divide_at_random(resolved, threads[number % threads.size()], number + 99);
    const output::RecordingOptions all = output::test::all_of(resolved);
    const output::test::Files files = output::test::recorded_whole(resolved, all, shuffle);
    ASSERT_EQ(files.at("digest"), std::to_string(whole.simulation().digest().value()))
        << "takt_soak --show " << number << ", recorded";
    ASSERT_EQ(output::test::difference(files, output::test::recorded_divided(resolved, division, all, shuffle)), "")
        << "takt_soak --show " << number << ", " << division.parts << " parts, recorded";
  }
  // Most networks have few nodes that may be apart.
  EXPECT_GT(recorded, count / 2);
  EXPECT_GT(runs_in_parts[2] + runs_in_parts[3] + runs_in_parts[4], count);
  for (unsigned parts = 1; parts <= 8; ++parts)
    RecordProperty("in_" + std::to_string(parts) + "_parts", std::to_string(runs_in_parts[parts]));
}

}  // namespace
}  // namespace takt::generator
