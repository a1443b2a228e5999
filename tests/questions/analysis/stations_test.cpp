// SPDX-License-Identifier: Apache-2.0
// Bounds over stations, by hand: 1 Gbit/s, 50 ns of cable, 500 ns of forwarding; 100 octets over Ethernet are 118
// octets, 1008 ns with their preamble.
#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::stations_test {
namespace {

using namespace sim::literals;  // NOLINT

StreamBound bound_of(const std::string& from, const std::string& to) {
  const std::string text = R"({"name": "t", "duration": "10ms",
 "network": {"nodes": {"plc": {"kind": "host"}}, "links": [{"ends": ["plc", "st1"]}], "generate": [{"topology": "line", "stations": 2, "forwarding_delay": "500ns"}]},
 "streams": [{"name": "s", "from": ")" +
                           from + R"(", "to": ")" + to +
                           R"(", "payload": "100B", "every": "1ms", "encapsulation": "ethernet"}]})";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text();
  return resolved ? bound(*resolved).streams[0] : StreamBound();
}

// Alone on its way a frame takes neither less nor more.
TEST(StationBounds, OfAFrameThatIsAlone) {
  for (const auto& [from, to, takes] :
       {std::tuple("st1", "plc", 1008_ns + 50_ns), std::tuple("plc", "st1", 1008_ns + 50_ns + 500_ns),
        std::tuple("st2", "plc", 2 * (1008_ns + 50_ns) + 500_ns),
        std::tuple("plc", "st2", 2 * (1008_ns + 50_ns + 500_ns))}) {
    const StreamBound made = bound_of(from, to);
    EXPECT_EQ(made.least, takes) << from << " to " << to;
    EXPECT_EQ(made.latency, takes) << from << " to " << to;
  }
}

}  // namespace
}  // namespace takt::analysis::stations_test
