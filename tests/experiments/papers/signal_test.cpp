// SPDX-License-Identifier: Apache-2.0
// What is measured at a digital signal, from signals whose figures are known.
#include "papers/coexistence/signal.hpp"

#include <gtest/gtest.h>

namespace takt::papers::coexistence {
namespace {

using namespace sim::literals;
using sim::TrueTime;

TrueTime at(std::int64_t us) { return TrueTime() + sim::Duration::from_ps(us * 1'000'000); }

std::vector<SignalEdge> edges_at(const std::vector<std::int64_t>& us) {
  std::vector<SignalEdge> edges;
  for (const std::int64_t time : us) edges.push_back({at(time), edges.size() % 2 == 0});
  return edges;
}

TEST(Signal, ACleanOne) {
  const SignalStatistics s = measure(edges_at({0, 1000, 2000, 3000, 4000}), 1_ms, at(0), at(4000));
  EXPECT_EQ(s.pulses, 4u);
  EXPECT_DOUBLE_EQ(s.expected, 4);
  EXPECT_DOUBLE_EQ(s.pulse_mean, 1);
  EXPECT_DOUBLE_EQ(s.pulse_deviation, 0);
  EXPECT_DOUBLE_EQ(s.period_mean, 2);
  EXPECT_DOUBLE_EQ(s.irregular, 0);
}

// Pulses of 1, 1.6, 0.4 and 3 intervals: three are off by more than a half, and so by more than a tenth.
TEST(Signal, AnIrregularOne) {
  const SignalStatistics s = measure(edges_at({0, 1000, 2600, 3000, 6000}), 1_ms, at(0), at(6000));
  EXPECT_EQ(s.pulses, 4u);
  EXPECT_DOUBLE_EQ(s.expected, 6);
  EXPECT_DOUBLE_EQ(s.irregular, 0.75);
  EXPECT_DOUBLE_EQ(s.pulse_mean, 1.5);
  EXPECT_DOUBLE_EQ(s.pulse_least, 0.4);
  EXPECT_DOUBLE_EQ(s.pulse_greatest, 3);
  EXPECT_DOUBLE_EQ(s.period_mean, 3);  // 2.6 and 3.4
}

TEST(Signal, AHalfIsNotMoreThanAHalf) {
  const SignalStatistics s = measure(edges_at({0, 1500, 2550}), 1_ms, at(0), at(3000));
  EXPECT_DOUBLE_EQ(s.irregular, 0);
  EXPECT_DOUBLE_EQ(s.off_by_a_tenth, 0.5) << "1.5 is, 1.05 is not";
}

TEST(Signal, OnlyWhatLiesWithin) {
  const SignalStatistics s = measure(edges_at({0, 1000, 5000, 6000, 7000, 9000}), 1_ms, at(5000), at(7000));
  EXPECT_EQ(s.pulses, 2u);
  EXPECT_DOUBLE_EQ(s.irregular, 0);
  EXPECT_EQ(measure({}, 1_ms, at(0), at(1)).pulses, 0u);
}

TEST(Reactions, FirstEdgeOfTheCommandedLevel) {
  // High at 0, low at 100, high at 200: answered after 5, not at all, and at 207, after a spurious fall.
  const std::vector<TrueTime> commands = {at(0), at(100), at(200), at(300)};
  const std::vector<SignalEdge> edges = {{at(5), true}, {at(204), false}, {at(207), true}, {at(311), false}};
  const ReactionTimes made = reactions(commands, edges, at(0), at(400));
  EXPECT_EQ(made.commands, 3u) << "the last has no end";
  EXPECT_EQ(made.answered, 2u);
  EXPECT_EQ(made.mean, 6_us);
  EXPECT_EQ(made.greatest, 7_us);
}

TEST(ValueChangeDump, EdgesInNanoseconds) {
  const std::string text = value_change_dump(edges_at({2, 7}), at(10));
  EXPECT_NE(text.find("#2000\n1!\n#7000\n0!\n#10000\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace takt::papers::coexistence
