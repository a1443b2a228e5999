// SPDX-License-Identifier: Apache-2.0
// Bounds of topics over OPC UA, driven by the simulator: random lines of switches, threads with laws of their responses
// that overrun or do not, clocks that run apart, other streams beside them. What is certain of threads is held against
// what they did. TAKT_TOPIC_NETWORKS=2000 looks at more networks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "analysis/thread_bound.hpp"
#include "sim/random.hpp"
#include "tests/questions/analysis/falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::topic_falsification_test {
namespace {

std::size_t topic_networks() { return support::case_count("TAKT_TOPIC_NETWORKS", 60); }

class TopicNetwork {
 public:
  explicit TopicNetwork(std::uint64_t number) : chance_(number, "topic network", "test") {
    const std::size_t switches = 1 + chance_.below(3);
    hosts_ = 3 + chance_.below(3);
    const auto link = [&](const std::string& a, const std::string& b) {
      links_ += fmt::format(R"({}{{"ends": ["{}", "{}"], "rate": "10Mbps"}})", links_.empty() ? "" : ", ", a, b);
    };
    for (std::size_t s = 0; s < switches; ++s) {
      nodes_ +=
          fmt::format(R"({}"s{}": {{"kind": "switch", "forwarding_delay": "1us"}})", nodes_.empty() ? "" : ", ", s);
      if (s > 0) link("s" + std::to_string(s - 1), "s" + std::to_string(s));
    }
    for (std::size_t h = 0; h < hosts_; ++h) {
      nodes_ += fmt::format(
          R"(, "h{}": {{"kind": "host"{}}})", h,
          one_in(3) ? R"(, "os": {"transmit": {"uniform": {"from": "1us", "to": "60us"}}, "receive": "5us"})" : "");
      link("h" + std::to_string(h), "s" + std::to_string(chance_.below(switches)));
    }
    const std::size_t topics = 3 + chance_.below(4);
    for (std::size_t i = 0; i < topics; ++i) add_topic(i);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t from = chance_.below(hosts_);
      streams_ +=
          fmt::format(R"({}{{"name": "t{}", "from": "h{}", "to": "h{}", "pcp": {}, "payload": "{}B", "every": "2ms"}})",
                      i == 0 ? "" : ", ", i, from, other(from), chance_.below(8), 10 + chance_.below(500));
    }
    if (one_in(2)) clocks_ = R"(, "clocks": {"all": {"offset": {"from": "-100ppm", "to": "100ppm"}}})";
  }

  /// With offsets of threads that change from run to run: the bounds hold at all of them.
  std::string text(std::uint64_t seed) {
    std::string applications;
    for (const auto& [host, threads] : applications_) {
      std::string all;
      for (const std::string& thread : threads)
        all += fmt::format(R"({}{{{}, "offset": "{}us"}})", all.empty() ? "" : ", ", thread,
                           one_in(2) ? 0 : chance_.below(500));
      applications +=
          fmt::format(R"({}{{"name": "{}", "on": "h{}", "threads": [{}]}})", applications.empty() ? "" : ", ",
                      "app" + std::to_string(applications.size()), host, all);
    }
    return fmt::format(
        R"({{"name": "topics", "duration": "60ms", "seed": {}, "allow_overload": true, "network": {{"nodes": {{{}}}, "links": [{}]}}, "topics": [{}], "applications": [{}], "streams": [{}]{}}})",
        seed, nodes_, links_, topics_, applications, streams_, clocks_);
  }

 private:
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }
  std::size_t other(std::size_t host) { return (host + 1 + chance_.below(hosts_ - 1)) % hosts_; }

  std::string response() {
    switch (chance_.below(4)) {
      case 0:
        return fmt::format(R"("{}us")", chance_.below(400));
      case 1:
        return R"({"uniform": {"from": "0s", "to": "999us"}})";
      case 2:
        return R"({"table": [{"value": "0s"}, {"value": "990us"}]})";
      default:
        return R"({"weibull": {"scale": "900us", "shape": 0.8}})";
    }
  }

  void add_topic(std::size_t i) {
    const char* const periods[] = {"1ms", "2ms", "3ms"};
    topics_ += fmt::format(
        R"({}{{"name": "p{}", "protocol": "opc-ua", "pcp": {}, "fields": {{"v": {{"type": "Double", "count": {}}}}}}})",
        i == 0 ? "" : ", ", i, chance_.below(3), 1 + chance_.below(20));
    const std::size_t from = chance_.below(hosts_);
    applications_.push_back({from,
                             {fmt::format(R"("name": "publish", "publish": "p{}", "every": "{}", "response": {})", i,
                                          periods[chance_.below(3)], response())}});
    applications_.push_back(
        {other(from),
         {fmt::format(R"("name": "take", "subscribe": "p{}", "every": "{}", "buffer": {}, "response": {})", i,
                      periods[chance_.below(3)], 1 + chance_.below(5), response())}});
  }

  sim::RandomStream chance_;
  std::size_t hosts_ = 0;
  std::string nodes_, links_, topics_, streams_, clocks_;
  std::vector<std::pair<std::size_t, std::vector<std::string>>> applications_;
};

