// SPDX-License-Identifier: Apache-2.0
#include "models/fault/loss_models.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdint>

namespace takt::models {
namespace {

using sim::RandomStream;
using sim::operator""_B;

constexpr Probability certain = Probability::ratio(1, 1);
constexpr Probability impossible;
RandomStream chance(std::uint64_t seed = 1) { return {seed, "link", "loss"}; }
long double real(Probability p) { return std::ldexp(static_cast<long double>(p.multiple()), -63); }

template <class Question>
std::int64_t count(std::int64_t frames, Question&& question) {
  std::int64_t yes = 0;
  for (std::int64_t i = 0; i < frames; ++i) yes += question() ? 1 : 0;
  return yes;
}

TEST(Probability, RatiosAreRoundedToTheNearest) {
  EXPECT_EQ(Probability::ratio(0, 7), impossible);
  EXPECT_EQ(certain.multiple(), Probability::one);
  EXPECT_EQ(Probability::ratio(1, 2).multiple(), std::uint64_t{1} << 62);
  EXPECT_EQ(Probability::ratio(1, 3).multiple(), 3'074'457'345'618'258'603u);  // 2^63 / 3 = ...602.67
  EXPECT_EQ(Probability::ratio(~0ULL, ~0ULL), certain);
  EXPECT_EQ(Probability::ratio(1, 4).complement(), Probability::ratio(3, 4));
  EXPECT_THROW(Probability::ratio(2, 1), sim::InvariantBroken);
  EXPECT_THROW(Probability::ratio(0, 0), sim::InvariantBroken);
}

TEST(Probability, TheEndsAreExact) {
  RandomStream stream = chance();
  EXPECT_EQ(count(10'000, [&] { return certain.occurs(stream); }), 10'000);
  EXPECT_EQ(count(10'000, [&] { return impossible.occurs(stream); }), 0);
}

// 10^6 frames at 1 %: mean 10000, standard deviation 99.5; the seed is fixed, so this either always holds or never.
TEST(IndependentLoss, LosesItsShare) {
  RandomStream stream = chance();
  IndependentLoss model{Probability::ratio(1, 100)};
  EXPECT_NEAR(static_cast<double>(count(1'000'000, [&] { return model.lost(stream); })), 10'000, 400);
}

TEST(GilbertElliott, CertainTransitionsAlternate) {
  RandomStream stream = chance();
  GilbertElliottLoss model{certain, certain, impossible, certain};
  for (int i = 0; i < 100; ++i) EXPECT_EQ(model.lost(stream), i % 2 == 0) << i;  // good -> bad with the first frame
  GilbertElliottLoss stuck{certain, impossible, impossible, certain};
  EXPECT_EQ(count(100, [&] { return stuck.lost(stream); }), 100);
  EXPECT_TRUE(stuck.bad);
  GilbertElliottLoss always_good{impossible, certain, impossible, certain};
  EXPECT_EQ(count(100, [&] { return always_good.lost(stream); }), 0);
}

// good_to_bad 1 %, bad_to_good 20 %: bad for 1/21 of the frames, spells of 5 frames; losses only in bad.
TEST(GilbertElliott, SharesAndBursts) {
  RandomStream stream = chance();
  GilbertElliottLoss model{Probability::ratio(1, 100), Probability::ratio(1, 5), impossible, certain};
  constexpr std::int64_t frames = 1'000'000;
  std::int64_t lost_frames = 0, bursts = 0;
  bool before = false;
  for (std::int64_t i = 0; i < frames; ++i) {
    const bool now = model.lost(stream);
    lost_frames += now ? 1 : 0;
    bursts += now && !before ? 1 : 0;
    before = now;
  }
  EXPECT_NEAR(static_cast<double>(lost_frames), frames / 21.0, 1'500);
  EXPECT_NEAR(static_cast<double>(lost_frames) / static_cast<double>(bursts), 5.0, 0.15);
}

// Common random numbers: whatever the probabilities, each model leaves the stream at the same place.
TEST(LossModels, DrawsDoNotDependOnProbabilities) {
  const auto after = [](LossModel model) {
    RandomStream stream = chance();
    for (int i = 0; i < 100; ++i) static_cast<void>(lost(model, stream));
    return stream.next();
  };
  const std::uint64_t independent = after(IndependentLoss{impossible});
  EXPECT_EQ(after(IndependentLoss{certain}), independent);
  EXPECT_EQ(after(IndependentLoss{Probability::ratio(1, 3)}), independent);
  const std::uint64_t bursts = after(GilbertElliottLoss{});
  EXPECT_EQ(after(GilbertElliottLoss{Probability::ratio(1, 3), Probability::ratio(1, 2), certain, impossible}), bursts);
  EXPECT_NE(independent, bursts);  // one draw, two draws
}

TEST(LossModels, MoreProbableLosesTheSameFramesAndMore) {
  RandomStream rare_stream = chance(), often_stream = chance();
  IndependentLoss rare{Probability::ratio(1, 50)}, often{Probability::ratio(1, 10)};
  for (int i = 0; i < 10'000; ++i) {
    const bool rarely = rare.lost(rare_stream);
    const bool often_lost = often.lost(often_stream);
    EXPECT_TRUE(!rarely || often_lost);
  }
}

TEST(Corruption, PerFrameIgnoresTheLength) {
  Corruption corruption = Corruption::per_frame(Probability::ratio(1, 4));
  EXPECT_EQ(corruption.probability(64_B), Probability::ratio(1, 4));
  EXPECT_EQ(corruption.probability(1522_B), Probability::ratio(1, 4));
  Corruption none;
  RandomStream stream = chance();
  EXPECT_FALSE(none.corrupts(1522_B, stream));
}

// 1 - (1 - 1/2)^8 = 255/256, exactly.
TEST(Corruption, PerBitByHand) {
  EXPECT_EQ(Corruption::per_bit(Probability::ratio(1, 2)).probability(1_B), Probability::ratio(255, 256));
  EXPECT_EQ(Corruption::per_bit(certain).probability(1_B), certain);
  EXPECT_EQ(Corruption::per_bit(impossible).probability(1522_B), impossible);
}

TEST(Corruption, PerBitAgreesWithLogarithms) {
  const bool agrees = rc::check("1 - (1 - ber)^n within 2^-48", [] {
    const auto denominator = *rc::gen::inRange<std::uint64_t>(2, 1'000'000'000'000'000);
    const auto length = *rc::gen::inRange<std::uint32_t>(1, 2'000);
    const Probability rate = Probability::ratio(1, denominator);
    const long double expected = -std::expm1(8.0L * length * std::log1p(-real(rate)));
    Corruption corruption = Corruption::per_bit(rate);
    RC_ASSERT(std::fabs(real(corruption.probability({length})) - expected) < std::ldexp(1.0L, -48));
    RC_ASSERT(corruption.probability({length}) == corruption.probability({length}));  // the remembered answer
  });
  EXPECT_TRUE(agrees);
}

TEST(Duplication, OneDrawAFrame) {
  RandomStream stream = chance(), other = chance();
  EXPECT_TRUE(Duplication{certain}.duplicates(stream));
  EXPECT_FALSE(Duplication{}.duplicates(stream));
  other.next(), other.next();
  EXPECT_EQ(stream.next(), other.next());
}

}  // namespace
}  // namespace takt::models
