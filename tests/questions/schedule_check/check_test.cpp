// SPDX-License-Identifier: Apache-2.0
// The checker and the layout against each other: what is laid out is sound, and what is changed in it is not.
#include "schedule_check/check.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <functional>
#include <map>
#include <ostream>

#include "random_problem.hpp"
#include "scenario/gates/layout.hpp"
#include "sim/random.hpp"

namespace takt::schedule_check {
namespace {

using namespace sim::literals;  // NOLINT
using scenario::GateList;
using scenario::GateProblem;
using scenario::GateSolution;
using sim::Duration;

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(GateCheck, WhatIsLaidOutIsSound) {
  std::size_t streams = 0;
  EXPECT_TRUE(rc::check("layout is sound", [&] {
    const GateProblem problem = random_problem_that_fits(*rc::gen::arbitrary<std::uint64_t>());
    const scenario::GateLayout layout = scenario::lay_out_gates(problem);
    const std::vector<std::string> wrong = check(problem, layout.schedule);
    if (!wrong.empty()) RC_FAIL(text_of(wrong));
    streams += problem.streams.size();
  }));
  EXPECT_GT(streams, 200u) << "the problems are not trivial";
}

// A layout that gives up is right: if its windows stood, they would be refused.
TEST(GateCheck, WhatConflictsIsRefused) {
  EXPECT_TRUE(rc::check("conflicts are refused", [] {
    const GateProblem problem = random_problem(*rc::gen::arbitrary<std::uint64_t>());
    const scenario::GateLayout layout = scenario::lay_out_gates(problem);
    RC_ASSERT(layout.conflicts.empty() == check(problem, layout.schedule).empty());
  }));
}

/// Changes a schedule so that it is wrong; false if this one has nothing to change.
using Mutation = std::function<bool(const GateProblem&, GateSolution&, sim::RandomStream&)>;

/// A list with an entry of more than a few ns, and such an entry.
std::optional<std::pair<GateList*, std::size_t>> some_entry(GateSolution& schedule, sim::RandomStream& chance) {
  for (int tries = 0; tries < 100; ++tries) {
    GateList& list = schedule.lists[chance.below(schedule.lists.size())];
    if (list.entries.size() < 2) continue;
    const std::size_t e = chance.below(list.entries.size());
    if (list.entries[e].interval > 8_ns && list.entries[(e + 1) % list.entries.size()].interval > 8_ns)
      return std::pair(&list, e);
  }
  return std::nullopt;
}

const std::map<std::string, Mutation>& mutations() {
  static const std::map<std::string, Mutation> all = {
      {"a frame begins later",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         auto& window = s.windows[chance.below(s.windows.size())];
         window[chance.below(window.size())].start += 1_ns;
         return true;
       }},
      {"a frame begins earlier",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         auto& window = s.windows[chance.below(s.windows.size())];
         window[chance.below(window.size())].start -= 1_ns;
         return true;
       }},
      {"a window that is said to be larger",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         auto& window = s.windows[chance.below(s.windows.size())];
         window[chance.below(window.size())].close += 1_ns;
         return true;
       }},
      {"a window is missing",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         s.windows[chance.below(s.windows.size())].pop_back();
         return true;
       }},
      {"a gate in the other state",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         const auto at = some_entry(s, chance);
         if (at) at->first->entries[at->second].open ^= static_cast<models::GateStates>(1u << chance.below(8));
         return at.has_value();
       }},
      {"an entry that ends later",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         const auto at = some_entry(s, chance);
         if (!at || at->second + 1 == at->first->entries.size()) return false;
         at->first->entries[at->second].interval += 4_ns;
         at->first->entries[at->second + 1].interval -= 4_ns;
         return true;
       }},
      {"an entry that ends earlier",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         const auto at = some_entry(s, chance);
         if (!at || at->second + 1 == at->first->entries.size()) return false;
         at->first->entries[at->second].interval -= 4_ns;
         at->first->entries[at->second + 1].interval += 4_ns;
         return true;
       }},
      {"an entry is missing",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         const auto at = some_entry(s, chance);
         if (!at || at->second == 0) return false;
         at->first->entries[at->second - 1].interval += at->first->entries[at->second].interval;
         at->first->entries.erase(at->first->entries.begin() + static_cast<std::ptrdiff_t>(at->second));
         return true;
       }},
      {"a list of another port",
       [](const GateProblem& problem, GateSolution& s, sim::RandomStream&) {
         for (std::size_t p = 1; p < s.lists.size(); ++p) {
           if (s.lists[p - 1].entries.empty() || s.lists[p].entries.empty() || s.lists[p - 1] == s.lists[p]) continue;
           // Two that differ by less than a tolerance are not different.
           if (s.lists[p - 1].entries.size() == s.lists[p].entries.size()) continue;
           std::swap(s.lists[p - 1], s.lists[p]);
           return problem.streams.size() > 0;
         }
         return false;
       }},
      {"a cycle that the entries do not fill",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         const auto at = some_entry(s, chance);
         if (at) at->first->cycle += at->first->cycle;
         return at.has_value();
       }},
      {"a cycle that is no multiple",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         const auto at = some_entry(s, chance);
         if (!at) return false;
         at->first->cycle += 1_us;
         at->first->entries[at->second].interval += 1_us;
         return true;
       }},
      {"an entry of nothing",
       [](const GateProblem&, GateSolution& s, sim::RandomStream& chance) {
         const auto at = some_entry(s, chance);
         if (at) at->first->entries.push_back({0xFF, Duration()});
         return at.has_value();
       }},
  };
  return all;
}

