// SPDX-License-Identifier: Apache-2.0
// Asynchronous writers: byte budgets and the order of schedulers.
#include "pair.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;

/// One participant with writers on one flow controller, and one that reads all of them.
struct Flows {
  explicit Flows(const FlowControllerSettings& settings, const std::vector<FlowShare>& shares,
                 ReliabilityKind reliability = ReliabilityKind::best_effort) {
    ParticipantConfig config = World::config(1);
    config.flow_controllers = {settings};
    writing = &world.add(config);
    reading = &world.add(World::config(2));
    for (const FlowShare& share : shares) {
      WriterConfig made = writer_config(reliability);
      made.asynchronous = true;
      made.flow_controller = settings.name;
      made.flow_share = share;
      made.qos.history.kind = HistoryKind::keep_all;
      made.topic = "topic" + std::to_string(writers.size());
      writers.push_back(*writing->create_writer(made, world.now).handle);
      ReaderConfig reader = reader_config(reliability);
      reader.topic = made.topic;
      readers.push_back(*reading->create_reader(reader, world.now).handle);
      world.match(*writing, writers.back(), *reading, readers.back());
    }
    world.run_for(1_s);
    world.log.clear();
  }
  void write(std::size_t writer, std::size_t size = 100) {
    writing->write(writers[writer], no_key, payload_of(++values, rounded_up(size, 4)), world.now);
  }
  /// In the order of sending: which writer, of messages with data.
  std::string order() const {
    std::string text;
    for (const Sent& sent : world.log) {
      for (MessageDecoder decoder(sent.octets); decoder.next();) {
        const auto* const data = std::get_if<Data>(&decoder.submessage());
        const auto* const fragment = std::get_if<DataFrag>(&decoder.submessage());
        if (data == nullptr && fragment == nullptr) continue;
        for (std::size_t i = 0; i < writers.size(); ++i)
          if ((data != nullptr ? data->writer : fragment->writer).key() == writers[i].number)
            text += static_cast<char>('a' + i);
      }
    }
    return text;
  }
  /// Octets with data in each period since `begin`.
  std::map<std::int64_t, std::size_t> octets_by_period(sim::LocalTime begin, sim::Duration period) const {
    std::map<std::int64_t, std::size_t> sums;
    for (const Sent& sent : world.log)
      if (sent.from == 0 && sent.kinds().find("DATA") != std::string::npos)
        sums[(sent.at - begin) / period] += sent.octets.size();
    return sums;
  }
  World world;
  Participant* writing = nullptr;
  Participant* reading = nullptr;
  std::vector<WriterHandle> writers;
  std::vector<ReaderHandle> readers;
  std::uint32_t values = 0;
};

TEST(FlowController, NothingIsSentWithinWrite) {
  Flows flows({"flow", FlowScheduler::fifo, 0, 10_ms}, {{}});
  flows.write(0);
  flows.world.collect();
  EXPECT_TRUE(flows.world.log.empty());
  EXPECT_EQ(flows.writing->next_wake(), flows.world.now);
  flows.world.run_for(1_ms);
  EXPECT_EQ(flows.order(), "a");
}

TEST(FlowController, NoPeriodExceedsItsBudget) {
  for (const FlowScheduler scheduler : {FlowScheduler::fifo, FlowScheduler::round_robin, FlowScheduler::high_priority,
                                        FlowScheduler::priority_with_reservation}) {
    for (const ReliabilityKind reliability : {ReliabilityKind::best_effort, ReliabilityKind::reliable}) {
      Flows flows({"flow", scheduler, 2000, 10_ms}, {{-1, 30}, {0, 20}, {1, 50}}, reliability);
      int lost = 0;
      flows.world.medium = [&](const Sent&) {
        return ++lost % 5 == 0 ? std::vector<sim::Duration>() : std::vector{100_us};
      };
      std::size_t octets = 0;
      for (std::size_t i = 0; i < 60; ++i) {
        const std::size_t size = 40 + i * 97 % 1900;  // some in fragments
        flows.write(i % 3, size);
        octets += size;
        if (i % 7 == 0) flows.world.run_for(3_ms);
      }
      flows.world.run_for(60_s);
      std::size_t full = 0;
      for (const auto& [period, sum] : flows.octets_by_period(start, 10_ms)) {
        EXPECT_LE(sum, 2000u) << static_cast<int>(scheduler);
        full += sum > 1000 ? 1 : 0;
      }
      EXPECT_GT(full, octets / 2000 / 2);  // and it is used
      if (reliability == ReliabilityKind::reliable) {
        std::size_t taken = 0;
        for (const ReaderHandle reader : flows.readers)
          taken += drain_values(*flows.reading, reader, flows.world.now).size();
        EXPECT_EQ(taken, 60u);
      }
    }
  }
}

