// SPDX-License-Identifier: Apache-2.0
// Bounds of classes that are counted window by window, driven by the simulator: long frames as many as windows, short
// ones beside them, from talkers at any phase. TAKT_PACKED_NETWORKS=4000 looks at more networks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "sim/random.hpp"
#include "tests/questions/analysis/falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::packed_falsification_test {
namespace {

class PackedNetwork {
 public:
  explicit PackedNetwork(std::uint64_t number) : chance_(number, "packed network", "test") {
    // At 1 Gb/s; most windows hold one long frame and some short ones.
    const std::size_t heavy = 500 + chance_.below(800);
    const std::size_t open = heavy * 8 / 1000 + 3 + chance_.below(one_in(4) ? 20 : 5);
    const std::size_t before = chance_.below(80 - open);
    // What is open beside class 7: nothing, or lower classes that may block it or reach into its window.
    const std::string beside = one_in(3) ? "7, 3" : "7";
    const std::string others = one_in(3) ? "0, 1, 2, 3, 4, 5, 6" : "0, 1, 2, 3";
    gates_ = fmt::format(
        R"({{"entries": [{{"open": [{}], "for": "{}us"}}, {{"open": [{}], "for": "{}us"}}, {{"open": [{}], "for": "{}us"}}]}})",
        others, before + 1, beside, open, others, 99 - open - before);
    if (one_in(3))
      clocks_ = fmt::format(R"(, "clocks": {{"model": "ideal", "nodes": {{"s": {{"offset": "{}ppm"}}}}}})",
                            one_in(2) ? 50 : 1000);
    add("heavy", heavy, 100, one_in(2) ? 0 : chance_.below(60), 7);
    add("light", 50 + chance_.below(250), one_in(3) ? 50 * (1 + chance_.below(5)) : 100, chance_.below(150), 7);
    if (one_in(4)) add("third", 50 + chance_.below(100), 200, 10, 7);
    add("load", 46 + chance_.below(1400), 40 + chance_.below(60), 0, one_in(2) ? 0 : 3);
  }

  std::string promised() const {
    return text([](std::size_t) { return std::string(); });
  }
  std::string running() {
    return text([&](std::size_t stream) {
      return fmt::format(R"(, "offset": "{}ns")", chance_.below(1000 * periods_[stream]));
    });
  }

 private:
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }
  void add(const std::string& name, std::size_t payload, std::size_t period, std::size_t jitter, int pcp) {
    streams_.push_back(fmt::format(
        R"("name": "{0}", "from": "{0}", "to": "sink", "encapsulation": "ethernet", "payload": "{1}B", "every": "{2}us", "jitter": "{3}us", "pcp": {4})",
        name, payload, period, std::min(jitter, period - 1), pcp));
    hosts_ += fmt::format(R"(, "{}": {{"kind": "host"}})", name);
    links_ += fmt::format(R"(, {{"ends": ["{}", "s"]}})", name);
    periods_.push_back(period);
  }
  template <class Offset>
  std::string text(const Offset& offset) const {
    std::string streams;
    for (std::size_t s = 0; s < streams_.size(); ++s)
      streams += fmt::format("{}{{{}{}}}", s == 0 ? "" : ", ", streams_[s], offset(s));
    return fmt::format(
        R"({{"name": "packed", "duration": "15ms", "allow_overload": true, "network": {{"nodes": {{"s": {{"kind": "switch", "forwarding_delay": "1us", "egress": [{{"to": "sink", "gates": {}}}]}},
      "sink": {{"kind": "host"}}{}}}, "links": [{{"ends": ["s", "sink"]}}{}]}}, "streams": [{}]{}}})",
        gates_, hosts_, links_, streams, clocks_);
  }

  sim::RandomStream chance_;
  std::string gates_, clocks_, hosts_, links_;
  std::vector<std::string> streams_;
  std::vector<std::size_t> periods_;
};

std::unique_ptr<scenario::Resolved> load(const std::string& text) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "packed.json", {}, diagnostics);
  if (!resolved) ADD_FAILURE() << diagnostics.to_text() << text;
  return resolved;
}

TEST(PackedFalsification, NoRunIsAboveItsBound) {
  const std::uint64_t networks = support::case_count("TAKT_PACKED_NETWORKS", 150);
  std::size_t bounded = 0, tight = 0;
  for (std::uint64_t number = 0; number < networks; ++number) {
    PackedNetwork network(number);
    const auto promised = load(network.promised());
    ASSERT_TRUE(promised);
    const Bounds bounds = bound(*promised);
    if (!bounds.streams[0].latency || !bounds.streams[1].latency) continue;
    ++bounded;
    double best = 0;
    for (int run = 0; run < 4; ++run) {
      const std::string text = network.running();
      const auto resolved = load(text);
      ASSERT_TRUE(resolved);
      const Verdict verdict = simulate(*resolved, bounds);
      for (const std::string& violation : verdict.violations)
        ADD_FAILURE() << "network " << number << ": " << violation << "\n" << text;
      best = std::max(best, verdict.tightest);
    }
    tight += best > 0.9;
  }
  EXPECT_GT(bounded, networks / 3);
  EXPECT_GT(tight, bounded / 4);
}

}  // namespace
}  // namespace takt::analysis::test::packed_falsification_test
