// SPDX-License-Identifier: Apache-2.0
#include "analysis/reaction_bound.hpp"

#include <gtest/gtest.h>

#include <map>

#include "scenario/figures/requirement.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::analysis::reaction_bound_test {
namespace {

ReactionGroup group(std::size_t participants, Ps initialise) {
  ReactionGroup made;
  made.notify = MaxPlusMatrix(participants, participants);
  made.initialise.assign(participants, MaxPlus(initialise));
  return made;
}

/// A star: the master is heard after `down`, heard by it after `up`, of each slave.
ReactionGroup star(const std::vector<std::pair<Ps, Ps>>& slaves, Ps initialise) {
  ReactionGroup made = group(slaves.size() + 1, initialise);
  for (std::size_t s = 0; s < slaves.size(); ++s) {
    made.notify(s + 1, 0) = MaxPlus(slaves[s].first);
    made.notify(0, s + 1) = MaxPlus(slaves[s].second);
  }
  return made;
}

// Slaves with ways of 10 + 30 and 25 + 5, all initialise for 100. Start: max(100, 10 + 100 + 30, 25 + 100 + 5) = 140
// until the master is Ready, then max(10 + 30, 25 + 5) = 40 until it is Running. Halt: at worst from the first slave
// over the master to the second, 30 + 25.
TEST(ReactionBound, StarByHand) {
  const ReactionGroup cell = star({{10, 30}, {25, 5}}, 100);
  EXPECT_EQ(ready_bound(cell), MaxPlus(140));
  EXPECT_EQ(run_bound(cell), MaxPlus(40));
  EXPECT_EQ(start_bound(cell), MaxPlus(180));
  EXPECT_EQ(spread_bound(cell), MaxPlus(55));
}

// From the master 10 or 25; from the first slave 30 + 25; from the second 5 + 10.
TEST(ReactionBound, OfCallsAtSomeParticipantsAlone) {
  ReactionGroup cell = star({{10, 30}, {25, 5}}, 100);
  cell.origins = {true, false, false};
  EXPECT_EQ(spread_bound(cell), MaxPlus(25));
  cell.origins = {false, false, true};
  EXPECT_EQ(spread_bound(cell), MaxPlus(15));
  cell.origins = {true, true, false};
  EXPECT_EQ(spread_bound(cell), MaxPlus(55));
}

std::map<std::string, sim::Duration> bounds_with(const std::string& callers, const std::string& script) {
  const std::string text =
      R"({"name": "t", "duration": "1s", "network": {"generate": [{"topology": "line", "switches": 1,
      "hosts_per_switch": 3}]},
  "programs": [{"name": "p", "master": "h1", "slaves": ["h2", "h3"], "cycle": "1ms"CALLERS}],
      "script": [{"at": "0ms", "program": "p", "call": "Start"}SCRIPT],
  "require": [{"reaction": "suspend", "within": "1s"}, {"reaction": "halt", "within": "1s"}, {"reaction": "halt",
      "cause": "command", "within": "1s"},
              {"reaction": "halt", "cause": "crash", "within": "1s"}, {"reaction": "halt", "cause": "mismatch",
      "within": "1s"}]})";
  std::string made = text;
  made.replace(made.find("CALLERS"), 7, callers);
  made.replace(made.find("SCRIPT"), 6, script);
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(made, "t.json", {}, diagnostics);
  std::map<std::string, sim::Duration> found;
  if (!resolved) {
    EXPECT_NE(diagnostics.to_text().find("a call that the program's \"callers\" exclude"), std::string::npos)
        << diagnostics.to_text();
    return found;
  }
  const Bounds bounds = bound(*resolved);
  for (std::size_t i = 0; i < bounds.requirements.size(); ++i)
    found[resolved->requirements[i].text] = bounds.requirements[i].duration.value_or(sim::Duration());
  return found;
}

