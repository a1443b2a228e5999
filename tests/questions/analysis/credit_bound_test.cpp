// SPDX-License-Identifier: Apache-2.0
// Credit-based shapers at one port, against all phases on a grid and against the published service curve. One switch at
// 100 Mb/s; class 6 goes before class 5, and classes without a shaper below.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "models/ethernet/sizes.hpp"
#include "scenario/resolve.hpp"
#include "sim/random.hpp"
#include "tests/questions/analysis/falsification.hpp"

namespace takt::analysis::test::credit_bound_test {
namespace {

using sim::Duration;

std::unique_ptr<scenario::Resolved> load(const std::string& text, const std::vector<std::string>& sets = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "credit.json", sets, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}

struct Talker {
  int pcp = 0;
  std::int64_t payload = 0;
  std::int64_t period_us = 0;
  double work() const {
    return 0.08 * static_cast<double>(payload + 28 + 18 + 4 + 20);
  }  // us, preamble and gap included
};

struct Star {
  double idle_a = 0, idle_b = 0;  // of the rate
  std::vector<Talker> talkers;

  std::string text() const {
    std::string nodes =
        R"("r": {"kind": "host"}, "sw": {"kind": "switch", "traffic_classes": "identity", "forwarding_delay": "0s", "egress": [{"to": "r", "shapers": [{"class": 6, "idle_slope": ")" +
        std::to_string(static_cast<int>(idle_a * 1e8)) + R"(bps"}, {"class": 5, "idle_slope": ")" +
        std::to_string(static_cast<int>(idle_b * 1e8)) + R"(bps"}]}]})";
    std::string links = R"({"ends": ["sw", "r"], "rate": "100Mbps", "delay": "0s"})", streams;
    for (std::size_t i = 0; i < talkers.size(); ++i) {
      const std::string n = std::to_string(i);
      nodes += R"(, "t)" + n + R"(": {"kind": "host"})";
      links += R"(, {"ends": ["t)" + n + R"(", "sw"], "rate": "10Gbps", "delay": "0s"})";
      streams += (i == 0 ? "" : ", ") + std::string(R"({"name": "f)") + n + R"(", "from": "t)" + n +
                 R"(", "to": "r", "payload": ")" + std::to_string(talkers[i].payload) + R"(B", "pcp": )" +
                 std::to_string(talkers[i].pcp) + R"(, "every": ")" + std::to_string(talkers[i].period_us) + R"(us"})";
    }
    return R"({"name": "star", "duration": "9ms", "allow_overload": true, "network": {"nodes": {)" + nodes +
           R"(}, "links": [)" + links + R"(]}, "streams": [)" + streams + "]}";
  }
  double longest(int pcp) const {
    double most = 0;
    for (const Talker& talker : talkers)
      if (talker.pcp == pcp || (pcp == 0 && talker.pcp < 5)) most = std::max(most, talker.work());
    return most;
  }
  /// At the port: the greatest credit of class B is that of a frame of a lower class and all that class A sends then, L
  /// / (1 - i_A) + frame of A (de Azua and Boyer, RTNS 2014), and a burst of one frame of each stream waits for it. In
  /// us.
  double published() const {
    double burst = 0;
    for (const Talker& talker : talkers)
      if (talker.pcp == 5) burst += talker.work();
    return longest(0) / (1 - idle_a) + longest(6) + burst / idle_b;
  }
};

Star drawn(std::uint64_t number) {
  sim::RandomStream chance(number, "credit", "star");
  constexpr double slopes[] = {0.05, 0.1, 0.2, 0.3, 0.4};
  constexpr std::int64_t payloads[] = {46, 100, 400, 1000, 1400};
  Star made;
  made.idle_a = slopes[chance.below(5)];
  made.idle_b = slopes[chance.below(4)];
  const auto add = [&](int pcp) { made.talkers.push_back({pcp, payloads[chance.below(5)], 3000}); };
  add(5);
  add(6);
  for (int more = 0; more < 2; ++more) add(chance.below(3) == 0 ? 0 : chance.below(2) == 0 ? 5 : 6);
  return made;
}

