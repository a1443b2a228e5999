// SPDX-License-Identifier: Apache-2.0
// Bounds under automatic gates, driven by the simulator: random networks, with clocks that are wrong by as much as the
// bounds are told. Clocks are set off by faults at the start of the run, each by the whole clock error one way or the
// other; the bounds are those of the same network with gPTP. TAKT_GATED_NETWORKS=2000 looks at more networks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "sim/random.hpp"
#include "tests/questions/analysis/falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::gated_falsification_test {
namespace {

std::size_t gated_networks() { return support::case_count("TAKT_GATED_NETWORKS", 60); }

std::unique_ptr<scenario::Resolved> load(const std::string& text) {
  json::Diagnostics diagnostics;
  return scenario::load_text(text, "gated.json", {}, diagnostics);
}

/// A network of random shape; ends of the text follow from what is asked of its clocks.
class GatedNetwork {
 public:
  explicit GatedNetwork(std::uint64_t number) : chance_(number, "gated network", "test") {
    has_clocks_ = one_in(2);
    error_ns_ = has_clocks_ ? 50 + static_cast<int>(chance_.below(500)) : 0;
    switches_ = 1 + chance_.below(5);
    hosts_ = 3 + chance_.below(4);
    guard_ = one_in(2) ? "length-aware" : "longest-frame";
    make_nodes();
    make_program();
    make_scheduled();
    make_background();
  }

  int error_ns() const { return error_ns_; }
  /// Operating systems take their time, or talkers have jitter.
  bool may_swap_frames() const {
    return nodes_.find("\"transmit\": {") != std::string::npos || scheduled_.find("jitter") != std::string::npos;
  }
  /// As the bounds see it: phases of other traffic are not promised, clocks follow gPTP.
  std::string promised() const {
    return text(has_clocks_ ? R"(, "clocks": {"all": {"offset": "10ppm"}, "gptp": {}})" : "", background_, "");
  }
  /// As it runs: clocks are off by up to so many ns, and drift on; other traffic comes somewhere.
  std::string running(int error_ns) {
    std::string background;
    for (const std::string& stream : split(background_))
      background += ", " + stream.substr(0, stream.size() - 1) +
                    fmt::format(R"(, "offset": "{}ns"}})", 100'000 + chance_.below(400'000));
    if (!has_clocks_) return text("", background, "");
    std::string faults, oscillators;
    for (const std::string& node : names_) {
      // 10 ppm in 6 ms make 60 ns: in the direction in which the clock is not off yet.
      const bool is_early = one_in(2);
      const int step = one_in(3)
                           ? static_cast<int>(chance_.below(2 * static_cast<std::size_t>(error_ns) + 1)) - error_ns
                       : is_early ? error_ns
                                  : -error_ns;
      const int drift = step > 0 ? -10 : 10;
      faults += fmt::format(R"({}{{"kind": "clock", "node": "{}", "at": "0ns", "step": "{}ns"}})",
                            faults.empty() ? "" : ", ", node, step);
      oscillators += fmt::format(R"({}"{}": {{"offset": "{}ppm"}})", oscillators.empty() ? "" : ", ", node,
                                 error_ns > 60 ? drift : 0);
    }
    return text(fmt::format(R"(, "clocks": {{"nodes": {{{}}}}})", oscillators), background,
                fmt::format(R"(, "faults": [{}])", faults));
  }

