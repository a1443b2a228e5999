// SPDX-License-Identifier: Apache-2.0
// Ports without gates whose frames come at known times, by hand. 100 Mb/s: a frame of 1518 octets takes 123.04 us of
// the medium, and its last bit is out after 122.08 us; one of 64 octets 6.72 us and 5.76 us.
#include "analysis/phased_bound.hpp"

#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::phased_bound_test {
namespace {

constexpr Ps octet = 80'000;
constexpr Ps ns = 1'000;
constexpr Ps us = 1'000'000;
constexpr Ps long_frame = 123'040 * ns;
constexpr Ps long_last_bit = 122'080 * ns;
constexpr Ps short_frame = 6'720 * ns;
constexpr Ps short_last_bit = 5'760 * ns;

PortFlow flow(std::uint32_t octets, models::TrafficClass q, Ps first, Ps width = 0, Ps period = 1000 * us) {
  PortFlow made;
  made.arrivals = FrameArrivals({period, 1, 0, width});
  made.phase = ArrivalPhase{first, period, width};
  made.frame = sim::Octets{octets};
  made.lowest_class = made.highest_class = q;
  return made;
}

std::vector<Ps> delays(std::vector<PortFlow> flows, const models::PortConfig& config = {}) {
  PortModel model;
  model.octet_time = octet;
  model.config = &config;
  std::vector<Ps> all;
  for (const PortFlowBound& bound : bound_port(model, {{{}}, std::move(flows)}).flows) all.push_back(bound.delay);
  return all;
}

TEST(PhasedBound, WhoNeverMeetsDoesNotWait) {
  EXPECT_EQ(delays({flow(1518, 7, 0), flow(1518, 7, 500 * us)}), (std::vector<Ps>{long_last_bit, long_last_bit}));
  // 100 us later, the first one is there for another 23.04 us.
  EXPECT_EQ(delays({flow(1518, 7, 0), flow(1518, 7, 100 * us)}),
            (std::vector<Ps>{long_last_bit, long_last_bit + 23'040 * ns}));
  // Which may come 30 us later.
  EXPECT_EQ(delays({flow(1518, 7, 0, 30 * us), flow(1518, 7, 100 * us)}),
            (std::vector<Ps>{long_last_bit, long_last_bit + 53'040 * ns}));
  // Windows that meet: each may be there just before the other.
  EXPECT_EQ(delays({flow(1518, 7, 0, 30 * us), flow(1518, 7, 20 * us, 30 * us)}),
            (std::vector<Ps>{long_last_bit + long_frame, long_last_bit + long_frame}));
}

// The second flow's frame of the period before is the one that is met; and phases in other periods: 0, 400, 800 us of
// 400 us; 850 us of 1 ms is 50 us after one of 800.
TEST(PhasedBound, PeriodsMeetInTheHyperperiod) {
  EXPECT_EQ(delays({flow(64, 7, 10 * us), flow(1518, 7, 900 * us)})[0], short_last_bit + 13'040 * ns);
  EXPECT_EQ(delays({flow(1518, 7, 850 * us), flow(1518, 7, 0, 0, 400 * us)}),
            (std::vector<Ps>{long_last_bit + 73'040 * ns, long_last_bit}));
  // Periods that never repeat together within reason: whatever the phases.
  EXPECT_EQ(delays({flow(1518, 7, 0), flow(1518, 7, 500 * us, 0, 1'000'000'007)}),
            (std::vector<Ps>{long_last_bit + long_frame, long_last_bit + long_frame}));
}

TEST(PhasedBound, HigherClasses) {
  // Of a higher class, that began 5 us before; or comes while it waits; or after it has begun.
  EXPECT_EQ(delays({flow(1518, 0, 0), flow(64, 7, -5 * us)})[0], long_last_bit + 1'720 * ns);
  EXPECT_EQ(delays({flow(1518, 0, 0), flow(64, 7, -5 * us), flow(64, 7, 1 * us)})[0],
            long_last_bit + 1'720 * ns + short_frame);
  EXPECT_EQ(delays({flow(1518, 0, 0), flow(64, 7, 1 * us)})[0], long_last_bit);
}

// A frame of class 0 that comes at 0, to a port at which it may wait for one of 6.72 us, is away by 129.76 us.
TEST(PhasedBound, LowerClasses) {
  EXPECT_EQ(delays({flow(64, 7, 130 * us), flow(1518, 0, 0)})[0], short_last_bit);
  EXPECT_EQ(delays({flow(64, 7, 120 * us), flow(1518, 0, 0)})[0], short_last_bit + 9'760 * ns);
  EXPECT_EQ(delays({flow(64, 7, 1 * us), flow(1518, 0, 0)})[0], short_last_bit + long_frame);
  EXPECT_EQ(delays({flow(64, 7, -1 * us), flow(1518, 0, 0)})[0], short_last_bit);
}

TEST(PhasedBound, OthersAtAnyTime) {
  PortFlow other = flow(64, 7, 0);
  other.phase.reset();
  // One of those, before or with it; but the other long one is not met.
  EXPECT_EQ(
      delays({flow(1518, 7, 0), flow(1518, 7, 500 * us), other}),
      (std::vector<Ps>{long_last_bit + short_frame, long_last_bit + short_frame, 2 * long_frame + short_last_bit}));
  // 123.04 us later the medium is free again, if nobody was there before: a busy period that the other has begun
  // reaches 6.72 us further.
  EXPECT_EQ(delays({flow(1518, 7, 0), flow(1518, 7, 123'040 * ns), other})[1], long_last_bit + short_frame);
}

// Phases of one clock say nothing of those of another.
TEST(PhasedBound, EveryClockForItself) {
  std::vector<PortFlow> flows{flow(1518, 7, 0), flow(1518, 7, 500 * us), flow(64, 7, 300 * us)};
  flows[0].phase->clock = flows[1].phase->clock = 3;
  EXPECT_EQ(delays(flows), (std::vector<Ps>{long_last_bit + short_frame, long_last_bit + short_frame,
                                            2 * long_frame + short_last_bit}));
  flows[1].phase->clock = 0;
  EXPECT_EQ(delays(flows)[0], long_last_bit + long_frame + short_frame);
}

std::unique_ptr<scenario::Resolved> two_talkers(const std::string& clocks, const std::string& more = "") {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(
      R"({"name": "two", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "s": {"kind": "switch", "forwarding_delay": "1us"}},
    "links": [{"ends": ["a", "s"], "rate": "1Gbps", "delay": "0s"}, {"ends": ["b", "s"], "rate": "1Gbps", "delay": "0s"}, {"ends": ["s", "c"], "rate": "1Gbps", "delay": "0s"}]},
    "streams": [{"name": "x", "from": "a", "to": "c", "payload": "200B", "every": "500us", "offset": "0us", "pcp": 5},
                {"name": "y", "from": "b", "to": "c", "payload": "1000B", "every": "500us", "offset": "250us", "pcp": 5})" +
          more + "]" + clocks + "}",
      "two.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

double latency_us(const scenario::Resolved& resolved, std::size_t stream = 0) {
  return static_cast<double>(bound(resolved).streams[stream].latency->ps()) / 1e6;
}

// 200 octets of payload are 250 from DA to FCS and 258 with the preamble, 2.064 us at each of two links, and 1 us
// between them. The other frame, 1070 octets, 8.56 us, is 250 us away.
TEST(PhasedBound, OfAScenario) {
  EXPECT_EQ(latency_us(*two_talkers("")), 5.128);
  // A talker of the same priority at no known phase counts, and makes x come up to 2.16 us later, too. Not so far apart
  // from y that it met it.
  EXPECT_NEAR(latency_us(*two_talkers(
                  "", R"(, {"name": "z", "from": "b", "to": "c", "payload": "200B", "every": "500us", "pcp": 5})")),
              5.128 + 2.16, 1e-6);
}

// With gPTP windows are wider by twice the clock error, and six messages of it may go before, of 96 octets and one of
// 120; at 250 us that changes nothing. If clocks drift freely there are no phases.
TEST(PhasedBound, OfAScenarioWithClocks) {
  const double alone = latency_us(*two_talkers(R"(, "clocks": {"all": {"offset": "10ppm"}, "gptp": {}})"));
  EXPECT_LT(alone, 5.128 + 2 * 6 * (120 + 20) * 0.008);
  const double free = latency_us(*two_talkers(R"(, "clocks": {"all": {"offset": "10ppm"}})"));
  EXPECT_NEAR(free, 5.128 + 8.56, 1e-3);
  // A clock error of 250 us makes them meet.
  EXPECT_GT(latency_us(*two_talkers(
                R"(, "clocks": {"all": {"offset": "10ppm"}, "gptp": {}}, "require": [{"sync": "130us"}])")),
            alone + 8.5);
}

// Streams of one host keep their phases whatever its clock does.
TEST(PhasedBound, OneHostWithAFreeClock) {
  const std::string drifting = R"(, "clocks": {"all": {"offset": "100ppm"}})";
  const auto resolved = two_talkers(
      drifting,
      R"(, {"name": "z", "from": "a", "to": "c", "payload": "1000B", "every": "500us", "offset": "100us", "pcp": 6})");
  // x waits for y, not for z, which is 100 us away.
  EXPECT_NEAR(latency_us(*resolved), 5.128 + 8.56, 3e-3);
}

}  // namespace
}  // namespace takt::analysis::phased_bound_test
