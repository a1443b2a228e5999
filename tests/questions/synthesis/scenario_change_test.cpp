// SPDX-License-Identifier: Apache-2.0
// A plant that changes while it runs: what comes of it is judged by when each frame is where, worked out here from the
// streams and their paths alone.
#include "synthesis/scenario_change.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "json/fields.hpp"
#include "models/ethernet/traffic.hpp"
#include "random_plant.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "synthesis/change_report.hpp"

namespace takt::synthesis::scenario_change_test {
namespace {

using scenario::Scenario;
using scenario::Stream;
using sim::Duration;
using test::random_plant;
using test::RandomPlant;
using test::scenario_of;

using Times = std::vector<std::int64_t>;

/// When frames came to their listeners, by stream.
class Arrivals final : public sim::TraceSink {
 public:
  void record(const sim::TraceRecord& record) override {
    if (record.kind == static_cast<std::uint32_t>(models::Occurrence::received))
      of_stream[static_cast<std::uint32_t>(record.detail >> 32)].push_back(record.time.ps());
  }
  std::map<std::uint32_t, Times> of_stream;
};

/// Of the scenario what came, and when each frame should have come if nothing stood in its way; of Programs what came.
struct Seen {
  std::map<std::string, Times> came, should, of_programs;
};

/// 18 octets of Ethernet, 4 of the tag, 28 of IP and UDP, at least 64 and the tag; 8 of the preamble.
Duration alone(const scenario::Resolved& resolved, const scenario::Path& path, const Stream& stream) {
  const std::int64_t octets = 8 + std::max<std::int64_t>(68, stream.payload.count + 50);
  Duration sum;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    for (const models::LinkPlan& link : resolved.plan.links) {
      if (std::minmax(link.a.node.value, link.b.node.value) != std::minmax(path[i], path[i + 1])) continue;
      sum += link.rate.octet_time() * octets + link.delay;
      if (const scenario::Relay* const relay = scenario::relay_of(resolved.topology.nodes[path[i + 1]].description))
        sum += relay->forwarding_delay;
      break;
    }
  return sum;
}

/// Nothing if it is no scenario that runs.
std::optional<Seen> see(const Scenario& scenario) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(scenario, diagnostics);
  if (!resolved) return std::nullopt;
  Seen seen;
  scenario::Run run(*resolved);
  Arrivals arrivals;
  run.simulation().set_trace(&arrivals);
  run.advance();
  for (const scenario::ResolvedStream& each : resolved->streams) {
    const auto found =
        std::ranges::find(resolved->scenario.streams, resolved->plan.streams[each.index.value].name, &Stream::name);
    if (found == resolved->scenario.streams.end()) {
      seen.of_programs[resolved->plan.streams[each.index.value].name] = arrivals.of_stream[each.index.value];
      continue;
    }
    const Stream& stream = *found;
    seen.came[stream.name] = arrivals.of_stream[each.index.value];
    Times& should = seen.should[stream.name];
    const Duration takes = alone(*resolved, each.paths.front(), stream);
    // Windows open on whole ns, and when the frame is surely there.
    for (Duration due = stream.offset.value_or(Duration());
         due < stream.until.value_or(Duration::max()) && due + stream.jitter + takes <= scenario.duration;
         due += *stream.every)
      should.push_back(((due + stream.jitter).ps() + 999) / 1'000 * 1'000 + takes.ps());
  }
  return seen;
}

std::optional<ScenarioChange> changed(const RandomPlant& plant, bool with_plant, std::string* told = nullptr) {
  json::Diagnostics diagnostics;
  auto answer =
      change_scenario(plant.running, with_plant ? std::optional(plant.wanted) : std::nullopt, plant.asked, diagnostics);
  if (told != nullptr)
    *told = diagnostics.to_text();
  else
    EXPECT_TRUE(answer) << diagnostics.to_text();
  return answer;
}

const Stream* find(const Scenario& scenario, const std::string& name) {
  const auto found = std::ranges::find(scenario.streams, name, &Stream::name);
  return found == scenario.streams.end() ? nullptr : &*found;
}

/// Each frame of each stream comes when it should, throughout; but those that a failed link has taken.
void expect_all_in_time(const RandomPlant& plant, const ScenarioChange& answer, const std::string& about) {
  const auto seen = see(answer.simulated.scenario);
  ASSERT_TRUE(seen) << about;
  // Programs do not notice.
  if (!plant.running.programs.empty()) {
    Scenario as_it_was = plant.running;
    as_it_was.duration = answer.simulated.scenario.duration;
    const auto before = see(as_it_was);
    ASSERT_TRUE(before) << about;
    EXPECT_GT(before->of_programs.size(), 2u) << about;
    EXPECT_EQ(seen->of_programs, before->of_programs) << about;
  }
  for (const auto& [name, came] : seen->came) {
    const auto change = std::ranges::find(answer.changes, name, &StreamChange::name);
    if (change == answer.changes.end() || !change->was_cut) {
      EXPECT_EQ(came, seen->should.at(name)) << about << name;
      continue;
    }
    // Nobody is late, and what had come before the link failed came.
    const Times& should = seen->should.at(name);
    EXPECT_TRUE(std::ranges::includes(should, came)) << about << name;
    Times before = should;
    std::erase_if(before, [&](std::int64_t at) { return at > answer.at.ps(); });
    EXPECT_TRUE(std::ranges::includes(came, before)) << about << name;
  }
}

/// Who does not move stays where it was, and who moves makes no longer pause than half a period more.
void expect_few_moves(const RandomPlant& plant, const ScenarioChange& answer, const std::string& about) {
  const Scenario& after = answer.after->scenario;
  for (const Stream& before : plant.running.streams) {
    const auto change = std::ranges::find(answer.changes, before.name, &StreamChange::name);
    const Stream* const now = find(after, before.name);
    if (change == answer.changes.end()) {
      ASSERT_NE(now, nullptr) << about << before.name;
      EXPECT_EQ(now->offset, before.offset) << about << before.name;
      EXPECT_EQ(now->path, before.path) << about << before.name;
      continue;
    }
    EXPECT_EQ(now != nullptr, change->fate == StreamFate::moves) << about << before.name;
    if (change->fate != StreamFate::moves || change->was_cut) continue;
    const Stream* const old = find(answer.simulated.scenario, before.name);
    const Stream* const fresh = find(answer.simulated.scenario, before.name + " moved");
    ASSERT_TRUE(old != nullptr && fresh != nullptr && old->until) << about << before.name;
    const Duration pause = fresh->offset->value - (*old->until - *old->every);
    EXPECT_GT(pause, *old->every / 2) << about << before.name;
    EXPECT_LE(pause, *old->every * 2 + Duration::from_ps(200'000'000)) << about << before.name;
  }
}

TEST(ScenarioChange, NobodyIsLateWhateverChanges) {
  std::size_t done = 0, moved = 0, cut = 0, came = 0, rounds = 0, programs = 0, paused = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const auto plant = random_plant(seed);
    if (!plant) continue;
    const std::string about = "seed " + std::to_string(seed) + ", ";
    std::string told;
    const auto answer = changed(*plant, seed % 2 == 0, &told);
    if (!answer) {
      // What Programs publish takes no other way.
      EXPECT_NE(told.find("a stream of a program over what fails"), std::string::npos) << about << told;
      continue;
    }
    if (!plant->running.programs.empty()) ++programs;
    for (const std::string& each : answer->wrong) ADD_FAILURE() << about << each;
    if (!answer->after) {
      EXPECT_FALSE(answer->how.empty()) << about;
      if (!answer->would_pause.empty()) ++paused;
      continue;
    }
    ++done;
    for (const StreamChange& each : answer->changes) {
      if (each.fate == StreamFate::moves && !each.was_cut) ++moved;
      if (each.fate == StreamFate::moves && each.was_cut) ++cut;
      if (each.fate == StreamFate::comes) ++came;
    }
    if (answer->transition.steps.size() > 3) ++rounds;  // more than lists, talkers, lists
    expect_all_in_time(*plant, *answer, about);
    expect_few_moves(*plant, *answer, about);
    // A requirement that fails would be said by takt run.
    EXPECT_EQ(answer->is_done,
              answer->without_place.empty() &&
                  std::ranges::none_of(answer->changes,
                                       [](const StreamChange& each) { return each.fate == StreamFate::lost; }))
        << about;
  }
  EXPECT_GT(done, 100u);
  EXPECT_GT(cut, 80u);
  EXPECT_GT(came, 80u);
  EXPECT_GT(moved, 3u);
  EXPECT_GT(rounds, 15u);
  EXPECT_GT(programs, 15u);
  EXPECT_GT(paused, 2u);
}

