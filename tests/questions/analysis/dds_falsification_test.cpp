// SPDX-License-Identifier: Apache-2.0
// What participants of DDS send at most, driven by the simulator: random lines of switches, topics of all kinds of
// quality of service, losses, crashes, clocks that run apart. The bounds of streams are held against latencies, and the
// arrival curves against each pair of messages of a stream. TAKT_DDS_NETWORKS=2000 looks at more networks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "analysis/dds_sources.hpp"
#include "models/ethernet/sizes.hpp"
#include "models/ethernet/traffic.hpp"
#include "scenario/resolved/resolved_dds.hpp"
#include "sim/random.hpp"
#include "tests/questions/analysis/falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::dds_falsification_test {
namespace {

std::size_t dds_networks() { return support::case_count("TAKT_DDS_NETWORKS", 60); }

class DdsNetwork {
 public:
  explicit DdsNetwork(std::uint64_t number) : chance_(number, "dds network", "test") {
    const std::size_t switches = 1 + chance_.below(2);
    hosts_ = 2 + chance_.below(3);
    const auto link = [&](const std::string& a, const std::string& b) {
      links_ += fmt::format(R"({}{{"ends": ["{}", "{}"], "rate": "1Gbps"}})", links_.empty() ? "" : ", ", a, b);
      ends_.emplace_back(a, b);
    };
    for (std::size_t s = 0; s < switches; ++s) {
      nodes_ +=
          fmt::format(R"({}"s{}": {{"kind": "switch", "forwarding_delay": "1us"}})", nodes_.empty() ? "" : ", ", s);
      if (s > 0) link("s" + std::to_string(s - 1), "s" + std::to_string(s));
    }
    for (std::size_t h = 0; h < hosts_; ++h) {
      nodes_ += fmt::format(
          R"(, "h{}": {{"kind": "host"{}}})", h,
          one_in(3)
              ? R"(, "os": {"transmit": {"uniform": {"from": "1us", "to": "60us"}}, "receive": "5us", "wake_up": {"uniform": {"from": "0s", "to": "20us"}}})"
              : "");
      link("h" + std::to_string(h), "s" + std::to_string(chance_.below(switches)));
    }
    const std::size_t topics = 1 + chance_.below(4);
    for (std::size_t i = 0; i < topics; ++i) add_topic(i);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t from = chance_.below(hosts_);
      streams_ +=
          fmt::format(R"({}{{"name": "t{}", "from": "h{}", "to": "h{}", "pcp": {}, "payload": "{}B", "every": "5ms"}})",
                      i == 0 ? "" : ", ", i, from, other(from), chance_.below(8), 10 + chance_.below(500));
    }
    if (one_in(2)) clocks_ = R"(, "clocks": {"all": {"offset": {"from": "-100ppm", "to": "100ppm"}}})";
    domain_ = fmt::format(R"({{"id": 0, "discovery": "{}", "announce_every": "{}ms", "lease_duration": "{}s"{}}})",
                          one_in(4) ? "static" : "simple", 200 + chance_.below(800), 1 + chance_.below(3),
                          one_in(3) ? R"(, "multicast": true)" : "");
  }

