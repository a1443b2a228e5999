// SPDX-License-Identifier: Apache-2.0
// Bounds of hosts with processors, driven by the simulator: random threads of all policies on one or two cores, bound
// to them or not, that run the protocol stack, Programs, applications and loads. TAKT_CPU_NETWORKS=2000 looks at more
// networks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "analysis/thread_bound.hpp"
#include "sim/random.hpp"
#include "tests/questions/analysis/host_falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::cpu_falsification_test {
namespace {

using sim::Duration;

std::size_t cpu_networks() { return support::case_count("TAKT_CPU_NETWORKS", 60); }

class CpuNetwork {
 public:
  explicit CpuNetwork(std::uint64_t number) : chance_(number, "cpu network", "test") {
    has_program_ = one_in(2);
    is_secured_ = has_program_ && one_in(2);
    for (std::size_t h = 0; h < hosts; ++h)
      nodes_ += fmt::format(
          R"("h{}": {{"kind": "host", "os": {{"wake_up": {{"uniform": {{"from": "0s", "to": "{}us"}}}}}}, "cpu": {}{}}}, )",
          h, chance_.below(30), processor(h), cryptography());
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t from = chance_.below(hosts);
      streams_ += fmt::format(
          R"({}{{"name": "s{}", "from": "h{}", "to": "h{}", "pcp": {}, "payload": "{}B", "every": "{}us"}})",
          i == 0 ? "" : ", ", i, from, (from + 1 + chance_.below(hosts - 1)) % hosts, chance_.below(8),
          10 + chance_.below(500), 400 + 100 * chance_.below(20));
    }
  }

