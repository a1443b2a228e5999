// SPDX-License-Identifier: Apache-2.0
// How long a lost sample takes with no other traffic: to the next HEARTBEAT, the way of that, the response delay, the
// way of the ACKNACK, the nack response delay, and the way of the sample.
#include "pair.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;

constexpr sim::Duration way = 100_us;

struct Lossy : Pair {
  explicit Lossy(const TimingProfile& timing) : Pair(keeping(), reader_config(), timing) {
    world.medium = [this](const Sent& sent) {
      return lose_next > 0 && sent.kinds().find("DATA") != std::string::npos && lose_next-- > 0
                 ? std::vector<sim::Duration>()
                 : std::vector{way};
    };
    world.run_until(start + 20_s);  // what follows a match is over
    world.events.clear();
  }
  static WriterConfig keeping() {
    WriterConfig config = writer_config();
    config.qos.history.depth = 10;
    return config;
  }
  sim::LocalTime available(std::size_t index = 0) const {
    for (const auto& [who, event] : world.events)
      if (event.kind == EventKind::data_available && index-- == 0) return event.at;
    return sim::LocalTime::never();
  }
  int lose_next = 0;
};

TEST(Recovery, TakesWhatTheFormulaSays) {
  for (const TimingProfile& timing : timing::all) {
    Lossy pair(timing);
    const sim::LocalTime written = pair.world.now;
    pair.lose_next = 1;
    pair.write(1);
    pair.world.run_for(20_s);
    const sim::LocalTime expected = written + timing.heartbeat_period + way + timing.heartbeat_response_delay + way +
                                    timing.nack_response_delay + way;
    EXPECT_EQ(pair.available(), expected) << timing.name;
    EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
  }
}

TEST(Recovery, OfASampleThatIsLostTwiceWaitsForTwoHeartbeats) {
  Lossy pair(timing::fast_dds);
  const sim::LocalTime written = pair.world.now;
  pair.lose_next = 2;
  pair.write(1);
  pair.world.run_for(20_s);
  EXPECT_EQ(pair.available(), written + 2 * timing::fast_dds.heartbeat_period + 5_ms + 5_ms + 3 * way);
}

TEST(Recovery, ThePiggybackedHeartbeatOfTheNextSampleIsSooner) {
  Lossy pair(timing::cyclone);
  pair.lose_next = 1;
  pair.write(1);
  pair.world.run_for(30_ms);
  const sim::LocalTime next = pair.world.now;
  pair.write(2);
  pair.world.run_for(1_s);
  EXPECT_EQ(pair.available(), next + 3 * way);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1, 2}));
}

TEST(Recovery, AHeartbeatThatAsksForNoAnswerIsAnsweredLaterIfSomethingIsMissing) {
  Lossy pair(timing::cyclone);
  pair.write(0);  // its HEARTBEAT asks
  pair.world.run_for(6_ms);
  pair.lose_next = 1;
  pair.write(1);
  pair.world.run_for(6_ms);
  const sim::LocalTime next = pair.world.now;
  pair.write(2);  // within 20 ms: asks for no answer
  pair.world.run_for(80_ms);
  EXPECT_EQ(pair.available(1), sim::LocalTime::never());
  // The periodic one, 100 ms after the first write that was not acknowledged, is sooner than NackDelay.
  pair.world.run_for(1_s);
  EXPECT_LE(pair.available(1), next + way + 100_ms + 2 * way);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{0, 1, 2}));
}

// Cyclone doubles the period from the sixth HEARTBEAT since the last write on.
TEST(Recovery, HeartbeatsBackOff) {
  Lossy pair(timing::cyclone);
  pair.world.medium = [](const Sent&) { return std::vector<sim::Duration>(); };
  const sim::LocalTime written = pair.world.now;
  pair.world.log.clear();
  pair.write(1);
  pair.world.run_for(30_s);
  std::vector<std::int64_t> at_ms;
  for (const Sent& sent : pair.world.log)
    if (sent.kinds() == "INFO_DST HEARTBEAT") at_ms.push_back((sent.at - written) / 1_ms);
  EXPECT_EQ(at_ms, (std::vector<std::int64_t>{100, 200, 300, 400, 500, 600, 800, 1200, 2000, 3600, 6800, 13200, 19600,
                                              26000}));
}

}  // namespace
}  // namespace takt::dds
