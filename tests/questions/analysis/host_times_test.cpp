// SPDX-License-Identifier: Apache-2.0
// What threads of processors add to streams, reactions and calls. At 100 Mbit/s a frame with 46 octets over UDP takes 8
// us to its last bit: 28 of IPv4 and UDP, 18 of Ethernet, 8 of preamble.
#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "analysis/thread_bound.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::host_times_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

/// A cable from a to b, whose processors are these.
std::shared_ptr<scenario::Resolved> pair(const std::string& a, const std::string& b, const std::string& more) {
  const std::string text = R"({"name": "t", "duration": "100ms", "network": {"nodes": {"a": {"kind": "host")" + a +
                           R"(}, "b": {"kind": "host")" + b +
                           R"(}}, "links": [{"ends": ["a", "b"], "rate": "100Mbps", "delay": "0s"}]}, )" + more + "}";
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text();
  return resolved;
}
std::string cpu(const std::string& threads) { return R"(, "cpu": {"threads": [)" + threads + "]}"; }

const std::string stream = R"("streams": [{"name": "s", "from": "a", "to": "b", "payload": "46B", "every": "1ms"}])";

// 20 us at most behind a load of 30 us to be sent, 8 us on the cable, and 7 us to be taken in, which nothing delays
// there; at least 10 + 8 + 7.
TEST(HostTimes, TheStackIsPartOfAWay) {
  const auto resolved = pair(
      cpu(R"({"name": "stack", "execution": {"uniform": {"from": "10us", "to": "20us"}}, "stack": ["transmit"]}, {"name": "load", "priority": 9, "execution": "30us", "every": "10ms"})"),
      cpu(R"({"name": "stack", "execution": "7us", "stack": ["receive"]})"), stream);
  const StreamBound found = bound(*resolved).streams.at(0);
  // Frames of the class are taken in one by one: a nanosecond for those that come at one instant (waits_in_order).
  EXPECT_EQ(found.latency, Duration::from_ps(50'000'000 + 8'000'000 + 7'000'000 + waits_in_order)) << found.reason;
  EXPECT_EQ(found.least, Duration::from_ps(10'000'000 + 8'000'000 + 7'000'000));
  EXPECT_TRUE(found.reaches_all);
}

TEST(HostTimes, WhatOverloadsItsHostHasNoBound) {
  const auto resolved = pair(
      {},
      cpu(R"({"name": "stack", "execution": "7us", "stack": ["receive"]}, {"name": "load", "priority": 9, "execution": "1ms", "every": "1ms"})"),
      stream);
  const StreamBound found = bound(*resolved).streams.at(0);
  EXPECT_FALSE(found.latency);
  EXPECT_EQ(found.reason, "thread b/stack: its core has more to do than it can");
  EXPECT_FALSE(found.reaches_all);
}

// Of each neighbour five messages in each 62.5 ms of half an interval, and an Announce: six jobs of 10 us that come at
// once, and the load.
TEST(HostTimes, MessagesOfClocksAreJobs) {
  const auto resolved = pair(
      cpu(R"({"name": "clock", "priority": 9, "execution": "10us", "stack": ["gptp"]}, {"name": "load", "execution": "30us", "every": "10ms"})"),
      {}, stream + R"(, "clocks": {"gptp": {}})");
  const Bounds bounds = bound(*resolved);
  EXPECT_EQ(duration_of(bounds.hosts->nodes()[0][0].worst), 60_us) << bounds.hosts->nodes()[0][0].reason;
  EXPECT_EQ(duration_of(bounds.hosts->nodes()[0][1].worst), 90_us);
}

// A call every millisecond, ready within 100 us, works for 300 us behind a load of 400 us.
TEST(HostTimes, CallsWaitForTheirThreads) {
  const std::string threads =
      R"({"name": "work", "execution": "300us", "runs": ["sensor"]}, {"name": "load", "priority": 9, "execution": "400us", "every": "50ms"})";
  const auto resolved =
      pair(cpu(threads), {}, R"("topics": [{"name": "level", "protocol": "opc-ua", "fields": {"level": "Int32"}}],
     "applications": [{"name": "sensor", "on": "a", "threads": [{"name": "publish", "publish": "level", "every": "1ms", "response": {"uniform": {"from": "0s", "to": "100us"}}}]},
                      {"name": "actor", "on": "b", "threads": [{"name": "take", "subscribe": "level", "every": "1ms"}]}])");
  const Bounds bounds = bound(*resolved);
  const ThreadBound found = thread_bound(*resolved, bounds, 0, 0, {});
  EXPECT_EQ(found.least_response, 300_us);
  EXPECT_EQ(found.greatest_response, 800_us);
  EXPECT_TRUE(found.is_always_done) << found.reason;
}

// With 700 us of load a call may take 1.1 ms: the next one is due.
TEST(HostTimes, CallsThatOverrunAreNotCertain) {
  const std::string threads =
      R"({"name": "work", "execution": "300us", "runs": ["sensor"]}, {"name": "load", "priority": 9, "execution": "700us", "every": "50ms"})";
  const auto resolved =
      pair(cpu(threads), {}, R"("topics": [{"name": "level", "protocol": "opc-ua", "fields": {"level": "Int32"}}],
     "applications": [{"name": "sensor", "on": "a", "threads": [{"name": "publish", "publish": "level", "every": "1ms", "response": {"uniform": {"from": "0s", "to": "100us"}}}]},
                      {"name": "actor", "on": "b", "threads": [{"name": "take", "subscribe": "level", "every": "1ms"}]}])");
  EXPECT_FALSE(thread_bound(*resolved, bound(*resolved), 0, 0, {}).is_always_done);
}

}  // namespace
}  // namespace takt::analysis::host_times_test
