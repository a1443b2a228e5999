// SPDX-License-Identifier: Apache-2.0
// Distributions, and what counts as an answer and as a round trip.
#include "node/statistics.hpp"

#include <gtest/gtest.h>

namespace takt::node::statistics_test {
namespace {

TEST(Distribution, ExtremesAndMeanAreExact) {
  Distribution distribution;
  for (const std::int64_t ns : {5, 1000, 20, 1'000'000'000}) distribution.add(ns);
  EXPECT_EQ(distribution.count(), 4u);
  EXPECT_EQ(distribution.least(), 5);
  EXPECT_EQ(distribution.greatest(), 1'000'000'000);
  EXPECT_EQ(distribution.mean(), (5 + 1000 + 20 + 1'000'000'000) / 4);
}

TEST(Distribution, PercentilesToAnEighth) {
  Distribution distribution;
  for (std::int64_t ns = 1; ns <= 10'000; ++ns) distribution.add(ns);
  for (const double percent : {1.0, 50.0, 90.0, 99.0}) {
    const double exact = 100 * percent;
    EXPECT_GE(static_cast<double>(distribution.percentile(percent)), exact);
    EXPECT_LE(static_cast<double>(distribution.percentile(percent)), exact * 1.125 + 1);
  }
  EXPECT_EQ(distribution.percentile(100), 10'000);
}

TEST(Distribution, EveryValueHasABucket) {
  for (int power = 0; power < 63; ++power) {
    Distribution distribution;
    distribution.add(std::int64_t{1} << power);
    EXPECT_EQ(distribution.percentile(99), std::int64_t{1} << power);
  }
  Distribution early;
  early.add(-5);
  EXPECT_EQ(early.least(), -5);
  EXPECT_EQ(early.percentile(50), -5);
}

sim::LocalTime at_us(std::int64_t us) { return sim::LocalTime::from_ps(us * 1'000'000); }

handshake::Word word(std::uint32_t number) {
  handshake::Word made;
  made.intent.number = number;
  return made;
}

TEST(PeerWatch, AnAnswerIsTheFirstMessageBehindAPublishing) {
  PeerWatch watch(2);
  watch.heard(0, word(0), at_us(5));  // nothing was asked yet
  watch.published(word(0), at_us(10));
  watch.heard(0, word(0), at_us(13));
  watch.heard(0, word(0), at_us(14));
  watch.published(word(0), at_us(20));
  watch.heard(0, word(0), at_us(21));
  watch.heard(1, word(0), at_us(22));  // since 10: it had not answered
  EXPECT_EQ(watch.peers()[0].answer.count(), 2u);
  EXPECT_EQ(watch.peers()[0].answer.least(), 1000);
  EXPECT_EQ(watch.peers()[0].answer.greatest(), 3000);
  EXPECT_EQ(watch.peers()[1].answer.mean(), 12'000);
  EXPECT_EQ(watch.peers()[0].round_trip.count(), 0u) << "no intent was new";
}

TEST(PeerWatch, ARoundTripEndsWithTheFirstWordThatHoldsTheIntent) {
  PeerWatch watch(1);
  watch.published(word(1), at_us(10));
  watch.heard(0, word(0), at_us(11));
  watch.published(word(1), at_us(20));
  watch.heard(0, word(1), at_us(25));
  watch.heard(0, word(1), at_us(35));
  ASSERT_EQ(watch.peers()[0].round_trip.count(), 1u);
  EXPECT_EQ(watch.peers()[0].round_trip.mean(), 15'000);
}

TEST(PeerWatch, AnIntentThatThePeerBroughtHasNoRoundTrip) {
  PeerWatch watch(1);
  watch.heard(0, word(3), at_us(5));
  watch.published(word(3), at_us(10));
  watch.heard(0, word(3), at_us(15));
  EXPECT_EQ(watch.peers()[0].round_trip.count(), 0u);
}

}  // namespace
}  // namespace takt::node::statistics_test