// All phases on a grid of three frames, of four talkers each, over two periods: no run exceeds the bound, which is no
// more than the published one where frames of one's own count for less than lower ones.
TEST(CreditBound, AllPhasesOfFourTalkers) {
  std::vector<double> shares;
  std::size_t published = 0;
  for (std::uint64_t number = 0; number < 12; ++number) {
    const Star star = drawn(number);
    const Bounds bounds = bound(*load(star.text()));
    if (star.longest(0) >= star.idle_a * star.longest(5)) {
      ++published;
      for (std::size_t s = 0; s < star.talkers.size(); ++s)
        if (star.talkers[s].pcp == 5) {
          ASSERT_TRUE(bounds.streams[s].hops[1].delay) << number;
          EXPECT_LE(static_cast<double>(bounds.streams[s].hops[1].delay->ps()) / 1e6, star.published() + 0.001)
              << number << "\n"
              << star.text();
        }
    }
    double tightest = 0;
    constexpr int steps = 5;
    const std::int64_t step_ns = 37'000;
    for (int phases = 0; phases < steps * steps * steps; ++phases) {
      const int of[] = {0, phases % steps, phases / steps % steps, phases / steps / steps};
      std::vector<std::string> sets;
      for (std::size_t s = 0; s < star.talkers.size(); ++s)
        sets.push_back("/streams/" + std::to_string(s) +
                       "/offset=" + std::to_string(1'000'000 + (s == 0 ? 2 * step_ns + 1 : step_ns * of[s])) + "ns");
      const Verdict verdict = simulate(*load(star.text(), sets), bounds);
      ASSERT_EQ(verdict.violations, std::vector<std::string>()) << number << "\n"
                                                                << star.text() << ::testing::PrintToString(sets);
      tightest = std::max(tightest, verdict.tightest);
    }
    shares.push_back(tightest);
  }
  EXPECT_GT(published, 2u);
  std::sort(shares.begin(), shares.end());
  EXPECT_GT(shares[shares.size() / 2], 0.8);
}

// Class B behind 1,400 octets of a lower class and three frames of class A, which has 30 % and more to send than that:
// N = 117.6 / 0.7 + 37.6 us. Of two frames of B of 100 octets, 13.6 us each, the second starts after (13.6 + 0.1 N) /
// 0.1.
TEST(CreditBound, OfClassBByHand) {
  const Star star{
      0.3, 0.1, {{5, 100, 3000}, {5, 100, 3000}, {6, 400, 3000}, {6, 400, 3000}, {6, 400, 3000}, {0, 1400, 3000}}};
  const Bounds bounds = bound(*load(star.text()));
  const double waits = star.longest(0) / 0.7 + star.longest(6);
  EXPECT_NEAR(static_cast<double>(bounds.streams[0].hops[1].delay->ps()) / 1e6,
              star.talkers[0].work() / 0.1 + waits + star.talkers[0].work() - 0.96, 0.001);
}

// Thirteen talkers that ask for exactly their slope: the class is never done, and has a bound, which the worst of them
// comes to within 10 ps (Boiger 2011).
TEST(CreditBound, OfAFullSlope) {
  Star star{0.7488, 0.1, {}};
  for (int i = 0; i < 13; ++i) star.talkers.push_back({6, 20, 125});  // 20 + 28 + 22 = 70 octets, 90 with all
  std::string text = star.text();
  for (std::size_t at = text.find("10Gbps"); at != std::string::npos; at = text.find("10Gbps"))
    text.replace(at, 6, "100Mbps");
  const Bounds bounds = bound(*load(text));
  ASSERT_TRUE(bounds.streams[12].latency) << bounds.streams[12].reason;
  std::vector<std::string> sets;
  for (int i = 0; i < 13; ++i) sets.push_back("/streams/" + std::to_string(i) + "/offset=0s");
  const Verdict verdict = simulate(*load(text, sets), bounds);
  EXPECT_EQ(verdict.violations, std::vector<std::string>());
  EXPECT_GT(verdict.tightest, 0.9999999);
  // One octet a second more, and there is none.
  star.idle_a = 0.74879999;
  EXPECT_FALSE(bound(*load(star.text())).streams[12].latency.has_value() &&
               *bound(*load(star.text())).streams[12].latency < Duration::from_ps(1'000'000'000));
}

}  // namespace
}  // namespace takt::analysis::test::credit_bound_test