/// Another transition: what the judge says of it, and whether all frames come in time.
struct Judged {
  bool is_found = false;
  bool is_in_time = false;
};
Judged judged(const RandomPlant& plant, const ScenarioChange& answer, const Transition& other) {
  json::Diagnostics diagnostics;
  const auto gates = gates_of_running(plant.running, std::nullopt, plant.asked.add, diagnostics);
  const auto placed = place_changes(plant.running, *gates, nullptr, plant.asked, diagnostics);
  const TransitionScenario made =
      make_transition_scenario(plant.running, *gates->resolved, *placed, answer.flows, other, answer.at);
  const auto seen = see(made.scenario);
  return {!judge_transition(made).wrong.empty(), seen && seen->came == seen->should};
}

bool has_first(const TransitionStep& step) {
  return std::ranges::any_of(step.talkers, [](const TalkerSwitch& each) { return each.first.has_value(); });
}

// Lists that come too late, are not written, or lack windows, and talkers that go on when their windows are gone.
TEST(ScenarioChange, TheJudgeFindsWhatIsWrong) {
  std::size_t missing = 0, late = 0, gone = 0, closed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto plant = random_plant(seed);
    if (!plant || !plant->asked.fail.empty()) continue;
    const auto answer = changed(*plant, false);
    if (!answer || !answer->after) continue;
    const std::string about = "seed " + std::to_string(seed);
    const Transition& right = answer->transition;
    const auto look = [&](const Transition& other, std::size_t& found) {
      const Judged seen = judged(*plant, *answer, other);
      EXPECT_TRUE(seen.is_found || seen.is_in_time) << about;
      if (!seen.is_in_time) ++found;
    };
    std::size_t none = 0;
    const Judged as_it_is = judged(*plant, *answer, right);
    EXPECT_TRUE(!as_it_is.is_found && as_it_is.is_in_time) << about;
    for (std::size_t s = 0; s < right.steps.size(); ++s) {
      Transition other = right;
      for (TalkerSwitch& each : other.steps[s].talkers) {
        if (!each.last || s + 1 == right.steps.size()) continue;
        Duration holds;
        for (const WrittenList& list : right.steps[s + 1].lists) holds = std::max(holds, list.holds_from);
        const Duration period =
            answer->flows.problem.flows.streams[*answer->flows.problem.changes[each.change].leaves].period;
        while (*each.last <= holds + period) each.last = *each.last + period;
      }
      look(other, right.steps[s].talkers.empty() ? none : gone);
      if (right.steps[s].lists.empty()) continue;
      // A base time in the past: ConfigChangeError counts, and the list holds from the next cycle on.
      other = right;
      other.steps[s].lists.front().written =
          right.steps[s].lists.front().holds_from + right.steps[s].lists.front().list.cycle / 2;
      EXPECT_TRUE(judged(*plant, *answer, other).is_found) << about;
      ++late;
      if (s + 1 == right.steps.size() || !has_first(right.steps[s + 1])) continue;
      other = right;
      other.steps.erase(other.steps.begin() + static_cast<std::ptrdiff_t>(s));
      look(other, missing);
      other = right;
      for (scenario::GateList::Entry& entry : other.steps[s].lists.front().list.entries)
        entry.open = static_cast<models::GateStates>(entry.open & ~0x60u);
      look(other, closed);
    }
    EXPECT_EQ(none, 0u) << about;
  }
  EXPECT_GT(missing, 5u);
  EXPECT_GT(late, 10u);
  EXPECT_GT(gone, 3u);
  EXPECT_GT(closed, 5u);
}

}  // namespace
}  // namespace takt::synthesis::scenario_change_test
