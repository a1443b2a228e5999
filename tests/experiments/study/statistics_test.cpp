// SPDX-License-Identifier: Apache-2.0
// Against values that can be worked out by hand or stand in printed tables.
#include "study/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace takt::study {
namespace {

// 2, 4, 4, 4, 5, 5, 7, 9: sum 40, mean 5, squares of the differences 9+1+1+1+0+0+4+16 = 32, variance 32/7.
TEST(Statistics, MeanAndVarianceByHand) {
  const std::array<double, 8> values = {2, 4, 4, 4, 5, 5, 7, 9};
  const Summary summary = summary_of(values);
  EXPECT_DOUBLE_EQ(summary.mean, 5);
  EXPECT_DOUBLE_EQ(summary.variance, 32.0 / 7);
  EXPECT_EQ(summary.min, 2);
  EXPECT_EQ(summary.max, 9);
  // t(0.975, 7) = 2.364624; half width = t * sqrt(32/7/8) = 2.364624 * 0.7559289 = 1.787488
  EXPECT_NEAR(*summary.half_width, 1.787488, 1e-6);
}

TEST(Statistics, OneValueHasNoInterval) {
  EXPECT_FALSE(summary_of(std::array<double, 1>{3}).half_width);
  EXPECT_EQ(summary_of({}).count, 0u);
  EXPECT_DOUBLE_EQ(*summary_of(std::array<double, 3>{2, 2, 2}).half_width, 0);
}

// The textbook formula sum(x^2) - n mean^2 would lose all digits here.
TEST(Statistics, GreatValuesKeepTheirVariance) {
  EXPECT_NEAR(summary_of(std::array<double, 3>{1e12 + 1, 1e12 + 2, 1e12 + 3}).variance, 1, 1e-9);
}

// One and two degrees of variable have closed forms: tan(pi (p - 1/2)) and (2p - 1) / sqrt(2 p (1 - p)).
TEST(Student, ClosedForms) {
  for (const double p : {0.6, 0.9, 0.975, 0.995, 0.9995}) {
    EXPECT_NEAR(student_quantile(p, 1) / std::tan(M_PI * (p - 0.5)), 1, 1e-11) << p;
    EXPECT_NEAR(student_quantile(p, 2) / ((2 * p - 1) / std::sqrt(2 * p * (1 - p))), 1, 1e-11) << p;
    EXPECT_NEAR(student_quantile(1 - p, 2), -student_quantile(p, 2), 1e-9);
  }
}

// Printed tables of the 0.975 quantile.
TEST(Student, PrintedTable) {
  const std::array<std::pair<double, double>, 8> table = {{{1, 12.7062},
                                                           {2, 4.30265},
                                                           {4, 2.77645},
                                                           {9, 2.26216},
                                                           {19, 2.09302},
                                                           {30, 2.04227},
                                                           {120, 1.97993},
                                                           {1e6, 1.95997}}};
  for (const auto& [degrees, quantile] : table)
    EXPECT_NEAR(student_quantile(0.975, degrees), quantile, 5e-5 * quantile / 10 + 5e-6) << degrees;
}

TEST(Student, QuantileInvertsTheDistribution) {
  for (const double degrees : {1.0, 3.0, 7.5, 50.0, 1000.0})
    for (const double p : {0.01, 0.3, 0.5, 0.7, 0.999})
      EXPECT_NEAR(student_cdf(student_quantile(p, degrees), degrees), p, 1e-12) << degrees << " " << p;
}

}  // namespace
}  // namespace takt::study
