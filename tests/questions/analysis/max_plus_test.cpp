// SPDX-License-Identifier: Apache-2.0
// The algebra's laws as properties, over random elements; then a chain by hand.
#include "analysis/max_plus.hpp"

#include <gtest/gtest.h>

#include "sim/random.hpp"

namespace takt::analysis::max_plus_test {
namespace {

MaxPlus any(sim::RandomStream& chance) {
  switch (chance.below(8)) {
    case 0:
      return MaxPlus::zero();
    case 1:
      return MaxPlus::one();
    case 2:
      return MaxPlus::unbounded();
    default:
      return MaxPlus(static_cast<Ps>(chance.below(1'000'000'000)));
  }
}

MaxPlusMatrix any(sim::RandomStream& chance, std::size_t rows, std::size_t columns) {
  MaxPlusMatrix made(rows, columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) made(i, j) = any(chance);
  return made;
}

TEST(MaxPlus, IsAnIdempotentSemiring) {
  sim::RandomStream chance(1, "max-plus", "elements");
  for (int i = 0; i < 10'000; ++i) {
    const MaxPlus a = any(chance), b = any(chance), c = any(chance);
    EXPECT_EQ(a + b, b + a);
    EXPECT_EQ((a + b) + c, a + (b + c));
    EXPECT_EQ(a + a, a);
    EXPECT_EQ(a + MaxPlus::zero(), a);
    EXPECT_EQ(a * b, b * a);
    EXPECT_EQ((a * b) * c, a * (b * c));
    EXPECT_EQ(a * MaxPlus::one(), a);
    EXPECT_EQ(a * MaxPlus::zero(), MaxPlus::zero());
    EXPECT_EQ(a * (b + c), a * b + a * c);
  }
}

TEST(MaxPlus, MatricesObeyTheSameLaws) {
  sim::RandomStream chance(2, "max-plus", "matrices");
  for (int i = 0; i < 500; ++i) {
    const std::size_t n = 1 + chance.below(12), m = 1 + chance.below(12), k = 1 + chance.below(12),
                      l = 1 + chance.below(12);
    const MaxPlusMatrix a = any(chance, n, m), b = any(chance, m, k), c = any(chance, k, l), d = any(chance, m, k);
    EXPECT_EQ((a * b) * c, a * (b * c));
    EXPECT_EQ(a * (b + d), a * b + a * d);
    EXPECT_EQ((b + d) * c, b * c + d * c);
    EXPECT_EQ(b + d, d + b);
    EXPECT_EQ(b + b, b);
    EXPECT_EQ(MaxPlusMatrix::identity(n) * a, a);
    EXPECT_EQ(a * MaxPlusMatrix::identity(m), a);
    EXPECT_EQ(a * MaxPlusMatrix(m, k), MaxPlusMatrix(n, k));
  }
}

TEST(MaxPlus, AProductIsTheSlowestWay) {
  MaxPlusMatrix a(1, 2), b(2, 1);
  a(0, 0) = MaxPlus(5);
  a(0, 1) = MaxPlus(1);
  b(0, 0) = MaxPlus(2);
  b(1, 0) = MaxPlus(7);
  EXPECT_EQ((a * b)(0, 0), MaxPlus(8));
  b(1, 0) = MaxPlus::zero();  // that way does not exist
  EXPECT_EQ((a * b)(0, 0), MaxPlus(7));
  b(1, 0) = MaxPlus::unbounded();
  EXPECT_EQ((a * b)(0, 0), MaxPlus::unbounded());
  EXPECT_EQ((a + a * MaxPlusMatrix::identity(2)).greatest(), MaxPlus(5));
}

}  // namespace
}  // namespace takt::analysis::max_plus_test
