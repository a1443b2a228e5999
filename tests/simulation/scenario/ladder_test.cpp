// SPDX-License-Identifier: Apache-2.0
// Ladders (IEEE 802.1CB, Annex C): elimination and replication at the same switch, and numbering apart from copying.
#include "support.hpp"

namespace takt::scenario::test {
namespace {

/// t - s, then two lines a1 - a2 and b1 - b2 with rungs, then m - l; `redundancy` of the stream from t to l, and
/// faults.
std::string ladder(const std::string& redundancy, const std::string& faults = {}) {
  return R"({"name": "t", "duration": "10ms", "network": {"nodes": {"t": {"kind": "host"}, "l": {"kind": "host"}, "s": {"kind": "switch"}, "m": {"kind": "switch"},
 "a1": {"kind": "switch"}, "a2": {"kind": "switch"}, "b1": {"kind": "switch"}, "b2": {"kind": "switch"}},
 "links": [{"ends": ["t", "s"], "delay": "0s"}, {"ends": ["s", "a1"], "delay": "0s"}, {"ends": ["s", "b1"], "delay": "0s"}, {"ends": ["a1", "a2"], "delay": "0s"}, {"ends": ["b1", "b2"], "delay": "0s"},
           {"ends": ["a1", "b1"], "delay": "0s"}, {"ends": ["a2", "b2"], "delay": "0s"}, {"ends": ["a2", "m"], "delay": "0s"}, {"ends": ["b2", "m"], "delay": "0s"}, {"ends": ["m", "l"], "delay": "0s"}]},
 "streams": [{"name": "x", "from": "t", "to": "l", "payload": "100B", "every": "1ms", "pcp": 3, "redundancy": )" +
         redundancy + "}], \"faults\": [" + faults + "]}";
}
const std::string upper = R"(["t", "s", "a1", "a2", "m", "l"])";
const std::string lower = R"(["t", "s", "b1", "b2", "m", "l"])";
const std::string rungs =
    R"(["t", "s", "a1", "b1", "b2", "a2", "m", "l"], ["t", "s", "b1", "a1", "a2", "b2", "m", "l"])";
std::string cut(const std::string& a, const std::string& b) {
  return R"({"kind": "link-down", "link": [")" + a + "\", \"" + b + R"("], "at": "0s"})";
}

struct Ended {
  std::uint64_t delivered = 0;
  std::uint64_t duplicates = 0;
  Duration latest;
};
Ended run(const std::string& text) {
  const auto r = sound(text);
  LiveRun run(*r);
  run.advance();
  const models::Stream& stream = run.network().traffic().streams()[0];
  return {stream.delivered, stream.dropped[static_cast<std::size_t>(models::DropReason::duplicate)],
          stream.latency.maximum()};
}

// 128 octets of SDU, 150 from DA to FCS with both tags off... 146 + 4: with preamble 158, 1.264 us; with an R-TAG
// 164, 1.312 us. Five hops by the shortest way, the first and the last one without R-TAG. Of each frame a1, b1, a2, b2
// and m take one copy out: over each rung one goes both ways.
TEST(Ladder, EachRelayTakesOutAndCopies) {
  const Ended ended =
      run(ladder(R"({"ladder": true, "history": 8, "paths": [)" + upper + ", " + lower + ", " + rungs + "]}"));
  EXPECT_EQ(ended.delivered, 10u);
  EXPECT_EQ(ended.duplicates, 50u);
  EXPECT_EQ(ended.latest, Duration::from_ps(2 * 1'264'000 + 3 * 1'312'000));
}

// The first way is cut in the upper line, the second in the lower one: the rung is left, and each frame goes over it.
TEST(Ladder, TwoCutsThatTwoPathsDoNotSurvive) {
  const std::string cuts = cut("s", "a1") + ", " + cut("b1", "b2");
  EXPECT_EQ(run(ladder(R"({"paths": [)" + upper + ", " + lower + "]}", cuts)).delivered, 0u);
  const Ended ended =
      run(ladder(R"({"ladder": true, "history": 8, "paths": [)" + upper + ", " + lower + ", " + rungs + "]}", cuts));
  EXPECT_EQ(ended.delivered, 10u);
  EXPECT_EQ(ended.latest, Duration::from_ps(2 * 1'264'000 + 4 * 1'312'000));
}

