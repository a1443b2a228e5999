// SPDX-License-Identifier: Apache-2.0
// Where all frames of a port are cut through, their latency is known to the bit.
#include <gtest/gtest.h>

#include "tests/questions/analysis/falsification.hpp"

namespace takt::analysis::cut_through_test {
namespace {

using sim::Duration;

struct Seen {
  Duration bound;
  Duration simulated;
};

/// A line of three switches that cut class 7 through, at 100 Mb/s; f goes from end to end.
Seen line(const std::string& more_links, const std::string& more_streams) {
  json::Diagnostics diagnostics;
  const std::string bridge = R"({"kind": "switch", "forwarding_delay": "1us", "egress": [{"cut_through": [7]}]})";
  const auto resolved = scenario::load_text(
      R"({"name": "line", "duration": "5ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "s1": )" +
          bridge + R"(, "s2": )" + bridge + R"(, "s3": )" + bridge +
          R"(}, "links": [{"ends": ["a", "s1"], "rate": "100Mbps", "delay": "100ns"}, {"ends": ["s1", "s2"], "rate": "100Mbps", "delay": "100ns"}, {"ends": ["s2", "s3"], "rate": "100Mbps", "delay": "100ns"},
            {"ends": ["s3", "b"], "rate": "100Mbps", "delay": "100ns"}, {"ends": ["c", "s2"], "delay": "100ns", )" +
          more_links +
          R"(}]}, "streams": [{"name": "f", "from": "a", "to": "b", "payload": "500B", "pcp": 7, "every": "250us"})" +
          more_streams + "]}",
      "line.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  const Bounds bounds = bound(*resolved);
  scenario::Run run(*resolved);
  run.advance();
  for (const std::string& violation : test::judge(run, bounds).violations) ADD_FAILURE() << violation;
  return {*bounds.streams[0].latency, run.network().traffic().streams()[0].latency.maximum()};
}

// 550 octets from DA to FCS; the last bit is out of the host after 558 octets, 44.64 us. At each switch the header of
// 22 octets and a tag, 2.08 us, the switch itself, 1 us; four links of 0.1 us. What c sends to a goes the other way.
TEST(CutThrough, AloneOnTheWayLatencyIsExact) {
  for (const std::string more :
       {"", R"(, {"name": "back", "from": "c", "to": "a", "payload": "300B", "pcp": 7, "every": "300us"})"}) {
    const Seen seen = line(R"("rate": "100Mbps")", more);
    EXPECT_EQ(seen.bound, Duration::from_ps(44'640'000 + 3 * 3'080'000 + 4 * 100'000));
    EXPECT_EQ(seen.simulated, seen.bound);
  }
}

// Two streams of one talker keep their order and their gap: the second waits at the talker only.
TEST(CutThrough, FramesOfOneLinkKeepTheirDistance) {
  const Seen seen = line(R"("rate": "100Mbps")",
                         R"(, {"name": "g", "from": "a", "to": "b", "payload": "800B", "pcp": 7, "every": "250us"})");
  // 850 octets and 20, 69.6 us, at the talker.
  EXPECT_EQ(seen.bound, Duration::from_ps(69'600'000 + 44'640'000 + 3 * 3'080'000 + 4 * 100'000));
}

// A frame that comes by another link may be in the way, and f is stored where it is.
TEST(CutThrough, WhatComesByAnotherLinkIsNoCutThrough) {
  const Seen seen = line(R"("rate": "100Mbps")",
                         R"(, {"name": "g", "from": "c", "to": "b", "payload": "800B", "pcp": 0, "every": "1ms"})");
  EXPECT_GT(seen.bound, Duration::from_ps(44'640'000 + 3 * 3'080'000 + 400'000 + 69'600'000));
}

}  // namespace
}  // namespace takt::analysis::cut_through_test
