// SPDX-License-Identifier: Apache-2.0
// When talkers produce: seen in the trace, exact to the picosecond.
//
// The digests follow from the definition in sim/digest.hpp, see expected_digest(): for each frame a record of its
// production, at that time, and one of its delivery, (stream 0 << 32 | node 1) at production + 126 octets * 80 ps,
// later if the one before is still on the wire. The first pinned one was computed in Python, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/models/network_fixture.hpp"

namespace takt::models {
namespace {

using namespace test;

struct Outcome {
  std::vector<std::int64_t> produced;  ///< ps
  std::vector<std::uint64_t> lengths;  ///< of the frames as they started
  std::uint64_t digest = 0;
  std::uint64_t delivered = 0;
};

/// A talker with that schedule on a fast direct link.
Outcome run(const TalkerSchedule& schedule, Duration end, std::uint64_t seed = 1) {
  Line line(0, 100_Gbps, 0_ns);
  const StreamIndex stream = line.builder.stream(line.talker, {line.listener});
  line.builder.talk(stream, 100_B, schedule);
  NetworkRun run(line.builder.plan, seed);
  TraceLog trace;
  run.simulation.set_trace(&trace);
  run.until(end);
  Outcome outcome;
  for (const sim::TraceRecord& record : trace.of(Occurrence::produced)) {
    EXPECT_EQ(record.detail, stream.value);
    outcome.produced.push_back(record.time.ps());
  }
  for (const sim::TraceRecord& record : trace.of(Occurrence::started))
    outcome.lengths.push_back(TransmissionDetail::unpack(record.detail).octets);
  EXPECT_EQ(outcome.produced.size(), run.stream(stream).sent);
  outcome.digest = run.digest();
  outcome.delivered = run.stream(stream).delivered;
  return outcome;
}

using Times = std::vector<std::int64_t>;

/// From when frames were produced and how long they are, from node 0 to node 1 without a tag, at 80 ps an octet.
std::uint64_t expected_digest(const Outcome& outcome) {
  sim::Digest digest;
  std::int64_t free = 0;
  for (std::size_t n = 0; n < outcome.lengths.size(); ++n) {
    const std::int64_t produced = outcome.produced[n];
    const auto length = static_cast<std::int64_t>(outcome.lengths[n]);
    const std::int64_t last_bit = std::max(produced, free) + (8 + length) * 80;
    free = last_bit + 12 * 80;
    digest.add(3, sim::Content(0, 0, 1, 0, 0, 0).value(), sim::TrueTime::from_ps(produced),
               sim::joined(n, static_cast<std::uint64_t>(length) << 32));
    if (n < outcome.delivered)
      digest.add(1, 1, sim::TrueTime::from_ps(last_bit), sim::joined(n, static_cast<std::uint64_t>(produced)));
  }
  return digest.value();
}

TEST(PeriodicSchedule, AtOffsetAndThenEveryPeriod) {
  const Outcome outcome = run(PeriodicSchedule{3_us, 10_us, 0_us}, 50_us);
  EXPECT_EQ(outcome.produced, (Times{3'000'000, 13'000'000, 23'000'000, 33'000'000, 43'000'000}));
  EXPECT_EQ(outcome.digest, expected_digest(outcome));
  EXPECT_EQ(outcome.digest, 0xC864CAC83DFCA306ULL);
}

TEST(PeriodicSchedule, WithoutJitterChanceHasNoPart) {
  EXPECT_EQ(run(PeriodicSchedule{3_us, 10_us, 0_us}, 1_ms, 1).digest,
            run(PeriodicSchedule{3_us, 10_us, 0_us}, 1_ms, 2).digest);
}

// Frame k lies in [offset + k period, offset + k period + jitter], and both ends are nearly reached; no drift
// accumulates.
TEST(PeriodicSchedule, JitterStaysInItsBounds) {
  const Outcome outcome = run(PeriodicSchedule{5_us, 10_us, 4_us}, 100_ms);
  ASSERT_EQ(outcome.produced.size(), 10'000u);
  std::int64_t least = INT64_MAX;
  std::int64_t greatest = 0;
  double sum = 0;
  for (std::size_t k = 0; k < outcome.produced.size(); ++k) {
    const std::int64_t jitter = outcome.produced[k] - 5'000'000 - static_cast<std::int64_t>(k) * 10'000'000;
    least = std::min(least, jitter);
    greatest = std::max(greatest, jitter);
    sum += static_cast<double>(jitter);
  }
  EXPECT_GE(least, 0);
  EXPECT_LE(greatest, 4'000'000);
  EXPECT_LT(least, 10'000);
  EXPECT_GT(greatest, 3'990'000);
  EXPECT_NEAR(sum / 1e4, 2e6, 4 * 4e6 / std::sqrt(12.0 * 1e4));
  EXPECT_EQ(outcome.digest, expected_digest(outcome));
  EXPECT_EQ(outcome.digest, 0x60DFB612908DC5F6ULL);
}

// With a jitter as long as the period frames may come close together but never change places.
TEST(PeriodicSchedule, JitterOfAWholePeriodKeepsTheOrder) {
  const Outcome outcome = run(PeriodicSchedule{0_us, 1_us, 1_us}, 10_ms);
  EXPECT_EQ(outcome.produced.size(), 10'000u);
  for (std::size_t k = 1; k < outcome.produced.size(); ++k) EXPECT_GE(outcome.produced[k], outcome.produced[k - 1]);
}

// The first times, computed independently (Python: the published generator and libm) from the stream named
// (seed 1, "talker/stream0", "schedule").
TEST(ExponentialSchedule, PinnedTimes) {
  const Outcome outcome = run(ExponentialSchedule{7_us, 20_us}, 10_ms);
  ASSERT_GE(outcome.produced.size(), 4u);
  EXPECT_EQ((Times{outcome.produced.begin(), outcome.produced.begin() + 4}),
            (Times{80'092'042, 111'343'713, 113'190'621, 152'387'061}));
  EXPECT_EQ(outcome.digest, expected_digest(outcome));
  EXPECT_EQ(outcome.digest, 0x7225A455E706A43AULL);
}

// Gaps of mean 20 us whose deviation is their mean; the first frame comes one gap after the offset.
TEST(ExponentialSchedule, MeanAndDeviationOfTheGaps) {
  const Outcome outcome = run(ExponentialSchedule{7_us, 20_us}, 2_s);
  double sum = 0;
  double squares = 0;
  std::int64_t last = 7'000'000;
  for (const std::int64_t time : outcome.produced) {
    const double gap = static_cast<double>(time - last) / 20e6;
    EXPECT_GE(gap, 0);
    sum += gap;
    squares += gap * gap;
    last = time;
  }
  const double n = static_cast<double>(outcome.produced.size());
  EXPECT_NEAR(n, 100'000, 4 * std::sqrt(100'000.0));  // a Poisson count
  EXPECT_NEAR(sum / n, 1.0, 4 / std::sqrt(n));
  EXPECT_NEAR(squares / n - sum / n * sum / n, 1.0, 4 * std::sqrt(8 / n));  // (mu4 - 1) = 9 - 1
}

// Gaps of a normal distribution cut off at 15 and 40 us, computed as above (Python: statistics.NormalDist).
TEST(RandomGapSchedule, PinnedTimes) {
  const RandomGapSchedule gaps{
      7_us, std::make_shared<const sim::Distribution>(sim::Distribution::truncated_normal(20_us, 10_us, 15_us, 40_us))};
  const Outcome outcome = run(gaps, 10_ms);
  ASSERT_GE(outcome.produced.size(), 4u);
  EXPECT_EQ((Times{outcome.produced.begin(), outcome.produced.begin() + 4}),
            (Times{22'485'658, 41'196'081, 75'130'894, 92'668'490}));
  EXPECT_EQ(outcome.digest, expected_digest(outcome));
  for (std::size_t k = 1; k < outcome.produced.size(); ++k) {
    EXPECT_GE(outcome.produced[k] - outcome.produced[k - 1], 15'000'000);
    EXPECT_LE(outcome.produced[k] - outcome.produced[k - 1], 40'000'000);
  }
}

TEST(BurstSchedule, FramesAndSpacing) {
  const Outcome outcome = run(BurstSchedule{2_us, 100_us, 3, 10_us}, 250_us);
  EXPECT_EQ(outcome.produced, (Times{2'000'000, 12'000'000, 22'000'000, 102'000'000, 112'000'000, 122'000'000,
                                     202'000'000, 212'000'000, 222'000'000}));
  EXPECT_EQ(outcome.digest, expected_digest(outcome));
  EXPECT_EQ(outcome.digest, 0x47C324F41A42B21CULL);
}

TEST(BurstSchedule, AllAtOnce) {
  const Outcome outcome = run(BurstSchedule{0_us, 100_us, 4, 0_us}, 150_us);
  EXPECT_EQ(outcome.produced, (Times{0, 0, 0, 0, 100'000'000, 100'000'000, 100'000'000, 100'000'000}));
  EXPECT_EQ(outcome.delivered, 8u);
}

// The table's times and payloads: 14 + payload + 4 octets, at least 64.
TEST(TraceSchedule, TimesAndPayloads) {
  const TraceSchedule table{{{local(1_us), 100_B}, {local(1_us), 10_B}, {local(5_us), 1500_B}}};
  const Outcome outcome = run(table, 1_ms);
  EXPECT_EQ(outcome.produced, (Times{1'000'000, 1'000'000, 5'000'000}));
  EXPECT_EQ(outcome.lengths, (std::vector<std::uint64_t>{118, 64, 1518}));
  EXPECT_EQ(outcome.delivered, 3u);
  EXPECT_EQ(outcome.digest, expected_digest(outcome));
  EXPECT_EQ(outcome.digest, 0xAE0CAF83035F5D53ULL);
}

TEST(TraceSchedule, EmptySendsNothing) { EXPECT_EQ(run(TraceSchedule{}, 1_ms).produced, Times{}); }

// Another talker, another stream: nobody else's times move.
TEST(Talker, ANewcomerMovesNoOtherNumbers) {
  std::vector<std::int64_t> produced[2];
  for (std::size_t variant = 0; variant < 2; ++variant) {
    PlanBuilder builder;
    const NodeIndex talker = builder.host("talker");
    const NodeIndex listener = builder.host("listener");
    builder.link(talker, listener, 100_Gbps);
    const NodeIndex other = builder.host("other");
    const NodeIndex sink = builder.host("sink");
    builder.link(other, sink, 100_Gbps);
    const StreamIndex stream = builder.stream(talker, {listener});
    const StreamIndex newcomer = builder.stream(talker, {listener});
    const StreamIndex stranger = builder.stream(other, {sink});
    if (variant == 1) builder.talk(newcomer, 200_B, ExponentialSchedule{0_us, 3_us});
    builder.talk(stream, 100_B, ExponentialSchedule{0_us, 20_us});
    if (variant == 1) builder.talk(stranger, 100_B, PeriodicSchedule{0_us, 10_us, 5_us});
    NetworkRun run(builder.plan);
    TraceLog trace;
    run.simulation.set_trace(&trace);
    run.until(10_ms);
    for (const sim::TraceRecord& record : trace.of(Occurrence::produced))
      if (record.detail == stream.value) produced[variant].push_back(record.time.ps());
  }
  EXPECT_GT(produced[0].size(), 400u);
  EXPECT_EQ(produced[0], produced[1]);
}

// A clock that is ahead when the run begins shows times that never were: nothing was due then. (It used to send all of
// it at once.)
TEST(Talker, SendsNothingThatWasDueBeforeTheBeginning) {
  const auto produced = [](const TalkerSchedule& schedule, Duration ahead) {
    PlanBuilder builder;
    const NodeIndex talker = builder.host("talker");
    const NodeIndex listener = builder.host("listener");
    builder.link(talker, listener, 100_Gbps);
    builder.plan.nodes[talker.value].clock = NodeClockPlan{.oscillator = {}, .timestamps = {}, .initial_offset = ahead};
    builder.talk(builder.stream(talker, {listener}), 100_B, schedule);
    NetworkRun run(builder.plan);
    TraceLog trace;
    run.simulation.set_trace(&trace);
    run.until(3500_us);
    std::vector<std::int64_t> us;
    for (const sim::TraceRecord& record : trace.of(Occurrence::produced)) us.push_back(record.time.ps() / 1'000'000);
    return us;
  };
  EXPECT_EQ(produced(PeriodicSchedule{100_us, 1_ms, 0_us}, 0_us), (Times{100, 1100, 2100, 3100}));
  EXPECT_EQ(produced(PeriodicSchedule{100_us, 1_ms, 0_us}, 1_s),
            (Times{100, 1100, 2100, 3100}));  // at 1.0001 s of its clock
  EXPECT_EQ(produced(PeriodicSchedule{100_us, 1_ms, 0_us}, 5200_us), (Times{900, 1900, 2900}));  // at 6.1 ms
  EXPECT_EQ(produced(PeriodicSchedule{0_us, 1_ms, 0_us}, 2_ms),
            (Times{0, 1000, 2000, 3000}));  // due at the beginning itself
  EXPECT_EQ(produced(PeriodicSchedule{100_us, 1_ms, 0_us}, -1_ms), (Times{1100, 2100, 3100}));      // behind: it waits
  EXPECT_EQ(produced(BurstSchedule{0_us, 2_ms, 2, 10_us}, 1_ms), (Times{1000, 1010, 3000, 3010}));  // at 2 and 4 ms
  EXPECT_EQ(produced(TraceSchedule{{{local(100_us), 10_B}, {local(2_ms), 10_B}}}, 1_ms), (Times{1000}));
  EXPECT_LT(produced(ExponentialSchedule{0_us, 500_us}, 1_s).size(), 30u);
}

TEST(Talker, AnotherSeedIsAnotherRun) {
  EXPECT_NE(run(ExponentialSchedule{0_us, 20_us}, 10_ms, 1).digest,
            run(ExponentialSchedule{0_us, 20_us}, 10_ms, 2).digest);
}

}  // namespace
}  // namespace takt::models