// Wherever two of the links are cut, frames arrive exactly if some way is left.
TEST(Ladder, ArrivesWhereverAWayIsLeft) {
  const std::vector<std::pair<std::string, std::string>> links = {
      {"s", "a1"}, {"s", "b1"}, {"a1", "a2"}, {"b1", "b2"}, {"a1", "b1"}, {"a2", "b2"}, {"a2", "m"}, {"b2", "m"}};
  const std::vector<std::vector<std::string>> ways = {{"s", "a1", "a2", "m"},
                                                      {"s", "b1", "b2", "m"},
                                                      {"s", "a1", "b1", "b2", "m"},
                                                      {"s", "b1", "a1", "a2", "m"},
                                                      {"s", "a1", "a2", "b2", "m"},
                                                      {"s", "b1", "b2", "a2", "m"},
                                                      {"s", "a1", "b1", "b2", "a2", "m"},
                                                      {"s", "b1", "a1", "a2", "b2", "m"}};
  const auto goes_over = [](const std::vector<std::string>& way, const std::pair<std::string, std::string>& link) {
    for (std::size_t i = 0; i + 1 < way.size(); ++i)
      if ((way[i] == link.first && way[i + 1] == link.second) || (way[i] == link.second && way[i + 1] == link.first))
        return true;
    return false;
  };
  for (std::size_t i = 0; i < links.size(); ++i)
    for (std::size_t j = i + 1; j < links.size(); ++j) {
      const bool is_left = std::ranges::any_of(
          ways, [&](const auto& way) { return !goes_over(way, links[i]) && !goes_over(way, links[j]); });
      const Ended ended =
          run(ladder(R"({"ladder": true, "history": 8, "paths": [)" + upper + ", " + lower + ", " + rungs + "]}",
                     cut(links[i].first, links[i].second) + ", " + cut(links[j].first, links[j].second)));
      EXPECT_EQ(ended.delivered, is_left ? 10u : 0u)
          << links[i].first << "-" << links[i].second << ", " << links[j].first << "-" << links[j].second;
    }
}

// The talker numbers, the switch behind it copies: the first cable has the 6 octets of the R-TAG.
TEST(Ladder, NumberedAtTheTalker) {
  const Ended apart = run(ladder(R"({"number": "t", "paths": [)" + upper + ", " + lower + "]}"));
  EXPECT_EQ(apart.delivered, 10u);
  EXPECT_EQ(apart.duplicates, 10u);
  EXPECT_EQ(apart.latest, Duration::from_ps(1'264'000 + 4 * 1'312'000));
  EXPECT_EQ(run(ladder(R"({"paths": [)" + upper + ", " + lower + "]}")).latest,
            Duration::from_ps(2 * 1'264'000 + 3 * 1'312'000));
}

// Neither the splitting switch nor the last merge: hosts with two interfaces at both ends.
TEST(Ladder, MistakesAreTold) {
  const auto complains = [](const std::string& redundancy, const std::string& what) {
    return load(ladder(redundancy)).diagnostics.to_text().find(what) != std::string::npos;
  };
  EXPECT_TRUE(complains(R"({"ladder": true})", "/redundancy/ladder: a ladder without paths"));
  EXPECT_TRUE(complains(R"({"ladder": true, "split": "s", "paths": [)" + upper + ", " + lower + "]}",
                        "/redundancy/split: a ladder otherwise than by its paths"));
  EXPECT_TRUE(complains(R"({"number": "m", "paths": [)" + upper + ", " + lower + "]}",
                        "/redundancy/number: a node that not all paths cross before they are copied"));
}

}  // namespace
}  // namespace takt::scenario::test