// One hop from the master instead of two; a halt for another reason than a call begins anywhere.
TEST(ReactionBound, CallersOfAProgram) {
  const auto any = bounds_with("", "");
  const auto one = bounds_with(R"(, "callers": {"Suspend": ["h1"], "Halt": ["h1"]})", "");
  const std::string suspend = "reaction suspend within 1s", halt = "reaction halt within 1s";
  const std::string called = "reaction halt because of a command within 1s",
                    crash = "reaction halt because of a crash within 1s";
  const std::string mismatch = "reaction halt because of a mismatch within 1s";
  EXPECT_LE(2 * one.at(suspend).ps(), any.at(suspend).ps());
  EXPECT_LE(2 * one.at(called).ps(), any.at(called).ps());
  EXPECT_EQ(one.at(halt), any.at(halt)) << "anybody may find that it cannot follow";
  EXPECT_EQ(one.at(crash), any.at(crash));
  EXPECT_EQ(one.at(mismatch), any.at(mismatch));
  EXPECT_EQ(bounds_with(R"(, "callers": {"Suspend": ["h1", "h2", "h3"]})", "").at(suspend), any.at(suspend));
}

TEST(ReactionBound, TheScriptMakesNoOtherCall) {
  const std::string callers = R"(, "callers": {"Suspend": ["h1"]})";
  const auto suspend = [](const std::string& on) {
    return R"(, {"at": "100ms", "program": "p", "call": "Suspend")" + on + "}";
  };
  EXPECT_TRUE(bounds_with(callers, suspend(R"(, "on": "h2")")).empty());
  EXPECT_FALSE(bounds_with(callers, suspend(R"(, "on": "h1")")).empty());
  EXPECT_FALSE(bounds_with(callers, suspend("")).empty());
}

TEST(ReactionBound, ASlowMasterInitialisesLonger) {
  ReactionGroup cell = star({{10, 10}}, 100);
  cell.initialise[0] = MaxPlus(500);
  EXPECT_EQ(start_bound(cell), MaxPlus(520));
}

TEST(ReactionBound, AllToAllTakesTheShorterWay) {
  ReactionGroup cell = star({{10, 30}, {25, 5}}, 100);
  cell.notify(2, 1) = MaxPlus(12);  // instead of 30 + 25
  cell.notify(1, 2) = MaxPlus(90);  // over the master it is 5 + 10
  // Of the master's calls slave 2 hears over slave 1, 10 + 12 instead of 25; all other ways are shorter.
  EXPECT_EQ(spread_bound(cell), MaxPlus(22));
  EXPECT_EQ(start_bound(cell), MaxPlus(180));  // the barrier is the master's
}

