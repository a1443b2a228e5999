// SPDX-License-Identifier: Apache-2.0
// A failed CHECK says what, where, when and with which seed.
#include "sim/check.hpp"

#include <gtest/gtest.h>

#include <string>

#include "sim/simulation.hpp"
#include "tests/sim/recorder.hpp"

namespace takt::sim {
namespace {

using test::at_ps;
using test::Entry;
using test::Recorder;

template <class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const InvariantBroken& broken) {
    return broken.what();
  }
  return "nothing was thrown";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Check, HoldingConditionIsSilent) { EXPECT_NO_THROW(TAKT_CHECK(1 + 1 == 2, "arithmetic")); }

TEST(Check, TextHasPlaceConditionAndMeaning) {
  const std::string text = message_of([] {
    const int bad = 3;
    TAKT_CHECK(bad == 2, "three is not two");
  });
  EXPECT_TRUE(contains(text, "check_test.cpp:")) << text;
  EXPECT_TRUE(contains(text, ": CHECK(bad == 2) failed: three is not two")) << text;
}

// The third event (kind 9, for component 1) comes at 4000 ps; the seed is 77.
TEST(Check, InARunTheTextHasTimeEventAndSeed) {
  Simulation simulation(77);
  std::vector<Entry> log;
  Recorder a(simulation, log);
  Recorder b(simulation, log);
  b.on_event = [](Simulation&, const Event& event) { TAKT_CHECK(event.kind() != 9, "kind nine is broken"); };
  simulation.schedule(a.source, at_ps(1'000), Phase::timer, a.id(), 1, 0);
  simulation.schedule(a.source, at_ps(2'000), Phase::timer, b.id(), 8, 0);
  simulation.schedule(a.source, at_ps(4'000), Phase::timer, b.id(), 9, 0);
  simulation.schedule(a.source, at_ps(5'000), Phase::timer, a.id(), 1, 0);
  const std::string text = message_of([&] { simulation.run(at_ps(9'000)); });
  EXPECT_TRUE(contains(text, "CHECK(event.kind() != 9) failed: kind nine is broken")) << text;
  EXPECT_TRUE(contains(text, "at 4000 ps")) << text;
  EXPECT_TRUE(contains(text, "event 3 (kind 9 for component 1)")) << text;
  EXPECT_TRUE(contains(text, "seed 77")) << text;
}

TEST(Check, TheComponentIsTheTrueOneUnderTieShuffle) {
  Simulation simulation(1);
  simulation.set_tie_shuffle(0xABCDEF);
  std::vector<Entry> log;
  Recorder a(simulation, log);
  Recorder b(simulation, log);
  b.on_event = [](Simulation&, const Event&) { TAKT_CHECK(false, "broken"); };
  simulation.schedule(a.source, at_ps(1), Phase::timer, b.id(), 2, 0);
  const std::string text = message_of([&] { simulation.run(at_ps(2)); });
  EXPECT_TRUE(contains(text, "event 1 (kind 2 for component 1)")) << text;
}

TEST(Check, WhileDecidingTheTextHasTimeAndSeed) {
  Simulation simulation(5);
  std::vector<Entry> log;
  Recorder a(simulation, log);
  a.on_event = [&a](Simulation& s, const Event&) { s.decide_later(a.id(), Decision::egress); };
  a.on_decide = [](Simulation&) { TAKT_CHECK(false, "cannot decide"); };
  simulation.schedule(a.source, at_ps(123), Phase::timer, a.id(), 1, 0);
  const std::string text = message_of([&] { simulation.run(at_ps(9'000)); });
  EXPECT_TRUE(contains(text, "cannot decide")) << text;
  EXPECT_TRUE(contains(text, "at 123 ps, event 1")) << text;
  EXPECT_TRUE(contains(text, "seed 5")) << text;
}

TEST(Check, SchedulingInThePastIsOne) {
  Simulation simulation(1);
  std::vector<Entry> log;
  Recorder a(simulation, log);
  a.on_event = [&a](Simulation& s, const Event&) { s.schedule(a.source, at_ps(9), Phase::timer, a.id(), 1, 0); };
  simulation.schedule(a.source, at_ps(10), Phase::timer, a.id(), 1, 0);
  const std::string text = message_of([&] { simulation.run(at_ps(20)); });
  EXPECT_TRUE(contains(text, "an event cannot be scheduled in the past")) << text;
  EXPECT_TRUE(contains(text, "at 10 ps")) << text;
}

}  // namespace
}  // namespace takt::sim
