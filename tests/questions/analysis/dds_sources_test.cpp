// SPDX-License-Identifier: Apache-2.0
// Arrival curves of participants of DDS, counted by hand from src/protocol/dds: a reader greets at most 7 times until its
// greetings are 3 s apart (70, 140, 280, 560, 1120, 2240, 3000 ms); each greeting may be answered by a HEARTBEAT, each
// HEARTBEAT by an ACKNACK. So of one reader and one writer, as {once per match, per greeting, per 3 s}, HEARTBEATs are
// {1, 1, 2} and ACKNACKs {1, 2, 3}.
#include "analysis/dds_sources.hpp"

#include <gtest/gtest.h>

#include <string>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::dds_sources_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

constexpr Ps ms = 1'000'000'000;

/// Two hosts; what topic, domain and readers there are.
std::shared_ptr<scenario::Resolved> plant(const std::string& topic, const std::string& more = {},
                                          const std::string& reader = {}, const std::string& link = {}) {
  const std::string text =
      R"({"name": "t", "duration": "1s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "delay": "0s")" +
      link + R"(}]},
   "topics": [{"name": "sample", "protocol": "dds", "fields": {"level": "Int32"})" +
      topic + R"(}],
   "applications": [{"name": "sensor", "on": "a", "threads": [{"name": "publish", "publish": "sample", "every": "1ms"}]},
                    {"name": "actor", "on": "b", "threads": [{"name": "take", "subscribe": "sample", "every": "1ms")" +
      reader + R"(}]}])" + more + "}";
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text();
  return resolved;
}

const std::string found_beforehand = R"(, "domains": [{"id": 0, "discovery": "static"}])";

/// Messages of a stream of at least so many octets in an interval, at most.
std::int64_t most(const scenario::Resolved& r, const std::string& stream, Ps interval, std::uint32_t from_octets = 0) {
  BoundOptions options;
  options.dds_within = 2_ms;
  const DdsTraffic traffic = dds_traffic(r, options, HostTimes(r));
  std::int64_t count = 0;
  for (const DdsSource& source : traffic.sources)
    if (r.plan.streams[source.stream.value].name == stream && source.payload.count >= from_octets)
      count += source.arrivals.count(interval);
  return count;
}
std::string why(const scenario::Resolved& r, const std::string& stream) {
  for (const StreamBound& each : bound(r).streams)
    if (each.name == stream) return each.latency ? "" : each.reason;
  return "no such stream";
}

// One message each millisecond: 104 octets beside the payload of 4 + 4, and room for a HEARTBEAT of 32. Nothing else
// goes that way, and nothing comes back.
TEST(DdsSources, BestEffortIsWhatIsPublished) {
  const auto r = plant("", found_beforehand);
  EXPECT_EQ(most(*r, "rtps-0/sensor/actor", 0), 1);
  EXPECT_EQ(most(*r, "rtps-0/sensor/actor", ms - 1), 1);
  EXPECT_EQ(most(*r, "rtps-0/sensor/actor", ms), 2);
  EXPECT_EQ(most(*r, "rtps-0/sensor/actor", 0, 104 + 8 + 32), 1);
  EXPECT_EQ(most(*r, "rtps-0/sensor/actor", 0, 104 + 8 + 32 + 1), 0);
  EXPECT_EQ(most(*r, "rtps-0/actor/sensor", 3000 * ms), 0);
}

// Beside the sample: HEARTBEATs {1, 1, 2}; each ACKNACK {1, 2, 3} may be answered by the one sample that the history
// holds and two GAPs; one GAP at the match. At one instant samples 1 + 1 + 2 + 3 = 7; others 1 + 2 + 1, 1 + 4, 2 + 6
// = 17. After the 3 s (less what answers may be late, 20 ms) once more those of a period.
TEST(DdsSources, ReliableIsAlsoHeartbeatsAndRepairs) {
  const auto r = plant(R"(, "qos": {"reliability": "reliable"})", found_beforehand);
  const std::string there = "rtps-0/sensor/actor";
  EXPECT_EQ(most(*r, there, 0, 144), 7);
  EXPECT_EQ(most(*r, there, 0), 7 + 17);
  // Readers greet 70 ms apart, 20 of which may be gone: another {1, 2} samples and {1 + 4} others, and 50 samples.
  EXPECT_EQ(most(*r, there, 50 * ms), 24 + 50 + 2 + 5);
  EXPECT_EQ(most(*r, "rtps-0/actor/sensor", 0), 1 + 2 + 3);
  // Seven greetings in a lease of 20 s, two periods, one match.
  EXPECT_EQ(most(*r, "rtps-0/actor/sensor", 2980 * ms), 1 + 7 * 2 + 2 * 3);
}

// New samples go to the group, once for each write, and in each period (and at the instant at which one ends) a
// HEARTBEAT for all. To the reader alone go HEARTBEATs, repairs and GAPs as above, but no new sample.
TEST(DdsSources, ToAGroupGoesWhatIsNew) {
  const std::string grouped = R"(, "domains": [{"id": 0, "discovery": "static", "multicast": true}])";
  const auto best_effort = plant("", grouped);
  EXPECT_EQ(most(*best_effort, "rtps-0/sensor/samples", 0), 1);
  EXPECT_EQ(most(*best_effort, "rtps-0/sensor/samples", ms), 2);
  EXPECT_EQ(most(*best_effort, "rtps-0/sensor/samples", 0, 104 + 8 + 32 + 1), 0);
  EXPECT_EQ(most(*best_effort, "rtps-0/sensor/actor", 3000 * ms), 0);
  const auto reliable = plant(R"(, "qos": {"reliability": "reliable"})", grouped);
  EXPECT_EQ(most(*reliable, "rtps-0/sensor/samples", 0), 1 + 1);
  EXPECT_EQ(most(*reliable, "rtps-0/sensor/samples", 50 * ms), 51 + 1);
  EXPECT_EQ(most(*reliable, "rtps-0/sensor/actor", 0, 144), 7 - 1);
  EXPECT_EQ(most(*reliable, "rtps-0/sensor/actor", 0), 24 - 1);
  // The ten samples of its history may go to the group for one reader that is the first, once per match.
  const auto lasting =
      plant(R"(, "qos": {"reliability": "reliable", "durability": "transient-local", "depth": 10})", grouped);
  EXPECT_EQ(most(*lasting, "rtps-0/sensor/samples", 0), 1 + 1 + 10);
}

// Of static discovery one built-in writer and reader are left, those of liveliness, of at most two instances:
// HEARTBEATs {1, 1, 2}, own ACKNACKs {1, 2, 3}, three GAPs an answer {3, 6, 9}, one at the match and three between what
// is past: 9 + 9 + 14. With samples {1, 2, 3} times two, two that are past and the answer of SPDP: 2 + 2 + 1, 4, 6.
TEST(DdsSources, DiscoveryIsCounted) {
  const auto r = plant("", found_beforehand);
  EXPECT_EQ(most(*r, "rtps-0/sensor/actor/discovery", 0), 9 + 9 + 14 + 5 + 4 + 6);
  // Announcements: five at the start, 100 ms apart, and one each 3 s.
  EXPECT_EQ(most(*r, "rtps-0/sensor/discovery", 0), 2);
  EXPECT_EQ(most(*r, "rtps-0/sensor/discovery", 399 * ms), 1 + 4);
  EXPECT_EQ(most(*r, "rtps-0/sensor/discovery", 2999 * ms), 1 + 5);
  EXPECT_EQ(most(*r, "rtps-0/sensor/discovery", 3000 * ms), 2 + 5);
}

// An acknowledged write that finds the history full waits for 100 ms at most.
TEST(DdsSources, WritesThatWaitAreLate) {
  const auto r = plant(R"(, "qos": {"reliability": "reliable", "resource_limits": {"max_samples": 3}, "depth": 3})",
                       found_beforehand);
  const auto free = plant(R"(, "qos": {"reliability": "reliable", "depth": 3})", found_beforehand);
  EXPECT_GE(most(*r, "rtps-0/sensor/actor", 0), most(*free, "rtps-0/sensor/actor", 0) + 100);
}

// A host that starts again has another participant, and the others keep the first one until its lease is over.
TEST(DdsSources, EachLifeOfAHostIsAnotherParticipant) {
  const auto r =
      plant("", found_beforehand + R"(, "faults": [{"kind": "crash", "node": "a", "at": "100ms", "for": "10ms"}])");
  EXPECT_EQ(most(*r, "rtps-0/sensor/actor", 0), 2);
  EXPECT_EQ(most(*r, "rtps-0/sensor/discovery", 0), 4);
}

// At 1 Gbit/s all of that is over within 2 ms, and so there are bounds, of whatever shares the class, too.
TEST(DdsSources, WhatSharesTheClassHasABound) {
  const auto r = plant(R"(, "qos": {"reliability": "reliable"})",
                       R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "46B", "every": "1ms"}])");
  const Bounds bounds = bound(*r);
  EXPECT_EQ(bounds.dds_within, 2_ms);
  for (const StreamBound& stream : bounds.streams) EXPECT_TRUE(stream.latency) << stream.name << ": " << stream.reason;
}

// On a slow link it takes longer, of 272 samples in an answer, as a history without a limit has them, longer than 200
// ms.
TEST(DdsSources, WhatAnswersTooLateHasNoBound) {
  const std::string slow = R"(, "rate": "10Mbps")";
  EXPECT_EQ(bound(*plant(R"(, "qos": {"reliability": "reliable"})", found_beforehand, "", slow)).dds_within, 20_ms);
  const auto r = plant(R"(, "qos": {"reliability": "reliable", "history": "keep-all"})", found_beforehand, "", slow);
  EXPECT_FALSE(bound(*r).dds_within);
  EXPECT_NE(why(*r, "rtps-0/sensor/actor").find("whose answers of DDS have no bound, since rtps-0/"), std::string::npos)
      << why(*r, "rtps-0/sensor/actor");
}

TEST(DdsSources, WhatHasNoCurveHasItsReason) {
  const auto reason = [](const std::string& topic, const std::string& more,
                         const std::string& stream = "rtps-0/sensor/actor") {
    return why(*plant(topic, more), stream);
  };
  EXPECT_NE(
      reason("", R"(, "domains": [{"id": 0, "discovery": "server", "server": "actor"}])").find("a discovery server"),
      std::string::npos);
  EXPECT_NE(
      reason(R"(, "qos": {"reliability": "reliable", "durability": "transient-local", "history": "keep-all"})", "")
          .find("keeps any number of samples"),
      std::string::npos);
}

}  // namespace
}  // namespace takt::analysis::dds_sources_test
