// SPDX-License-Identifier: Apache-2.0
// The tie shuffle permutes the nodes of an instant and the sources of a phase, and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include "sim/random.hpp"
#include "sim/simulation.hpp"
#include "tests/sim/recorder.hpp"

namespace takt::sim {
namespace {

using test::at_ps;
using test::Entry;
using test::Recorder;

constexpr std::uint32_t component_count = 12;

/// The arguments carry source and serial: source << 32 | serial.
std::vector<Entry> run(std::uint64_t key) {
  Simulation simulation(1);
  simulation.set_tie_shuffle(key);
  std::vector<Entry> log;
  std::vector<std::unique_ptr<Recorder>> components;
  for (std::uint32_t i = 0; i < component_count; ++i) components.push_back(std::make_unique<Recorder>(simulation, log));
  RandomStream chance(3, "tie shuffle", "events");
  std::map<std::uint32_t, std::uint64_t> serials;
  for (int i = 0; i < 2'000; ++i) {
    const auto source = static_cast<std::uint32_t>(chance.below(component_count));
    const auto target = static_cast<std::uint32_t>(chance.below(component_count));
    const auto time = static_cast<std::int64_t>(chance.below(3));
    const auto phase = static_cast<Phase>(chance.below(3));
    // The kind repeats what must hold of the event: phase and target.
    simulation.schedule(components[source]->source, at_ps(time), phase, ComponentId{target},
                        static_cast<EventKind>(static_cast<std::uint32_t>(phase) << 8 | target),
                        static_cast<std::uint64_t>(source) << 32 | serials[source]++);
  }
  simulation.run(at_ps(10));
  return log;
}

bool entry_less(const Entry& a, const Entry& b) {
  return std::tuple(a.time, a.who, a.kind, a.argument) < std::tuple(b.time, b.who, b.kind, b.argument);
}

TEST(TieShuffle, DeliversEveryEventToItsTargetAtItsTimeAndPhase) {
  const std::vector<Entry> plain = run(0);
  ASSERT_EQ(plain.size(), 2'000u);
  std::vector<Entry> sorted = plain;
  std::sort(sorted.begin(), sorted.end(), entry_less);
  for (const std::uint64_t key : {1ULL, 2ULL, 0x123456789ABCDEFULL, (1ULL << 60) - 1}) {
    std::vector<Entry> shuffled = run(key);
    std::int64_t last_time = -1;
    std::set<std::uint32_t> over;  // nodes that have had their run at this instant
    const Entry* before = nullptr;
    for (const Entry& entry : shuffled) {
      EXPECT_EQ(entry.who, entry.kind & 0xFFu) << "an event for another component";
      EXPECT_GE(entry.time, last_time) << "time still comes first";
      if (entry.time > last_time) {
        over.clear();
        before = nullptr;
      }
      last_time = entry.time;
      const bool is_control = entry.kind >> 8 == static_cast<unsigned>(Phase::control);
      if (is_control) {
        EXPECT_TRUE(before == nullptr || before->kind >> 8 == static_cast<unsigned>(Phase::control))
            << "control still comes before all nodes";
      }
      if (!is_control && before != nullptr && before->who == entry.who) {
        EXPECT_LE(before->kind >> 8, entry.kind >> 8) << "phases of a node keep their order";
      }
      if (!is_control && (before == nullptr || before->who != entry.who ||
                          before->kind >> 8 == static_cast<unsigned>(Phase::control))) {
        EXPECT_TRUE(over.insert(entry.who).second) << "the events of a node are one run";
      }
      before = &entry;
    }
    EXPECT_NE(shuffled, plain) << "nothing was permuted, key " << key;
    std::sort(shuffled.begin(), shuffled.end(), entry_less);
    EXPECT_EQ(shuffled, sorted);
  }
}

TEST(TieShuffle, KeepsCauseAndEffectOfOneSourceAndOneTarget) {
  for (const std::uint64_t key : {0ULL, 1ULL, 42ULL, 0xFEDCBA987654321ULL}) {
    // (time and phase, target, source) -> last serial
    std::map<std::tuple<std::int64_t, std::uint32_t, std::uint64_t>, std::uint64_t> last;
    for (const Entry& entry : run(key)) {
      const std::uint64_t serial = entry.argument & 0xFFFF'FFFF;
      auto& before = last[{entry.time * 4 + (entry.kind >> 8), entry.who, entry.argument >> 32}];
      EXPECT_LE(before, serial);
      before = serial + 1;
    }
  }
}

// Two targets, one event each at one instant: over a hundred keys both orders occur, about equally often.
TEST(TieShuffle, BothOrdersOfTwoEventsOccur) {
  int first_wins = 0;
  for (std::uint64_t key = 1; key <= 100; ++key) {
    Simulation simulation(1);
    simulation.set_tie_shuffle(mix64(key));
    std::vector<Entry> log;
    Recorder a(simulation, log);
    Recorder b(simulation, log);
    EventSource source(ComponentId{77});
    simulation.schedule(source, at_ps(1), Phase::arrival, a.id(), 0, 0);
    simulation.schedule(source, at_ps(1), Phase::arrival, b.id(), 0, 0);
    simulation.run(at_ps(1));
    ASSERT_EQ(log.size(), 2u);
    first_wins += log[0].who == a.id().index ? 1 : 0;
  }
  EXPECT_GT(first_wins, 20);
  EXPECT_LT(first_wins, 80);
}

TEST(TieShuffle, IsABijectionForExtremeIds) {
  // Only ids that have a component may be targets, but sources may be any: no two (target, source) pairs fall together,
  // so every event arrives where it should.
  for (const std::uint64_t key : {3ULL, 0xFFFF'FFFFULL << 28}) {
    Simulation simulation(1);
    simulation.set_tie_shuffle(key);
    std::vector<Entry> log;
    Recorder a(simulation, log);
    Recorder b(simulation, log);
    std::set<std::uint64_t> expected;
    for (std::uint32_t bit = 0; bit < 29; ++bit) {
      EventSource low(ComponentId{1u << bit});
      EventSource high(ComponentId{max_components - 1 - (1u << bit)});
      for (EventSource* source : {&low, &high}) {
        for (Recorder* target : {&a, &b}) {
          const std::uint64_t name = static_cast<std::uint64_t>(target->id().index) << 32 | source->id().index;
          simulation.schedule(*source, at_ps(0), Phase::timer, target->id(), 0, name);
          expected.insert(name);
        }
      }
    }
    simulation.run(at_ps(0));
    std::set<std::uint64_t> seen;
    for (const Entry& entry : log) {
      EXPECT_EQ(entry.argument >> 32, entry.who);
      seen.insert(entry.argument);
    }
    EXPECT_EQ(seen, expected);
  }
}

TEST(TieShuffle, MustBeSetBeforeTheFirstEvent) {
  Simulation simulation(1);
  std::vector<Entry> log;
  Recorder a(simulation, log);
  simulation.schedule(a.source, at_ps(1), Phase::timer, a.id(), 0, 0);
  EXPECT_THROW(simulation.set_tie_shuffle(5), InvariantBroken);
}

}  // namespace
}  // namespace takt::sim
