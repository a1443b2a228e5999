// SPDX-License-Identifier: Apache-2.0
// Separated-flow analysis of scenarios, by hand.
#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "analysis/picoseconds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::separated_flow_test {
namespace {

using sim::Duration;

Bounds bounds_of(const std::string& more) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(
      R"({"name": "line", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"},
    "s1": {"kind": "switch", "forwarding_delay": "1us"}, "s2": {"kind": "switch", "forwarding_delay": "1us")" +
          std::string(
              more.starts_with("gates")
                  ? R"(, "egress": [{"gates": {"entries": [{"open": [6], "for": "100us"}, {"open": [0], "for": "100us"}]}}])"
                  : "") +
          R"(}},
    "links": [{"ends": ["a", "s1"], "rate": "100Mbps", "delay": "100ns"}, {"ends": ["s1", "s2"], "rate": "100Mbps", "delay": "100ns"}, {"ends": ["s2", "b"], "rate": "100Mbps", "delay": "100ns"},
              {"ends": ["c", "s2"], "rate": "100Mbps", "delay": "100ns"}]},
   "streams": [{"name": "f", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"})" +
          (more.starts_with("gates") ? "" : more) + "]}",
      "line.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return bound(*resolved);
}

// 100 octets of payload are 150 octets from DA to FCS and 170 with preamble and gap: 13.6 us. Three links, two
// switches; the last gap, 0.96 us, is not waited for.
TEST(SeparatedFlow, AloneItIsStoredAtEachHop) {
  const Bounds bounds = bounds_of("");
  const Ps exact = 3 * 13'600'000 - 960'000 + 3 * 100'000 + 2 * 1'000'000;
  EXPECT_GE(bounds.streams[0].separated_flow->ps(), exact);
  EXPECT_LE(bounds.streams[0].separated_flow->ps(), exact + 2);  // rounded up
  EXPECT_EQ(*bounds.streams[0].total_flow,
            Duration::from_ps(3 * 13'600'000 - 3 * 960'000 + 3 * 100'000 + 2 * 1'000'000));
}

// At the last port a frame of c, 1050 octets and 20 = 85.6 us of each 1 ms: in its class it leaves 1 - 0.0856 of the
// rate after 85.6 us.
TEST(SeparatedFlow, PaysForOthersInItsClass) {
  const Bounds bounds =
      bounds_of(R"(, {"name": "c", "from": "c", "to": "b", "payload": "1000B", "pcp": 6, "every": "1ms"})");
  const double rest = 2 * 13.6 - 0.96 + 2.3;
  EXPECT_NEAR(static_cast<double>(bounds.streams[0].separated_flow->ps()), 1e6 * (rest + 85.6 + 13.6 / (1 - 0.0856)),
              10);
  EXPECT_EQ(bounds.streams[0].latency, std::min(bounds.streams[0].separated_flow, bounds.streams[0].total_flow));
}

// In a lower class it blocks once; in a higher one it goes before and takes its rate too: 13.6 us / (1 - 0.0856),
// after 85.6 us / (1 - 0.0856).
TEST(SeparatedFlow, PaysForOtherClasses) {
  const double rest = 2 * 13.6 - 0.96 + 2.3;
  const Bounds lower =
      bounds_of(R"(, {"name": "c", "from": "c", "to": "b", "payload": "1000B", "pcp": 0, "every": "1ms"})");
  EXPECT_NEAR(static_cast<double>(lower.streams[0].separated_flow->ps()), 1e6 * (rest + 85.6 + 13.6), 10);
  const Bounds higher =
      bounds_of(R"(, {"name": "c", "from": "c", "to": "b", "payload": "1000B", "pcp": 7, "every": "1ms"})");
  EXPECT_NEAR(static_cast<double>(higher.streams[0].separated_flow->ps()), 1e6 * (rest + (85.6 + 13.6) / (1 - 0.0856)),
              10);
}

TEST(SeparatedFlow, SaysWhereItDoesNotApply) {
  const Bounds bounds = bounds_of("gates");
  EXPECT_FALSE(bounds.streams[0].separated_flow);
  EXPECT_EQ(bounds.streams[0].separated_flow_reason.substr(0, 11), "gates at s2");
  EXPECT_EQ(bounds.streams[0].latency, bounds.streams[0].total_flow);
}

}  // namespace
}  // namespace takt::analysis::separated_flow_test
