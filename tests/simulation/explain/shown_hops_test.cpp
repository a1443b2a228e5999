// SPDX-License-Identifier: Apache-2.0
// A way of hundreds of hops: those at which the frame waited, and sums of the others.
#include "explain/shown_hops.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace takt::explain::shown_hops_test {
namespace {

using sim::Duration;

constexpr Duration us(std::int64_t n) { return Duration::from_ps(n * 1'000'000); }

ExplainedPart part(Cause cause, Duration takes) {
  ExplainedPart made;
  made.cause = name_of(cause);
  made.words = words_of(cause);
  made.takes = takes;
  return made;
}

/// n hops of 12 us each (10 of transmission, 1 of cable, 1 of forwarding); at hop i the frame also waits for waits(i),
/// behind frame i of its own class.
template <class Waits>
ExplainedFrame way(std::size_t n, Waits waits) {
  ExplainedFrame frame;
  frame.stream = "far";
  frame.talker = "h";
  frame.end = "delivered";
  frame.node = "to";
  for (std::size_t i = 0; i < n; ++i) {
    ExplainedHop hop;
    hop.node = i == 0 ? "h" : "sw" + std::to_string(i);
    hop.port = 1;
    hop.to = i + 1 == n ? "to" : "sw" + std::to_string(i + 1);
    if (const Duration wait = waits(i); wait > Duration()) {
      hop.parts.push_back(part(Cause::own_class, wait));
      hop.parts.back().stream = "far";
      hop.parts.back().sequence = i;
    }
    for (const ExplainedPart& each :
         {part(Cause::transmission, us(10)), part(Cause::cable, us(1)), part(Cause::forwarding, us(1))})
      hop.parts.push_back(each);
    frame.takes += hop.takes();
    frame.hops.push_back(std::move(hop));
  }
  return frame;
}

Duration sum_of(const std::vector<ShownHop>& shown) {
  Duration sum;
  for (const ShownHop& each : shown) sum += each.hop.takes();
  return sum;
}

std::size_t hops_of(const std::vector<ShownHop>& shown) {
  std::size_t sum = 0;
  for (const ShownHop& each : shown) sum += each.count;
  return sum;
}

TEST(ShownHops, AllOfAShortWay) {
  const ExplainedFrame frame = way(most_hops, [](std::size_t i) { return us(static_cast<std::int64_t>(i)); });
  const auto shown = shown_hops(frame);
  ASSERT_EQ(shown.size(), most_hops);
  EXPECT_TRUE(std::ranges::all_of(shown, [](const ShownHop& each) { return each.count == 1; }));
  EXPECT_EQ(sum_of(shown), frame.takes);
}

// 250 hops; the frame waits at 100 for 5 us and at 101 for 7 us: h to sw100 in 100 hops of 12 us, these two, 147 hops,
// and the last one.
TEST(ShownHops, HopsWithoutAWaitAreSums) {
  const ExplainedFrame frame = way(250, [](std::size_t i) { return i == 100 ? us(5) : i == 101 ? us(7) : Duration(); });
  const auto shown = shown_hops(frame);
  ASSERT_EQ(shown.size(), 5u);
  std::vector<std::size_t> counts;
  for (const ShownHop& each : shown) counts.push_back(each.count);
  EXPECT_EQ(counts, (std::vector<std::size_t>{100, 1, 1, 147, 1}));
  ASSERT_EQ(shown[0].hop.parts.size(), 3u);
  EXPECT_EQ(shown[0].hop.parts[0].takes, us(1000));
  EXPECT_EQ(shown[0].place_of(shown[0].hop.parts[0]), "h:1 to sw100, 100 hops");
  EXPECT_EQ(shown[1].place_of(shown[1].hop.parts[1]), "sw100:1 to sw101");
  EXPECT_EQ(shown[1].hop.parts[0].sequence, 100u);
  EXPECT_EQ(shown[3].place_of(shown[3].hop.parts[0]), "sw102:1 to sw249, 147 hops");
  EXPECT_EQ(sum_of(shown), frame.takes);
}

// It waits everywhere: the twelve greatest waits are those of the last hops but the last one, which stands by itself in
// any case.
TEST(ShownHops, OfManyWaitsTheGreatest) {
  const ExplainedFrame frame = way(300, [](std::size_t i) { return us(static_cast<std::int64_t>(i) + 1); });
  const auto shown = shown_hops(frame);
  EXPECT_EQ(hops_of(shown), 300u);
  EXPECT_EQ(sum_of(shown), frame.takes);
  ASSERT_EQ(shown.size(), 13u) << "288 hops, and twelve";
  EXPECT_EQ(shown[0].count, 288u);
  const ExplainedPart& wait = shown[0].hop.parts[0];
  EXPECT_EQ(wait.takes, us(288 * 289 / 2));
  EXPECT_FALSE(wait.stream || wait.sequence) << "a sum is behind no single frame";
  // Every second hop: sums of one hop are that hop.
  const ExplainedFrame other = way(60, [](std::size_t i) { return i % 2 == 1 && i < 24 ? us(100) : Duration(); });
  const auto alternating = shown_hops(other);
  EXPECT_EQ(hops_of(alternating), 60u);
  EXPECT_EQ(sum_of(alternating), other.takes);
  EXPECT_EQ(alternating[2].count, 1u);
  EXPECT_EQ(alternating[2].hop.node, "sw2");
}

TEST(ShownHops, TheTextIsShort) {
  Explanation explanation;
  explanation.frames.push_back(way(250, [](std::size_t i) { return i % 10 == 0 ? us(3) : Duration(); }));
  const std::string text = text_of(explanation);
  EXPECT_LT(std::ranges::count(text, '\n'), 100);
  EXPECT_NE(text.find("250 hops"), std::string::npos);
  explanation.frames[0] = way(5, [](std::size_t) { return us(1); });
  EXPECT_EQ(text_of(explanation).find("hops"), std::string::npos);
}

}  // namespace
}  // namespace takt::explain::shown_hops_test