 private:
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }
  template <std::size_t N>
  std::string any(const char* const (&values)[N]) {
    return values[chance_.below(N)];
  }
  std::string host() { return "h" + std::to_string(chance_.below(hosts_)); }
  std::string another_host(const std::string& than) {
    for (;;)
      if (std::string found = host(); found != than) return found;
  }
  /// The objects of a list, which begin with ", {".
  static std::vector<std::string> split(const std::string& objects) {
    std::vector<std::string> all;
    for (std::size_t at = 0; at < objects.size();) {
      const std::size_t next = std::min(objects.find(", {\"name\"", at + 1), objects.size());
      all.push_back(objects.substr(at + 2, next - at - 2));
      at = next;
    }
    return all;
  }

  void make_nodes() {
    const bool is_fast = one_in(2);
    const auto link = [&](const std::string& a, const std::string& b) {
      links_ += fmt::format(R"({}{{"ends": ["{}", "{}"], "rate": "{}", "delay": "{}"}})", links_.empty() ? "" : ", ", a,
                            b, is_fast ? "1Gbps" : any({"100Mbps", "1Gbps"}), any({"0ns", "50ns", "333ns"}));
    };
    for (std::size_t s = 0; s < switches_; ++s) {
      names_.push_back("s" + std::to_string(s));
      nodes_ += fmt::format(R"({}"s{}": {{"kind": "switch", "forwarding_delay": "{}"}})", nodes_.empty() ? "" : ", ", s,
                            any({"0ns", "1us", "777ns"}));
      if (s > 0) link(names_.back(), "s" + std::to_string(chance_.below(s)));
    }
    if (switches_ > 3) link("s0", names_.back());  // a circle, if that is no link yet
    for (std::size_t h = 0; h < hosts_; ++h) {
      names_.push_back("h" + std::to_string(h));
      nodes_ += fmt::format(R"(, "h{}": {{"kind": "host", "os": {}}})", h,
                            any({R"("none")", R"("none")", R"({"transmit": {"uniform": {"from": "1us", "to": "9us"}}})",
                                 R"({"transmit": "2us", "receive": {"uniform": {"from": "0us", "to": "3us"}}})"}));
      link(names_.back(), "s" + std::to_string(chance_.below(switches_)));
    }
  }

  void make_program() {
    if (one_in(3)) return;
    const std::string master = host();
    const std::string slave = another_host(master);
    const std::size_t data = chance_.below(3);
    std::string process_data;
    for (std::size_t d = 0; d < data; ++d)
      process_data +=
          fmt::format(R"({}{{"name": "d{}", "from": "{}", "fields": {{"q": {{"type": "Double", "count": {}}}}}}})",
                      d == 0 ? "" : ", ", d, one_in(2) ? master : slave, 1 + chance_.below(90));
    program_ = fmt::format(
        R"(, "programs": [{{"name": "p", "master": "{}", "slaves": ["{}"], "cycle": "500us", "phases": {{"{}": "{}us", "{}": "{}us"}}, "process_data": [{}]}}],
      "script": [{{"at": "1ms", "program": "p", "call": "Start"}}])",
        master, slave, master, 30 + chance_.below(100), slave, 200 + chance_.below(100), process_data);
    if (!load(promised())) program_.clear();
  }

  /// As many as fit.
  void make_scheduled() {
    for (int wanted = 0; wanted < 8; ++wanted) {
      const std::string before = scheduled_;
      const std::string from = host();
      std::string to = "\"" + another_host(from) + "\"";
      if (const std::string more = another_host(from); one_in(4) && to != "\"" + more + "\"")
        to += ", \"" + more + "\"";
      scheduled_ += fmt::format(
          R"(, {{"name": "t{}", "from": "{}", "to": [{}], "payload": "{}", "every": "{}", "offset": "{}ns", "pcp": {}{}}})",
          wanted, from, to, any({"18B", "100B", "400B", "1400B"}), any({"250us", "500us", "1ms"}),
          20'000 + chance_.below(230'000), any({"4", "6"}), one_in(4) ? R"(, "jitter": "5us")" : "");
      if (!load(promised())) scheduled_ = before;
    }
  }

  void make_background() {
    const std::size_t count = 1 + chance_.below(4);
    for (std::size_t b = 0; b < count; ++b) {
      const std::string from = host();
      background_ +=
          fmt::format(R"(, {{"name": "b{}", "from": "{}", "to": "{}", "payload": "{}", "every": "{}", "pcp": {}}})", b,
                      from, another_host(from), any({"60B", "500B", "1400B"}), any({"600us", "1100us", "500us"}),
                      any({"0", "0", "3", "5", "7"}));
    }
  }

  std::string text(const std::string& clocks, const std::string& background, const std::string& faults) const {
    const std::string streams = scheduled_ + background;
    return fmt::format(
        R"({{"name": "gated", "duration": "6ms", "network": {{"nodes": {{{}}}, "links": [{}]}}, "streams": [{}],
      "gates": {{"plan": "auto", "margin": "{}ns", "classes": [4, 6], "guard": "{}"}}{}{}{}}})",
        nodes_, links_, streams.empty() ? "" : streams.substr(2), has_clocks_ ? 2 * error_ns_ + 20 : 0, guard_,
        program_, clocks, faults);
  }

  sim::RandomStream chance_;
  bool has_clocks_ = false;
  int error_ns_ = 0;
  std::size_t switches_ = 1, hosts_ = 2;
  std::string guard_, nodes_, links_, program_, scheduled_, background_;
  std::vector<std::string> names_;
};

