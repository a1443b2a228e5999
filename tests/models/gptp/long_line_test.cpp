// SPDX-License-Identifier: Apache-2.0
// 100 hops under the assumptions of IEC/IEEE 60802, and what the error at the end is made of.
//
// Intervals 125 ms, residence and turnaround 10 ms, timestamps of 8 ns granularity with +-4 ns of dynamic error, +-50
// ppm, 80 % of the oscillators drift by up to +-1.5 ppm/s. What each remedy is for:
//   - The transit takes T = 1 s; the rate ratio that is handed on is that old at the end. Drift d makes D = d T^2 / 2 =
//   0.75 us of the
//     grandmaster's drift alone: rate_ratio_drift_window.
//   - The neighbour rate ratio over 1 s lags by 0.5 s: up to 1.5 ppm a hop, and the sum of all of them counts:
//   compensate_drift.
//   - The PI servo keeps D T / ki, 957 ns for each ppm/s of relative drift, up to 3 ppm/s: drift tracking.
#include <gtest/gtest.h>

#include <algorithm>

#include "gptp_fixture.hpp"

namespace takt::models::gptp::long_line_test {
namespace {

struct Remedies {
  bool ratio_drift = true;
  bool neighbor_drift = true;
  bool servo_drift = true;
};

/// The largest error at the last node from 20 s to 25 s.
sim::Duration worst_error(std::size_t hops, std::uint64_t seed, const Remedies& remedies) {
  Harness harness;
  sim::RandomStream chance(seed, "line", "oscillators");
  for (std::size_t i = 0; i <= hops; ++i) {
    Harness::NodeSetUp node;
    node.instances[0].system.priority1 = i == 0 ? 50 : 246;
    node.instances[0].rate_ratio_drift_window = remedies.ratio_drift ? 32 : 0;
    draw_oscillator({{-50'000'000}, {50'000'000}, -1'500'000, 1'500'000}, seed, "node" + std::to_string(i),
                    node.oscillator);
    if (chance.below(10) >= 8) node.oscillator.drift_ppt_per_second = 0;
    node.oscillator.update_interval = 100_ms;  // 1.5 ppm/s: 1.9 ns within an interval
    node.timestamps = {.granularity = 8_ns, .jitter = 4_ns};
    node.send_latency = 10_ms;
    node.link = {.log_pdelay_req_interval = -3, .compensate_drift = remedies.neighbor_drift, .average_over = 16};
    node.servo.kind = remedies.servo_drift ? ServoKind::drift_tracking : ServoKind::pi;
    harness.add(node);
  }
  for (std::size_t i = 1; i <= hops; ++i) harness.connect(i - 1, i, 500_ns);
  harness.start(seed);
  harness.run(20_s);
  sim::Duration worst;
  for (int i = 0; i < 500; ++i) {
    harness.run(10_ms);
    const sim::Duration offset = harness.offset(hops, 0);
    worst = std::max(worst, offset < sim::Duration() ? -offset : offset);
  }
  return worst;
}

TEST(LongLine, AHundredHopsWithinAMicrosecond) { EXPECT_LE(worst_error(100, 1, {}), 1_us); }

TEST(LongLine, EachRemedyIsNeeded) {
  const sim::Duration all = worst_error(30, 5, {});
  EXPECT_LE(all, 250_ns);
  EXPECT_GT(worst_error(30, 5, {.ratio_drift = false}), all);
  EXPECT_GT(worst_error(30, 5, {.neighbor_drift = false}), all);
  EXPECT_GT(worst_error(30, 5, {.servo_drift = false}), all);
}

}  // namespace
}  // namespace takt::models::gptp::long_line_test
