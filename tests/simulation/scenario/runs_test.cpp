// SPDX-License-Identifier: Apache-2.0
// Runs of the shipped scenarios: pinned digests, and everything that must not change a digest.
//
// tests/golden/scenario_digests.txt holds a line `name duration digest` for each (the duration is short, for the test's
// sake). After a change that is meant to change what happens, or what the digest covers: tests/golden/renew.py
// build/release
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "evaluation/evaluate.hpp"
#include "support.hpp"

namespace takt::scenario::test {
namespace {

const std::string golden_file = std::string(TAKT_SOURCE_DIR) + "/tests/golden/scenario_digests.txt";

struct Golden {
  std::string name;
  std::string duration;
  std::string digest;
};

std::vector<Golden> golden() {
  std::vector<Golden> lines;
  std::ifstream file(golden_file);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    Golden one;
    std::istringstream(line) >> one.name >> one.duration >> one.digest;
    lines.push_back(one);
  }
  return lines;
}

std::string hex(std::uint64_t digest) { return fmt::format("{:016x}", digest); }

TEST(Runs, EveryShippedScenarioPasses) {
  for (const std::string& name : shipped_names()) {
    const auto resolved = shipped(name);
    LiveRun run(*resolved);
    ASSERT_TRUE(run.advance());
    const results::RunResult result = evaluation::evaluate(run, false);
    EXPECT_EQ(result.verdict, results::Verdict::pass) << name;
    for (const results::ProgramResult& program : result.programs)
      EXPECT_TRUE(program.violations.empty() || program.violations_allowed) << name;
  }
}

TEST(Runs, DigestsAreThePinnedOnes) {
  const bool is_update = std::getenv("TAKT_UPDATE_GOLDEN") != nullptr;
  const std::vector<Golden> lines = golden();
  std::string now = "# name, duration, digest; how to renew it: tests/README.md\n";
  for (const std::string& name : shipped_names()) {
    const auto found = std::find_if(lines.begin(), lines.end(), [&](const Golden& one) { return one.name == name; });
    EXPECT_TRUE(is_update || found != lines.end()) << name << " has no pinned digest";
    const std::string duration =
        found != lines.end() ? found->duration : json::to_text(shipped(name)->scenario.duration);
    const std::string digest = hex(digest_of(*shipped(name, duration)));
    now += name + " " + duration + " " + digest + "\n";
    EXPECT_TRUE(is_update || found == lines.end() || digest == found->digest)
        << name << ": " << digest << " instead of " << found->digest;
  }
  if (is_update) std::ofstream(golden_file) << now;
}

// Events that are equal in time and phase may come in any order.
TEST(Runs, TieShuffleChangesNothing) {
  for (const Golden& one : golden()) {
    const auto resolved = shipped(one.name, one.duration);
    const std::string plain = hex(digest_of(*resolved));
    for (const std::uint64_t key : {1ULL, 2ULL, 0xDEADBEEFULL, ~0ULL})
      EXPECT_EQ(hex(digest_of(*resolved, key)), plain) << one.name << " " << key;
  }
}

// Nor may it matter in which slices a run is advanced (the progress bar, Ctrl-C).
TEST(Runs, SlicesChangeNothing) {
  for (const std::string& name : shipped_names()) {
    const auto resolved = shipped(name, "55ms");
    const std::uint64_t whole = digest_of(*resolved);
    for (const std::uint64_t slice : {1ULL, 1000ULL}) {
      LiveRun run(*resolved);
      while (!run.advance(slice)) {
      }
      EXPECT_EQ(run.simulation().digest().value(), whole) << name << " in slices of " << slice;
      EXPECT_EQ(run.simulation().now(), run.end());
    }
  }
}

// No global state: runs live side by side, interleaved in one thread and in several.
TEST(Runs, SideBySideInOneThread) {
  const auto one = shipped("robot-arm", "50ms");
  const auto other = shipped("ring-1000", "50ms");
  LiveRun a(*one);
  LiveRun b(*other);
  LiveRun c(*one);
  for (bool done = false; !done;) {
    done = a.advance(100);
    done = b.advance(70) && done;
    done = c.advance(130) && done;
  }
  EXPECT_EQ(a.simulation().digest().value(), digest_of(*one));
  EXPECT_EQ(b.simulation().digest().value(), digest_of(*other));
  EXPECT_EQ(c.simulation().digest().value(), digest_of(*one));
}

TEST(Runs, SideBySideInThreads) {
  const auto resolved = shipped("line-of-switches", "300ms");
  const std::uint64_t alone = digest_of(*resolved);
  std::vector<std::uint64_t> digests(4);
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t& digest : digests) threads.emplace_back([&digest, &resolved] { digest = digest_of(*resolved); });
  }
  EXPECT_EQ(digests, std::vector<std::uint64_t>(4, alone));
}

TEST(Runs, SeedsDiffer) {
  std::set<std::uint64_t> digests;
  for (int seed = 1; seed <= 20; ++seed) {
    json::Diagnostics diagnostics;
    const auto resolved =
        load_file(shipped_path("direct-link"), {"/duration=120ms", "/seed=" + std::to_string(seed)}, diagnostics);
    digests.insert(digest_of(*resolved));
  }
  EXPECT_EQ(digests.size(), 20u);
}

// Common random numbers: a node more moves no draw of the others.
TEST(Runs, ANodeMoreMovesNoOthersChance) {
  const char* const text =
      R"({"name": "t", "duration": "20ms", "network": {"nodes": {)"
      R"("a": {"kind": "host", "os": "preempt-rt"}, "b": {"kind": "host", "os": "preempt-rt"}%s}, "links": [{"ends": ["a", "b"]}]},
 "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "exponential": "100us"}]})";
  const auto with = [&](const std::string& node) {
    std::string filled = text;
    return filled.replace(filled.find("%s"), 2, node);
  };
  const auto one = sound(with(""));
  const auto two = sound(with(R"(, "AA": {"kind": "host", "os": "general-purpose"})"));
  LiveRun a(*one);
  LiveRun b(*two);
  a.advance();
  b.advance();
  const models::Stream& in_a = a.network().traffic().streams()[0];
  const models::Stream& in_b = b.network().traffic().streams()[0];
  EXPECT_EQ(in_a.sent, in_b.sent);
  EXPECT_EQ(in_a.latency.maximum(), in_b.latency.maximum());
  EXPECT_EQ(in_a.latency.mean(), in_b.latency.mean());
}

}  // namespace
}  // namespace takt::scenario::test
