// An endpoint by hand: its cycle, what it takes and what it drops, restarts.
#include "wire/program_endpoint.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace takt::wire {
namespace {

using namespace test;
using program::Method;

struct Endpoint : ::testing::Test {
  std::shared_ptr<const ProgramFormat> format = std::make_shared<const ProgramFormat>(shape());
  Remembering host;
  std::array<std::byte, 1500> buffer{};

  void at(sim::Duration time) { host.time = sim::LocalTime() + time; }
  sim::Duration alarm(std::size_t number) const { return host.alarms.at(number).since_start(); }
  /// A state of `sender` in this Program.
  uadp::Octets state(std::uint8_t sender, std::uint16_t sequence, handshake::Word word = {1, PublishedState::Halted, {}, 0}) {
    return format->encode(StateMessage{sender, sequence, word}, buffer);
  }
};

TEST_F(Endpoint, PublishesEveryCycle) {
  EndpointSettings made = settings(0, format);
  made.offset = 300_us;
  made.priority = 5;
  ProgramEndpoint endpoint(made);
  endpoint.start(host);
  EXPECT_EQ(alarm(0), 300_us);
  at(300_us);
  endpoint.wake(host, 0);
  EXPECT_EQ(alarm(0), 1300_us);
  ASSERT_EQ(host.sent.size(), 1u);
  EXPECT_EQ(host.sent[0].octets.size(), 42u);
  EXPECT_EQ(host.sent[0].destination, (pubsub::Destination{1, 5}));
}

// The grid of cycles is that of the clock, not of the start.
TEST_F(Endpoint, StartsOnTheGrid) {
  ProgramEndpoint endpoint(settings(0, format));
  for (const auto& [now, first] : {std::pair{0_ms, 0_ms}, {1_ms, 1_ms}, {1001_us, 2_ms}, {-(1500_us), -(1_ms)}, {-(1_ms), -(1_ms)}}) {
    at(now);
    endpoint.start(host);
    EXPECT_EQ(alarm(0), first) << now.ps();
  }
}

TEST_F(Endpoint, ALateOnePublishesOnceAndCounts) {
  ProgramEndpoint endpoint(settings(0, format));
  endpoint.start(host);
  at(3500_us);  // due at 0; 1, 2 and 3 ms have passed
  endpoint.wake(host, 0);
  EXPECT_EQ(host.sent.size(), 1u);
  EXPECT_EQ(alarm(0), 4_ms);
  EXPECT_EQ(endpoint.missed_cycles(), 3u);
  at(4_ms);
  endpoint.wake(host, 0);
  EXPECT_EQ(endpoint.missed_cycles(), 3u);
}

TEST_F(Endpoint, DropsWhatIsNotForIt) {
  ProgramEndpoint slave(settings(1, format));
  slave.receive(host, {});
  slave.receive(host, uadp::Octets(buffer));
  slave.receive(host, state(1, 0));  // its own
  slave.receive(host, state(2, 0));  // another slave's, which it does not hear in a star
  EXPECT_EQ(slave.counts().foreign, 2u);
  EXPECT_EQ(slave.counts().unsubscribed, 2u);
  EXPECT_EQ(slave.counts().taken, 0u);
  EndpointSettings hears_all = settings(1, format);
  hears_all.handshake.subscription = handshake::Subscription::AllToAll;
  ProgramEndpoint other(hears_all);
  other.receive(host, state(2, 0));
  EXPECT_EQ(other.counts().taken, 1u);
}

// OPC 10000-14, 7.2.3: repeated and overtaken messages are ignored, across the roll-over.
TEST_F(Endpoint, TakesEachStateOnceAndInOrder) {
  ProgramEndpoint slave(settings(1, format));
  for (const int sequence : {65534, 65535, 65535, 0, 65534, 2, 1}) slave.receive(host, state(0, static_cast<std::uint16_t>(sequence)));
  EXPECT_EQ(slave.counts().taken, 4u);  // 65534, 65535, 0, 2
  EXPECT_EQ(slave.counts().stale, 3u);
}

TEST_F(Endpoint, AfterSilenceAnyNumberIsTheFirst) {
  ProgramEndpoint slave(settings(1, format));
  slave.receive(host, state(0, 1000));
  at(9'999_us);
  slave.receive(host, state(0, 5));
  EXPECT_EQ(slave.counts().stale, 1u);
  at(10_ms);
  slave.receive(host, state(0, 5));
  EXPECT_EQ(slave.counts().taken, 2u);
}

// Otherwise a peer that comes back within the time-out would be deaf to us for the rest of it.
TEST_F(Endpoint, AnotherIncarnationBeginsAnew) {
  ProgramEndpoint slave(settings(1, format));
  slave.receive(host, state(0, 1000));
  slave.receive(host, state(0, 0, {2, PublishedState::Halted, {}, 0}));
  EXPECT_EQ(slave.counts().taken, 2u);
}

TEST_F(Endpoint, ForgetsInACrash) {
  ProgramEndpoint master(settings(0, format));
  master.start(host);
  EXPECT_EQ(master.call(host, Method::Start), program::StatusCode::Good);
  EXPECT_EQ(master.participant().state(), PublishedState::HaltedInit);
  EXPECT_EQ(alarm(1), 2_ms);
  master.wake(host, 0);
  master.forget(8);
  EXPECT_EQ(master.participant().state(), PublishedState::Halted);
  EXPECT_EQ(master.participant().intent(), handshake::Intent{});
  master.wake(host, 0);
  const auto first = format->decode(host.sent[0].octets);
  const auto second = format->decode(host.sent[1].octets);
  EXPECT_EQ(std::get<StateMessage>(*first).word.incarnation, 7u);
  EXPECT_EQ(std::get<StateMessage>(*second).word.incarnation, 8u);
  EXPECT_EQ(std::get<StateMessage>(*second).sequence, 0u);
}

/// Two endpoints, each message of one handed to the other at once.
struct Pair : ::testing::Test {
  std::shared_ptr<const ProgramFormat> format = std::make_shared<const ProgramFormat>(shape(Variant::Robust, 1));
  ProgramEndpoint master{settings(0, format)};
  ProgramEndpoint slave{settings(1, format)};
  Remembering at_master;
  Remembering at_slave;

  void cycle() {
    at_master.sent.clear();
    at_slave.sent.clear();
    master.wake(at_master, 0);
    slave.wake(at_slave, 0);
    for (const auto& one : at_master.sent) slave.receive(at_slave, one.octets);
    for (const auto& one : at_slave.sent) master.receive(at_master, one.octets);
  }
  void start() {
    master.call(at_master, Method::Start);
    cycle();
    master.wake(at_master, 1);
    slave.wake(at_slave, 1);
    for (int i = 0; i < 6; ++i) cycle();
    ASSERT_EQ(master.participant().state(), PublishedState::Running);
    ASSERT_EQ(slave.participant().state(), PublishedState::Running);
  }
};

TEST_F(Pair, ProcessDataReachesWhoRuns) {
  at_master.fill_with = std::byte{0x5A};
  start();
  at_slave.data.clear();
  cycle();
  ASSERT_EQ(at_slave.data.size(), 1u);
  EXPECT_EQ(at_slave.data[0].data_set, 0u);
  EXPECT_EQ(at_slave.data[0].run, slave.participant().run());
  EXPECT_EQ(at_master.sent[1].octets.size(), 34u);
  EXPECT_EQ(at_master.sent[1].octets[24], std::byte{0x5A});
  EXPECT_EQ(at_master.sent[1].destination.writer_group_id, 2u);
  // The same message a second time is stale, and of no use after the halt.
  slave.receive(at_slave, at_master.sent[1].octets);
  EXPECT_EQ(at_slave.data.size(), 1u);
  const std::vector<std::byte> late = at_master.sent[1].octets;
  slave.call(at_slave, Method::Halt);
  const std::uint64_t before = slave.counts().not_running;
  slave.receive(at_slave, late);
  EXPECT_EQ(slave.counts().not_running, before + 1);
}

// A slave that crashed and is back within the time-out halts the group.
TEST_F(Pair, ARestartHaltsTheOther) {
  start();
  slave.forget(8);
  cycle();
  EXPECT_EQ(master.participant().state(), PublishedState::Halted);
}

TEST_F(Pair, OnChangePublishesAtOnce) {
  EndpointSettings made = settings(0, format);
  made.publish_on_change = true;
  ProgramEndpoint eager(made);
  eager.call(at_master, Method::Start);
  EXPECT_EQ(at_master.sent.size(), 1u);
  eager.call(at_master, Method::Start);  // refused: nothing has changed
  EXPECT_EQ(at_master.sent.size(), 1u);
}

}  // namespace
}  // namespace takt::wire
