// SPDX-License-Identifier: Apache-2.0
// Streams that have windows of their own, by hand. 1 Gb/s: an octet lasts 8 ns, the gap behind a frame 96 ns. A payload
// of 100 octets makes 100 + 28 (IP, UDP) + 18 (MAC, FCS) + 4 (tag) + 8 (preamble) = 158 octets, 1264 ns; one of 1000
// octets 1058 octets, 8464 ns; one of 1400 octets without a tag 1454 octets, 11632 ns. Links of 50 ns, switches of 1
// us.
#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "analysis/frame_sequence.hpp"
#include "scenario/resolve.hpp"
#include "tests/questions/analysis/falsification.hpp"

namespace takt::analysis::no_wait_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

constexpr Ps us = 1'000'000;

std::unique_ptr<scenario::Resolved> load(const std::string& rest) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(R"({"name": "t", "duration": "20ms", )" + rest + "}", "t.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}
const StreamBound& stream(const Bounds& bounds, const std::string& name) {
  for (const StreamBound& each : bounds.streams)
    if (each.name == name) return each;
  throw std::runtime_error("no stream " + name);
}
Duration simulated(const scenario::Run& run, const StreamBound& bound) {
  return run.network().traffic().streams()[bound.index.value].latency.maximum();
}

const std::string cable =
    R"("network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "rate": "1Gbps", "delay": "50ns"}]},
  "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "500us", "offset": "10us", "pcp": 6},
              {"name": "rest", "from": "a", "to": "b", "payload": "1400B", "every": "100us"}], )";

TEST(NoWait, OneStreamOneHop) {
  const auto resolved = load(cable + R"("gates": {"plan": "auto", "classes": [6]})");
  const Bounds bounds = bound(*resolved);
  const StreamBound& s = stream(bounds, "s");
  ASSERT_TRUE(s.latency) << s.reason;
  EXPECT_EQ(*s.latency, 1'264_ns + 50_ns);
  EXPECT_EQ(s.least, *s.latency);
  EXPECT_EQ(*s.hops[0].delay, 1'264_ns);
  EXPECT_EQ(*s.hops[0].backlog_bits, 8u * 170);  // one frame and the gap behind it
  EXPECT_TRUE(s.loses_nothing);
}

// The gap before the window, the frame's time, and all that is left to others: what automatic gates lay, written by
// hand.
TEST(NoWait, TheSameListByHand) {
  const auto resolved =
      load(cable + R"("gates": {"plan": "listed", "lists": [{"node": "a", "to": "b", "gates": {"entries": [
    {"open": [0, 1, 2, 3, 4, 5, 7], "for": "9904ns"}, {"open": [], "for": "96ns"}, {"open": [6], "for": "1264ns"}, {"open": [0, 1, 2, 3, 4, 5, 7], "for": "488736ns"}]}}]})");
  EXPECT_EQ(stream(bound(*resolved), "s").latency, 1'264_ns + 50_ns);
  // A window that opens 5 us later holds the frame until then.
  const auto later =
      load(cable + R"("gates": {"plan": "listed", "lists": [{"node": "a", "to": "b", "gates": {"entries": [
    {"open": [0, 1], "for": "14904ns"}, {"open": [], "for": "96ns"}, {"open": [6], "for": "1264ns"}, {"open": [0, 1], "for": "483736ns"}]}}]})");
  EXPECT_EQ(stream(bound(*later), "s").latency, 5_us + 1'264_ns + 50_ns);
}

// What is left to the others: a frame of 11632 ns comes when it just does not end any more before the gap and the
// window, 96 + 1264 ns, and starts the gap behind the window's frame.
TEST(NoWait, BestEffortBesideAWindow) {
  const auto resolved = load(cable + R"("gates": {"plan": "auto", "classes": [6]})");
  const Bounds bounds = bound(*resolved);
  ASSERT_TRUE(stream(bounds, "rest").latency) << stream(bounds, "rest").reason;
  EXPECT_EQ(*stream(bounds, "rest").hops[0].delay, 11'632_ns + 96_ns + 1'264_ns + 96_ns + 11'632_ns);
  // Switches that do not look at the length of frames close 1522 octets, preamble and gap before: 12336 ns, all of them
  // beside what the frame itself needs.
  const auto wide = load(cable + R"("gates": {"plan": "auto", "classes": [6], "guard": "longest-frame"})");
  EXPECT_EQ(*stream(bound(*wide), "rest").hops[0].delay, 11'632_ns + 12'336_ns + 1'264_ns + 96_ns + 11'632_ns);
}

const std::string star =
    R"("network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch", "forwarding_delay": "1us"}},
    "links": [{"ends": ["a", "sw"], "rate": "1Gbps", "delay": "50ns"}, {"ends": ["b", "sw"], "rate": "1Gbps", "delay": "50ns"}, {"ends": ["sw", "c"], "rate": "1Gbps", "delay": "50ns"}]}, )";

