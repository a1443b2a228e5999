// SPDX-License-Identifier: Apache-2.0
// The judges of requirements: what is lost or never comes, copies, what begins before the requirement counts, values
// that must be equal.
#include "evaluation/evaluate.hpp"
#include "models/ethernet/sequence_ledger.hpp"
#include "results/result_json.hpp"
#include "scenario/figures/requirement.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario::test::judges_test {
namespace {

using results::RequirementResult;
using results::RunResult;
using results::StreamResult;
using results::Verdict;
using sim::Duration;
using namespace sim::literals;

RunResult judged(const Resolved& resolved) {
  LiveRun live(resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}
RunResult judged(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return judged(*sound(text, overrides));
}

std::unique_ptr<Resolved> finding(const std::string& name, std::vector<std::string> overrides = {}) {
  json::Diagnostics diagnostics;
  auto resolved = load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + name + ".json", overrides, diagnostics);
  if (!resolved) throw std::runtime_error("refused:\n" + diagnostics.to_text());
  return resolved;
}

const StreamResult& stream(const RunResult& result, std::string_view name) {
  return *std::find_if(result.streams.begin(), result.streams.end(),
                       [&](const StreamResult& each) { return each.name == name; });
}

// As in requirements_test.cpp: every frame takes 2.564 us; those of 0, 1 ... 10 ms are produced, that of 10 ms is under
// way at the end.
std::string frames(const std::string& requirement, const std::string& more = {}) {
  return over_one_switch(
      R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}], "require": [)" +
      requirement + "]" + more);
}

// One frame in 101 arrives, the others wait for 990 ms and more.
TEST(Latency, OfAStarvedStreamFails) {
  const RunResult result = judged(*finding("starved-stream", {"streams.0.every=117us"}));
  EXPECT_EQ(result.verdict, Verdict::fail);
  const RequirementResult& latency = result.requirements.at(0);
  EXPECT_EQ(latency.verdict, Verdict::fail);
  EXPECT_GT(*latency.measured, 900_ms);
  const StreamResult& lo = stream(result, "lo");
  EXPECT_EQ(lo.delivered + lo.in_flight, lo.sent);
  EXPECT_EQ(lo.lost, 0u);
  ASSERT_TRUE(lo.oldest_in_flight);
  EXPECT_EQ(*lo.oldest_in_flight, *latency.measured);
  EXPECT_EQ(json::double_of(*results::run_node(result).find("streams")->find("lo")->find("oldest_in_flight_ps")),
            static_cast<double>(lo.oldest_in_flight->ps()));
  EXPECT_EQ(judged(*finding("starved-stream")).verdict, Verdict::pass);
}

// The frame of 10 ms has been under way for 0 s when the run ends; that is not too long.
TEST(Latency, AYoungFrameUnderWayIsNoFailure) {
  const RunResult result = judged(frames(R"({"stream": "s", "latency": "2564ns"})"));
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::pass);
  EXPECT_EQ(stream(result, "s").in_flight, 1u);
  EXPECT_EQ(*stream(result, "s").oldest_in_flight, 0_s);
}

