// SPDX-License-Identifier: Apache-2.0
// Bounds must be falsifiable: random small networks with every shaper are driven towards their bounds; a simulated
// value above one fails, and a wrong bound is caught. TAKT_FALSIFICATION_NETWORKS=8000 looks at more networks,
// TAKT_FALSIFICATION_ALL=1 prints all violations, TAKT_FALSIFICATION_SHOW=17 network 17.
#include "tests/questions/analysis/falsification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>

#include "sim/random.hpp"
#include "tests/experiments/property/random_scenario.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::falsification_test {
namespace {

using property::Feature;
using property::Wishes;

/// Each network has one of these mixes, in turn.
const std::vector<std::vector<Feature>>& mixes() {
  static const std::vector<std::vector<Feature>> all = {
      {},
      {Feature::rates},
      {Feature::shapers},
      {Feature::gates},
      {Feature::preemption},
      {Feature::ats},
      {Feature::cqf},
      {Feature::cut_through},
      {Feature::redundancy},
      {Feature::launch, Feature::latencies},
      {Feature::hold},
      {Feature::policing},
      {Feature::multicast, Feature::untagged, Feature::rates},
      {Feature::shapers, Feature::preemption},
      {Feature::gates, Feature::shapers},
      {Feature::gates, Feature::preemption, Feature::cut_through},
      {Feature::ats, Feature::preemption, Feature::rates},
      {Feature::cqf, Feature::preemption, Feature::identity_classes},
      {Feature::babble, Feature::queue_limits},
      {Feature::redundancy, Feature::gates, Feature::multicast, Feature::latencies},
  };
  return all;
}

/// Every mix of features has its networks in the quick tier, too.
std::size_t networks() { return std::max<std::size_t>(support::case_count("TAKT_FALSIFICATION_NETWORKS", 200), 200); }

/// A random network whose streams have a least gap between their frames, and whose links are not hopelessly full.
std::string network(std::size_t number) {
  sim::RandomStream chance(number, "falsification", "wishes");
  Wishes wishes;
  wishes.seed = number;
  wishes.features = mixes()[number % mixes().size()];
  wishes.switches = 1 + chance.below(4);
  wishes.hosts = 2 + chance.below(4);
  wishes.streams = 2 + chance.below(5);
  std::string text = property::scenario_text(wishes);
  text = std::regex_replace(text, std::regex("\"exponential\": \"[0-9]+us\""), "\"every\": \"700us\"");
  text = std::regex_replace(text, std::regex("\"every\": \"(100|125|250)us\""), "\"every\": \"500us\"");
  return text;
}

std::unique_ptr<scenario::Resolved> load(const std::string& text, const std::vector<std::string>& overrides) {
  json::Diagnostics diagnostics;
  return scenario::load_text(text, "random.json", overrides, diagnostics);
}

using Offsets = std::vector<std::int64_t>;  // of streams, in nanoseconds

/// Talkers begin when all gate lists run: before, gates are open, and nothing is promised.
constexpr std::int64_t lists_run_ns = 4'000'000;

std::vector<std::string> overrides_of(const Offsets& offsets) {
  std::vector<std::string> overrides{"/duration=8ms"};
  for (std::size_t s = 0; s < offsets.size(); ++s)
    overrides.push_back("/streams/" + std::to_string(s) + "/offset=" + std::to_string(lists_run_ns + offsets[s]) +
                        "ns");
  return overrides;
}

struct Total {
  std::size_t networks = 0;
  std::size_t compared = 0;
  std::size_t unbounded = 0;
  std::size_t second_opinions = 0;
  std::size_t wrong_second_opinions = 0;
  std::size_t better_second_opinions = 0;
  std::size_t queues = 0;
  std::size_t full_queues = 0;
  std::size_t violations = 0;
  std::string first;
  std::vector<double> shares;  // of each stream, at the worst phases that were found
  std::map<std::size_t, std::size_t> by_mix;
};

/// Phases as drawn, all at once, all at the listeners at once, then changed one by one where that brings some stream
/// nearer to its bound.
void drive(std::size_t number, const BoundOptions& options, Total& total) {
  const std::string text = network(number);
  const auto resolved = load(text, {});
  if (!resolved) return;  // it asked for something that is refused
  const Bounds bounds = bound(*resolved, options);
  // Without offsets nothing is promised of phases: such bounds hold at all of them.
  const auto without_phases = load(std::regex_replace(text, std::regex(", \"offset\": \"([0-9]+us|auto)\""), ""), {});
  const Bounds free_bounds = bound(*without_phases, options);
  const std::size_t streams = resolved->scenario.streams.size();
  sim::RandomStream chance(number, "falsification", "phases");
  Offsets best(streams, 0);
  Verdict greatest;
  std::vector<double> shares;
  const auto attempt = [&](const std::vector<std::string>& overrides) {
    const auto shifted = load(text, overrides);
    if (!shifted) return false;
    // Bounds may use the phases that a scenario gives.
    scenario::Run run(*shifted);
    run.advance();
    Verdict verdict = judge(run, bound(*shifted, options));
    for (const std::string& violation : judge(run, free_bounds).violations)
      verdict.violations.push_back(violation + " (whatever the phases)");
    // And where only every other stream's offset is a promise.
    for (std::size_t i = 1; i < streams; i += 2) shifted->scenario.streams[i].offset.reset();
    for (const std::string& violation : judge(run, bound(*shifted, options)).violations)
      verdict.violations.push_back(violation + " (whatever half of the phases)");
    total.violations += verdict.violations.size();
    total.second_opinions += verdict.second_opinions;
    total.wrong_second_opinions += verdict.wrong_second_opinions;
    total.better_second_opinions += verdict.better_second_opinions;
    total.queues += verdict.queues;
    total.full_queues += verdict.full_queues;
    if (std::getenv("TAKT_FALSIFICATION_ALL") != nullptr)
      for (const std::string& violation : verdict.violations)
        std::printf("network %zu, mix %zu: %s\n", number, number % mixes().size(), violation.c_str());
    if (total.first.empty() && !verdict.violations.empty())
      total.first = "network " + std::to_string(number) + ": " + verdict.violations.front() + "\n" + text;
    shares.resize(std::max(shares.size(), verdict.shares.size()));
    for (std::size_t i = 0; i < verdict.shares.size(); ++i) shares[i] = std::max(shares[i], verdict.shares[i]);
    const bool is_better = verdict.tightest > greatest.tightest;
    if (is_better || greatest.compared + greatest.unbounded == 0) greatest = verdict;
    return is_better;
  };
  Offsets drawn(streams, 0);
  for (std::size_t s = 0; s < streams; ++s)
    drawn[s] = resolved->scenario.streams[s].offset.value_or(sim::Duration()).value.ps() / 1000;
  attempt(overrides_of(drawn));
  attempt(overrides_of(best));
  Offsets together(streams, 0);
  sim::Duration latest;
  for (std::size_t s = 0; s < streams; ++s) latest = std::max(latest, bounds.streams[s].least);
  for (std::size_t s = 0; s < streams; ++s) together[s] = (latest - bounds.streams[s].least).ps() / 1000;
  if (attempt(overrides_of(together))) best = together;
  for (int step = 0; step < 6; ++step) {
    Offsets next = best;
    const std::size_t s = chance.below(streams);
    next[s] = static_cast<std::int64_t>(
        chance.below(2) == 0
            ? chance.below(400'000)
            : std::min<std::uint64_t>(400'000, static_cast<std::uint64_t>(best[s]) + chance.below(13'000)));
    if (attempt(overrides_of(next))) best = next;
  }
  ++total.networks;
  ++total.by_mix[number % mixes().size()];
  total.compared += greatest.compared;
  total.unbounded += greatest.unbounded;
  total.shares.insert(total.shares.end(), shares.begin(), shares.end());
}

Total drive_all(std::size_t count, const BoundOptions& options) {
  Total total;
  for (std::size_t number = 0; number < count; ++number) drive(number, options, total);
  std::sort(total.shares.begin(), total.shares.end());
  return total;
}

TEST(Falsification, NoBoundIsExceeded) {
  if (const char* const wanted = std::getenv("TAKT_FALSIFICATION_SHOW"))
    std::fputs(network(static_cast<std::size_t>(std::atoi(wanted))).c_str(), stdout);
  const Total total = drive_all(networks(), {});
  EXPECT_EQ(total.violations, 0u) << total.first;
  EXPECT_GE(total.networks, networks() * 8 / 10) << "too many networks are refused";
  EXPECT_EQ(total.by_mix.size(), mixes().size());
  EXPECT_GT(total.compared, 2 * total.unbounded) << "too few bounds are finite to say anything";
  EXPECT_GT(total.full_queues, total.queues / 4) << "bounds of queues that are never reached say nothing";
  EXPECT_GT(total.second_opinions, total.compared) << "separated-flow analysis applies too rarely";
  EXPECT_GT(total.better_second_opinions, 0u);
  // The bounds are worth something: half of the streams come to 60 % of them.
  ASSERT_FALSE(total.shares.empty());
  EXPECT_GT(total.shares[total.shares.size() / 2], 0.5);
  std::printf(
      "%zu networks, %zu bounds, %zu streams unbounded; simulated / bound: median %.2f, quartiles %.2f and %.2f; %zu "
      "of %zu queues full; %zu by separated flows, %zu of them better\n",
      total.networks, total.compared, total.unbounded, total.shares[total.shares.size() / 2],
      total.shares[total.shares.size() / 4], total.shares[total.shares.size() * 3 / 4], total.full_queues, total.queues,
      total.second_opinions, total.better_second_opinions);
}

// Networks that once exceeded a bound, by number.
TEST(Falsification, NetworksThatBrokeABound) {
  Total total;
  for (const std::size_t number : {2608u, 3688u, 4999u, 5259u})
    drive(number, {}, total);  // match recovery passes copies that come in between each other
  EXPECT_EQ(total.networks, 4u);
  EXPECT_EQ(total.violations, 0u) << total.first;
}

// Without packetiser frames are fluids that leave a port as they come.
TEST(Falsification, CatchesABoundWithoutPacketiser) {
  BoundOptions wrong;
  wrong.counts_packets = false;
  const Total total = drive_all(20, wrong);
  EXPECT_GT(total.violations, 0u);
  EXPECT_GT(total.wrong_second_opinions, 0u);
}

}  // namespace
}  // namespace takt::analysis::test::falsification_test