struct Total {
  std::size_t networks = 0, scheduled = 0, unbounded = 0, with_clocks = 0, others = 0, others_unbounded = 0, queues = 0,
              full_queues = 0;
  std::vector<std::string> violations;
  std::vector<double> shares;  // of scheduled streams
};

/// Clocks are off by up to `worse` times what the bounds are told.
void drive(std::uint64_t number, int worse, Total& total) {
  GatedNetwork network(number);
  const auto promised = load(network.promised());
  if (!promised || !promised->gates) return;
  BoundOptions options;
  options.clock_error = sim::Duration::from_ps(1000 * network.error_ns());
  const Bounds bounds = bound(*promised, options);
  ++total.networks;
  if (network.error_ns() > 0) ++total.with_clocks;
  for (const StreamBound& stream : bounds.streams) {
    const bool is_scheduled =
        std::any_of(promised->gates->problem.streams.begin(), promised->gates->problem.streams.end(),
                    [&](const auto& each) { return each.name == stream.name; });
    if (!is_scheduled) {
      ++(stream.latency ? total.others : total.others_unbounded);
      continue;
    }
    ++total.scheduled;
    if (stream.latency) continue;
    // Where a host may hand two frames over in either order there is nothing to state.
    ++total.unbounded;
    if (!network.may_swap_frames())
      total.violations.push_back(
          fmt::format("network {}: {} is unbounded: {}\n{}", number, stream.name, stream.reason, network.promised()));
  }
  for (int attempt = 0; attempt < 4; ++attempt) {
    const std::string text = network.running(worse * network.error_ns());
    const auto running = load(text);
    if (!running) {
      total.violations.push_back("refused: " + text);
      return;
    }
    scenario::Run run(*running);
    run.advance();
    const Verdict verdict = judge(run, bounds);
    total.queues += verdict.queues;
    total.full_queues += verdict.full_queues;
    for (const std::string& violation : verdict.violations)
      total.violations.push_back(fmt::format("network {}: {}\n{}", number, violation, text));
    for (const StreamBound& stream : bounds.streams) {
      const models::Stream& seen = run.network().traffic().streams()[stream.index.value];
      if (stream.latency && !seen.latency.empty() &&
          std::any_of(promised->gates->problem.streams.begin(), promised->gates->problem.streams.end(),
                      [&](const auto& each) { return each.name == stream.name; }))
        total.shares.push_back(static_cast<double>(seen.latency.maximum().ps()) /
                               static_cast<double>(stream.latency->ps()));
    }
  }
}

TEST(GatedFalsification, NoBoundIsExceeded) {
  Total total;
  for (std::uint64_t number = 0; number < gated_networks(); ++number) drive(number, 1, total);
  if (std::getenv("TAKT_FALSIFICATION_ALL") != nullptr)
    for (const std::string& violation : total.violations) std::printf("%s\n", violation.c_str());
  EXPECT_TRUE(total.violations.empty()) << total.violations.size() << ", first " << total.violations.front();
  EXPECT_GT(total.networks, gated_networks() * 8 / 10);
  EXPECT_GT(total.with_clocks, total.networks / 4);
  EXPECT_GT(total.scheduled, 3 * total.networks) << "too few streams find a window";
  EXPECT_LT(total.unbounded, total.scheduled / 20);
  EXPECT_GT(total.others, 5 * total.others_unbounded) << "too few of the others are bounded to say anything";
  std::sort(total.shares.begin(), total.shares.end());
  ASSERT_FALSE(total.shares.empty());
  // Nobody waits: what keeps the simulated latency from its bound is the clocks and what operating systems may take.
  EXPECT_GT(total.shares[total.shares.size() / 2], 0.9);
  std::printf(
      "%zu networks, %zu with clocks; %zu scheduled streams, %zu of them unbounded, %zu others, %zu of them unbounded; "
      "simulated / bound of scheduled ones: median %.3f, least %.2f; %zu of %zu ports full\n",
      total.networks, total.with_clocks, total.scheduled, total.unbounded, total.others + total.others_unbounded,
      total.others_unbounded, total.shares[total.shares.size() / 2], total.shares.front(), total.full_queues,
      total.queues);
}

// Clocks that are worse than the bounds are told make frames miss their windows.
TEST(GatedFalsification, CatchesClocksThatAreWorse) {
  Total total;
  for (std::uint64_t number = 0; number < 20; ++number) drive(number, 4, total);
  EXPECT_FALSE(total.violations.empty());
}

}  // namespace
}  // namespace takt::analysis::test::gated_falsification_test
