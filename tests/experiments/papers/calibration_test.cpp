// SPDX-License-Identifier: Apache-2.0
// Response laws go through the cells that they were fitted to, and predict the others within the limits.
#include "papers/coexistence/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace takt::papers::coexistence {
namespace {

TEST(ResponseLaw, GoesThroughBothPoints) {
  for (const Law law : laws)
    for (const PublishedTable& table : tables) {
      const FittedLaw fitted = calibrate(law, table);
      EXPECT_NEAR(100 * fitted.done_within(1), table.success[at_1_ms], 1e-6) << name_of(law) << " " << table.number;
      EXPECT_NEAR(100 * fitted.done_within(5), std::min(table.success[at_5_ms], 99.8), 1e-6)
          << name_of(law) << " " << table.number;
      EXPECT_LT(fitted.done_within(2), fitted.done_within(2.1)) << name_of(law) << " " << table.number;
    }
}

// Table 1 by hand: ln(-ln 0.1) - ln(-ln 0.36) = 0.83403 - 0.02137, over ln 5 = 1.60944.
TEST(ResponseLaw, WeibullShapeAndScale) {
  const FittedLaw fitted = fit(Law::weibull, 1, 0.64, 5, 0.9);
  EXPECT_NEAR(fitted.shape, std::log(std::log(0.1) / std::log(0.36)) / std::log(5), 1e-12);
  EXPECT_NEAR(fitted.shape, 0.5049, 5e-5);
  EXPECT_NEAR(fitted.scale, 0.9585, 5e-5);
}

// Known values: an exponential law is Weibull and gamma of shape 1; the median of a lognormal and a log-logistic law is
// their scale.
TEST(ResponseLaw, KnownValues) {
  const double at_1 = 1 - std::exp(-0.5);
  const double at_5 = 1 - std::exp(-2.5);
  for (const Law law : {Law::weibull, Law::gamma}) {
    const FittedLaw fitted = fit(law, 1, at_1, 5, at_5);
    EXPECT_NEAR(fitted.shape, 1, 1e-6) << name_of(law);
    EXPECT_NEAR(fitted.scale, 2, 1e-6) << name_of(law);
  }
  EXPECT_DOUBLE_EQ((FittedLaw{Law::lognormal, 1.3, 2}.done_within(2)), 0.5);
  EXPECT_DOUBLE_EQ((FittedLaw{Law::log_logistic, 1.3, 2}.done_within(2)), 0.5);
  // One standard deviation of the logarithm above the median.
  EXPECT_NEAR((FittedLaw{Law::lognormal, 0.5, 1}.done_within(std::exp(0.5))), 0.841344746, 1e-9);
  // Gamma of shape 3: 1 - exp(-x) (1 + x + x^2 / 2), below and above the switch to the continued fraction.
  for (const double x : {0.3, 2.0, 7.0})
    EXPECT_NEAR((FittedLaw{Law::gamma, 3, 1}.done_within(x)), 1 - std::exp(-x) * (1 + x + x * x / 2), 1e-12) << x;
}

TEST(Calibration, WeibullKeepsTheLimitsAndErrsLeastAt2Milliseconds) {
  const std::vector<LawErrors> all = compare_laws();
  ASSERT_EQ(all.size(), 4u);
  ASSERT_EQ(all[0].law, Law::weibull);
  EXPECT_TRUE(all[0].fits());
  EXPECT_LE(all[0].worst_at_2_ms, 6);
  EXPECT_GE(all[0].least(), 93);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LT(all[0].worst_at_2_ms, all[i].worst_at_2_ms) << name_of(all[i].law);
    EXPECT_LT(all[0].rms_at_2_ms, all[i].rms_at_2_ms) << name_of(all[i].law);
  }
  EXPECT_FALSE(all[2].fits()) << "log-logistic is beyond both limits";
}

}  // namespace
}  // namespace takt::papers::coexistence
