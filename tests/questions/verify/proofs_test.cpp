// SPDX-License-Identifier: Apache-2.0
// What is proved of each requirement, with limits that are worked out by hand.
#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

#include "evaluation/evaluate.hpp"
#include "scenario/run/run.hpp"
#include "tests/questions/verify/support.hpp"
#include "verify/bounds.hpp"

namespace takt::verify::proofs_test {
namespace {

using analysis::Assumption;
using namespace sim::literals;  // NOLINT

struct Proved {
  Proof proof;
  results::RequirementResult requirement;
};

/// The proof of each line of the table: of the requirements, then of the Programs' invariants.
std::vector<Proved> proved(const std::string& text, const ProofOptions& options = {}) {
  const auto made = resolved(text);
  scenario::Run run(*made);
  run.advance();
  const std::vector<results::RequirementResult> requirements = evaluation::evaluate(run, false).requirements;
  const std::vector<Proof> proofs = prove(*made, analysis::bound(*made), requirements, options);
  std::vector<Proved> all;
  for (std::size_t i = 0; i < proofs.size(); ++i) all.push_back({proofs[i], requirements[i]});
  return all;
}

// (8 + 146) octets of 8 ns and a cable of 50 ns: 1.282 us.
std::string stream(const std::string& requirement, const std::string& more = {}, const std::string& host = {},
                   const std::string& rest = {}) {
  return R"({"name": "two", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host")" + host +
         R"(}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
    "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms")" +
         more + R"(}], "require": [)" + requirement + "]" + rest + "}";
}
bool holds(const std::string& text) { return proved(text).at(0).proof.holds; }

TEST(Proofs, OfALatency) {
  EXPECT_TRUE(holds(stream(R"({"stream": "s", "latency": "1282ns"})")));
  EXPECT_FALSE(holds(stream(R"({"stream": "s", "latency": "1281ns"})")));
  EXPECT_TRUE(holds(stream(R"({"stream": "s", "latency": {"equal": "1282ns"}})")));
  const std::string slow = R"(, "os": {"transmit": {"uniform": {"from": "1us", "to": "3us"}}})";
  EXPECT_TRUE(holds(stream(R"({"stream": "s", "latency": {"equal": "3282ns", "within": "1us"}})", "",
                           R"(, "os": {"transmit": "3us"})")));
  // It may come after 2.282 us.
  EXPECT_TRUE(holds(stream(R"({"stream": "s", "latency": {"equal": "3282ns", "within": "1us"}})", "", slow)));
  EXPECT_FALSE(holds(stream(R"({"stream": "s", "latency": {"equal": "3282ns", "within": "999ns"}})", "", slow)));
  EXPECT_TRUE(holds(stream(R"({"stream": "s", "jitter": "2us"})", "", slow)));
  EXPECT_FALSE(holds(stream(R"({"stream": "s", "jitter": "1999ns"})", "", slow)));
  // A jitter that is never less than something is not proved.
  EXPECT_FALSE(holds(stream(R"({"stream": "s", "jitter": {"equal": "2us", "within": "1us"}})", "", slow)));
}

TEST(Proofs, OfALatencyWhereFramesMayBeLost) {
  const std::string chance = R"(, "faults": [{"kind": "frame-errors", "link": ["a", "b"], "loss": 0.000001}])";
  EXPECT_FALSE(holds(stream(R"({"stream": "s", "latency": "1282ns"})", "", "", chance)));
  EXPECT_TRUE(
      holds(stream(R"({"stream": "s", "latency": "1282ns"}, {"stream": "s", "delivered": 1})", "", "", chance)));
  EXPECT_FALSE(holds(stream(R"({"stream": "s", "dropped": 3})", "", "", chance)));
  EXPECT_TRUE(holds(stream(R"({"stream": "s", "dropped": 0})")));
}