/// How many statements were held against what threads did.
std::size_t judge_threads(const scenario::Run& run, const Bounds& bounds, const std::string& text) {
  const scenario::Resolved& r = run.resolved();
  std::size_t certain = 0;
  for (std::size_t a = 0; a < r.applications.size(); ++a)
    for (std::size_t t = 0; t < r.applications[a].threads.size(); ++t) {
      const ThreadBound bound = thread_bound(r, bounds, a, t, {});
      const scenario::ThreadFigures found = run.thread(a, t, {});
      const std::string name = r.applications[a].name + "/" + r.applications[a].threads[t].name + "\n" + text;
      if (found.response.count() > 0) {
        EXPECT_GE(found.response.least(), bound.least_response) << name;
        EXPECT_LE(found.response.greatest(), bound.greatest_response) << name;
      }
      if (bound.is_always_done) {
        EXPECT_EQ(found.done, found.activations) << name;
      }
      if (bound.is_tested) {
        EXPECT_EQ(found.calls.percent(), 100.0) << name;
      }
      if (bound.loses_nothing) {
        EXPECT_EQ(found.lost, 0U) << name;
      }
      if (bound.most_found && *bound.most_found <= r.applications[a].threads[t].buffer) {
        EXPECT_EQ(found.overwritten, 0U) << name;
      }
      certain += (bound.is_tested ? 1U : 0U) + (bound.loses_nothing ? 1U : 0U) +
                 (bound.most_found && *bound.most_found <= r.applications[a].threads[t].buffer ? 1U : 0U);
    }
  return certain;
}

TEST(TopicFalsification, NoRunExceedsABound) {
  std::size_t compared = 0, unbounded = 0, certain = 0;
  std::vector<double> shares;
  for (std::size_t number = 0; number < topic_networks(); ++number) {
    TopicNetwork network(number);
    json::Diagnostics diagnostics;
    std::vector<double> greatest;
    std::optional<Bounds> first;
    for (std::uint64_t attempt = 0; attempt < 8; ++attempt) {
      const std::string text = network.text(attempt + 1);
      const auto running = scenario::load_text(text, "topics.json", {}, diagnostics);
      ASSERT_TRUE(running) << diagnostics.to_text() << text;
      if (!first) first = bound(*running);
      scenario::Run run(*running);
      run.advance();
      const Verdict verdict = judge(run, *first);
      ASSERT_TRUE(verdict.violations.empty()) << "network " << number << ": " << verdict.violations.front() << "\n"
                                              << text;
      certain += judge_threads(run, *first, text);
      if (HasFailure()) return;
      greatest.resize(std::max(greatest.size(), verdict.shares.size()));
      for (std::size_t i = 0; i < verdict.shares.size(); ++i) greatest[i] = std::max(greatest[i], verdict.shares[i]);
      if (attempt == 0) compared += verdict.compared, unbounded += verdict.unbounded;
    }
    shares.insert(shares.end(), greatest.begin(), greatest.end());
  }
  ASSERT_FALSE(shares.empty());
  std::sort(shares.begin(), shares.end());
  std::printf(
      "%zu streams with a bound, %zu without, %zu statements of threads; half of the streams come to %.0f %% of their "
      "bound, the tightest to %.1f %%\n",
      compared, unbounded, certain, 100 * shares[shares.size() / 2], 100 * shares.back());
  EXPECT_GT(compared, 4 * topic_networks());
  EXPECT_GT(compared, 20 * unbounded);
  EXPECT_GT(certain, 8 * topic_networks());
  EXPECT_GT(shares.back(), 0.9);
}

}  // namespace
}  // namespace takt::analysis::test::topic_falsification_test
