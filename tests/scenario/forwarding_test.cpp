// What a bridge does with a frame between its two ports: ATS and the forwarding delay, cut-through.
#include "evaluation/evaluate.hpp"
#include "tests/scenario/support.hpp"

namespace takt::scenario::test::forwarding_test {
namespace {

using sim::Duration;
using namespace sim::literals;

results::RunResult judged(const Resolved& resolved) {
  LiveRun live(resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}

void expect_pass(const std::string& finding, const std::vector<std::string>& overrides = {}) {
  json::Diagnostics diagnostics;
  const auto resolved =
      load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + finding + ".json", overrides, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  for (const results::RequirementResult& requirement : judged(*resolved).requirements)
    EXPECT_EQ(requirement.verdict, results::Verdict::pass) << requirement.text << ": " << requirement.remark;
}

std::map<std::string, Duration> longest(const std::string& text) {
  std::map<std::string, Duration> made;
  for (const results::StreamResult& stream : judged(*sound(text)).streams) made[stream.name] = stream.latency->max;
  return made;
}

// Best effort waits behind its closed gate while the medium is idle: no reason to store the frame of class 7.
TEST(CutThrough, StartsBesideWhatWaitsForItsGate) { expect_pass("cut-through-backlog"); }

// The port is idle and two headers come at once: the one by the first port is cut through. The other one is stored at
// the first switch, starts a gap behind, and is cut through at the second.
TEST(CutThrough, TheFirstOfTwoHeadersStarts) { expect_pass("two-cut-through"); }

/// d1 and d2 to z over one switch that cuts through classes 5 and 6; 1 Gb/s, no delays on cables. A frame of 1,200
/// octets of payload with a tag is 1250 + 8 octets, 10.064 us; its header 26 octets, 208 ns.
std::string one_switch(const std::string& egress, const std::string& streams, const std::string& rate_of_d1 = "1Gbps") {
  return R"({"name": "one", "duration": "2ms", "network": {"nodes": {"d1": {"kind": "host"}, "d2": {"kind": "host"}, "z": {"kind": "host"},
    "sw": {"kind": "switch", "egress": [{"to": "z", "cut_through": [5, 6])" +
         egress + R"(}]}},
    "links": [{"ends": ["d1", "sw"], "delay": "0ns", "rate": ")" +
         rate_of_d1 +
         R"("}, {"ends": ["d2", "sw"], "delay": "0ns"}, {"ends": ["sw", "z"], "delay": "0ns"}]}, "streams": [)" +
         streams + "]}";
}
std::string stream(const std::string& name, const std::string& from, int pcp, const std::string& offset,
                   const std::string& payload = "1200B") {
  return R"({"name": ")" + name + R"(", "from": ")" + from + R"(", "to": "z", "payload": ")" + payload +
         R"(", "pcp": )" + std::to_string(pcp) + R"(, "every": "1ms", "offset": ")" + offset + R"("})";
}

// Of two headers of one instant that of the higher class goes first, although it comes by the second port.
TEST(CutThrough, TheMoreUrgentOfTwoHeadersStarts) {
  const auto latencies = longest(one_switch("", stream("low", "d1", 5, "0us") + "," + stream("high", "d2", 6, "0us")));
  EXPECT_EQ(latencies.at("high"), 10'064_ns + 208_ns);
  EXPECT_EQ(latencies.at("low"), 208_ns + 10'064_ns + 96_ns + 10'064_ns);
}

// Class 3 has no credit left and waits: a frame of class 5 is cut through meanwhile. A frame of class 3 has the medium
// for 170 octets, 1.36 us, in which its credit falls by 1292 bits; at 50 Mb/s it is back 25.84 us later.
TEST(CutThrough, StartsBesideWhatWaitsForCredit) {
  const std::string shaper = R"(, "shapers": [{"class": 3, "idle_slope": "50Mbps"}])";
  const auto latencies =
      longest(one_switch(shaper, stream("a", "d1", 3, "0us", "100B") + "," + stream("b", "d1", 3, "0us", "100B") + "," +
                                     stream("c", "d2", 5, "5us")));
  EXPECT_EQ(latencies.at("c"), 10'064_ns + 208_ns);
  EXPECT_GT(latencies.at("b"), 20_us);
}

// A frame of the same class that waits for the next window has come before: none overtakes it, although a short one
// would fit. The long one comes from a link of 100 Mb/s and is whole at 110.64 us; from then on it takes 10.064 us, and
// the window closes at 120 us.
TEST(CutThrough, NobodyOvertakesWithinAClass) {
  const std::string gates = R"(, "gates": {"entries": [{"open": [5], "for": "20us"}, {"open": [6], "for": "80us"}]})";
  const auto latencies = longest(
      one_switch(gates, stream("long", "d1", 5, "10us") + "," + stream("short", "d2", 5, "112us", "100B"), "100Mbps"));
  EXPECT_EQ(latencies.at("long"), 200_us - 10_us + 10'064_ns);
  EXPECT_EQ(latencies.at("short"), 200_us - 112_us + 10'064_ns + 96_ns + 1'264_ns);
}

// What may start now goes first, whatever its class: the frame of class 0 is whole when the header of class 6 comes.
TEST(CutThrough, IsNotDoneWhereAWholeFrameMayStart) {
  // 100 octets of payload with tag are whole after 158 octets, 1.264 us.
  const auto latencies =
      longest(one_switch("", stream("whole", "d1", 0, "0us", "100B") + "," + stream("header", "d2", 6, "1056ns")));
  EXPECT_EQ(latencies.at("whole"), 1'264_ns + 1'264_ns);
  EXPECT_EQ(latencies.at("header"), 10'064_ns + 10'064_ns);
}

// A burst of four before ATS: 100 octets of payload with tag are 150 octets on the medium with gap and preamble 170, a
// bucket of 170 octets at 10 Mb/s: 136 us apart, however long the bridge takes.
TEST(Ats, DistancesAreThoseOfTheBucketWhateverTheForwardingDelay) {
  for (const std::string delay : {"0us", "3us", "100us", "500us"}) {
    json::Diagnostics diagnostics;
    const auto resolved = load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/ats-forwarding-delay.json",
                                    {"/network/nodes/s/forwarding_delay=" + delay, "/duration=3ms"}, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    const results::RunResult result = judged(*resolved);
    const auto burst = std::ranges::find(result.streams, "burst", &results::StreamResult::name);
    EXPECT_EQ(burst->latency->max - burst->latency->min, 3 * 136_us) << delay;
  }
}

}  // namespace
}  // namespace takt::scenario::test::forwarding_test