// From 5.5 ms on the gate is closed: the frame of 6 ms has been under way for 4 ms at the end. All others have
// taken 2.564 us, so it spreads them by the difference.
TEST(Latency, AFrameUnderWaySpreadsTheOthers) {
  const RunResult result = judged(
      frames(
          R"({"stream": "s", "latency": "1ms"}, {"stream": "s", "jitter": "1ms"}, {"stream": "s", "jitter": "3998us"})",
          R"(, "faults": [{"kind": "stuck-gate", "node": "sw", "to": "b", "class": 1, "state": "closed", "at": "5500us"}])"),
      {R"(network.nodes.sw.egress=[{"gates": {"entries": [{"open": [0, 1, 2, 3, 4, 5, 6, 7], "for": "1ms"}]}}])"});
  const RequirementResult& latency = result.requirements.at(0);
  EXPECT_EQ(latency.verdict, Verdict::fail);
  EXPECT_EQ(latency.measured, 4_ms);
  EXPECT_EQ(latency.remark, "6 frames came; one has been under way for 4ms at the end");
  EXPECT_EQ(result.requirements.at(1).verdict, Verdict::fail);
  EXPECT_EQ(result.requirements.at(1).measured, 4_ms - 2'564_ns);
  EXPECT_EQ(result.requirements.at(2).verdict, Verdict::pass);
}

TEST(Latency, ALostFrameNeverArrives) {
  // The link is down from 4.5 to 6.5 ms: the frames of 5 and 6 ms are lost.
  const std::string fault = R"(, "faults": [{"kind": "link-down", "link": ["sw", "b"], "at": "4500us", "for": "2ms"}])";
  const RunResult alone =
      judged(frames(R"({"stream": "s", "latency": "3us"}, {"stream": "s", "jitter": "1us"})", fault));
  EXPECT_EQ(stream(alone, "s").lost, 2u);
  EXPECT_EQ(alone.requirements.at(0).verdict, Verdict::fail);
  EXPECT_EQ(alone.requirements.at(1).verdict, Verdict::fail);
  EXPECT_NE(alone.requirements.at(0).remark.find("2 lost"), std::string::npos) << alone.requirements.at(0).remark;
  // Who says how many may be lost means it.
  for (const char* separately : {R"({"stream": "s", "latency": "3us", "dropped": 2})",
                                 R"({"stream": "s", "latency": "3us"}, {"stream": "s", "delivered": 5})",
                                 R"({"stream": "s", "latency": "3us"}, {"figure": "dropped", "at_most": 3})",
                                 R"({"stream": "s", "latency": "3us"}, {"figure": "lost", "at_most": 2})",
                                 R"({"stream": "s", "latency": "3us"}, {"figure": "/streams/*/lost", "at_most": 3})"})
    EXPECT_EQ(judged(frames(separately, fault)).verdict, Verdict::pass) << separately;
  // From 7 ms on nothing is lost.
  EXPECT_EQ(judged(frames(R"({"stream": "s", "latency": "3us", "after": "7ms"})", fault)).verdict, Verdict::pass);
  // What is said of losses from 7 ms on says nothing of those before.
  EXPECT_EQ(judged(frames(R"({"stream": "s", "latency": "3us"}, {"stream": "s", "dropped": 0, "after": "7ms"})", fault))
                .requirements.at(0)
                .verdict,
            Verdict::fail);
}

TEST(Losses, WhoRequiresThemSeparately) {
  const auto requires_them = [](const std::string& requirement) {
    return requires_losses_separately(*sound(frames(requirement)), "s");
  };
  EXPECT_FALSE(requires_them(R"({"stream": "s", "latency": "3us"})"));
  EXPECT_TRUE(requires_them(R"({"stream": "s", "dropped": 0})"));
  EXPECT_TRUE(requires_them(R"({"figure": "/streams/s/delivered", "at_least": 3})"));
  EXPECT_TRUE(requires_them(R"({"figure": "/streams/*/delivered", "take": "min", "at_least": 3})"));
  EXPECT_FALSE(requires_them(R"({"figure": "/streams/*/delivered", "take": "sum", "at_least": 3})"));
  EXPECT_FALSE(requires_them(R"({"figure": "/streams/s/delivered", "at_most": 3})"));
  EXPECT_TRUE(requires_them(R"({"figure": "/streams/s/dropped/*", "take": "sum", "at_most": 3})"));
  EXPECT_FALSE(requires_them(R"({"figure": "/streams/s/dropped/queue_frames", "at_most": 3})"));
  EXPECT_TRUE(requires_them(R"({"figure": "/streams/s/lost", "equal": 3})"));
  EXPECT_FALSE(requires_them(R"({"figure": "/streams/s/sent", "at_most": 3})"));
}

// While a link of the ring is down one copy of every frame is lost, and every frame arrives.
TEST(Losses, OfARedundantStreamAreThoseOfItsFrames) {
  const RunResult result = judged(*finding("redundancy-dropped"));
  const StreamResult& safety = stream(result, "safety");
  EXPECT_TRUE(safety.has_copies);
  EXPECT_EQ(safety.lost, 0u);
  EXPECT_EQ(safety.dropped_in_all(), 1000u) << "of each frame one copy is lost or taken out";
  EXPECT_EQ(result.requirements.at(0).text, "stream safety latency at most 100us");
  EXPECT_EQ(result.requirements.at(1).text, "stream safety drops at most 0");
  EXPECT_EQ(result.requirements.at(1).verdict, Verdict::pass);
  EXPECT_EQ(result.verdict, Verdict::pass);
}

// If both ways are down at once, the frames of that time are lost: 100 of 1 ms each.
TEST(Losses, OfARedundantStreamWithoutAWay) {
  const auto resolved =
      finding("redundancy-dropped",
              {R"(faults.0={"kind": "crash", "node": "h4", "at": "300ms", "for": "100ms"})", "require.0.dropped=100"});
  const RunResult result = judged(*resolved);
  const StreamResult& safety = stream(result, "safety");
  EXPECT_GE(safety.lost, 99u);
  EXPECT_LE(safety.lost, 101u);
  EXPECT_EQ(safety.lost + safety.delivered + (safety.oldest_in_flight ? 1u : 0u), safety.sent);
}

// The frame of 10 ms has come over two switches, of 20 us each; its copy is still on the way over four.
TEST(Losses, ACopyUnderWayOfAFrameThatHasComeIsNothing) {
  const RunResult result = judged(
      R"({"name": "ring", "duration": "10060us", "network": {"generate": [{"topology": "ring", "switches": 4, "hosts_per_switch": 1, "forwarding_delay": "20us"}]},
    "streams": [{"name": "s", "from": "h1", "to": "h2", "payload": "64B", "every": "1ms", "redundancy": 2}], "require": [{"stream": "s", "dropped": 0, "delivered": 11, "latency": "50us"}]})");
  EXPECT_EQ(stream(result, "s").in_flight, 1u);
  EXPECT_FALSE(stream(result, "s").oldest_in_flight);
  EXPECT_EQ(stream(result, "s").lost, 0u);
  EXPECT_EQ(result.verdict, Verdict::pass);
}

TEST(Losses, FramesThatComeTwiceAreNotMoreThanOne) {
  // Every frame is doubled; the copies do not make up for what is lost while the link is down.
  const std::string fault =
      R"(, "faults": [{"kind": "frame-errors", "link": ["a", "sw"], "duplication": 1}, {"kind": "link-down", "link": ["sw", "b"], "at": "4500us", "for": "2ms"}])";
  const RunResult result = judged(frames(R"({"stream": "s", "dropped": 2})", fault));
  EXPECT_EQ(stream(result, "s").delivered, 16u);
  EXPECT_EQ(stream(result, "s").lost, 2u);
  EXPECT_EQ(result.verdict, Verdict::pass);
}

TEST(Losses, LedgerOfSequenceNumbers) {
  models::SequenceLedger ledger;
  for (const std::uint64_t sequence : {0u, 1u, 5u, 3u, 3u, 9u}) ledger.arrive(sequence);
  // 0 1 _ 3 _ 5 _ _ _ 9
  EXPECT_EQ(ledger.missing(0, 10), 5u);
  EXPECT_EQ(ledger.missing(4, 10), 4u);
  EXPECT_EQ(ledger.missing(0, 12), 7u);
  EXPECT_EQ(ledger.missing(7, 8), 1u);
  EXPECT_TRUE(ledger.has(3));
  EXPECT_FALSE(ledger.has(4));
  EXPECT_FALSE(ledger.has(10));
  for (const std::uint64_t sequence : {2u, 4u, 7u}) ledger.arrive(sequence);
  EXPECT_EQ(ledger.missing(0, 10), 2u);
  for (const std::uint64_t sequence : {6u, 8u}) ledger.arrive(sequence);
  EXPECT_EQ(ledger.missing(0, 10), 0u);
}

TEST(Losses, LedgerStaysSmall) {
  models::SequenceLedger ledger;
  const std::uint64_t half = 200'000;
  const std::vector<std::uint64_t> boundaries = {half};
  // Every third is lost.
  for (std::uint64_t sequence = 0; sequence < 2 * half; ++sequence) {
    if (sequence % 3 != 0) ledger.arrive(sequence);
    if (ledger.has_many_gaps()) ledger.fold(boundaries);
  }
  const auto lost = [](std::uint64_t from, std::uint64_t to) { return (to + 2) / 3 - (from + 2) / 3; };
  EXPECT_EQ(ledger.missing(0, 2 * half), lost(0, 2 * half));
  EXPECT_EQ(ledger.missing(half, 2 * half), lost(half, 2 * half));
}

TEST(Verdicts, WithoutRequirementsSayThatNothingWasRequired) {
  const RunResult result = judged(frames(""));
  EXPECT_TRUE(result.nothing_required);
  EXPECT_EQ(result.verdict, Verdict::pass);
  EXPECT_EQ(results::run_node(result).find("verdict")->text, "nothing was required");
  EXPECT_FALSE(judged(frames(R"({"stream": "s", "latency": "3us"})")).nothing_required);
}

TEST(Equal, Latency) {
  const auto verdict = [](const char* limit) {
    return judged(frames(R"({"stream": "s", "latency": )" + std::string(limit) + "}")).requirements.at(0);
  };
  EXPECT_EQ(verdict(R"({"equal": "2564ns"})").verdict, Verdict::pass);
  EXPECT_EQ(verdict(R"({"equal": "2564ns", "within": "0ns"})").verdict, Verdict::pass);
  EXPECT_EQ(verdict(R"({"equal": "2565ns"})").verdict, Verdict::fail) << "all are shorter";
  EXPECT_EQ(verdict(R"({"equal": "2563ns"})").verdict, Verdict::fail);
  EXPECT_EQ(verdict(R"({"equal": "2565ns", "within": "1ns"})").verdict, Verdict::pass);
  EXPECT_EQ(verdict(R"({"at_most": "2564ns"})").verdict, Verdict::pass);
  const RequirementResult both = verdict(R"({"equal": "2565ns", "within": "1ns"})");
  EXPECT_EQ(both.text, "stream s latency 2.565us within 1ns");
  EXPECT_EQ(both.least_limit->ps(), 2'564'000);
  EXPECT_EQ(both.limit->ps(), 2'566'000);
}

TEST(Equal, Figures) {
  const auto verdict = [](const char* requirement) { return judged(frames(requirement)).requirements.at(0).verdict; };
  EXPECT_EQ(verdict(R"({"figure": "latency.s.max", "equal": "2564ns"})"), Verdict::pass);
  EXPECT_EQ(verdict(R"({"figure": "latency.s.max", "equal": "2565ns"})"), Verdict::fail);
  EXPECT_EQ(verdict(R"({"figure": "latency.s.max", "equal": "2565ns", "within": "1ns"})"), Verdict::pass);
  EXPECT_EQ(verdict(R"({"figure": "latency.s.max", "equal": 2.5, "within": 0.1, "unit": "us"})"), Verdict::pass);
  EXPECT_EQ(verdict(R"({"figure": "/streams/s/sent", "equal": 11})"), Verdict::pass);
  EXPECT_EQ(verdict(R"({"figure": "/streams/s/sent", "equal": 12, "within": 1})"), Verdict::pass);
  EXPECT_EQ(verdict(R"({"figure": "/streams/s/sent", "equal": 13, "within": 1})"), Verdict::fail);
}

TEST(Equal, MistakesAreTold) {
  const auto complaint = [](const char* requirement) { return load(frames(requirement)).diagnostics.to_text(); };
  EXPECT_NE(
      complaint(R"({"figure": "/streams/s/sent", "at_most": 12, "within": 1})").find("\"within\" without \"equal\""),
      std::string::npos);
  EXPECT_NE(complaint(R"({"figure": "/streams/s/sent", "equal": 12, "within": "1ns"})").find("what is no time"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"stream": "s", "latency": {"at_most": "1us", "within": "1ns"}})")
                .find("\"within\" without \"equal\""),
            std::string::npos);
  EXPECT_NE(complaint(R"({"stream": "s", "latency": {"at_most": "1us", "equal": "1us"}})").find("exclude each other"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"figure": "latency.s.max", "equal": 2564})").find("a time without a unit"),
            std::string::npos);
}

// 20 long frames at 0 s make the first frame of the stream wait.
TEST(After, CountsWhatIsProducedThen) {
  const std::string text = over_one_switch(
      R"(, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "offset": "1us"},
                       {"name": "early", "from": "a", "to": "b", "payload": "1400B", "burst": {"frames": 20, "every": "1s"}}],
          "require": [{"stream": "s", "latency": "3us", "dropped": 0}, {"stream": "s", "latency": "3us", "delivered": 9, "after": "1ms"}, {"stream": "s", "delivered": 10, "after": "1ms"},
                      {"figure": "latency.s.max", "at_most": "3us", "after": "1ms"}, {"figure": "/streams/s/sent", "equal": 9, "after": "1ms"},
                      {"figure": "/streams/early/delivered", "equal": 0, "after": "1ms"}])");
  const RunResult result = judged(text);
  std::vector<Verdict> verdicts;
  for (const RequirementResult& each : result.requirements) verdicts.push_back(each.verdict);
  const std::vector<Verdict> wanted = {Verdict::fail, Verdict::pass, Verdict::pass, Verdict::pass,
                                       Verdict::fail, Verdict::pass, Verdict::pass, Verdict::pass};
  EXPECT_EQ(verdicts, wanted);
  EXPECT_EQ(result.requirements.at(2).text, "stream s latency at most 3us after 1ms");
  EXPECT_EQ(stream(result, "s").sent, 10u) << "the table is of the whole run";
  // The same for all by a warm-up, and the table, too; the run is the same.
  const RunResult warm = judged(text, {"warm_up=1ms"});
  EXPECT_EQ(warm.requirements.at(0).verdict, Verdict::pass);
  EXPECT_EQ(stream(warm, "s").sent, 9u);
  EXPECT_EQ(stream(warm, "s").delivered, 9u);
  EXPECT_EQ(stream(warm, "s").in_flight, 0u);
  EXPECT_EQ(stream(warm, "early").delivered, 0u);
  EXPECT_EQ(warm.digest, result.digest);
  EXPECT_EQ(warm.events, result.events);
}

// A frame that is produced before the instant and comes after it does not count, though it comes in time to be seen.
TEST(After, FramesUnderWayAtTheInstantAreNotCounted) {
  const RunResult result = judged(frames(
      R"({"figure": "/streams/s/delivered", "equal": 4, "after": "5001us"}, {"figure": "/streams/s/delivered", "equal": 5, "after": "5ms"})"));
  EXPECT_EQ(result.verdict, Verdict::pass);
}

TEST(After, CountsReactionsThatBeginThen) {
  const std::string text = over_one_switch(
      R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "100us", "initialisation": "200us"}],
 "script": [{"at": "1ms", "program": "p", "call": "Start"}], "require": [{"reaction": "start", "within": "2ms"}, {"reaction": "start", "within": "2ms", "after": "1ms"},
  {"reaction": "start", "within": "2ms", "after": "1001us"}, {"figure": "reaction.start.count", "equal": 0, "after": "1001us"}])");
  const RunResult result = judged(text);
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::pass);
  EXPECT_EQ(result.requirements.at(1).verdict, Verdict::pass);
  EXPECT_EQ(result.requirements.at(2).verdict, Verdict::fail);
  EXPECT_EQ(result.requirements.at(2).remark, "no such reaction");
  EXPECT_EQ(result.requirements.at(3).verdict, Verdict::pass);
  EXPECT_EQ(judged(text, {"warm_up=5ms"}).requirements.at(0).verdict, Verdict::fail);
}

std::string called(const std::string& requirement, const std::vector<std::pair<const char*, const char*>>& calls) {
  std::string script;
  for (const auto& [at, call] : calls)
    script += (script.empty() ? "" : ", ") + std::string(R"({"at": ")") + at + R"(", "program": "p", "call": ")" +
              call + "\"}";
  return over_one_switch(
      R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "100us", "initialisation": "200us"}], "script": [)" +
      script + R"(], "require": [)" + requirement + "]");
}

// Just behind the master's publishing a call waits for almost a cycle, just before it for nothing.
TEST(Reactions, TheSlowestCounts) {
  const auto suspend = [](const std::vector<std::pair<const char*, const char*>>& calls) {
    return judged(called(R"({"reaction": "suspend", "within": "1ms"})", calls)).requirements.at(0).measured.value();
  };
  const Duration slow = suspend({{"1ms", "Start"}, {"3010us", "Suspend"}});
  const Duration fast = suspend({{"1ms", "Start"}, {"5090us", "Suspend"}});
  ASSERT_GT(slow, fast);
  EXPECT_EQ(suspend({{"1ms", "Start"}, {"3010us", "Suspend"}, {"4ms", "Resume"}, {"5090us", "Suspend"}}), slow);
}

// A halt overtakes the start: there is none that was, or should have been, complete.
TEST(Reactions, OvertakenOnesDoNotCount) {
  const RequirementResult start =
      judged(called(R"({"reaction": "start", "within": "5ms"})", {{"1ms", "Start"}, {"1100us", "Halt"}}))
          .requirements.at(0);
  EXPECT_EQ(start.verdict, Verdict::fail);
  EXPECT_EQ(start.remark, "no such reaction");
}

// The outer group is suspended before the slave of the inner one has heard of it, whose master publishes each 5 ms.
TEST(Reactions, OfTheTreeAreThoseOfAllGroups) {
  const RunResult result = judged(
      R"({"name": "tree", "duration": "100ms", "network": {"nodes": {"m": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch"}},
    "links": [{"ends": ["m", "sw"]}, {"ends": ["b", "sw"]}, {"ends": ["c", "sw"]}]},
    "programs": [{"name": "o", "master": "m", "slaves": ["b"], "cycle": "1ms"}, {"name": "i", "within": "o", "master": "b", "slaves": ["c"], "cycle": "5ms"}],
    "script": [{"at": "10ms", "program": "o", "call": "Start"}, {"at": "61ms", "program": "o", "call": "Suspend"}],
    "require": [{"reaction": "suspend", "program": "o", "within": "3ms"}, {"reaction": "suspend", "program": "o", "tree": true, "within": "3ms"}]})");
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::pass) << result.requirements.at(0).remark;
  EXPECT_EQ(result.requirements.at(1).verdict, Verdict::fail) << result.requirements.at(1).remark;
  EXPECT_GT(result.requirements.at(1).measured, result.requirements.at(0).measured);
}

// Two oscillators 20 ppm apart: gPTP holds them within a millisecond, and nobody within a picosecond.
TEST(Clocks, AreJudgedByTheirGreatestError) {
  const auto verdict = [](const char* limit) {
    return judged(
               std::string(
                   R"({"name": "clocks", "duration": "3s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
      "clocks": {"all": {"offset": "10ppm"}, "nodes": {"b": {"offset": "-10ppm"}}, "gptp": {}}, "require": [{"sync": ")") +
               limit + R"(", "after": "2s"}]})")
        .requirements.at(0)
        .verdict;
  };
  EXPECT_EQ(verdict("1ms"), Verdict::pass);
  EXPECT_EQ(verdict("1ps"), Verdict::fail);
}

// Three frames of 150 octets and two of 64 at once: the first one is sent, and the others wait, each in the queue of
// its class. Queues in which nothing waited count 0.
TEST(Queues, PeaksOfEachClass) {
  const RunResult result = judged(
      R"({"name": "queues", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "rate": "100Mbps"}]},
    "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "burst": {"frames": 3, "every": "1s"}}, {"name": "t", "from": "a", "to": "b", "payload": "1B", "pcp": 2, "burst": {"frames": 2, "every": "1s"}}],
    "require": [{"figure": "/queues/*/frames", "only": {"node": "a", "class": 6}, "equal": 2}, {"figure": "/queues/*/octets", "only": {"class": 2}, "at_most": 127}, {"figure": "/queues/*/frames", "only": {"node": "b"}, "equal": 0},
                {"figure": "/queues/*/octets", "take": "sum", "at_most": 428}]})");
  ASSERT_EQ(result.queues.size(), 2u);
  EXPECT_EQ(result.queues[0].traffic_class, 2);
  EXPECT_EQ(result.queues[0].frames, 2u);
  EXPECT_EQ(result.queues[0].octets, 128u);
  EXPECT_EQ(result.queues[1].node, "a");
  EXPECT_EQ(result.queues[1].peer, "b");
  EXPECT_EQ(result.queues[1].traffic_class, 6);
  EXPECT_EQ(result.queues[1].frames, 2u);
  EXPECT_EQ(result.queues[1].octets, 300u);
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::pass);
  EXPECT_EQ(result.requirements.at(1).verdict, Verdict::fail);
  EXPECT_EQ(result.requirements.at(2).verdict, Verdict::pass);
  EXPECT_EQ(result.requirements.at(3).verdict, Verdict::pass);
}