TEST(GateCheck, WhatIsChangedIsRefused) {
  for (const auto& [name, change] : mutations()) {
    std::size_t changed = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      const GateProblem problem = random_problem_that_fits(seed);
      GateSolution schedule = scenario::lay_out_gates(problem).schedule;
      sim::RandomStream chance(seed, "mutation", name);
      if (!change(problem, schedule, chance)) continue;
      ++changed;
      EXPECT_FALSE(check(problem, schedule).empty()) << name << ", seed " << seed;
    }
    EXPECT_GT(changed, 15u) << name;
  }
}

// One train, two ways to the last port: nothing keeps its frames in order there, so they must not meet.
TEST(GateCheck, ATrainThatPartsAndJoins) {
  GateProblem problem;
  problem.margin = Duration();
  for (const char* name : {"a to sw1", "sw1 to sw2", "sw1 to sw3", "sw2 to sw4", "sw3 to sw4", "sw4 to b"})
    problem.ports.push_back({models::NodeIndex{0}, 0, name, 96_ns, 96_ns});
  const auto hop = [](std::uint32_t port, std::optional<std::uint32_t> previous) {
    return scenario::ScheduledHop{port, previous, 6, 864_ns, 1'050_ns};
  };
  problem.streams = {{"left", 100_us, 10_us, 0, {hop(0, std::nullopt), hop(1, 0), hop(3, 1), hop(5, 2)}},
                     {"right", 100_us, 10_us, 0, {hop(0, std::nullopt), hop(2, 0), hop(4, 1), hop(5, 2)}}};
  const scenario::GateLayout exact = scenario::lay_out_gates(problem);
  ASSERT_TRUE(exact.conflicts.empty());
  EXPECT_TRUE(check(problem, exact.schedule).empty());
  problem.margin = 2_us;
  const scenario::GateLayout layout = scenario::lay_out_gates(problem);
  ASSERT_EQ(layout.conflicts.size(), 1u) << "on the link that they share from the beginning they are in order";
  EXPECT_EQ(layout.conflicts[0].port, 5u);
  EXPECT_NE(text_of(check(problem, exact.schedule, 1'000))
                .find("\"left\" at \"sw4 to b\" and \"right\" at \"sw4 to b\" meet"),
            std::string::npos);
}

// The problem is part of what is checked: with less margin, another guard or a longer frame the same lists are wrong.
TEST(GateCheck, ASchedulesOfAnotherProblemIsRefused) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const GateProblem problem = random_problem_that_fits(seed);
    const GateSolution schedule = scenario::lay_out_gates(problem).schedule;
    GateProblem other = problem;
    other.margin += 5_ns;
    EXPECT_FALSE(check(other, schedule).empty()) << seed;
    other = problem;
    other.streams[0].hops[0].transmission += 5_ns;
    EXPECT_FALSE(check(other, schedule).empty()) << seed;
    other = problem;
    other.streams[0].release += 5_ns;
    EXPECT_FALSE(check(other, schedule).empty()) << seed;
    other = problem;
    other.streams[0].hops[0].traffic_class = 4;
    EXPECT_FALSE(check(other, schedule).empty()) << seed;
    other = problem;
    scenario::GatedPort& port = other.ports[other.streams[0].hops[0].port];
    if (port.guard != port.gap)
      continue;  // a long one may keep the others closed all the time, and then there is none that is longer
    port.guard += 10_us;
    EXPECT_FALSE(check(other, schedule).empty()) << seed;
  }
}

}  // namespace
}  // namespace takt::schedule_check