// A budget of three samples of 164 octets (60 + 104).
FlowControllerSettings three(FlowScheduler scheduler) { return {"flow", scheduler, 3 * 240, 10_ms}; }

TEST(FlowController, FifoKeepsTheOrderOfWriting) {
  Flows flows(three(FlowScheduler::fifo), {{}, {}, {}});
  for (const std::size_t writer : {2u, 0u, 0u, 1u, 2u, 1u, 0u}) flows.write(writer);
  flows.world.run_for(1_s);
  EXPECT_EQ(flows.order(), "caabcba");
}

TEST(FlowController, RoundRobinTakesTurns) {
  Flows flows(three(FlowScheduler::round_robin), {{}, {}, {}});
  for (const std::size_t writer : {0u, 0u, 0u, 0u, 1u, 1u, 2u, 2u, 2u}) flows.write(writer);
  flows.world.run_for(1_s);
  EXPECT_EQ(flows.order(), "abcabcaca");
}

TEST(FlowController, RoundRobinSendsASampleWhole) {
  Flows flows({"flow", FlowScheduler::round_robin, 3000, 10_ms}, {{}, {}});
  flows.write(0, 4000);
  flows.write(0, 100);
  flows.write(1, 4000);
  flows.world.run_for(1_s);
  EXPECT_EQ(flows.order(), "aaabbba");
}

TEST(FlowController, HighPriorityGoesFirst) {
  Flows flows(three(FlowScheduler::high_priority), {{5, 0}, {-10, 0}, {0, 0}});
  for (const std::size_t writer : {0u, 0u, 2u, 1u, 2u, 1u, 0u}) flows.write(writer);
  flows.world.run_for(1_s);
  EXPECT_EQ(flows.order(), "bbccaaa");
}

TEST(FlowController, AReservationGoesBeforePriority) {
  // Of 1000 octets c has 50 %: two of its samples of at most 208 (60 + 100, and what might stand beside) in each
  // period, before the others.
  Flows flows({"flow", FlowScheduler::priority_with_reservation, 1000, 10_ms}, {{-10, 0}, {0, 0}, {10, 50}});
  for (int i = 0; i < 6; ++i)
    for (const std::size_t writer : {0u, 1u, 2u}) flows.write(writer);
  flows.world.run_for(1_s);
  const std::string order = flows.order();
  EXPECT_EQ(order.substr(0, 2), "cc");
  EXPECT_EQ(order.find('b') > order.rfind('a'), true) << order;
  std::map<std::int64_t, std::string> by_period;
  for (std::size_t i = 0; i < flows.world.log.size(); ++i)
    by_period[(flows.world.log[i].at - start) / 10_ms] += order[i];
  ASSERT_GE(by_period.size(), 3u);
  for (auto at = by_period.begin(); at->second.find('c') != std::string::npos && std::next(at) != by_period.end(); ++at)
    EXPECT_EQ(at->second.substr(0, 2), "cc") << order;
}

TEST(FlowController, AHeartbeatAnnouncesOnlyWhatWasSent) {
  TimingProfile timing = timing::fast_dds;
  timing.heartbeat_period = 10_ms;
  timing.heartbeat_period_max = 10_ms;
  ParticipantConfig config = World::config(1);
  config.timing = timing;
  config.flow_controllers = {{"flow", FlowScheduler::fifo, 1472, 100_ms}};
  WriterConfig writing = writer_config();
  writing.asynchronous = true;
  writing.flow_controller = "flow";
  Pair pair(writing, reader_config(), config);
  pair.world.run_for(1_s);
  pair.world.log.clear();
  pair.write(1, 6000);  // five fragments, one every 100 ms, while HEARTBEATs come every 10 ms
  pair.world.run_for(2_s);
  EXPECT_EQ(pair.take(), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(pair.writing->figures().resent, 0u);
  for (const Sent& sent : pair.world.log) {
    if (sent.from != 0 || sent.at >= start + 1400_ms) continue;  // the last fragment goes at 1.4 s
    for (MessageDecoder decoder(sent.octets); decoder.next();)
      if (const auto* const heartbeat = std::get_if<Heartbeat>(&decoder.submessage())) {
        EXPECT_EQ(heartbeat->last, SequenceNumber{0});
      }
  }
  EXPECT_GT(pair.writing->figures().sent[SubmessageKind::heartbeat_frag], 10u);
}

}  // namespace
}  // namespace takt::dds
