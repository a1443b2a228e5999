// SPDX-License-Identifier: Apache-2.0
// Latencies of hosts: the named profiles come out as their table says, and the distributions of a file as it says.
#include "scenario/resolve/os_profiles.hpp"

#include "sim/random.hpp"
#include "support.hpp"

namespace takt::scenario::test::os_profiles_test {
namespace {

using sim::operator""_us;
using sim::operator""_ms;

struct Sampled {
  Duration least = Duration::max();
  Duration greatest;
  double average_us = 0;
};

Sampled sample(const sim::Distribution& distribution, int draws = 200'000) {
  sim::RandomStream chance(1, "test", "latency");
  Sampled result;
  double sum = 0;
  for (int i = 0; i < draws; ++i) {
    const Duration drawn = distribution.draw(chance);
    result.least = std::min(result.least, drawn);
    result.greatest = std::max(result.greatest, drawn);
    sum += static_cast<double>(drawn.ps());
  }
  result.average_us = sum / draws / 1e6;
  return result;
}

models::OsLatency latency_of(OsProfile profile) {
  OperatingSystem os;
  os.profile = profile;
  json::Diagnostics diagnostics;
  return os_latency_of(os, diagnostics);
}

struct WakeUp {
  OsProfile profile;
  Duration least;
  double average_us;
  Duration greatest;
};

// Least, average and greatest wake-up, as the table gives them. The cut of the body at the beginning of the tail takes
// a little from the average: e^-4.5 of the excess at preempt-rt.
TEST(OsProfiles, WakeUpIsAsTheTableSays) {
  for (const WakeUp& w : {WakeUp{OsProfile::preempt_rt, 1_us, 3, 50_us},
                          {OsProfile::preempt_rt_isolated, 1_us, 2, 11_us},
                          {OsProfile::preempt_rt_arm, 6_us, 9, 66_us},
                          {OsProfile::general_purpose, 1_us, 10, 20_ms},
                          {OsProfile::virtual_machine, 2_us, 15, 30_ms},
                          {OsProfile::virtual_machine_rt, 3_us, 8, 50_us}}) {
    const models::OsLatency latency = latency_of(w.profile);
    EXPECT_GE(latency.wake_up.least(), w.least) << spelling(w.profile);
    EXPECT_LE(latency.wake_up.least(), w.least + w.least / 20) << spelling(w.profile);  // the first of 256 quantiles
    EXPECT_EQ(latency.wake_up.greatest(), w.greatest) << spelling(w.profile);
    const Sampled drawn = sample(latency.wake_up);
    // The rare tail of milliseconds of the loaded systems weighs 1e-4 x 10 ms = 1 us (general-purpose) or 1.5 us.
    const double tail_us = w.greatest > 1_ms ? 1e-4 * static_cast<double>(w.greatest.ps()) / 2e6 : 0;
    EXPECT_NEAR(drawn.average_us, w.average_us + tail_us, 0.1 * w.average_us) << spelling(w.profile);
    EXPECT_GE(drawn.least, w.least);
    EXPECT_LE(drawn.greatest, w.greatest);
  }
}

TEST(OsProfiles, EveryDelayOfEveryProfileIsBounded) {
  for (const OsProfile profile :
       {OsProfile::preempt_rt, OsProfile::preempt_rt_isolated, OsProfile::preempt_rt_arm, OsProfile::general_purpose,
        OsProfile::virtual_machine, OsProfile::virtual_machine_rt}) {
    const models::OsLatency latency = latency_of(profile);
    for (const sim::Distribution* one : {&latency.transmit, &latency.receive, &latency.wake_up}) {
      EXPECT_GT(one->least(), Duration());
      EXPECT_LE(one->greatest(), 30_ms);
      const Sampled drawn = sample(*one, 20'000);
      EXPECT_GE(drawn.least, one->least());
      EXPECT_LE(drawn.greatest, one->greatest());
    }
  }
}

TEST(OsProfiles, NoneIsNoDelayAtAll) {
  const models::OsLatency latency = latency_of(OsProfile::none);
  for (const sim::Distribution* one : {&latency.transmit, &latency.receive, &latency.wake_up}) {
    EXPECT_TRUE(one->is_constant());
    EXPECT_EQ(one->greatest(), Duration());
  }
}

sim::Distribution receive_of(const std::string& latency) {
  const auto r =
      sound(over_one_switch(""), {"network.nodes.a.os={\"profile\": \"preempt-rt\", \"receive\": " + latency + "}"});
  return r->plan.os_latencies[r->plan.nodes[node(*r, "a")].os_latency].receive;
}

TEST(OsProfiles, AFileReplacesSingleDelays) {
  EXPECT_EQ(receive_of(R"("7us")").greatest(), 7_us);
  EXPECT_TRUE(receive_of(R"({"fixed": "7us"})").is_constant());
  EXPECT_EQ(receive_of(R"({"fixed": "7us", "min": "9us"})").least(), 9_us);
  const auto r = sound(over_one_switch(""), {R"(network.nodes.a.os={"profile": "preempt-rt", "receive": "7us"})"});
  EXPECT_EQ(r->plan.os_latencies[r->plan.nodes[node(*r, "a")].os_latency].wake_up.greatest(), 50_us);
}

TEST(OsProfiles, DistributionsOfAFile) {
  const sim::Distribution uniform = receive_of(R"({"uniform": {"from": "2us", "to": "6us"}})");
  EXPECT_EQ(uniform.least(), 2_us);
  EXPECT_EQ(uniform.greatest(), 6_us);
  EXPECT_NEAR(sample(uniform).average_us, 4, 0.02);
  EXPECT_NEAR(sample(receive_of(R"({"normal": {"mean": "20us", "deviation": "2us"}})")).average_us, 20, 0.05);
  EXPECT_NEAR(sample(receive_of(R"({"exponential": {"mean": "20us"}})")).average_us, 20, 0.2);
  EXPECT_NEAR(sample(receive_of(R"({"weibull": {"scale": "20us", "shape": 1}})")).average_us, 20,
              0.2);  // is exponential
  EXPECT_NEAR(sample(receive_of(R"({"log_normal": {"median": "20us", "sigma": 0}})")).average_us, 20,
              1e-3);  // is constant
  const sim::Distribution table = receive_of(R"({"table": [{"value": "1us", "weight": 3}, {"value": "9us"}]})");
  EXPECT_NEAR(sample(table).average_us, 3, 0.05);  // (3 x 1 + 9) / 4
  const sim::Distribution cut = receive_of(R"({"exponential": {"mean": "20us"}, "min": "5us", "max": "30us"})");
  EXPECT_EQ(sample(cut).least, 5_us);
  EXPECT_EQ(sample(cut).greatest, 30_us);
}

// Equal systems share their latencies: a plant of 100,000 hosts has one.
TEST(OsProfiles, EqualSystemsAreOne) {
  const auto r = sound(generated(R"("topology": "line", "switches": 50, "os": "preempt-rt")"));
  EXPECT_EQ(r->plan.os_latencies.size(), 1u);
}

}  // namespace
}  // namespace takt::scenario::test::os_profiles_test