// The outer slave is master of an inner star with ways of 3 + 4 and initialisations of 100. Inner Ready 107, Running 7.
// Outer: 20 + 107 + 20 until Ready, 20 + 7 + 20 until Running. Halt from the outer master to the inner slave: 20 + 3;
// from the inner slave outwards 4 + 20.
TEST(ReactionBound, NestedByHand) {
  ReactionGroup outer = star({{20, 20}}, 100);
  outer.inner.push_back({1, star({{3, 4}}, 100)});
  EXPECT_EQ(ready_bound(outer), MaxPlus(147));
  EXPECT_EQ(run_bound(outer), MaxPlus(47));
  EXPECT_EQ(start_bound(outer), MaxPlus(194));
  EXPECT_EQ(spread_bound(outer), MaxPlus(24));
  // A suspend may come when all are Running, but the outer slave has not heard so of its master: it waits for that, 20,
  // and goes on for 20.
  EXPECT_EQ(spread_bound(outer, Spread::after_barriers), MaxPlus(40));
  // A third level, within the inner slave.
  outer.inner[0].group.inner.push_back({1, star({{1, 2}}, 1'000)});
  EXPECT_EQ(start_bound(outer), MaxPlus((20 + 3 + 1'003 + 4 + 20) + (20 + 3 + 3 + 4 + 20)));
  EXPECT_EQ(spread_bound(outer), MaxPlus(4 + 2 + 20));
  EXPECT_EQ(spread_bound(outer, Spread::after_barriers), MaxPlus(40));
}

TEST(ReactionBound, PartsNameTheSlowestChainAndSumUp) {
  ReactionGroup outer = star({{20, 20}, {21, 21}}, 100);
  outer.names = {"m", "a", "b"};
  ReactionGroup inner = star({{3, 4}}, 200);
  inner.names = {"a", "x"};
  outer.inner.push_back({1, inner});
  const auto text_of = [](const std::vector<ReactionPart>& parts) {
    std::string text;
    for (const ReactionPart& part : parts) text += part.what + " " + std::to_string(part.duration.ps()) + ", ";
    return text;
  };
  EXPECT_EQ(text_of(ready_parts(outer)),
            "a hears of INIT 20, x hears of INIT 3, x initialises 200, a hears of Ready 4, m hears of Ready 20, ");
  EXPECT_EQ(text_of(run_parts(outer)),
            "a hears of Ready 20, x hears of Ready 3, a hears of Running 4, m hears of Running 20, ");
  EXPECT_EQ(text_of(spread_parts(outer)), "a hears of x 4, m hears of a 20, b hears of m 21, ");
}

TEST(ReactionBound, UnboundedNotificationsAreToldFromMissingOnes) {
  ReactionGroup cell = star({{10, 30}}, 100);
  cell.notify(0, 1) = MaxPlus::unbounded();
  EXPECT_FALSE(is_bounded(start_bound(cell).ps()));
  EXPECT_FALSE(is_bounded(spread_bound(cell).ps()));
}

std::string cell_text(const std::string& variant, const std::string& publish, const std::string& subscription,
                      const std::string& phase) {
  const std::string call = R"(, "program": "cell", "call": )";
  return R"({"name": "cell", "duration": "60ms", "network": {"nodes": {"m": {"kind": "host"}, "a": {"kind": "host"},
      "b": {"kind": "host"}, "far": {"kind": "host"},
    "s1": {"kind": "switch", "forwarding_delay": "1us"}, "s2": {"kind": "switch", "forwarding_delay": "1us"}},
    "links": [{"ends": ["m", "s1"], "rate": "100Mbps"}, {"ends": ["a", "s1"], "rate": "100Mbps"}, {"ends": ["s1",
      "s2"], "rate": "100Mbps"},
              {"ends": ["b", "s2"], "rate": "100Mbps"}, {"ends": ["far", "s2"], "rate": "100Mbps"}]},
   "streams": [{"name": "noise", "from": "far", "to": "m", "payload": "1400B", "every": "237us"}],
   "programs": [{"name": "cell", "master": "m", "slaves": ["a", "b"], "cycle": "1ms", "variant": ")" +
         variant + R"(", "publish": ")" + publish + R"(", "subscription": ")" + subscription + R"("}],
   "script": [{"at": "5)" +
         phase + R"(us")" + call + R"("Start"}, {"at": "20)" + phase + R"(us")" + call + R"("Suspend", "on": "a"},
              {"at": "27)" +
         phase + R"(us")" + call + R"("Resume", "on": "b"}, {"at": "34)" + phase + R"(us")" + call +
         R"("Suspend", "on": "m"},
              {"at": "41)" +
         phase + R"(us")" + call + R"("Reset", "on": "b"}, {"at": "50)" + phase + R"(us")" + call +
         R"("Halt", "on": "b"}]})";
}

// Calls at all phases of the cycle: no reaction exceeds its bound, and the slowest come near it.
TEST(ReactionBound, HoldsInTheSimulatorAtAllPhases) {
  for (const std::string variant : {"robust", "paper"})
    for (const std::string publish : {"cyclic", "on-change"})
      for (const std::string subscription : {"star", "all-to-all"}) {
        std::array<sim::Duration, 5> slowest{};
        std::vector<ReactionBound> bounds;
        for (int phase = 0; phase < 1000; phase += 97) {
          std::string digits = std::to_string(phase);
          digits.insert(0, 3 - digits.size(), '0');
          json::Diagnostics diagnostics;
          const auto resolved =
              scenario::load_text(cell_text(variant, publish, subscription, digits), "cell.json", {}, diagnostics);
          ASSERT_TRUE(resolved) << diagnostics.to_text();
          bounds = bound(*resolved).reactions;
          std::erase_if(bounds, [](const ReactionBound& each) { return each.cause != handshake::Cause::command; });
          scenario::Run run(*resolved);
          run.advance();
          for (const handshake::Reaction& reaction : run.monitor(0).reactions()) {
            if (reaction.outcome != handshake::ReactionOutcome::completed) continue;
            for (std::size_t k = 0; k < bounds.size(); ++k)
              if (handshake::name_of(reaction.kind) == std::string_view(scenario::spelling(bounds[k].kind)))
                slowest[k] = std::max(slowest[k], reaction.completed - reaction.began);
          }
        }
        ASSERT_EQ(bounds.size(), slowest.size());
        for (std::size_t k = 0; k < bounds.size(); ++k) {
          ASSERT_TRUE(bounds[k].bound);
          EXPECT_LE(slowest[k], *bounds[k].bound)
              << variant << publish << subscription << scenario::spelling(bounds[k].kind);
          EXPECT_GT(slowest[k], sim::Duration())
              << variant << publish << subscription << scenario::spelling(bounds[k].kind);
          sim::Duration sum;
          for (const ReactionPart& part : bounds[k].parts) sum += part.duration;
          EXPECT_EQ(sum, *bounds[k].bound);
        }
        if (publish == "cyclic") {
          EXPECT_GT(slowest[0].ps(), bounds[0].bound->ps() / 2) << variant << subscription;
        }
      }
}

// Faults at all phases of the cycle: from the instant of the fault until all who live are Halted, nothing exceeds the
// bound of its cause.
TEST(ReactionBound, HaltsHoldFromTheirCausesAtAllPhases) {
  const std::pair<handshake::Cause, const char*> faults[] = {
      {handshake::Cause::crash, R"("kind": "crash", "node": "a")"},
      {handshake::Cause::crash, R"("kind": "crash", "node": "m")"},
      {handshake::Cause::crash, R"("for": "1ms", "kind": "crash", "node": "b")"},
      {handshake::Cause::cut, R"("kind": "link-down", "link": ["s1", "s2"])"},
      {handshake::Cause::cut, R"("kind": "crash", "node": "s2")"},
      {handshake::Cause::silence, R"("kind": "frame-errors", "loss": 1, "link": ["s1", "s2"])"},
  };
  std::map<handshake::Cause, double> tightest;
  for (const std::string subscription : {"star", "all-to-all"})
    for (const auto& [cause, fault] : faults)
      for (int phase = 100; phase < 1000; phase += 97) {
        json::Diagnostics diagnostics;
        std::string text = cell_text("robust", "cyclic", subscription, "000");
        text.insert(text.rfind('}'), R"(, "faults": [{"at": "12)" + std::to_string(phase) + R"(us", )" + fault +
                                         R"(}], "require": [{"reaction": "halt", "within": "1s"}])");
        const auto resolved = scenario::load_text(text, "cell.json", {}, diagnostics);
        ASSERT_TRUE(resolved) << diagnostics.to_text();
        const Bounds bounds = bound(*resolved);
        const auto of_cause = std::find_if(bounds.reactions.begin(), bounds.reactions.end(),
                                           [&](const ReactionBound& each) { return each.cause == cause; });
        ASSERT_TRUE(of_cause != bounds.reactions.end() && of_cause->bound);
        sim::Duration sum;
        for (const ReactionPart& part : of_cause->parts) sum += part.duration;
        EXPECT_EQ(sum, *of_cause->bound);
        // Without a cause a requirement is for what the faults can bring about, too.
        EXPECT_GE(bounds.requirements.at(0).duration, of_cause->bound) << fault;
        scenario::Run run(*resolved);
        run.advance();
        int seen = 0;
        for (const handshake::Reaction& reaction : run.monitor(0).reactions()) {
          if (reaction.cause != cause || reaction.kind != handshake::IntentKind::Halt) continue;
          ++seen;
          ASSERT_EQ(reaction.outcome, handshake::ReactionOutcome::completed) << fault;
          EXPECT_LE(reaction.completed - reaction.began, *of_cause->bound) << fault << " at " << phase;
          tightest[cause] = std::max(tightest[cause], static_cast<double>((reaction.completed - reaction.began).ps()) /
                                                          static_cast<double>(of_cause->bound->ps()));
        }
        EXPECT_EQ(seen, 1) << fault;
      }
  for (const auto& [cause, share] : tightest) EXPECT_GT(share, 0.8) << scenario::spelling(cause);
}

// Three levels, called at all phases of the cycles, and suspended as soon as all run: nothing exceeds the bounds of the
// groups or of the tree.
TEST(ReactionBound, HoldsForNestedGroupsAtAllPhases) {
  std::map<std::tuple<std::size_t, scenario::Reaction, bool>, std::pair<sim::Duration, sim::Duration>>
      slowest;  // and the bound
  for (int phase = 0; phase < 1000; phase += 29) {
    const auto at = [&](int entry, int microseconds) {
      return "/script/" + std::to_string(entry) + "/at=" + std::to_string(microseconds) + "us";
    };
    json::Diagnostics diagnostics;
    const auto resolved =
        scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/programs/nested-cell.json",
                            {"/duration=150ms", at(0, 5'000 + phase), at(1, 10'500 + phase * 5),
                             at(2, 30'000 + phase * 3), at(3, 50'000 + phase), at(4, 70'000 + phase * 7),
                             at(5, 90'000 + phase), at(6, 120'000 + phase), at(7, 130'000 + phase),
                             "/script/1/program=axis", phase % 2 == 0 ? "/script/1/on=drive1" : "/script/1/on=axis1"},
                            diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    const Bounds bounds = bound(*resolved);
    scenario::Run run(*resolved);
    run.advance();
    for (const ReactionBound& reaction : bounds.reactions) {
      ASSERT_TRUE(reaction.bound);
      if (reaction.cause != handshake::Cause::command) continue;
      sim::Duration sum;
      for (const ReactionPart& part : reaction.parts) sum += part.duration;
      EXPECT_EQ(sum, *reaction.bound);
      const auto seen = reaction.of_tree ? run.trees().front()->reactions() : run.monitor(reaction.program).reactions();
      for (std::size_t i = 0; i < seen.size(); ++i) {
        // Nothing is said of what comes before the last call is over.
        const bool is_alone = i == 0 || (seen[i - 1].outcome == handshake::ReactionOutcome::completed &&
                                         seen[i - 1].completed <= seen[i].began);
        if (!is_alone || seen[i].outcome != handshake::ReactionOutcome::completed ||
            handshake::name_of(seen[i].kind) != std::string_view(scenario::spelling(reaction.kind)))
          continue;
        auto& [longest, limit] = slowest[{reaction.program, reaction.kind, reaction.of_tree}];
        longest = std::max(longest, seen[i].completed - seen[i].began);
        limit = *reaction.bound;
      }
    }
  }
  EXPECT_EQ(slowest.size(), 20u);  // five of each program and of the tree
  double tightest = 0;
  for (const auto& [which, of] : slowest) {
    EXPECT_LE(of.first, of.second) << std::get<0>(which) << scenario::spelling(std::get<1>(which))
                                   << std::get<2>(which);
    if (std::get<2>(which))
      tightest = std::max(tightest, static_cast<double>(of.first.ps()) / static_cast<double>(of.second.ps()));
  }
  EXPECT_GT(tightest, 0.6);
}

}  // namespace
}  // namespace takt::analysis::reaction_bound_test
