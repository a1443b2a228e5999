// SPDX-License-Identifier: Apache-2.0
// Bounds of classes that share bandwidth (ETS), driven by the simulator: random lines of switches, with strict and
// shaped classes, preemption and an overloaded class beside them. TAKT_SHARED_NETWORKS=2000 looks at more networks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "sim/random.hpp"
#include "tests/questions/analysis/falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::shared_falsification_test {
namespace {

std::size_t shared_networks() { return support::case_count("TAKT_SHARED_NETWORKS", 60); }

class SharedNetwork {
 public:
  explicit SharedNetwork(std::uint64_t number) : chance_(number, "shared network", "test") {
    make_egress();
    const std::size_t switches = 1 + chance_.below(3);
    hosts_ = 3 + chance_.below(3);
    const bool is_fast = one_in(3);
    const auto link = [&](const std::string& a, const std::string& b) {
      links_ += fmt::format(R"({}{{"ends": ["{}", "{}"], "rate": "{}"}})", links_.empty() ? "" : ", ", a, b,
                            is_fast && one_in(2) ? "1Gbps" : "100Mbps");
    };
    for (std::size_t s = 0; s < switches; ++s) {
      nodes_ += fmt::format(
          R"({}"s{}": {{"kind": "switch", "forwarding_delay": "1us", "traffic_classes": "identity", "egress": [{{{}}}]}})",
          nodes_.empty() ? "" : ", ", s, egress_);
      if (s > 0) link("s" + std::to_string(s - 1), "s" + std::to_string(s));
    }
    for (std::size_t h = 0; h < hosts_; ++h) {
      nodes_ += fmt::format(R"(, "h{}": {{"kind": "host"}})", h);
      link("h" + std::to_string(h), "s" + std::to_string(chance_.below(switches)));
    }
    const std::size_t streams = 4 + chance_.below(6);
    for (std::size_t i = 0; i < streams; ++i) add_stream(i, 0);
    // It may send more than its links carry: the others keep their shares.
    if (one_in(3)) add_stream(streams, 1300 + chance_.below(170));
  }

  /// `with_offsets`: as it runs. Bounds must hold at all of them, and so are asked without.
  std::string text(bool with_offsets) {
    std::string streams;
    for (const std::string& stream : streams_)
      streams += (streams.empty() ? "{" : ", {") + stream +
                 (with_offsets ? fmt::format(R"(, "offset": "{}us"}})", one_in(2) ? 0 : chance_.below(500)) : "}");
    return fmt::format(
        R"({{"name": "shares", "duration": "8ms", "allow_overload": true, "network": {{"nodes": {{{}}}, "links": [{}]}}, "streams": [{}]}})",
        nodes_, links_, streams);
  }

 private:
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }

  void make_egress() {
    const std::size_t count = 2 + chance_.below(3);
    for (int q = 0; q < 8; ++q) (shared_.size() < count && one_in(2) ? shared_ : others_).push_back(q);
    while (shared_.size() < 2) {
      shared_.push_back(others_.back());
      others_.pop_back();
    }
    std::string shares, preemptable;
    std::size_t left = 100;
    for (std::size_t i = 0; i < shared_.size(); ++i) {
      const std::size_t share = i + 1 == shared_.size() ? left : 5 + chance_.below(left - 5 * (shared_.size() - i));
      left -= share;
      shares += fmt::format(R"({}{{"class": {}, "bandwidth": {}}})", i == 0 ? "" : ", ", shared_[i], share);
      preemptable += fmt::format("{}{}", i == 0 ? "" : ", ", shared_[i]);
    }
    egress_ = fmt::format(R"("ets": [{}])", shares);
    if (one_in(3)) egress_ += fmt::format(R"(, "shapers": [{{"class": {}, "idle_slope": "20Mbps"}}])", others_.back());
    if (one_in(4)) egress_ += fmt::format(R"(, "preemption": {{"preemptable": [{}]}})", preemptable);
  }

  void add_stream(std::size_t i, std::size_t flood) {
    const std::size_t from = chance_.below(hosts_);
    const std::size_t to = (from + 1 + chance_.below(hosts_ - 1)) % hosts_;
    const bool is_shared = flood != 0 || !one_in(3);
    const int q = is_shared ? shared_[chance_.below(shared_.size())] : others_[chance_.below(others_.size())];
    const char* const periods[] = {"400us", "500us", "1ms", "700us"};
    streams_.push_back(fmt::format(
        R"("name": "t{}", "from": "h{}", "to": "h{}", "pcp": {}, "payload": "{}B", "every": "{}")", i, from, to, q,
        flood != 0 ? flood : 10 + chance_.below(1400), flood != 0 ? "110us" : periods[chance_.below(4)]));
  }

  sim::RandomStream chance_;
  std::size_t hosts_ = 0;
  std::vector<int> shared_, others_;
  std::string egress_, nodes_, links_;
  std::vector<std::string> streams_;
};

TEST(SharedFalsification, NoRunExceedsABound) {
  std::size_t compared = 0, unbounded = 0;
  std::vector<double> shares;
  for (std::size_t number = 0; number < shared_networks(); ++number) {
    SharedNetwork network(number);
    json::Diagnostics diagnostics;
    const auto promised = scenario::load_text(network.text(false), "shares.json", {}, diagnostics);
    ASSERT_TRUE(promised) << diagnostics.to_text();
    const Bounds bounds = bound(*promised);
    std::vector<double> greatest;
    for (int attempt = 0; attempt < 8; ++attempt) {
      const std::string text = network.text(true);
      const auto running = scenario::load_text(text, "shares.json", {}, diagnostics);
      ASSERT_TRUE(running) << diagnostics.to_text();
      const Verdict verdict = simulate(*running, bounds);
      ASSERT_TRUE(verdict.violations.empty()) << "network " << number << ": " << verdict.violations.front() << "\n"
                                              << text;
      greatest.resize(std::max(greatest.size(), verdict.shares.size()));
      for (std::size_t i = 0; i < verdict.shares.size(); ++i) greatest[i] = std::max(greatest[i], verdict.shares[i]);
      if (attempt == 0) compared += verdict.compared, unbounded += verdict.unbounded;
    }
    shares.insert(shares.end(), greatest.begin(), greatest.end());
  }
  ASSERT_FALSE(shares.empty());
  std::sort(shares.begin(), shares.end());
  std::printf(
      "%zu streams with a bound, %zu without; half of them come to %.0f %% of their bound, the tightest to %.1f %%\n",
      compared, unbounded, 100 * shares[shares.size() / 2], 100 * shares.back());
  EXPECT_GT(compared, 3 * shared_networks());
  EXPECT_GT(compared, 5 * unbounded);
  EXPECT_GT(shares.back(), 0.9);
}

}  // namespace
}  // namespace takt::analysis::test::shared_falsification_test