  /// With offsets, losses and crashes that change from run to run: the curves hold whatever they are; of crashes only
  /// the number counts.
  std::string text(std::uint64_t seed, bool fails) {
    std::string applications;
    for (std::size_t i = 0; i < applications_.size(); ++i) {
      std::string all;
      for (const std::string& thread : applications_[i].second)
        all += fmt::format(R"({}{{{}, "offset": "{}us"}})", all.empty() ? "" : ", ", thread,
                           one_in(2) ? 0 : chance_.below(10'000));
      applications += fmt::format(R"({}{{"name": "app{}", "on": "h{}", "threads": [{}]}})", i == 0 ? "" : ", ", i,
                                  applications_[i].first, all);
    }
    std::string faults;
    if (fails) {
      for (const auto& [a, b] : ends_)
        faults += fmt::format(
            R"({}{{"kind": "frame-errors", "link": ["{}", "{}"], "loss": {}, "at": "{}ms", "for": "{}ms"}})",
            faults.empty() ? "" : ", ", a, b, one_in(2) ? "1" : "0.3", chance_.below(3000), 100 + chance_.below(4000));
      faults += fmt::format(R"(, {{"kind": "crash", "node": "h{}", "at": "{}ms", "for": "{}ms"}})",
                            chance_.below(hosts_), 500 + chance_.below(3000), 1 + chance_.below(1500));
    }
    return fmt::format(
        R"({{"name": "dds", "duration": "9s", "seed": {}, "allow_overload": true, "network": {{"nodes": {{{}}}, "links": [{}]}}, "domains": [{}], "topics": [{}], "applications": [{}], "streams": [{}], "faults": [{}]{}}})",
        seed, nodes_, links_, domain_, topics_, applications, streams_, faults, clocks_);
  }

 private:
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }
  std::size_t other(std::size_t host) { return (host + 1 + chance_.below(hosts_ - 1)) % hosts_; }

  std::string response() {
    switch (chance_.below(3)) {
      case 0:
        return fmt::format(R"("{}us")", chance_.below(400));
      case 1:
        return R"({"uniform": {"from": "0s", "to": "9ms"}})";
      default:
        return R"({"weibull": {"scale": "900us", "shape": 0.8}})";
    }
  }

  std::string qos() {
    std::string made = fmt::format(R"("reliability": "{}")", one_in(4) ? "best-effort" : "reliable");
    switch (chance_.below(4)) {
      case 0:
        break;
      case 1:
        made += fmt::format(R"(, "depth": {})", 1 + chance_.below(8));
        break;
      case 2:
        made += R"(, "history": "keep-all")";
        break;
      default:
        made += R"(, "history": "keep-all", "resource_limits": {"max_samples": 4}, "max_blocking_time": "7ms")";
        break;
    }
    if (one_in(3)) made += R"(, "durability": "transient-local")";
    if (one_in(4)) made += R"(, "lease_duration": "700ms")";
    if (one_in(5)) made += R"(, "lifespan": "15ms")";
    return made;
  }

  void add_topic(std::size_t i) {
    const char* const periods[] = {"10ms", "20ms", "50ms"};
    const std::size_t values = one_in(6) ? 300 : 1 + chance_.below(20);
    topics_ += fmt::format(
        R"({}{{"name": "p{}", "protocol": "dds", "pcp": {}, "qos": {{{}}}, "fields": {{"v": {{"type": "Double", "count": {}}}}}{}}})",
        i == 0 ? "" : ", ", i, chance_.below(3), qos(), values,
        one_in(5)   ? R"(, "publication": "asynchronous", "flow_control": {"octets": 1600, "every": "3ms"})"
        : one_in(8) ? R"(, "publication": "asynchronous")"
                    : "");
    const std::size_t from = chance_.below(hosts_);
    applications_.push_back({from,
                             {fmt::format(R"("name": "publish", "publish": "p{}", "every": "{}", "response": {})", i,
                                          periods[chance_.below(3)], response())}});
    const std::size_t readers = 1 + chance_.below(2);
    for (std::size_t n = 0; n < readers; ++n)
      applications_.push_back(
          {other(from),
           {fmt::format(R"("name": "take", "subscribe": "p{}", "every": "{}", "buffer": {}, "response": {})", i,
                        periods[chance_.below(3)], 1 + chance_.below(5), response())}});
  }

  sim::RandomStream chance_;
  std::size_t hosts_ = 0;
  std::string nodes_, links_, topics_, streams_, clocks_, domain_;
  std::vector<std::pair<std::string, std::string>> ends_;
  std::vector<std::pair<std::size_t, std::vector<std::string>>> applications_;
};

/// When messages of each stream are made, and how long their frames are.
class Messages final : public sim::TraceSink {
 public:
  explicit Messages(const scenario::Run& run) : run_(run), of_(run.resolved().plan.streams.size()) {}
  void record(const sim::TraceRecord& record) override {
    if (record.kind != static_cast<std::uint32_t>(models::Occurrence::produced)) return;
    const models::Frame& frame = run_.network().traffic().frame({static_cast<std::uint32_t>(record.what)});
    of_[record.detail].emplace_back(record.time.ps(), frame.length);
  }
  const std::vector<std::vector<std::pair<Ps, std::uint32_t>>>& of() const { return of_; }

