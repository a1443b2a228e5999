// SPDX-License-Identifier: Apache-2.0
// Bounds of plants as they are built, driven by the simulator: a ring of stations with two ports, closed by a host that
// is attached twice or by a further station; a redundant Program; several threads on each processor; cables that are
// cut in the run, one or two; and a station that goes down and is bypassed. TAKT_PLANTS=2000 looks at more plants.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "evaluation/evaluate.hpp"
#include "sim/random.hpp"
#include "tests/questions/analysis/host_falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::plant_falsification_test {
namespace {

std::size_t plants() { return support::case_count("TAKT_PLANTS", 40); }

class Plant {
 public:
  explicit Plant(std::uint64_t number) : chance_(number, "plant", "test"), stations_(2 + chance_.below(3)) {
    closed_by_a_host_ = one_in(2);
    // Draws are made one by one: in which order a call evaluates its arguments is up to the compiler.
    add_node("plc", closed_by_a_host_ ? R"("kind": "host")" : station());
    for (std::size_t s = 0; s < stations_; ++s) {
      add_node(fmt::format("s{}", s), station());
      slaves_ += fmt::format(R"({}"s{}")", s == 0 ? "" : ", ", s);
    }
    // Both ways around lead from the controller to each station; between stations one of them may lead over a host,
    // which does not forward.
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string station = name(1 + chance_.below(stations_));
      const bool is_sent_by_plc = one_in(2);
      const std::size_t pcp = chance_.below(8);
      const std::size_t payload = 10 + chance_.below(800);
      const std::size_t period = 600 + 100 * chance_.below(20);
      streams_ += fmt::format(
          R"({}{{"name": "t{}", "from": "{}", "to": "{}", "pcp": {}, "payload": "{}B", "every": "{}us"{}}})",
          i == 0 ? "" : ", ", i, is_sent_by_plc ? "plc" : station, is_sent_by_plc ? station : "plc", pcp, payload,
          period, one_in(2) ? R"(, "redundancy": 2)" : "");
    }
  }

  /// With other cables that are cut, none to two, and other draws, from run to run.
  std::string text(std::uint64_t seed) {
    std::string links;
    for (std::size_t n = 0; n <= stations_; ++n)
      links +=
          fmt::format(R"({}{{"ends": ["{}", "{}"], "rate": "100Mbps"}})", n == 0 ? "" : ", ", name(n), name(n + 1));
    std::string faults;
    for (std::size_t cuts = chance_.below(3); cuts > 0; --cuts) {
      const std::size_t cut = chance_.below(stations_ + 1);
      const std::size_t at = 20'000 + chance_.below(40'000);
      faults += fmt::format(R"({}{{"kind": "link-down", "link": ["{}", "{}"], "at": "{}us", "for": "{}us"}})",
                            faults.empty() ? "" : ", ", name(cut), name(cut + 1), at, 1'000 + chance_.below(25'000));
    }
    // A station loses its supply, and its relay joins its neighbours. Where all nodes of the ring forward, what is for
    // it would go round until it is back, and nothing be bounded.
    if (one_in(2) && closed_by_a_host_) {
      const std::size_t station = chance_.below(stations_);
      const std::size_t at = 10'000 + chance_.below(40'000);
      faults += fmt::format(R"({}{{"kind": "crash", "node": "s{}", "at": "{}us", "for": "{}us"}})",
                            faults.empty() ? "" : ", ", station, at, 4'000 + chance_.below(20'000));
    }
    const std::size_t start = 3'000 + chance_.below(4'000);
    return fmt::format(R"({{"name": "plant", "duration": "100ms", "seed": {},
      "network": {{"nodes": {{{}}}, "links": [{}]}}, "streams": [{}],
      "programs": [{{"name": "p", "master": "plc", "slaves": [{}], "cycle": "2ms", "redundancy": 2}}],
      "script": [{{"at": "{}us", "program": "p", "call": "Start"}},
                 {{"at": "{}us", "program": "p", "call": "Halt"}}], "faults": [{}]}})",
                       seed, nodes_, links, streams_, slaves_, start, 60'000 + chance_.below(10'000), faults);
  }

 private:
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }
  /// Around the ring, the controller first.
  std::string name(std::size_t place) const {
    return place % (stations_ + 1) == 0 ? "plc" : fmt::format("s{}", place - 1);
  }
  std::string station() {
    return fmt::format(R"("kind": "station", "bypass": true, "bypass_switching": "2ms", "forwarding_delay": "{}ns")",
                       500 + 100 * chance_.below(20));
  }

  void add_node(const std::string& name, const std::string& kind) {
    const std::string threads = processor();
    nodes_ +=
        fmt::format(R"({}"{}": {{{}, "os": {{"wake_up": {{"uniform": {{"from": "0s", "to": "{}us"}}}}}}, "cpu": {}}})",
                    nodes_.empty() ? "" : ", ", name, kind, chance_.below(30), threads);
  }

  /// The Program, the protocol stack and loads, which delay each other.
  std::string processor() {
    const std::size_t cores = one_in(4) ? 2 : 1;
    std::vector<std::string> what = {R"("stack": ["receive"])", R"("stack": ["transmit"])", R"("runs": ["p"])"};
    for (std::size_t loads = 1 + chance_.below(2); loads > 0; --loads) {
      const std::size_t period = 900 + 100 * chance_.below(30);
      what.push_back(fmt::format(R"("every": "{}us", "offset": "{}us")", period, chance_.below(900)));
    }
    std::string threads;
    for (std::size_t t = 0; t < what.size(); ++t) {
      const std::size_t longest = 3 + chance_.below(20);
      const std::size_t priority = 1 + chance_.below(5);
      threads += fmt::format(
          R"({}{{"name": "t{}", {}, "execution": {{"uniform": {{"from": "1us", "to": "{}us"}}}}, "priority": {}, "core": {}}})",
          t == 0 ? "" : ", ", t, what[t], longest, priority, chance_.below(cores));
    }
    return fmt::format(R"({{"cores": {}, "switching": "{}us", "threads": [{}]}})", cores, chance_.below(3), threads);
  }

  sim::RandomStream chance_;
  std::size_t stations_ = 0;
  bool closed_by_a_host_ = false;
  std::string nodes_, slaves_, streams_;
};

