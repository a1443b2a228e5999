// SPDX-License-Identifier: Apache-2.0
// Drives the simulator at the bounds of ladders: a ladder of two to four rungs, other traffic that crosses it, links
// that are cut. No bound may be exceeded, and where every frame is promised to arrive, every frame must.
// TAKT_LADDERS=20000 looks at more of them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "sim/random.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::ladder_falsification_test {
namespace {

using sim::Duration;

std::uint64_t ladders() { return support::case_count("TAKT_LADDERS", 300); }

class LadderMaker {
 public:
  explicit LadderMaker(std::uint64_t seed) : chance_(seed, "ladder", "test"), rungs_(2 + chance_.below(3)) {}

  std::string text() {
    std::string nodes =
        host("t") + ", " + host("l") + ", " + host("x") + ", " + host("y") + ", " + relay("s") + ", " + relay("m");
    link("t", "s");
    link("m", "l");
    for (const char* side : {"a", "b"}) {
      for (std::size_t i = 0; i < rungs_; ++i) nodes += ", " + relay(side + std::to_string(i));
      link("s", std::string(side) + "0");
      for (std::size_t i = 1; i < rungs_; ++i) link(side + std::to_string(i - 1), side + std::to_string(i));
      link(side + std::to_string(rungs_ - 1), "m");
    }
    for (std::size_t i = 0; i < rungs_; ++i) link("a" + std::to_string(i), "b" + std::to_string(i));
    link("x", "a0");
    link("y", chance_.below(2) == 0 ? "b" + std::to_string(rungs_ - 1) : "m");
    const std::string talker = chance_.below(2) == 0 ? "t" : "s";
    return R"({"name": "t", "duration": "20ms", "network": {"nodes": {)" + nodes + "}, \"links\": [" + links_ +
           R"(]}, "streams": [
{"name": "s", "from": "t", "to": "l", "payload": "100B", "every": "500us", "pcp": 5, "redundancy": {"ladder": true, "number": ")" +
           talker + "\", " + recovery() + R"(, "paths": [)" + paths() + R"(]}},
{"name": "up", "from": "x", "to": "y", "payload": "900B", "burst": {"frames": 4, "every": "1ms"}, "pcp": )" +
           std::to_string(4 + chance_.below(3)) + R"(},
{"name": "down", "from": "y", "to": "x", "payload": "300B", "every": "200us", "pcp": 5}], "faults": [)" +
           cuts() + "]}";
  }

 private:
  static std::string host(const std::string& name) { return "\"" + name + R"(": {"kind": "host"})"; }
  std::string relay(const std::string& name) {
    return "\"" + name + R"(": {"kind": "switch", "forwarding_delay": ")" + std::to_string(chance_.below(4)) + "us\"}";
  }
  void link(const std::string& a, const std::string& b) {
    links_ +=
        (links_.empty() ? "" : ", ") + (R"({"ends": [")" + a + R"(", ")" + b + R"("], "rate": "100Mbps", "length": ")" +
                                        std::to_string(1 + chance_.below(100)) + "m\"}");
    if (a != "t" && b != "l" && a != "x" && a != "y") ends_.emplace_back(a, b);
  }
  /// Both lines, and one way that changes over at every rung, begun on either side: all links in all directions.
  std::string paths() const {
    std::string all;
    for (const bool lower : {false, true})
      for (const bool zigzag : {false, true}) {
        std::string path = R"("t", "s")";
        bool is_low = lower;
        for (std::size_t i = 0; i < rungs_; ++i) {
          path += ", \"" + std::string(is_low ? "b" : "a") + std::to_string(i) + "\"";
          if (zigzag) is_low = !is_low;
          if (zigzag) path += ", \"" + std::string(is_low ? "b" : "a") + std::to_string(i) + "\"";
        }
        all += (all.empty() ? "[" : ", [") + path + R"(, "m", "l"])";
      }
    return all;
  }
  /// Histories that a cut outlasts, timers that expire while copies are under way, match recovery.
  std::string recovery() {
    static const char* const timeouts[] = {"1s", "10ms", "2ms", "20us"};
    std::string text = R"("reset_timeout": ")" + std::string(timeouts[chance_.below(4)]) + "\"";
    return text + (chance_.below(5) == 0 ? R"(, "algorithm": "match")"
                                         : ", \"history\": " + std::to_string(2 + chance_.below(15)));
  }
  std::string cuts() {
    std::string all;
    const std::size_t count = chance_.below(4);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [a, b] = ends_[chance_.below(ends_.size())];
      all += (all.empty() ? "" : ", ") +
             (R"({"kind": "link-down", "link": [")" + a + R"(", ")" + b + R"("], "at": ")" +
              std::to_string(chance_.below(12)) + R"(ms", "for": ")" + std::to_string(1 + chance_.below(8)) + "ms\"}");
    }
    return all;
  }

  sim::RandomStream chance_;
  std::size_t rungs_;
  std::string links_;
  std::vector<std::pair<std::string, std::string>> ends_;
};

