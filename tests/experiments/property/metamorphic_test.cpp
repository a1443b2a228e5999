// SPDX-License-Identifier: Apache-2.0
// What must not count: names, the order of streams, nodes, links and keys, a switch that nobody uses, units. Runs and
// bounds are the same then, and ten times as long where all times are. TAKT_TWINS=2000 looks at more random scenarios,
// TAKT_TWINS_SHOW=17 prints one.
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "analysis/bounds.hpp"
#include "sim/random.hpp"
#include "tests/experiments/property/random_scenario.hpp"
#include "tests/experiments/property/twins.hpp"
#include "tests/simulation/scenario/support.hpp"
#include "tests/support/case_count.hpp"

namespace takt::property {
namespace {

using scenario::Resolved;
using sim::Duration;

constexpr std::int64_t never = -1;

/// What is compared of one stream, in picoseconds and frames.
struct Seen {
  std::map<std::string, std::int64_t> bound;
  std::map<std::string, std::int64_t> run;
  std::vector<std::string> path;
};

std::int64_t ps_of(const std::optional<Duration>& value) { return value ? value->ps() : never; }

std::map<std::string, Seen> bounds_of(const Resolved& resolved) {
  std::map<std::string, Seen> all;
  const analysis::Bounds bounds = analysis::bound(resolved);
  for (const analysis::StreamBound& stream : bounds.streams) {
    Seen& seen = all[stream.name];
    seen.bound = {{"longest", ps_of(stream.latency)},
                  {"by total flows", ps_of(stream.total_flow)},
                  {"by separated flows", ps_of(stream.separated_flow)},
                  {"shortest", stream.least.ps()}};
    seen.path = passed_by(resolved, resolved.streams[stream.index.value]);
  }
  return all;
}

void add_run(const Resolved& resolved, std::map<std::string, Seen>& all) {
  scenario::Run run(resolved);
  run.advance();
  for (std::size_t s = 0; s < resolved.plan.streams.size(); ++s) {
    const models::Stream& stream = run.network().traffic().streams()[s];
    Seen& seen = all[resolved.plan.streams[s].name];
    seen.run = {{"dropped", static_cast<std::int64_t>(stream.dropped_in_all())}};
    if (stream.latency.empty()) continue;
    seen.run["least"] = stream.latency.minimum().ps();
    seen.run["greatest"] = stream.latency.maximum().ps();
  }
}

struct Tally {
  std::size_t twins = 0, refused = 0, other_paths = 0;
  std::string first;
};

/// What floating point, and steps through slopes, may round otherwise in a bound where all times are ten times as long;
/// and what a run rounds, of which each instant is a whole picosecond, where credit and tokens grow.
constexpr std::int64_t rounding_of_bounds_ps = 2'000;
constexpr std::int64_t rounding_of_runs_ps = 200;
bool grows(const std::string& text) {
  return text.find("idle_slope") != std::string::npos || text.find("\"burst\":\"") != std::string::npos ||
         text.find("\"cir\"") != std::string::npos;
}

/// Holds a twin against what was seen of the scenario. A twin that has another path, since several are as short, is
/// another scenario.
void compare(const std::string& what, const std::map<std::string, Seen>& seen, const Twin& twin, bool with_run,
             Tally& tally) {
  if (twin.text.empty()) return;
  const scenario::test::Loaded loaded = scenario::test::load(twin.text);
  if (!loaded.resolved) {
    ++tally.refused;
    return;
  }
  std::map<std::string, Seen> others = bounds_of(*loaded.resolved);
  if (with_run) add_run(*loaded.resolved, others);
  if (twin.name_of.empty())
    for (const auto& [name, one] : seen)
      if (others.at(name).path != one.path) {
        ++tally.other_paths;
        return;
      }
  ++tally.twins;
  const auto differ = [&](const std::string& name, const std::string& figure, std::int64_t one, std::int64_t other) {
    ADD_FAILURE() << what << ", " << name << ": " << figure << " " << one << " and " << other << " ps";
    if (tally.first.empty()) tally.first = twin.text;
  };
  for (const auto& [name, one] : seen) {
    const auto renamed = twin.name_of.find(name);
    const Seen& other = others.at(renamed == twin.name_of.end() ? name : renamed->second);
    for (const auto& [figure, value] : one.bound) {
      const std::int64_t found = other.bound.at(figure);
      const bool is_same = value == never || found == never ? value == found
                                                            : std::abs(value * twin.factor - found) <=
                                                                  (twin.factor == 1 ? 0 : rounding_of_bounds_ps);
      if (!is_same) differ(name, "bound, " + figure, value, found);
    }
    if (!with_run) continue;
    const std::int64_t rounding = twin.factor != 1 && grows(twin.text) ? rounding_of_runs_ps : 0;
    for (const auto& [figure, value] : one.run) {
      const std::int64_t found = other.run.contains(figure) ? other.run.at(figure) : never;
      if (figure == "dropped" ? found != value : found == never || std::abs(value * twin.factor - found) > rounding)
        differ(name, "run, " + figure, value, found);
    }
  }
}

std::vector<Twin> all_orders(const std::string& text, std::uint64_t seed) {
  return {with_other_streams(text, seed), with_other_nodes(text, seed), with_other_links(text, seed)};
}

std::string random_text(std::uint64_t number) {
  static const std::vector<std::vector<Feature>> mixes = {{},
                                                          {Feature::rates},
                                                          {Feature::shapers},
                                                          {Feature::gates},
                                                          {Feature::preemption},
                                                          {Feature::ats},
                                                          {Feature::cqf},
                                                          {Feature::cut_through},
                                                          {Feature::shapers, Feature::rates},
                                                          {Feature::hold},
                                                          {Feature::policing},
                                                          {Feature::multicast, Feature::untagged, Feature::rates},
                                                          {Feature::shapers, Feature::preemption},
                                                          {Feature::gates, Feature::shapers},
                                                          {Feature::ats, Feature::preemption, Feature::rates},
                                                          {Feature::queue_limits}};
  sim::RandomStream chance(number, "twins", "wishes");
  Wishes wishes;
  wishes.seed = number;
  wishes.features = mixes[number % mixes.size()];
  wishes.switches = 1 + chance.below(3);
  wishes.hosts = 2 + chance.below(4);
  wishes.streams = 2 + chance.below(5);
  return without_ties_and_chance(scenario_text(wishes), number);
}

TEST(Metamorphic, RandomScenarios) {
  const std::uint64_t count = support::case_count("TAKT_TWINS", 80);
  if (const char* const shown = std::getenv("TAKT_TWINS_SHOW"))
    std::puts(random_text(std::strtoull(shown, nullptr, 10)).c_str());
  Tally tally;
  std::size_t sound = 0;
  for (std::uint64_t number = 0; number < count; ++number) {
    const std::string text = random_text(number);
    const scenario::test::Loaded loaded = scenario::test::load(text);
    if (!loaded.resolved) continue;
    ++sound;
    std::map<std::string, Seen> seen = bounds_of(*loaded.resolved);
    add_run(*loaded.resolved, seen);
    SCOPED_TRACE(number);
    compare("other keys", seen, with_other_keys(text, number), true, tally);
    compare("other units", seen, with_other_units(text), true, tally);
    compare("an unused switch", seen, with_unused_switch(text), true, tally);
    compare("other names", seen, with_other_names(text), true, tally);
    for (const Twin& twin : all_orders(text, number)) compare("another order", seen, twin, true, tally);
    compare("ten times slower", seen, ten_times_slower(text), true, tally);
  }
  EXPECT_GE(sound, count * 8 / 10);
  EXPECT_GT(tally.twins, 5 * sound) << tally.refused << " refused, " << tally.other_paths << " with other paths";
  EXPECT_EQ(tally.first, "");
}

std::string text_of_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// Of shipped scenarios, whose frames may meet at one instant and whose clocks hear every switch, runs are the same with
// other keys and units alone.
TEST(Metamorphic, ShippedScenarios) {
  Tally tally;
  std::uint64_t seed = 0;
  for (const std::string& name : scenario::test::shipped_names()) {
    const std::string text = text_of_file(scenario::test::shipped_path(name));
    if (text.find("\"trace\"") != std::string::npos || text.find("\"network\"") == std::string::npos)
      continue;  // a trace is looked for beside the file
    const std::string duration = name.starts_with("clocks/") ? "2s" : "";
    const auto resolved = scenario::test::shipped(name);
    if (resolved->plan.nodes.size() > 100) continue;
    SCOPED_TRACE(name);
    const std::map<std::string, Seen> seen = bounds_of(*resolved);
    ++seed;
    for (const Twin& twin : {with_other_keys(text, seed), with_other_units(text)})
      compare("other keys or units", seen, twin, false, tally);
    if (resolved->scenario.programs.empty() && resolved->applications.empty()) {
      for (const Twin& twin : all_orders(text, seed)) compare("another order", seen, twin, false, tally);
      if (resolved->plan.gptp.empty()) compare("an unused switch", seen, with_unused_switch(text), false, tally);
    }
  }
  EXPECT_GT(tally.twins, 150u) << tally.refused << " refused, " << tally.other_paths << " with other paths";
  EXPECT_EQ(tally.first, "");
}

// The finding: with all phases the times repeat too late, and which of them were forgotten rested on the order of the
// streams.
TEST(Metamorphic, TheOrderOfTheStreamsOfTheFinding) {
  const std::string text =
      text_of_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/bound-depends-on-stream-order.json");
  std::map<std::string, Seen> seen = bounds_of(*scenario::test::sound(text));
  add_run(*scenario::test::sound(text), seen);
  Tally tally;
  for (std::uint64_t seed = 0; seed < 30; ++seed)
    compare("another order of streams", seen, with_other_streams(text, seed), true, tally);
  EXPECT_EQ(tally.twins, 30u);
}

// Of two links between the same switches the first in the file is taken. Another order is another path then, by a cable
// of 100 m (500 ns) instead of the default 50 ns: what is compared says so, and run and bound are 450 ns longer.
TEST(Metamorphic, OfParallelLinksTheFirstIsAnotherPath) {
  const std::string head = R"({"name": "t", "duration": "10ms", "network": {"nodes": {"s0": {"kind": "switch"},
    "s1": {"kind": "switch"}, "a": {"kind": "host", "os": "none"}, "b": {"kind": "host", "os": "none"}}, "links": [)";
  const std::string tail = R"(, {"ends": ["a", "s0"]}, {"ends": ["s1", "b"]}]},
    "streams": [{"name": "x", "from": "a", "to": "b", "payload": "200B", "every": "1ms"}]})";
  const std::string near = R"({"ends": ["s0", "s1"], "delay": "50ns"})";
  const std::string far = R"({"ends": ["s0:40", "s1:40"], "length": "100m"})";
  std::map<std::string, Seen> by_near, by_far;
  for (const auto& [text, seen] :
       {std::pair(head + near + ", " + far + tail, &by_near), std::pair(head + far + ", " + near + tail, &by_far)}) {
    const auto resolved = scenario::test::sound(text);
    *seen = bounds_of(*resolved);
    add_run(*resolved, *seen);
    EXPECT_GE(seen->at("x").bound.at("longest"), seen->at("x").run.at("greatest"));
  }
  EXPECT_NE(by_near.at("x").path, by_far.at("x").path);
  EXPECT_EQ(by_far.at("x").bound.at("longest"), by_near.at("x").bound.at("longest") + 450'000);
  EXPECT_EQ(by_far.at("x").run.at("greatest"), by_near.at("x").run.at("greatest") + 450'000);
}

// A twin that does not behave alike is caught.
TEST(Metamorphic, CatchesWhatCounts) {
  const std::string text = random_text(0);
  std::map<std::string, Seen> seen = bounds_of(*scenario::test::sound(text));
  seen.begin()->second.bound["longest"] += 1;
  Tally tally;
  EXPECT_NONFATAL_FAILURE(compare("units", seen, with_other_units(text), false, tally), "bound, longest");
}

}  // namespace
}  // namespace takt::property
