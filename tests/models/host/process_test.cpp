// SPDX-License-Identifier: Apache-2.0
// Applications on hosts: alarms, their latency, their order with what arrives.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "tests/models/network_fixture.hpp"

namespace takt::models {
namespace {

using namespace test;
using sim::Distribution;

/// Writes down every call; `on_*` say what it does then.
class Scripted final : public Application {
 public:
  static constexpr AlarmId alarms = 3;
  AlarmId alarm_count() const override { return alarms; }
  void start(HostServices& host) override {
    if (on_start) on_start(host);
  }
  void receive(HostServices& host, StreamIndex stream, std::span<const std::byte> payload) override {
    note(host, "receive " + std::to_string(stream.value) + " of " + std::to_string(payload.size()));
    if (on_receive) on_receive(host);
  }
  void wake(HostServices& host, AlarmId alarm) override {
    note(host, "wake " + std::to_string(alarm));
    if (on_wake) on_wake(host, alarm);
  }

  std::function<void(HostServices&)> on_start;
  std::function<void(HostServices&)> on_receive;
  std::function<void(HostServices&, AlarmId)> on_wake;
  std::vector<std::pair<std::int64_t, std::string>> log;  // ns

 private:
  void note(HostServices& host, std::string what) { log.emplace_back(host.now().ps() / 1'000, std::move(what)); }
};
using Log = std::vector<std::pair<std::int64_t, std::string>>;

/// Two hosts on a direct link of 1 Gb/s without delay; the scripted application is on the second.
struct Pair {
  explicit Pair(const OsLatency& latency = {}) {
    const std::uint32_t os = builder.os_latency(latency);
    peer = builder.host("peer");
    host = builder.host("host", os);
    builder.link(peer, host);
    to_host = builder.stream(peer, {host});
    to_peer = builder.stream(host, {peer});
    run.emplace(builder.plan);
    auto application = std::make_unique<Scripted>();
    scripted = application.get();
    process = &run->network->add_process(host, "scripted", std::move(application));
    run->network->listen(host, to_host, process);
  }
  PlanBuilder builder;
  NodeIndex peer, host;
  StreamIndex to_host, to_peer;
  std::optional<NetworkRun> run;
  Scripted* scripted = nullptr;
  Process* process = nullptr;
};

TEST(Process, AlarmsWakeAtTheirTimes) {
  Pair pair;
  pair.scripted->on_start = [](HostServices& host) {
    EXPECT_EQ(host.now(), local(0_us));
    host.set_alarm(1, local(5_us));
    host.set_alarm(0, local(9_us));
    host.set_alarm(2, local(7_us));
  };
  pair.run->until(1_ms);
  EXPECT_EQ(pair.scripted->log, (Log{{5'000, "wake 1"}, {7'000, "wake 2"}, {9'000, "wake 0"}}));
}

TEST(Process, AnAlarmReplacesItsEarlierSetting) {
  Pair pair;
  pair.scripted->on_start = [](HostServices& host) {
    host.set_alarm(0, local(5_us));
    host.set_alarm(0, local(9_us));  // later
    host.set_alarm(1, local(8_us));
    host.set_alarm(1, local(3_us));  // earlier
  };
  pair.run->until(1_ms);
  EXPECT_EQ(pair.scripted->log, (Log{{3'000, "wake 1"}, {9'000, "wake 0"}}));
}

TEST(Process, ACancelledAlarmDoesNotWakeAndMayBeSetAgain) {
  Pair pair;
  pair.scripted->on_start = [](HostServices& host) {
    host.set_alarm(0, local(5_us));
    host.set_alarm(1, local(2_us));
    host.set_alarm(2, local(20_us));
    host.cancel_alarm(2);
  };
  pair.scripted->on_wake = [](HostServices& host, AlarmId alarm) {
    if (alarm != 1) return;
    host.cancel_alarm(0);
    host.set_alarm(0, local(12_us));
  };
  pair.run->until(1_ms);
  EXPECT_EQ(pair.scripted->log, (Log{{2'000, "wake 1"}, {12'000, "wake 0"}}));
}

TEST(Process, AnAlarmInThePastWakesNow) {
  Pair pair;
  pair.scripted->on_start = [](HostServices& host) { host.set_alarm(0, local(5_us)); };
  pair.scripted->on_wake = [](HostServices& host, AlarmId alarm) {
    if (alarm == 0) host.set_alarm(1, local(1_us));
  };
  pair.run->until(1_ms);
  EXPECT_EQ(pair.scripted->log, (Log{{5'000, "wake 0"}, {5'000, "wake 1"}}));
}

// Every 10 us, 100 times; each wake-up sets the next one at the time the grid says, so nothing drifts.
TEST(Process, APeriodicAlarm) {
  Pair pair;
  pair.scripted->on_start = [](HostServices& host) { host.set_alarm(0, local(10_us)); };
  pair.scripted->on_wake = [](HostServices& host, AlarmId) { host.set_alarm(0, host.now() + 10_us); };
  pair.run->until(1_ms);
  ASSERT_EQ(pair.scripted->log.size(), 100u);
  EXPECT_EQ(pair.scripted->log.back().first, 1'000'000);
}

TEST(Process, AnAlarmForNeverDoesNotWake) {
  Pair pair;
  pair.scripted->on_start = [](HostServices& host) { host.set_alarm(0, LocalTime::never()); };
  pair.run->until(1_ms);
  EXPECT_EQ(pair.scripted->log, Log{});
}

TEST(Process, TheWakeUpLatencyIsAdded) {
  OsLatency latency;
  latency.wake_up = Distribution::constant(3_us);
  Pair pair(latency);
  pair.scripted->on_start = [](HostServices& host) { host.set_alarm(0, local(10_us)); };
  pair.scripted->on_wake = [](HostServices& host, AlarmId alarm) {
    if (alarm == 0) host.set_alarm(1, local(5_us));  // in the past: now and the latency
  };
  pair.run->until(1_ms);
  EXPECT_EQ(pair.scripted->log, (Log{{13'000, "wake 0"}, {16'000, "wake 1"}}));
}

TEST(Process, ARandomWakeUpLatencyStaysInItsBounds) {
  OsLatency latency;
  latency.wake_up = Distribution::uniform(2_us, 6_us);
  Pair pair(latency);
  std::vector<std::int64_t> latencies;
  LocalTime due = local(20_us);
  pair.scripted->on_start = [&](HostServices& host) { host.set_alarm(0, due); };
  pair.scripted->on_wake = [&](HostServices& host, AlarmId) {
    latencies.push_back((host.now() - due).ps());
    host.set_alarm(0, due += 20_us);
  };
  pair.run->until(20_ms);
  ASSERT_EQ(latencies.size(), 999u);  // the one of 20 ms wakes after the end
  const auto [least, greatest] = std::minmax_element(latencies.begin(), latencies.end());
  EXPECT_GE(*least, 2'000'000);
  EXPECT_LE(*greatest, 6'000'000);
  EXPECT_LT(*least, 2'100'000);
  EXPECT_GT(*greatest, 5'900'000);
}

// 46 octets from 1 us on: delivered at 1.576 us. An alarm of that very instant wakes after the frame was received.
TEST(Process, WhatArrivesComesBeforeTheAlarmOfTheSameInstant) {
  for (const std::uint64_t key : {0ULL, 1ULL, 0xABCDEFULL}) {
    Pair pair;
    pair.run.emplace(pair.builder.plan, 1, key);
    auto application = std::make_unique<Scripted>();
    Scripted& scripted = *application;
    Process& process = pair.run->network->add_process(pair.host, "scripted", std::move(application));
    pair.run->network->listen(pair.host, pair.to_host, &process);
    install<Sender>(*pair.run->network, pair.peer, "sender",
                    std::vector<Sender::Item>{{local(1_us), pair.to_host, 46}});
    scripted.on_start = [](HostServices& host) { host.set_alarm(0, local(1'576_ns)); };
    pair.run->until(1_ms);
    EXPECT_EQ(scripted.log, (Log{{1'576, "receive 0 of 46"}, {1'576, "wake 0"}}));
  }
}

// A frame that re-arms the watchdog in the instant in which it would bite saves the application.
TEST(Process, AWatchdogIsFedInTheLastInstant) {
  Pair pair;
  install<Sender>(*pair.run->network, pair.peer, "sender", std::vector<Sender::Item>{{local(1_us), pair.to_host, 46}});
  pair.scripted->on_start = [](HostServices& host) { host.set_alarm(0, local(1'576_ns)); };
  pair.scripted->on_receive = [](HostServices& host) { host.set_alarm(0, host.now() + 5_us); };
  pair.run->until(1_ms);
  EXPECT_EQ(pair.scripted->log, (Log{{1'576, "receive 0 of 46"}, {6'576, "wake 0"}}));
}

// Replies from within receive() and wake(), also while the payload that is being received lives in the same pool: 400
// replies.
TEST(Process, RepliesWhileItReceives) {
  Pair pair;
  install<Sender>(*pair.run->network, pair.peer, "sender", std::vector<Sender::Item>{{local(1_us), pair.to_host, 46}});
  const std::vector<std::byte> reply(200);
  pair.scripted->on_receive = [&](HostServices& host) {
    for (int i = 0; i < 400; ++i) host.send(pair.to_peer, reply);
  };
  const Listener& peer = listen(*pair.run->network, pair.peer, {pair.to_peer});
  pair.run->until(10_ms);
  EXPECT_EQ(peer.arrivals.size(), 400u);
  // 1.576 us, then 226 octets (14 + 200 + 4 + 8) of 8 ns to the last bit: 3.384 us.
  EXPECT_EQ(peer.arrivals[0].time, local(3'384_ns));
  EXPECT_EQ(pair.run->network->traffic().live_frames(), 0u);
}

TEST(Process, TheScriptsHandActsAtThePresentInstant) {
  Pair pair;
  const Listener& peer = listen(*pair.run->network, pair.peer, {pair.to_peer});
  pair.run->until(40_us);
  pair.process->call([&](Application& application, HostServices& host) {
    EXPECT_EQ(&application, pair.scripted);
    EXPECT_EQ(host.now(), local(40_us));
    host.send(pair.to_peer, std::vector<std::byte>(46));
    host.set_alarm(2, local(50_us));
  });
  pair.run->until(1_ms);
  ASSERT_EQ(peer.arrivals.size(), 1u);
  EXPECT_EQ(peer.arrivals[0].time, local(40'576_ns));
  EXPECT_EQ(pair.scripted->log, (Log{{50'000, "wake 2"}}));
}

TEST(Process, ThePayloadArrivesOctetForOctet) {
  class Keeper final : public Application {
   public:
    AlarmId alarm_count() const override { return 0; }
    void start(HostServices&) override {}
    void receive(HostServices&, StreamIndex, std::span<const std::byte> payload) override {
      kept.assign(payload.begin(), payload.end());
    }
    void wake(HostServices&, AlarmId) override {}
    std::vector<std::byte> kept;
  };
  for (const std::size_t length : {0u, 1u, 1'500u}) {
    Pair pair;
    auto application = std::make_unique<Keeper>();
    Keeper& keeper = *application;
    Process& process = pair.run->network->add_process(pair.peer, "keeper", std::move(application));
    pair.run->network->listen(pair.peer, pair.to_peer, &process);
    std::vector<std::byte> payload(length);
    for (std::size_t i = 0; i < length; ++i) payload[i] = static_cast<std::byte>(i * 7 + 1);
    pair.scripted->on_start = [&](HostServices& host) { host.send(pair.to_peer, payload); };
    pair.run->until(1_ms);
    EXPECT_EQ(pair.run->stream(pair.to_peer).delivered, 1u);
    EXPECT_EQ(keeper.kept, payload);
  }
}

TEST(Process, APayloadBeyondAFrameIsACheck) {
  Pair pair;
  pair.scripted->on_start = [&](HostServices& host) { host.send(pair.to_peer, std::vector<std::byte>(1'600)); };
  EXPECT_THROW(pair.run->until(1_ms), sim::InvariantBroken);
}

// While it is told of one frame an application sends more than the pool of frames holds: the frame it was told of is
// whole afterwards.
TEST(Process, AnswersWithMoreFramesThanThereWere) {
  Pair pair;
  Process& sender = pair.run->network->add_process(pair.peer, "sender", std::make_unique<Scripted>());
  pair.scripted->on_receive = [&](HostServices& host) {
    for (int i = 0; i < 1'000; ++i) host.send(pair.to_peer, std::vector<std::byte>(46));
  };
  pair.run->until(1_us);
  sender.call([&](Application&, HostServices& host) { host.send(pair.to_host, std::vector<std::byte>(46)); });
  pair.run->until(10_ms);
  EXPECT_EQ(pair.run->stream(pair.to_host).delivered, 1u);
  EXPECT_EQ(pair.run->stream(pair.to_peer).delivered, 1'000u);
  EXPECT_EQ(pair.run->network->traffic().live_frames(), 0u);
}

// The latency is not added to never.
TEST(Process, AnAlarmForNeverWithAWakeUpLatency) {
  OsLatency latency;
  latency.wake_up = Distribution::constant(3_us);
  Pair pair(latency);
  pair.scripted->on_start = [](HostServices& host) { host.set_alarm(0, LocalTime::never()); };
  EXPECT_NO_THROW(pair.run->until(1_ms));
  EXPECT_EQ(pair.scripted->log, Log{});
}

}  // namespace
}  // namespace takt::models