// Frames at 0, 1 ... 10 ms; that of 10 ms has not come at the end. A talker that begins later has sent fewer, and so
// has one whose frames may be late.
TEST(Proofs, OfANumberOfFrames) {
  const auto delivered = [](const char* count, const std::string& more = {}, const std::string& after = {}) {
    return holds(stream(std::string(R"({"stream": "s", "delivered": )") + count + after + "}", more));
  };
  EXPECT_TRUE(delivered("10"));
  EXPECT_FALSE(delivered("11"));
  EXPECT_TRUE(delivered("9", R"(, "offset": "999us")"));
  EXPECT_FALSE(delivered("10", R"(, "offset": "999us")"));
  EXPECT_TRUE(delivered("9", R"(, "offset": "0s", "jitter": "999us")"));
  EXPECT_FALSE(delivered("10", R"(, "offset": "0s", "jitter": "999us")"));
  EXPECT_TRUE(delivered("4", "", R"(, "after": "5ms")"));
  EXPECT_FALSE(delivered("6", "", R"(, "after": "5ms")"));
  EXPECT_FALSE(holds(stream(R"({"stream": "s", "delivered": 1})", "", "",
                            R"(, "faults": [{"kind": "link-down", "link": ["a", "b"], "at": "5ms", "for": "1ms"}])")));
}

