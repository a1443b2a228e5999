// SPDX-License-Identifier: Apache-2.0
// ATS schedulers at talkers: from the scenario to the run, and what is refused.
#include "support.hpp"

namespace takt::scenario::test {
namespace {

/// A talker with those fields that sends bursts of four frames of 270 octets with preamble and gap, in class 5, over a
/// switch.
std::string shaped(const std::string& talker, const std::string& stream = {}) {
  return R"({"name": "t", "duration": "3ms", "network": {"nodes": {"a": {"kind": "host", )" + talker +
         R"(}, "b": {"kind": "host"}, "sw": {"kind": "switch"}},
 "links": [{"ends": ["a", "sw"], "rate": "100Mbps", "delay": "0s"}, {"ends": ["b", "sw"], "rate": "100Mbps", "delay": "0s"}]},
 "streams": [{"name": "s", "from": "a", "to": "b", "payload": "200B", "burst": {"frames": 4, "every": "1ms"}, "pcp": 5)" +
         stream + R"(},
             {"name": "free", "from": "a", "to": "b", "payload": "200B", "every": "1ms", "offset": "100us", "pcp": 5}]})";
}
constexpr const char* ats_5 = R"("egress": [{"ats": [5]}], "ats": )";

bool complains(const std::string& text, const std::string& place, const std::string& what) {
  return load(text).diagnostics.to_text().find("at " + place + ": " + what) != std::string::npos;
}
Duration worst(const LiveRun& run, std::size_t stream) {
  return run.network().traffic().streams()[stream].latency.maximum();
}

// 2160 bits a frame with preamble and gap; a bucket of 4320 bits that fills with 20 Mbit/s. Of four frames at once the
// first two go, the third lacks 2160 bits (108 us), the fourth as many again: eligible at 216 us. Then 250 octets and a
// preamble twice, 20.64 us each: 257.28 us. The next burst finds a full bucket. What nobody shapes goes in between.
TEST(TalkerAts, SpreadsABurst) {
  const auto r = sound(shaped(std::string(ats_5) + R"([{"stream": "s", "rate": "20Mbps", "burst": "540B"}])"));
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(worst(run, 0), Duration::from_ps(257'280'000));
  EXPECT_EQ(worst(run, 1), Duration::from_ps(2 * 20'640'000));
  EXPECT_EQ(run.network().traffic().streams()[0].delivered, 12u);
}

// Without preamble and gap 2000 bits a frame, a bucket of 4000.
TEST(TalkerAts, CountsFramesAlone) {
  const auto r =
      sound(shaped(std::string(ats_5) + R"([{"stream": "s", "rate": "20Mbps", "burst": "500B", "length": "frame"}])"));
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(worst(run, 0), Duration::from_ps(200'000'000 + 2 * 20'640'000));
}

// The switch minds its own times only: there frames wait for nothing.
TEST(TalkerAts, EndsWithTheTalker) {
  std::string text = shaped(std::string(ats_5) + R"([{"stream": "s", "rate": "20Mbps", "burst": "540B"}])");
  const std::string bridge = R"("sw": {"kind": "switch")";
  text.replace(text.find(bridge), bridge.size(), bridge + R"(, "egress": [{"ats": [5]}])");
  const auto r = sound(text);
  LiveRun run(*r);
  run.advance();
  EXPECT_EQ(worst(run, 0), Duration::from_ps(257'280'000));
}

TEST(TalkerAts, MistakesAreTold) {
  EXPECT_TRUE(complains(shaped(std::string(ats_5) + R"([{"stream": "x", "rate": "20Mbps", "burst": "540B"}])"),
                        "/network/nodes/a/ats/0/stream", "unknown stream"));
  EXPECT_TRUE(complains(shaped(std::string(ats_5) + R"([{"stream": "s", "rate": "20Mbps", "burst": "269B"}])"),
                        "/network/nodes/a/ats/0/burst", "a burst smaller than a frame"));
  EXPECT_TRUE(complains(shaped(std::string(ats_5) + R"([{"stream": "s", "rate": "200Mbps", "burst": "540B"}])"),
                        "/network/nodes/a/ats/0/rate", "a scheduler faster than its link"));
  EXPECT_TRUE(complains(shaped(R"("ats": [{"stream": "s", "rate": "20Mbps", "burst": "540B"}])"),
                        "/network/nodes/a/ats/0/stream", "eligibility times that no port minds"));
  EXPECT_TRUE(complains(shaped(R"("egress": [{"ats": [5]}])"), "/network/nodes/a/egress/0/ats", "ATS in a host"));
  EXPECT_TRUE(complains(
      shaped(
          std::string(ats_5) +
          R"([{"stream": "s", "rate": "20Mbps", "burst": "540B"}, {"stream": "s", "rate": "20Mbps", "burst": "540B"}])"),
      "/network/nodes/a/ats/1/stream", "a stream with two schedulers"));
}

}  // namespace
}  // namespace takt::scenario::test
