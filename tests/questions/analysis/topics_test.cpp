// SPDX-License-Identifier: Apache-2.0
// Topics over OPC UA as flows, at 80 ns an octet. The message of one Int32 has 20 octets: 4 of flags and PublisherId, 3
// of the group, 3 of the payload header, 3 of flags and sequence number, 2 of how many fields there are and 5 of a
// Variant. With 14 of Ethernet, 4 of the tag, 28 of IPv4 and UDP and 4 of the check sequence a frame has 70: 6.24 us
// with its preamble to its last bit, and 7.2 us on the medium with the gap.
#include <gtest/gtest.h>

#include <string>

#include "analysis/bounds.hpp"
#include "analysis/thread_bound.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::topics_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

/// Two hosts and a switch without delays; what publishes every millisecond, and what else there is.
std::shared_ptr<scenario::Resolved> plant(const std::string& response, const std::string& subscriber,
                                          const std::string& more = {}, const std::string& duration = "100ms") {
  const std::string text = R"({"name": "t", "duration": ")" + duration + R"(",
   "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch", "forwarding_delay": "0s"}},
     "links": [{"ends": ["a", "sw"], "rate": "100Mbps", "delay": "0s"}, {"ends": ["sw", "b"], "rate": "100Mbps", "delay": "0s"}, {"ends": ["c", "sw"], "rate": "100Mbps", "delay": "0s"}]},
   "topics": [{"name": "level", "protocol": "opc-ua", "pcp": 5, "fields": {"level": "Int32"}}],
   "applications": [{"name": "sensor", "on": "a", "threads": [{"name": "publish", "publish": "level", "every": "1ms", "response": )" +
                           response + R"(}]},
                    {"name": "actor", "on": "b", "threads": [{"name": "take", "subscribe": "level", )" +
                           subscriber + R"(}]}])" + more + "}";
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text();
  return resolved;
}

const std::string on_time = R"("every": "1ms", "response": {"fixed": "10us"})";

/// From the beginning of a message's wait at the host to its last bit there, beside those before it, and one more hop
/// alone.
StreamBound stream_with(const std::string& response) {
  const auto resolved = plant(response, on_time);
  return bound(*resolved).streams.at(0);
}

// No jitter: the message meets none of its own, twice 6.24 us.
TEST(Topics, AConstantResponseIsNoJitter) {
  const StreamBound found = stream_with(R"({"fixed": "300us"})");
  EXPECT_EQ(found.latency, Duration::from_ps(2 * 6'240'000));
  EXPECT_EQ(found.least, Duration::from_ps(2 * 6'240'000));
  EXPECT_TRUE(found.reaches_all) << found.loss_reason;
}

// Responses from 0 to 998 us: two messages may be 2 us apart, and the second waits for 7.2 - 2 us. Behind the link they
// are 7.2 us apart, and none waits.
TEST(Topics, ResponsesAreJitter) {
  EXPECT_EQ(stream_with(R"({"uniform": {"from": "0s", "to": "998us"}})").latency,
            Duration::from_ps(2 * 6'240'000 + 5'200'000));
}

// A response of a period or more publishes nothing, so that two are at least 1 ps apart: 7.2 us less that.
TEST(Topics, ALateCallPublishesNothing) {
  for (const char* const law :
       {R"({"uniform": {"from": "0s", "to": "5ms"}})", R"({"weibull": {"scale": "900us", "shape": 0.8}})"})
    EXPECT_EQ(stream_with(law).latency, Duration::from_ps(2 * 6'240'000 + 7'200'000 - 1)) << law;
}

// What comes in a lower class waits for one message before it, where that was without a bound.
TEST(Topics, LowerClassesHaveABoundBesideThem) {
  const auto resolved =
      plant(R"({"uniform": {"from": "0s", "to": "100us"}})", on_time,
            R"(, "streams": [{"name": "s", "from": "c", "to": "b", "payload": "46B", "pcp": 0, "every": "1ms"}])");
  const Bounds bounds = bound(*resolved);
  ASSERT_EQ(bounds.streams.size(), 2U);
  for (const StreamBound& stream : bounds.streams) EXPECT_TRUE(stream.latency) << stream.name << ": " << stream.reason;
}

TEST(Topics, CallsThatAreNeverLateAreAllDone) {
  const auto resolved = plant(R"({"uniform": {"from": "20us", "to": "700us"}})", on_time);
  const Bounds bounds = bound(*resolved);
  const ThreadBound publishes = thread_bound(*resolved, bounds, 0, 0, {});
  EXPECT_TRUE(publishes.is_always_done && publishes.is_tested) << publishes.reason;
  EXPECT_EQ(publishes.least_response, 20_us);
  EXPECT_EQ(publishes.greatest_response, 700_us);
}

// From one call to the next 1010 us may pass: 2 messages without jitter, 1 + (1010 + 680) / 1000 with 680 us of it.
TEST(Topics, ACallFindsWhatHasComeSinceTheLast) {
  const auto found = [](const std::string& response) {
    const auto resolved = plant(response, on_time);
    return thread_bound(*resolved, bound(*resolved), 1, 0, {});
  };
  EXPECT_EQ(found(R"({"fixed": "0s"})").most_found, 2U);
  EXPECT_EQ(found(R"({"uniform": {"from": "0s", "to": "680us"}})").most_found, 2U);
  EXPECT_EQ(found(R"({"uniform": {"from": "0s", "to": "991us"}})").most_found, 3U);
  EXPECT_TRUE(found(R"({"fixed": "0s"})").loses_nothing);
}

TEST(Topics, WhatIsNotCertainHasItsReason) {
  const auto reason = [](const std::string& subscriber, const std::string& more,
                         const std::string& duration = "100ms") {
    const auto resolved = plant(R"({"fixed": "0s"})", subscriber, more, duration);
    const ThreadBound found = thread_bound(*resolved, bound(*resolved), 1, 0, {});
    EXPECT_FALSE(found.is_tested);
    return found.reason;
  };
  EXPECT_NE(reason(R"("every": "1ms", "response": {"weibull": {"scale": "100us", "shape": 0.8}})", "")
                .find("may last longer than the 1ms"),
            std::string::npos);
  EXPECT_NE(reason(on_time, R"(, "faults": [{"kind": "crash", "node": "b", "at": "10ms"}])").find("faults"),
            std::string::npos);
  EXPECT_NE(reason(on_time, R"(, "clocks": {"gptp": {}})").find("synchronisation"), std::string::npos);
  EXPECT_NE(reason(on_time, R"(, "clocks": {"all": {"initial": "-90ms"}})").find("before a window"), std::string::npos);
  EXPECT_NE(reason(on_time, "", "15ms").find("before a window"), std::string::npos);
}

// A call every 300 ms finds up to 301 messages, and a socket holds 256.
TEST(Topics, AFullInboxLosesMessages) {
  const auto resolved = plant(R"({"fixed": "0s"})", R"("every": "300ms", "response": {"fixed": "0s"})", "", "2s");
  const ThreadBound found = thread_bound(*resolved, bound(*resolved), 1, 0, {});
  EXPECT_FALSE(found.loses_nothing);
  EXPECT_NE(found.values_reason.find("up to 301 messages"), std::string::npos) << found.values_reason;
}

}  // namespace
}  // namespace takt::analysis::topics_test