/// m is master of s over the switch sw.
std::string cell(const std::string& program, const std::string& more, const std::string& host = {}) {
  return R"({"name": "cell", "duration": "1s", "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host")" +
         host + R"(}, "sw": {"kind": "switch"}},
    "links": [{"ends": ["m", "sw"], "rate": "100Mbps"}, {"ends": ["s", "sw"], "rate": "100Mbps"}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms")" +
         program + "}]" + more + "}";
}
Proof invariants(const std::string& program, const std::string& more, const std::string& host = {},
                 const ProofOptions& options = {}) {
  return proved(cell(program, more, host), options).back().proof;
}

TEST(Proofs, OfInvariantsExploreAsManyCallsAndFaultsAsMeet) {
  const std::string one = R"({"at": "10ms", "program": "p", "call": "Start"})";
  const Proof alone = invariants("", R"(, "script": [)" + one + "]");
  EXPECT_TRUE(alone.holds) << alone.reason;
  EXPECT_NE(alone.remark.find("1 call and 0 faults before"), std::string::npos) << alone.remark;
  EXPECT_FALSE(alone.assumptions.contains(Assumption::no_loss));
  EXPECT_TRUE(alone.assumptions.contains(Assumption::nothing_else));
  const Proof two = invariants("", R"(, "script": [)" + one + R"(, {"at": "11ms", "program": "p", "call": "Halt"}])");
  EXPECT_NE(two.remark.find("2 calls and 0 faults before"), std::string::npos) << two.remark;
  const Proof crash =
      invariants("", R"(, "script": [)" + one + R"(], "faults": [{"kind": "crash", "node": "s", "at": "500ms"}])");
  EXPECT_TRUE(crash.holds) << crash.reason;
  EXPECT_NE(crash.remark.find("1 call and 1 fault before"), std::string::npos) << crash.remark;
  ProofOptions few;
  few.states = 5;
  const Proof early = invariants("", R"(, "script": [)" + one + "]", "", few);
  EXPECT_FALSE(early.holds);
  EXPECT_NE(early.reason.find("not all"), std::string::npos) << early.reason;
}

/// A line of so many drives, as in tests/findings/halt-of-six-drives.json with a cycle that meets its limit.
std::string line_of_drives(std::size_t drives, const std::string& more = {}, const std::string& cycle = "800us") {
  const std::string last = "d" + std::to_string(drives);
  std::string slaves;
  for (std::size_t i = 1; i <= drives; ++i) slaves += (i == 1 ? "\"d" : ", \"d") + std::to_string(i) + "\"";
  return R"({"name": "line", "duration": "100ms", "network": {"nodes": {"plc": {"kind": "host", "os": "preempt-rt"}},
    "links": [{"ends": ["plc", "d1"]}], "generate": [{"topology": "line", "stations": )" +
         std::to_string(drives) +
         R"(, "station_prefix": "d", "length": "5m", "os": "preempt-rt", "forwarding_delay": "1us"}]},
    "programs": [{"name": "line", "master": "plc", "slaves": [)" +
         slaves + R"(], "cycle": ")" + cycle + "\"" + more + R"(}],
    "script": [{"at": "10ms", "program": "line", "call": "Start"}, {"at": "60ms", "program": "line", "call": "Halt", "on": ")" +
         last + R"("}], "require": [{"reaction": "halt", "within": "2ms"}]})";
}

// One proof for all sizes, and it says so. What it does not cover is not said to be proved.
TEST(Proofs, OfInvariantsHoldForEveryNumberOfSlaves) {
  std::string remark;
  for (const std::size_t drives : {5U, 6U, 12U, 32U, 64U}) {
    const Proof found = proved(line_of_drives(drives)).at(1).proof;
    EXPECT_TRUE(found.holds) << drives << " drives: " << found.reason;
    EXPECT_TRUE(found.remark.starts_with("proved for every number of slaves: ")) << found.remark;
    if (remark.empty()) remark = found.remark;
    EXPECT_EQ(found.remark, remark);
  }
  EXPECT_TRUE(proved(line_of_drives(4)).at(1).proof.remark.starts_with("explored: "));
  const Proof paper = proved(line_of_drives(6, R"(, "variant": "paper")")).at(1).proof;
  EXPECT_FALSE(paper.holds);
  EXPECT_EQ(paper.reason, "at most 4 slaves can be explored with paper");
  const Proof all_to_all = proved(line_of_drives(6, R"(, "subscription": "all-to-all")")).at(1).proof;
  EXPECT_FALSE(all_to_all.holds);
  EXPECT_EQ(all_to_all.reason, "takt explore --subscription all-to-all looks at it");
}

// All that is required is proved where the cycle meets the limit of the halt, however many drives there are.
TEST(Proofs, OfLinesOfDrivesGoThrough) {
  for (const auto& [drives, cycle] : {std::pair(6U, "800us"), std::pair(12U, "700us"), std::pair(32U, "600us")})
    for (const Proved& each : proved(line_of_drives(drives, {}, cycle)))
      EXPECT_TRUE(each.proof.holds) << drives << " drives, " << each.requirement.text << ": " << each.proof.reason;
}

// Words that are lost with the participant that crashes are those of a crash that was explored; all others are not.
TEST(Proofs, OfInvariantsRestOnWords) {
  const auto rests_on_words = [](const std::string& fault) {
    return invariants("", R"(, "faults": [{"at": "500ms", )" + fault + "}]").assumptions.contains(Assumption::no_loss);
  };
  EXPECT_FALSE(rests_on_words(R"("kind": "crash", "node": "s")"));
  EXPECT_TRUE(rests_on_words(R"("kind": "crash", "node": "sw")"));
  EXPECT_TRUE(rests_on_words(R"("kind": "link-down", "link": ["s", "sw"])"));
  EXPECT_TRUE(rests_on_words(R"("kind": "frame-errors", "link": ["s", "sw"], "loss": 0.001)"));
  const Proof slow = invariants("", "", R"(, "os": {"transmit": {"uniform": {"from": "0s", "to": "9us"}}})");
  EXPECT_TRUE(slow.assumptions.contains(Assumption::os_latency));
}

// 1.1 cycles and what latencies differ by must be less than 0.9 of the time-out, or a participant may be taken for
// silent.
TEST(Proofs, OfInvariantsNeedWordsInTime) {
  EXPECT_TRUE(invariants(R"(, "receive_timeout": "1.3ms")", "").holds);
  EXPECT_FALSE(invariants(R"(, "receive_timeout": "1.2ms")", "").holds);
  EXPECT_FALSE(invariants(R"(, "receive_timeout": "1.3ms")", "",
                          R"(, "os": {"transmit": {"uniform": {"from": "0s", "to": "100us"}}})")
                   .holds);
  EXPECT_FALSE(invariants(R"(, "receive_timeout": "1.3ms")", "",
                          R"(, "os": {"wake_up": {"uniform": {"from": "0s", "to": "100us"}}})")
                   .holds);
}

}  // namespace
}  // namespace takt::verify::proofs_test