 private:
  const scenario::Run& run_;
  std::vector<std::vector<std::pair<Ps, std::uint32_t>>> of_;
};

/// Holds messages longer than each length that sources tell apart against the curves of these sources; "" if none is
/// exceeded. `greatest`: the share of a curve that was reached.
std::string exceeded(const scenario::Resolved& r, const DdsTraffic& traffic, const Messages& messages, double& greatest,
                     std::size_t& compared) {
  for (std::size_t s = 0; s < messages.of().size(); ++s) {
    std::vector<const DdsSource*> sources;
    for (const DdsSource& source : traffic.sources)
      if (source.stream.value == s && source.arrivals.is_limited()) sources.push_back(&source);
    if (sources.empty() || messages.of()[s].empty()) continue;
    ++compared;
    const sim::Octets headers = r.plan.streams[s].headers;
    std::set<std::uint32_t> lengths{0};
    for (const DdsSource* const source : sources)
      lengths.insert(models::frame_length(headers + source->payload, true).count);
    for (const std::uint32_t above : lengths) {
      std::vector<Ps> times;
      for (const auto& [time, length] : messages.of()[s])
        if (length > above) times.push_back(time);
      for (std::size_t i = 0; i < times.size(); ++i)
        for (std::size_t j = i; j < std::min(times.size(), i + 250); ++j) {
          std::int64_t most = 0;
          for (const DdsSource* const source : sources)
            if (models::frame_length(headers + source->payload, true).count > above)
              most += source->arrivals.count(times[j] - times[i]);
          const auto seen = static_cast<std::int64_t>(j - i + 1);
          if (seen > most)
            return fmt::format("{}: {} messages of more than {} octets within {} us, at most {}",
                               r.plan.streams[s].name, seen, above, (times[j] - times[i]) / 1'000'000, most);
          greatest = std::max(greatest, static_cast<double>(seen) / static_cast<double>(most));
        }
    }
  }
  return {};
}

TEST(DdsFalsification, NoRunExceedsABoundOrACurve) {
  std::size_t compared = 0, unbounded = 0, curves = 0;
  double greatest = 0;
  std::vector<double> shares;
  for (std::size_t number = 0; number < dds_networks(); ++number) {
    DdsNetwork network(number);
    for (std::uint64_t attempt = 0; attempt < 4; ++attempt) {
      const std::string text = network.text(attempt + 1, attempt % 2 == 1);
      json::Diagnostics diagnostics;
      const auto running = scenario::load_text(text, "dds.json", {}, diagnostics);
      ASSERT_TRUE(running) << diagnostics.to_text() << text;
      const Bounds bounds = bound(*running);
      scenario::Run run(*running);
      Messages messages(run);
      run.simulation().set_trace(&messages);
      run.advance();
      const Verdict verdict = judge(run, bounds);
      ASSERT_TRUE(verdict.violations.empty()) << "network " << number << ": " << verdict.violations.front() << "\n"
                                              << text;
      // What takes longer is seen by the first that holds; that which is claimed to hold is looked at.
      if (bounds.dds_within) {
        BoundOptions options;
        options.dds_within = bounds.dds_within;
        const std::string why =
            exceeded(*running, dds_traffic(*running, options, *bounds.hosts), messages, greatest, curves);
        ASSERT_TRUE(why.empty()) << "network " << number << ": " << why << "\n" << text;
      }
      shares.insert(shares.end(), verdict.shares.begin(), verdict.shares.end());
      compared += verdict.compared, unbounded += verdict.unbounded;
    }
  }
  ASSERT_FALSE(shares.empty());
  std::sort(shares.begin(), shares.end());
  std::printf(
      "%zu streams with a bound, %zu without; half come to %.0f %% of their bound, the tightest to %.1f %%; %zu "
      "curves, the tightest reached to %.0f %%\n",
      compared, unbounded, 100 * shares[shares.size() / 2], 100 * shares.back(), curves, 100 * greatest);
  EXPECT_GT(compared, 20 * dds_networks());
  EXPECT_GT(compared, unbounded);
  EXPECT_GT(curves, 10 * dds_networks());
  EXPECT_GT(greatest, 0.99);
}

}  // namespace
}  // namespace takt::analysis::test::dds_falsification_test