// A long and a short frame of one class, which share the port to c one right behind the other: the window of the short
// one is too short for the long one, which must not matter.
TEST(NoWait, TwoStreamsOnASharedPort) {
  // "long" ends at the port at 10 us + 2 * 8464 + 1050 ns and 96 ns of gap: 28074 ns. "short" is there 1264 + 1050 ns
  // behind its offset.
  const auto resolved = load(
      star +
      R"("streams": [{"name": "long", "from": "a", "to": "c", "payload": "1000B", "every": "500us", "offset": "10us", "pcp": 6},
      {"name": "short", "from": "b", "to": "c", "payload": "100B", "every": "250us", "offset": "25760ns", "pcp": 6},
      {"name": "rest", "from": "a", "to": "c", "payload": "1400B", "every": "100us"}], "gates": {"plan": "auto", "classes": [6]})");
  const Bounds bounds = bound(*resolved);
  ASSERT_TRUE(stream(bounds, "long").latency) << stream(bounds, "long").reason;
  ASSERT_TRUE(stream(bounds, "short").latency) << stream(bounds, "short").reason;
  EXPECT_EQ(*stream(bounds, "long").latency, 2 * (8'464_ns + 50_ns) + 1_us);
  EXPECT_EQ(*stream(bounds, "short").latency, 2 * (1'264_ns + 50_ns) + 1_us);
  EXPECT_EQ(*stream(bounds, "long").hops[1].backlog_bits, 8u * (1058 + 12)) << "never both at once";
  scenario::Run run(*resolved);
  run.advance();
  EXPECT_EQ(simulated(run, stream(bounds, "long")), *stream(bounds, "long").latency);
  EXPECT_EQ(simulated(run, stream(bounds, "short")), *stream(bounds, "short").latency);
}

// State and data of a participant come at one instant and leave one behind the other; ideal clocks and no operating
// system: simulated and bound are one.
TEST(NoWait, TrainsOfPrograms) {
  const auto resolved = load(
      star +
      R"("programs": [{"name": "p", "master": "a", "slaves": ["b", "c"], "cycle": "500us", "phases": {"a": "0us", "b": "100us", "c": "200us"}, "process_data": [
      {"name": "x", "from": "a", "fields": {"q": {"type": "Double", "count": 60}}}, {"name": "y", "from": "a", "fields": {"q": {"type": "Double", "count": 1}}}, {"name": "z", "from": "b", "fields": {"q": {"type": "Double", "count": 9}}}]}],
    "script": [{"at": "1ms", "program": "p", "call": "Start"}], "gates": "auto")");
  const Bounds bounds = bound(*resolved);
  scenario::Run run(*resolved);
  run.advance();
  for (const StreamBound& each : bounds.streams) {
    ASSERT_TRUE(each.latency) << each.name << ": " << each.reason;
    EXPECT_EQ(simulated(run, each), *each.latency) << each.name;
  }
  for (const ReactionBound& reaction : bounds.reactions) EXPECT_TRUE(reaction.bound) << reaction.reason;
}

// What the operating system takes ends at the talker's gate, 9 us after the offset; then nobody waits.
TEST(NoWait, TheOperatingSystemDoesNotAdd) {
  const auto resolved = load(
      R"("network": {"nodes": {"a": {"kind": "host", "os": {"transmit": {"uniform": {"from": "1us", "to": "9us"}}}}, "c": {"kind": "host"}, "sw": {"kind": "switch", "forwarding_delay": "1us"}},
    "links": [{"ends": ["a", "sw"], "rate": "1Gbps", "delay": "50ns"}, {"ends": ["sw", "c"], "rate": "1Gbps", "delay": "50ns"}]},
    "streams": [{"name": "s", "from": "a", "to": "c", "payload": "100B", "every": "500us", "offset": "10us", "pcp": 6}], "gates": {"plan": "auto", "classes": [6]}, "require": [{"stream": "s", "jitter": "0us"}])");
  const Bounds bounds = bound(*resolved);
  EXPECT_EQ(stream(bounds, "s").latency, 9_us + 2 * (1'264_ns + 50_ns) + 1_us);
  EXPECT_EQ(bounds.requirements[0].duration, 0_us);
}

std::string with_clocks(const std::string& margin) {
  return star +
         R"("clocks": {"all": {"offset": "50ppm"}, "gptp": {}}, "streams": [{"name": "s", "from": "a", "to": "c", "payload": "100B", "every": "500us", "offset": "10us", "pcp": 6},
    {"name": "t", "from": "b", "to": "c", "payload": "100B", "every": "500us", "offset": "20us", "pcp": 6}], "gates": {"plan": "auto", "classes": [6], "margin": ")" +
         margin + R"("})";
}