TEST(After, IsRefusedOfFiguresThatCountFromTheStart) {
  const std::string told = load(frames(R"({"figure": "queue", "at_most": 3, "after": "1ms"})")).diagnostics.to_text();
  EXPECT_NE(told.find("counts from the start of the run only"), std::string::npos) << told;
  EXPECT_NE(load(frames(R"({"figure": "queue", "at_most": 3})"), {"warm_up=1ms"}).diagnostics.to_text().find("warm_up"),
            std::string::npos);
  EXPECT_TRUE(load(frames(R"({"figure": "queue", "at_most": 3, "after": "0s"})"), {"warm_up=1ms"}).resolved);
}

// The source speaks every 5 ms, the gateway looks every millisecond: what it can bring is what the source says.
TEST(Gateway, BringsWhatItsSourceSays) {
  const auto resolved = finding("gateway-criterion");
  const RunResult result = judged(*resolved);
  EXPECT_EQ(result.verdict, Verdict::pass) << result.requirements.at(0).remark;
}

TEST(Gateway, ASlowGatewayBringsWhatItSends) {
  const auto resolved = finding("gateway-criterion", {"gateways.0.send_every=10ms"});
  EXPECT_EQ(resolved->applications.at(1).threads.at(0).values_expected, 1u);
  const auto fast = finding("gateway-criterion");
  EXPECT_EQ(fast->applications.at(1).threads.at(0).values_expected, 2u);
}

TEST(After, HoldsForApplications) {
  // The thread is due at 0, 5, 10 ms ... 1,995 ms.
  const auto resolved = finding(
      "gateway-criterion",
      {R"(require=[{"application": "ctl", "success": 0}, {"figure": "/applications/ctl/threads/pub/activations", "equal": 200, "within": 1, "after": "1s"},
    {"figure": "/applications/ctl/threads/pub/published", "equal": 200, "within": 1, "after": "1s"}, {"figure": "/applications/ctl/threads/pub/published", "equal": 400, "within": 1},
    {"figure": "/applications/rosnode/threads/sub/buffered", "equal": 200, "within": 4, "after": "1s"}])"});
  const RunResult result = judged(*resolved);
  for (const RequirementResult& each : result.requirements)
    EXPECT_EQ(each.verdict, Verdict::pass) << each.text << ": " << each.remark;
}

}  // namespace
}  // namespace takt::scenario::test::judges_test
