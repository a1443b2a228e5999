// SPDX-License-Identifier: Apache-2.0
// Streams with random gaps: those that have a least one have a bound.
#include <gtest/gtest.h>

#include <stdexcept>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::random_gaps_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

/// The bound of frames of 150 octets from a over sw to b, which frames of 1450 octets of a lower priority cross at sw.
std::optional<Duration> bound_with(const std::string& schedule) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(
      R"({"name": "gaps", "duration": "50ms", "allow_overload": true, "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch"}},
          "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
          "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, )" +
          schedule + R"(}, {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms"}]})",
      "gaps.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return bound(*resolved).streams.at(0).latency;
}

// A frame takes 158 octets of 8 ns to its last bit at each of two ports, 50 ns in each cable, and waits for 1470 octets
// at the switch: 2 * 1264 + 2 * 50 + 11760 ns. The next one comes 2 us later at the earliest, and needs 1.36 us of the
// medium, so it does not wait for longer.
TEST(RandomGaps, TheLeastGapCounts) {
  EXPECT_EQ(bound_with(R"("normal": {"mean": "1ms", "deviation": "1ms", "min": "2us"})"), 14'388_ns);
  EXPECT_EQ(bound_with(R"("normal": {"mean": "3us", "deviation": "1us", "min": "2us", "max": "5us"})"), 14'388_ns);
  EXPECT_EQ(bound_with(R"("every": "2us")"), 14'388_ns);
}

// Frames that come faster than they leave, if only for a while, and frames that may come at once.
TEST(RandomGaps, WithoutOneThereIsNoBound) {
  EXPECT_EQ(bound_with(R"("normal": {"mean": "1ms", "deviation": "1ms", "min": "1us"})"), std::nullopt);
  EXPECT_EQ(bound_with(R"("normal": {"mean": "1ms", "deviation": "1ms"})"), std::nullopt);
  EXPECT_EQ(bound_with(R"("exponential": "1ms")"), std::nullopt);
}

}  // namespace
}  // namespace takt::analysis::random_gaps_test