// Clocks within 100 ns: the talker's gate may be that much late, and what publishes as much early. On the way nobody
// waits if the margin is twice the error, and a little for rates.
TEST(NoWait, ClocksWithinTheMargin) {
  BoundOptions options;
  options.clock_error = 100_ns;
  const Bounds bounds = bound(*load(with_clocks("201ns")), options);
  ASSERT_TRUE(stream(bounds, "s").latency) << stream(bounds, "s").reason;
  EXPECT_GE(*stream(bounds, "s").latency, 2 * (1'264_ns + 50_ns) + 1_us);
  EXPECT_LE(*stream(bounds, "s").latency, 2 * (1'264_ns + 50_ns) + 1_us + 200_ns + 1_ns);
  EXPECT_LE(stream(bounds, "s").least, 2 * (1'264_ns + 50_ns) + 1_us);
}

// Beyond it a frame may come when its window is over, and nothing is said.
TEST(NoWait, ClocksBeyondTheMargin) {
  BoundOptions options;
  options.clock_error = 100_ns;
  const auto resolved = load(with_clocks("150ns"));
  const Bounds bounds = bound(*resolved, options);
  EXPECT_FALSE(stream(bounds, "s").latency);
  EXPECT_NE(stream(bounds, "s").reason.find("clocks that are off"), std::string::npos) << stream(bounds, "s").reason;
}

// The sequence itself. Windows of 10 and 4 us in 100 us; frames of 10 us (9 until the last bit) and 4 us (3).
SequencedFlow frames(Ps first, Ps width, Ps work, Ps period = 100 * us) {
  return {{first, period, width, work}, work - us, {}, 0};
}
SequenceWindows windows() {
  SequenceWindows made;
  made.cycle = 100 * us;
  made.windows = {{10 * us, 19 * us, 0}, {20 * us, 23 * us, 0}};
  return made;
}

TEST(FrameSequence, EachIntoItsWindow) {
  std::string reason;
  const auto bound =
      bound_sequence({frames(5 * us, 5 * us, 10 * us), frames(19 * us, 0, 4 * us)}, windows(), {}, reason);
  ASSERT_TRUE(bound) << reason;
  EXPECT_TRUE(bound->is_exact);
  EXPECT_EQ(bound->flows[0].wait, 5 * us);
  EXPECT_EQ(bound->flows[0].earliest, 5 * us);
  EXPECT_EQ(bound->flows[0].latest, 5 * us);  // all of its frames start as the window opens
  EXPECT_EQ(bound->flows[1].wait, 1 * us);
  EXPECT_EQ(bound->backlog_frames, 2);  // the gap behind the first is not over when the second comes
  EXPECT_EQ(bound->backlog, 14 * us);
}

TEST(FrameSequence, WhoJustMissesAWindowWaitsForTheNext) {
  std::string reason;
  const auto bound = bound_sequence({frames(9 * us, 2 * us, 10 * us, 300 * us)}, windows(), {}, reason);
  ASSERT_TRUE(bound) << reason;
  EXPECT_EQ(bound->flows[0].wait, 100 * us - 1);  // from 1 ps behind 10 us to 110 us
  EXPECT_EQ(bound->flows[0].latest, 101 * us);
  EXPECT_EQ(bound->flows[0].earliest, 1 * us);
}

// The other window is long enough for the short frame only; if the long one may come first, the short one waits behind
// it.
TEST(FrameSequence, InAnyOrder) {
  std::string reason;
  const std::vector<SequencedFlow> flows{frames(2 * us, 2 * us, 10 * us, 200 * us),
                                         frames(3 * us, 2 * us, 4 * us, 200 * us)};
  const auto bound = bound_sequence(flows, windows(), {}, reason);
  ASSERT_TRUE(bound) << reason;
  EXPECT_FALSE(bound->is_exact);
  // Long before short: 10 and 20 us. Short before long: 10 us, and 110 us for the long one, which has no room behind
  // it.
  EXPECT_EQ(bound->flows[0].latest, 108 * us);
  EXPECT_EQ(bound->flows[1].latest, 17 * us);
}

// As long as the order of a train is known, the same arrivals go one behind the other.
TEST(FrameSequence, TrainsKeepTheirOrder) {
  std::string reason;
  std::vector<SequencedFlow> flows{frames(2 * us, 2 * us, 10 * us), frames(2 * us, 2 * us, 4 * us)};
  for (std::uint32_t i = 0; i < 2; ++i) {
    flows[i].train = 7;
    flows[i].rank = i;
  }
  const auto bound = bound_sequence(flows, windows(), {}, reason);
  ASSERT_TRUE(bound) << reason;
  EXPECT_TRUE(bound->is_exact);
  EXPECT_EQ(bound->flows[0].latest, 8 * us);
  EXPECT_EQ(bound->flows[1].latest, 18 * us);
}

// Two long frames a cycle for one window: what waits grows without end.
TEST(FrameSequence, MoreThanThereAreWindows) {
  std::string reason;
  EXPECT_FALSE(bound_sequence({frames(5 * us, 0, 10 * us, 50 * us)}, windows(), {}, reason));
  EXPECT_NE(reason, "");
}

TEST(FrameSequence, OthersTakeTime) {
  std::string reason;
  SequenceWindows wide = windows();
  wide.windows = {{10 * us, 40 * us, 2 * us}};
  const auto bound = bound_sequence(
      {frames(5 * us, 0, 10 * us)}, wide, [](Ps) { return 3 * us; }, reason);
  ASSERT_TRUE(bound) << reason;
  EXPECT_EQ(bound->flows[0].wait, 5 * us + 2 * us + 3 * us);
  EXPECT_FALSE(bound->is_exact);
}

}  // namespace
}  // namespace takt::analysis::no_wait_test