  /// With phases that change from run to run: the bounds hold at all of them.
  std::string text(std::uint64_t seed) {
    std::string links;
    for (std::size_t h = 0; h < hosts; ++h)
      links += fmt::format(R"({}{{"ends": ["h{}", "sw"], "rate": "100Mbps"}})", h == 0 ? "" : ", ", h);
    const std::string program =
        R"(, "programs": [{"name": "p", "master": "h0", "slaves": ["h1", "h2"], "cycle": "2ms")" +
        std::string(is_secured_ ? R"(, "security": "sign")" : "") +
        R"(}], "script": [{"at": "7ms", "program": "p", "call": "Start"}, {"at": "60ms", "program": "p", "call": "Halt"}])";
    return fmt::format(
        R"({{"name": "cpus", "duration": "100ms", "seed": {}, "network": {{"nodes": {{{}"sw": {{"kind": "switch", "forwarding_delay": "1us"}}}}, "links": [{}]}}, "streams": [{}],
      "topics": [{{"name": "level", "protocol": "opc-ua", "fields": {{"level": "Int32"}}}}],
      "applications": [{{"name": "sensor", "on": "h0", "threads": [{{"name": "publish", "publish": "level", "every": "2ms", "offset": "{}us", "response": {{"uniform": {{"from": "0s", "to": "200us"}}}}}}]}},
                       {{"name": "actor", "on": "h1", "threads": [{{"name": "take", "subscribe": "level", "every": "3ms", "offset": "{}us"}}]}}]{}}})",
        seed, nodes_, links, streams_, chance_.below(2000), chance_.below(3000), has_program_ ? program : "");
  }

 private:
  static constexpr std::size_t hosts = 3;
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }

  std::string processor(std::size_t host) {
    const std::size_t cores = one_in(3) ? 2 : 1;
    const bool all_are_bound = one_in(2);
    std::string threads;
    std::vector<std::string> what = {R"("stack": ["receive"])", R"("stack": ["transmit"])"};
    if (one_in(4)) what = {R"("stack": ["receive", "transmit"])"};
    if (has_program_) what.push_back(R"("runs": ["p"])");
    if (host == 0) what.push_back(R"("runs": ["sensor"])");
    if (host == 1) what.push_back(R"("runs": ["actor"])");
    for (std::size_t loads = chance_.below(3); loads > 0; --loads)
      what.push_back(
          fmt::format(R"("every": "{}us", "offset": "{}us")", 700 + 100 * chance_.below(30), chance_.below(700)));
    for (std::size_t t = 0; t < what.size(); ++t) {
      threads += fmt::format(R"({}{{"name": "t{}", {}, "execution": {{"uniform": {{"from": "1us", "to": "{}us"}}}})",
                             t == 0 ? "" : ", ", t, what[t], 5 + chance_.below(60));
      const std::size_t policy = chance_.below(5);
      if (policy == 0) threads += R"(, "policy": "deadline", "deadline": "500us")";
      if (policy == 1) threads += fmt::format(R"(, "policy": "fair", "weight": {})", 1 + chance_.below(2000));
      if (policy > 1) threads += fmt::format(R"(, "priority": {})", 1 + chance_.below(4));
      if (one_in(3)) threads += fmt::format(R"(, "non_preemptive": "{}us")", 1 + chance_.below(40));
      if (all_are_bound || one_in(3)) threads += fmt::format(R"(, "core": {})", chance_.below(cores));
      threads += "}";
    }
    return fmt::format(R"({{"cores": {}, "switching": "{}us", "slice": "{}us", "threads": [{}]}})", cores,
                       chance_.below(4), 10 + chance_.below(50), threads);
  }

  /// Sealing is a job, which may be shorter than those of the thread; opening makes a job longer. One without the
  /// other, too, so that neither hides behind what the other costs.
  std::string cryptography() {
    if (!is_secured_) return "";
    const std::uint64_t seal = one_in(3) ? 0 : chance_.below(200'000);
    return fmt::format(R"(, "cryptography": {{"seal": "{}ns", "open": "{}ns"}})", seal,
                       one_in(3) ? 0 : chance_.below(300'000));
  }

  sim::RandomStream chance_;
  bool has_program_ = false;
  bool is_secured_ = false;
  std::string nodes_, streams_;
};

/// The application of the first host, whose thread publishes.
void judge_publisher(const scenario::Run& run, const Bounds& bounds, const std::string& text) {
  const ThreadBound sensor = thread_bound(run.resolved(), bounds, 0, 0, {});
  const scenario::ThreadFigures calls = run.thread(0, 0, {});
  if (sensor.is_always_done) {
    EXPECT_EQ(calls.done, calls.activations) << text;
  }
  if (calls.response.count() > 0) {
    EXPECT_LE(calls.response.greatest(), sensor.greatest_response) << text;
  }
}

TEST(CpuFalsification, NoRunExceedsABound) {
  std::size_t unbounded = 0;
  std::size_t reactions = 0;
  std::vector<double> shares;
  for (std::size_t number = 0; number < cpu_networks(); ++number) {
    CpuNetwork network(number);
    std::optional<Bounds> first;
    for (std::uint64_t attempt = 0; attempt < 6; ++attempt) {
      const std::string text = network.text(attempt + 1);
      json::Diagnostics diagnostics;
      const auto running = scenario::load_text(text, "cpus.json", {}, diagnostics);
      ASSERT_TRUE(running) << diagnostics.to_text() << text;
      if (!first) first = bound(*running);
      scenario::Run run(*running);
      run.advance();
      const Verdict verdict = judge(run, *first);
      ASSERT_TRUE(verdict.violations.empty()) << "network " << number << ": " << verdict.violations.front() << "\n"
                                              << text;
      judge_threads(run, *first, text, shares, unbounded);
      judge_publisher(run, *first, text);
      reactions += judge_reactions(run, *first, text);
      if (HasFailure()) return;
    }
  }
  ASSERT_FALSE(shares.empty());
  std::sort(shares.begin(), shares.end());
  std::printf("%zu threads with a bound, %zu without; half of them come to %.0f %% of it, the tightest to %.1f %%\n",
              shares.size(), unbounded, 100 * shares[shares.size() / 2], 100 * shares.back());
  EXPECT_GT(shares.size(), 4 * unbounded);
  EXPECT_GT(reactions, cpu_networks());
  EXPECT_GT(shares.back(), 0.9);
}

}  // namespace
}  // namespace takt::analysis::test::cpu_falsification_test
