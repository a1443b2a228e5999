// SPDX-License-Identifier: Apache-2.0
#include "analysis/rational.hpp"

#include <gtest/gtest.h>

namespace takt::analysis::rational_test {
namespace {

TEST(Rational, IsInLowestTerms) {
  EXPECT_EQ(Rational(6, 8).to_text(), "3/4");
  EXPECT_EQ(Rational(6, -8).to_text(), "-3/4");
  EXPECT_EQ(Rational(-6, -3).to_text(), "2");
  EXPECT_EQ(Rational(0, -3).to_text(), "0");
}

TEST(Rational, ObeysTheLawsOfAField) {
  std::vector<Rational> some;
  for (int n = -4; n <= 4; ++n)
    for (int d = 1; d <= 4; ++d) some.push_back(Rational(n, d));
  for (const Rational& a : some)
    for (const Rational& b : some) {
      EXPECT_EQ(a + b, b + a);
      EXPECT_EQ(a * b, b * a);
      EXPECT_EQ(a - b + b, a);
      if (b != Rational()) {
        EXPECT_EQ(a / b * b, a);
      }
      EXPECT_EQ(a < b, a.to_double() < b.to_double());
      for (const Rational& c : some) {
        EXPECT_EQ((a + b) + c, a + (b + c));
        EXPECT_EQ((a * b) * c, a * (b * c));
        EXPECT_EQ(a * (b + c), a * b + a * c);
      }
    }
}

TEST(Rational, ReadsNumbersAndFractions) {
  EXPECT_EQ(Rational::parse("53.75"), Rational(215, 4));
  EXPECT_EQ(Rational::parse("575/12"), Rational(575, 12));
  EXPECT_EQ(Rational::parse("-2.5e3"), Rational(-2500));
  EXPECT_EQ(Rational::parse("1e-2"), Rational(1, 100));
  EXPECT_EQ(Rational::parse("0.1/0.3"), Rational(1, 3));
  for (const char* const wrong : {"", "-", "1/0", "a", "1.", ".5", "1e", "1/", "1 ", "1e99", "0x10"})
    EXPECT_FALSE(Rational::parse(wrong)) << wrong;
  EXPECT_FALSE(Rational::parse(std::string(60, '9')));
}

TEST(Rational, NeverWraps) {
  const Rational great(sim::int128{1} << 125, 1);
  EXPECT_THROW(great + great, RationalOverflow);
  EXPECT_THROW(great * Rational(3), RationalOverflow);
  EXPECT_EQ(great - great, Rational());
  EXPECT_EQ(great * Rational(1, 2) + great * Rational(1, 2), great);
}

}  // namespace
}  // namespace takt::analysis::rational_test
