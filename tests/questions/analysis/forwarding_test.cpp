// SPDX-License-Identifier: Apache-2.0
// Forwarding delays with jitter, and priorities that frames have at their host only, against figures by hand. Frames of
// 150 octets (tagged) take 158 octets of 8 ns to their last bit, and 170 of the medium.
#include <gtest/gtest.h>

#include <stdexcept>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::forwarding_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

Bounds bounds_of(const std::string& sw, const std::string& streams, const std::string& kind = "switch") {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(
      R"({"name": "forwarding", "duration": "50ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": ")" +
          kind + R"(", )" + sw + R"(}}, "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}]}, "streams": [)" +
          streams + "]}",
      "forwarding.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return bound(*resolved);
}

std::string stream(const std::string& name, const std::string& rest) {
  return R"({"name": ")" + name + R"(", "from": "a", "to": "b", "every": "1ms", )" + rest + "}";
}

const std::string jitter =
    R"("forwarding_delay": "920ns", "forwarding_jitter": {"uniform": {"from": "0ns", "to": "160ns"}})";
const std::string urgent = R"("payload": "100B", "pcp": 6)";

// Alone: twice 1264 ns, two cables of 50 ns, and 920 to 1080 ns between them.
TEST(ForwardingJitter, IsBoundedByItsEnds) {
  const Bounds bounds = bounds_of(jitter, stream("x", urgent));
  EXPECT_EQ(bounds.streams.at(0).latency, 3'708_ns);
  EXPECT_EQ(bounds.streams.at(0).least, 3'548_ns);
}

// Two frames that leave the host at once wait for each other there, 1360 ns. The wire keeps them apart, and behind a
// fixed delay they do not meet again; with jitter the second one may catch up.
TEST(ForwardingJitter, FramesOfOneLinkMayMeetAgain) {
  const std::string two = stream("x", urgent) + ", " + stream("y", urgent);
  EXPECT_EQ(bounds_of(R"("forwarding_delay": "1080ns")", two).streams.at(0).latency, 1'360_ns + 3'708_ns);
  EXPECT_EQ(bounds_of(jitter, two).streams.at(0).latency, 2 * 1'360_ns + 3'708_ns);
}

// What a station forwards takes the time of a switch.
TEST(ForwardingJitter, OfAStationIsBoundedByItsEnds) {
  const Bounds bounds = bounds_of(jitter, stream("x", urgent), "station");
  EXPECT_EQ(bounds.streams.at(0).latency, 3'708_ns);
  EXPECT_EQ(bounds.streams.at(0).least, 3'548_ns);
}

// For its host as well: 1264 ns, a cable of 50 ns, 920 to 1080 ns. What the host sends has none: 1264 and 50 ns.
TEST(ForwardingJitter, OfAStationIsOfWhatComesIn) {
  const Bounds bounds = bounds_of(
      jitter,
      R"({"name": "in", "from": "a", "to": "sw", "every": "1ms", "payload": "100B", "pcp": 6}, {"name": "out", "from": "sw", "to": "b", "every": "1ms", "payload": "100B", "pcp": 6})",
      "station");
  EXPECT_EQ(bounds.streams.at(0).latency, 2'394_ns);
  EXPECT_EQ(bounds.streams.at(0).least, 2'234_ns);
  EXPECT_EQ(bounds.streams.at(1).latency, 1'314_ns);
  EXPECT_EQ(bounds.streams.at(1).least, 1'314_ns);
}

// Filters have seen the frame before the jitter: what they have let pass comes otherwise than they have seen it.
TEST(ForwardingJitter, BehindFiltersThereIsNoBound) {
  const Bounds bounds =
      bounds_of(jitter + R"(, "ingress": {"filters": [{"stream": "x", "max_sdu": "1000B"}]})", stream("x", urgent));
  EXPECT_FALSE(bounds.streams.at(0).latency);
  EXPECT_NE(bounds.streams.at(0).reason.find("jitter"), std::string::npos) << bounds.streams.at(0).reason;
}

// Untagged, 146 octets: 1232 ns to the last bit. Two long ones of 1446 octets (11728 ns of the medium) may be before it
// at the host, or one of them if the host queues it by its priority; at the switch all three are alike, and the wire
// keeps them apart, but the long one before it still takes its time there: 11728 - 1328 ns of it when the short one has
// come, after its own 1232 ns.
TEST(HostPriority, CountsAtTheHostAlone) {
  const std::string loads = ", " + stream("v", R"("payload": "1400B")") + ", " + stream("w", R"("payload": "1400B")");
  const std::optional<Duration> alike =
      bounds_of(R"("forwarding_delay": "0ns")", stream("x", R"("payload": "100B")") + loads).streams.at(0).latency;
  const std::optional<Duration> first =
      bounds_of(R"("forwarding_delay": "0ns")", stream("x", R"("payload": "100B", "host_priority": 6)") + loads)
          .streams.at(0)
          .latency;
  ASSERT_TRUE(alike && first);
  EXPECT_EQ(*alike - *first, 11'728_ns);
}

}  // namespace
}  // namespace takt::analysis::forwarding_test