struct Seen {
  std::vector<double> threads, streams;
  std::size_t unbounded_threads = 0, unbounded_streams = 0;
  std::size_t reactions = 0;
  std::size_t cut = 0;       ///< redundant streams that lost copies, and no frame, as was promised
  std::size_t promised = 0;  ///< redundant streams that lose no frame
  std::size_t lossy = 0;     ///< redundant streams without a promise that lost frames
};

/// What reaches all of its listeners comes to them although copies are lost; and a Program whose messages do is halted
/// by nobody but who calls it.
void judge_copies(const scenario::Run& run, const Bounds& bounds, const std::string& text, Seen& seen) {
  const results::RunResult result = evaluation::evaluate(run, false);
  bool all_of_program = true;
  for (const StreamBound& stream : bounds.streams) {
    const results::StreamResult& found = result.streams[stream.index.value];
    const bool is_promised = stream.latency && stream.reaches_all;
    if (found.of_program) all_of_program = all_of_program && is_promised;
    if (!found.has_copies) continue;
    seen.lossy += !is_promised && found.lost > 0;
    if (!is_promised) continue;
    ++seen.promised;
    seen.cut += std::ranges::any_of(found.dropped, [](const auto& each) { return each.first == "link_down"; });
    EXPECT_EQ(found.lost, 0U) << stream.name << "\n" << text;
  }
  if (!all_of_program) return;
  for (const handshake::Reaction& reaction : run.monitor(0).reactions())
    EXPECT_EQ(reaction.cause, handshake::Cause::command) << text;
}

TEST(PlantFalsification, NoRunExceedsABound) {
  Seen seen;
  for (std::size_t number = 0; number < plants(); ++number) {
    Plant plant(number);
    for (std::uint64_t attempt = 0; attempt < 4; ++attempt) {
      const std::string text = plant.text(attempt + 1);
      json::Diagnostics diagnostics;
      const auto resolved = scenario::load_text(text, "plant.json", {}, diagnostics);
      ASSERT_TRUE(resolved) << diagnostics.to_text() << text;
      const Bounds bounds = bound(*resolved);
      scenario::Run run(*resolved);
      run.advance();
      const Verdict verdict = judge(run, bounds);
      ASSERT_TRUE(verdict.violations.empty()) << "plant " << number << ": " << verdict.violations.front() << "\n"
                                              << text;
      seen.streams.insert(seen.streams.end(), verdict.shares.begin(), verdict.shares.end());
      seen.unbounded_streams += verdict.unbounded;
      judge_threads(run, bounds, text, seen.threads, seen.unbounded_threads);
      seen.reactions += judge_reactions(run, bounds, text);
      judge_copies(run, bounds, text, seen);
      if (HasFailure()) return;
    }
  }
  ASSERT_FALSE(seen.streams.empty());
  ASSERT_FALSE(seen.threads.empty());
  std::ranges::sort(seen.streams);
  std::ranges::sort(seen.threads);
  std::printf(
      "%zu streams with a bound, half of them come to %.0f %% of it, the tightest to %.1f %%; %zu threads with a "
      "bound, the tightest to %.1f %%\n",
      seen.streams.size(), 100 * seen.streams[seen.streams.size() / 2], 100 * seen.streams.back(), seen.threads.size(),
      100 * seen.threads.back());
  std::printf("%zu redundant streams are promised, %zu of them lost copies; %zu others lost frames; %zu reactions\n",
              seen.promised, seen.cut, seen.lossy, seen.reactions);
  EXPECT_EQ(seen.unbounded_streams + seen.unbounded_threads, 0U);
  EXPECT_GT(seen.reactions, 3 * plants());
  EXPECT_GT(seen.threads.back(), 0.9);
  EXPECT_GT(seen.streams.back(), 0.5);
  EXPECT_GT(seen.cut, 5 * plants()) << "too few cables are cut to say anything of copies";
  EXPECT_GT(seen.lossy, plants() / 2) << "without frames that are lost a promise that none is says nothing";
}

}  // namespace
}  // namespace takt::analysis::test::plant_falsification_test
