// SPDX-License-Identifier: Apache-2.0
// A node in a Program by hand: its cycle, what it takes and what it drops, restarts; what a turn has for outputs.
#include "wire/program_node.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support.hpp"

namespace takt::wire {
namespace {

using namespace test;
using program::Method;

struct Endpoint : ::testing::Test {
  std::shared_ptr<const ProgramFormat> format = std::make_shared<const ProgramFormat>(shape());
  std::array<std::byte, 1500> buffer{};

  /// A state of `sender` in this Program.
  uadp::Octets state(std::uint8_t sender, std::uint16_t sequence,
                     handshake::Word word = {1, PublishedState::Halted, {}, 0}) {
    return format->encode(StateMessage{sender, sequence, word}, buffer);
  }
};

TEST_F(Endpoint, PublishesEveryCycle) {
  EndpointSettings made = settings(0, format);
  made.offset = 300_us;
  made.priority = 5;
  Bench endpoint(made);
  endpoint.start();
  EXPECT_EQ(endpoint.alarm(0), 300_us);
  endpoint.at(300_us);
  endpoint.wake(0);
  EXPECT_EQ(endpoint.alarm(0), 1300_us);
  ASSERT_EQ(endpoint.sent.size(), 1u);
  EXPECT_EQ(endpoint.sent[0].octets.size(), 42u);
  EXPECT_EQ(endpoint.sent[0].destination, (pubsub::Destination{1, 5}));
}

// The grid of cycles is that of the clock, not of the start.
TEST_F(Endpoint, StartsOnTheGrid) {
  Bench endpoint(settings(0, format));
  for (const auto& [now, first] :
       {std::pair{0_ms, 0_ms}, {1_ms, 1_ms}, {1001_us, 2_ms}, {-(1500_us), -(1_ms)}, {-(1_ms), -(1_ms)}}) {
    endpoint.at(now);
    endpoint.start();
    EXPECT_EQ(endpoint.alarm(0), first) << now.ps();
  }
}

TEST_F(Endpoint, ALateOnePublishesOnceAndCounts) {
  Bench endpoint(settings(0, format));
  endpoint.start();
  endpoint.at(3500_us);  // due at 0; 1, 2 and 3 ms have passed
  endpoint.wake(0);
  EXPECT_EQ(endpoint.sent.size(), 1u);
  EXPECT_EQ(endpoint.alarm(0), 4_ms);
  EXPECT_EQ(endpoint.node.endpoint()->missed_cycles(), 3u);
  endpoint.at(4_ms);
  endpoint.wake(0);
  EXPECT_EQ(endpoint.node.endpoint()->missed_cycles(), 3u);
}

TEST_F(Endpoint, DropsWhatIsNotForIt) {
  Bench slave(settings(1, format));
  slave.receive({});
  slave.receive(uadp::Octets(buffer));
  slave.receive(state(1, 0));  // its own
  slave.receive(state(2, 0));  // another slave's, which it does not hear in a star
  EXPECT_EQ(slave.counts().foreign, 2u);
  EXPECT_EQ(slave.counts().unsubscribed, 2u);
  EXPECT_EQ(slave.counts().taken, 0u);
  EndpointSettings hears_all = settings(1, format);
  hears_all.handshake.subscription = handshake::Subscription::all_to_all;
  Bench other(hears_all);
  other.receive(state(2, 0));
  EXPECT_EQ(other.counts().taken, 1u);
}

// OPC 10000-14, 7.2.3: repeated and overtaken messages are ignored, across the roll-over.
TEST_F(Endpoint, TakesEachStateOnceAndInOrder) {
  Bench slave(settings(1, format));
  for (const int sequence : {65534, 65535, 65535, 0, 65534, 2, 1})
    slave.receive(state(0, static_cast<std::uint16_t>(sequence)));
  EXPECT_EQ(slave.counts().taken, 4u);  // 65534, 65535, 0, 2
  EXPECT_EQ(slave.counts().stale, 3u);
}

TEST_F(Endpoint, AfterSilenceAnyNumberIsTheFirst) {
  Bench slave(settings(1, format));
  slave.receive(state(0, 1000));
  slave.at(9'999_us);
  slave.receive(state(0, 5));
  EXPECT_EQ(slave.counts().stale, 1u);
  slave.at(10_ms);
  slave.receive(state(0, 5));
  EXPECT_EQ(slave.counts().taken, 2u);
}

// Otherwise a peer that comes back within the time-out would be deaf to us for the rest of it.
TEST_F(Endpoint, AnotherIncarnationBeginsAnew) {
  Bench slave(settings(1, format));
  slave.receive(state(0, 1000));
  slave.receive(state(0, 0, {2, PublishedState::Halted, {}, 0}));
  EXPECT_EQ(slave.counts().taken, 2u);
}

TEST_F(Endpoint, ForgetsInACrash) {
  Bench master(settings(0, format));
  master.start();
  EXPECT_EQ(master.call(Method::Start), program::StatusCode::Good);
  EXPECT_EQ(master.participant().state(), PublishedState::HaltedInit);
  EXPECT_EQ(master.alarm(1), 2_ms);
  master.wake(0);
  master.node.crash();
  EXPECT_EQ(master.participant().state(), PublishedState::Halted);
  EXPECT_EQ(master.participant().intent(), handshake::Intent{});
  master.wake(0);
  const auto first = format->decode(master.sent[0].octets);
  const auto second = format->decode(master.sent[1].octets);
  EXPECT_EQ(std::get<StateMessage>(*first).word.incarnation, 7u);
  EXPECT_EQ(std::get<StateMessage>(*second).word.incarnation, 8u);
  EXPECT_EQ(std::get<StateMessage>(*second).sequence, 0u);
}

/// Two endpoints, each message of one handed to the other at once.
struct Pair : ::testing::Test {
  std::shared_ptr<const ProgramFormat> format = std::make_shared<const ProgramFormat>(shape(Variant::robust, 1));
  Bench master{settings(0, format)};
  Bench slave{settings(1, format)};

  void cycle() {
    master.sent.clear();
    slave.sent.clear();
    master.wake(0);
    slave.wake(0);
    for (const auto& one : master.sent) slave.receive(one.octets);
    for (const auto& one : slave.sent) master.receive(one.octets);
  }
  void start() {
    master.call(Method::Start);
    cycle();
    master.wake(1);
    slave.wake(1);
    for (int i = 0; i < 6; ++i) cycle();
    ASSERT_EQ(master.participant().state(), PublishedState::Running);
    ASSERT_EQ(slave.participant().state(), PublishedState::Running);
  }
};

TEST_F(Pair, ProcessDataReachesWhoRuns) {
  master.fill_with = std::byte{0x5A};
  start();
  slave.data.clear();
  cycle();
  ASSERT_EQ(slave.data.size(), 1u);
  EXPECT_EQ(slave.data[0].data_set, 0u);
  EXPECT_EQ(slave.data[0].run, slave.participant().run());
  EXPECT_EQ(master.sent[1].octets.size(), 34u);
  EXPECT_EQ(master.sent[1].octets[24], std::byte{0x5A});
  EXPECT_EQ(master.sent[1].destination.writer_group_id, 2u);
  // The same message a second time is stale, and of no use after the halt.
  slave.receive(master.sent[1].octets);
  EXPECT_EQ(slave.data.size(), 1u);
  const std::vector<std::byte> late = master.sent[1].octets;
  slave.call(Method::Halt);
  const std::uint64_t before = slave.counts().not_running;
  slave.receive(late);
  EXPECT_EQ(slave.counts().not_running, before + 1);
}

// A slave that crashed and is back within the time-out halts the group.
TEST_F(Pair, ARestartHaltsTheOther) {
  start();
  slave.node.crash();
  cycle();
  EXPECT_EQ(master.participant().state(), PublishedState::Halted);
}

TEST_F(Pair, OnChangePublishesAtOnce) {
  EndpointSettings made = settings(0, format);
  made.publish_on_change = true;
  Bench eager(made);
  eager.call(Method::Start);
  EXPECT_EQ(eager.sent.size(), 1u);
  eager.call(Method::Start);  // refused: nothing has changed
  EXPECT_EQ(eager.sent.size(), 1u);
}

// A turn only says what is to be done, in order; nothing happens before it is carried out.
TEST_F(Endpoint, SaysWhatIsToBeDoneInOrder) {
  EndpointSettings made = settings(0, format);
  made.publish_on_change = true;
  ProgramNode node({made, {}});
  NodeOutputs& outputs = node.call(sim::LocalTime(), Method::Start);
  EXPECT_EQ(outputs.status, program::StatusCode::Good);
  EXPECT_EQ(&node.receive(sim::LocalTime(), state(1, 0)),
            &outputs);  // another turn before they have been taken: they come behind
  std::vector<Output> all;
  while (const auto* const output = outputs.next()) all.push_back(output->what);
  const auto at = [&](auto is) { return std::find_if(all.begin(), all.end(), is) - all.begin(); };
  EXPECT_EQ(std::get<Stepped>(all.at(0)).after.state, PublishedState::HaltedInit);
  EXPECT_EQ(std::get<SetAlarm>(all.at(1)).alarm, 1u);
  EXPECT_EQ(std::get<SetAlarm>(all.at(1)).time, sim::LocalTime() + 2_ms);
  const auto published = at([](const Output& each) { return std::holds_alternative<Publish>(each); });
  const auto heard = at([](const Output& each) { return std::holds_alternative<Heard>(each); });
  EXPECT_LT(1, published);
  EXPECT_LT(published, heard);
  EXPECT_EQ(std::get<Publish>(all.at(static_cast<std::size_t>(published))).word, std::get<Stepped>(all.at(0)).after);
  // The step with what was heard is quiet: it only arms the time-out of peer 0 anew.
  EXPECT_EQ(std::get<SetAlarm>(all.at(static_cast<std::size_t>(heard) + 1)).alarm, 2u);
  EXPECT_EQ(all.size(), static_cast<std::size_t>(heard) + 2);
  EXPECT_FALSE(outputs.next());
}

}  // namespace
}  // namespace takt::wire