TEST(LadderFalsification, NothingIsExceededAndNothingPromisedIsLost) {
  std::size_t promised = 0, lossy = 0;
  for (std::uint64_t seed = 0; seed < ladders(); ++seed) {
    const std::string text = LadderMaker(seed).text();
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
    ASSERT_NE(resolved, nullptr) << diagnostics.to_text() << text;
    const Bounds bounds = bound(*resolved);
    scenario::Run run(*resolved);
    run.advance();
    const auto& streams = run.network().traffic().streams();
    for (std::size_t s = 0; s < streams.size(); ++s) {
      if (bounds.streams[s].latency && streams[s].delivered > 0) {
        EXPECT_LE(streams[s].latency.maximum(), *bounds.streams[s].latency) << seed << " " << bounds.streams[s].name;
        EXPECT_GE(streams[s].latency.minimum(), bounds.streams[s].least) << seed << " " << bounds.streams[s].name;
      }
      if (bounds.streams[s].reaches_all) {
        const std::uint64_t under_way = s == 1 ? 4 : 1;  // at the end
        EXPECT_GE(streams[s].delivered + under_way, streams[s].sent) << seed << " " << bounds.streams[s].name;
      }
    }
    ++(bounds.streams[0].reaches_all ? promised : lossy);
  }
  EXPECT_GT(promised, 50u);
  EXPECT_GT(lossy, 5u);
}

struct Both {
  Bounds bounds;
  std::uint64_t sent = 0, delivered = 0;
  Duration longest;
};
Both both_of(const std::string& nodes, const std::string& links, const std::string& redundancy,
             const std::string& faults) {
  std::string all;
  for (const char name : nodes)
    all += std::string(all.empty() ? "" : ", ") + '"' + name + R"(": {"kind": ")" +
           (name == 't' || name == 'l' ? "host" : "switch") + "\"}";
  std::string cables;
  for (std::size_t i = 0; i < links.size(); i += 3)
    cables +=
        std::string(cables.empty() ? "" : ", ") + R"({"ends": [")" + links[i] + R"(", ")" + links[i + 1] + R"("]})";
  const std::string text =
      R"({"name": "t", "duration": "40ms", "network": {"nodes": {)" + all + "}, \"links\": [" + cables +
      R"(]}, "streams": [{"name": "x", "from": "t", "to": "l", "payload": "100B", "every": "1ms", "pcp": 3, "redundancy": {"ladder": true, )" +
      redundancy + "}}], \"faults\": [" + faults + "]}";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text() << text;
  Both made;
  if (!resolved) return made;
  made.bounds = bound(*resolved);
  scenario::Run run(*resolved);
  run.advance();
  const models::Stream& stream = run.network().traffic().streams()[0];
  made.sent = stream.sent;
  made.delivered = stream.delivered;
  made.longest = stream.latency.maximum();
  return made;
}
std::string down(const char* a, const char* b, int at) {
  return R"({"kind": "link-down", "link": [")" + std::string(a) + R"(", ")" + b + R"("], "at": ")" +
         std::to_string(at) + R"(ms", "for": "10ms"})";
}

// Nothing comes to relay c for ten frames, more than its history; when the other line is cut, c still takes what comes
// for wrong. A timer that has expired by then makes it listen again.
TEST(Ladder, ARelayThatHeardNothingIsDeafUntilItsTimerExpires) {
  const std::string links = "ts sa sb ac bd ab cd cm dm ml";
  const std::string paths =
      R"("paths": [["t","s","a","c","m","l"], ["t","s","b","d","m","l"], ["t","s","a","b","d","c","m","l"], ["t","s","b","a","c","d","m","l"]])";
  const std::string faults = down("a", "c", 2) + ", " + down("c", "d", 2) + ", " + down("d", "m", 20);
  const Both deaf = both_of("tsabcdml", links, R"("history": 8, "reset_timeout": "1s", )" + paths, faults);
  EXPECT_LT(deaf.delivered + 1, deaf.sent);
  EXPECT_FALSE(deaf.bounds.streams[0].reaches_all);
  const Both awake = both_of("tsabcdml", links, R"("history": 8, "reset_timeout": "5ms", )" + paths, faults);
  EXPECT_EQ(awake.delivered + 1, awake.sent);
  EXPECT_TRUE(awake.bounds.streams[0].reaches_all) << awake.bounds.streams[0].loss_reason;
}

// Round three relays: one that forgets a number before its copy has come back sends it round again, for ever.
TEST(Ladder, WhatIsForgottenBeforeItComesBackGoesInCircles) {
  const std::string links = "ts sa sb sc ab bc ca am bm cm ml";
  const std::string paths =
      R"("paths": [["t","s","a","b","c","m","l"], ["t","s","b","c","a","m","l"], ["t","s","c","a","b","m","l"]])";
  const Both forgets = both_of("tsabcml", links, R"("history": 8, "reset_timeout": "1us", )" + paths, "");
  EXPECT_GT(forgets.longest, Duration::from_ps(1'000'000'000));
  EXPECT_FALSE(forgets.bounds.streams[0].latency);
  EXPECT_TRUE(forgets.bounds.streams[0].hops.empty());
  for (const QueueBound& queue : forgets.bounds.queues) EXPECT_FALSE(queue.frames);
  const Both knows = both_of("tsabcml", links, R"("history": 8, )" + paths, "");
  ASSERT_TRUE(knows.bounds.streams[0].latency);
  EXPECT_LE(knows.longest, *knows.bounds.streams[0].latency);
}

}  // namespace
}  // namespace takt::analysis::ladder_falsification_test
