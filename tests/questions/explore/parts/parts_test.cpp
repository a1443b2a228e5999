// SPDX-License-Identifier: Apache-2.0
// Groups in parts: they have the runs of groups whose slaves have names, and are far fewer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "../ask.hpp"
#include "explore/model/group_model.hpp"
#include "explore/parts/parts_model.hpp"
#include "explore/report/replay.hpp"

namespace takt::explore {
namespace {

using Key = std::vector<std::uint64_t>;

void add(Key& key, const handshake::Intent& intent) {
  key.push_back(std::uint64_t{intent.number} << 32 | intent.run);
  key.push_back(handshake::index_of(intent.kind) << 1 | (intent.origin != 0 ? 1 : 0));  // slaves have no names
}
void add(Key& key, const Participant::Peer& peer) {
  key.push_back(std::uint64_t{peer.incarnation} << 32 | peer.run);
  key.push_back(std::uint64_t{peer.sequence} << 16 | handshake::index_of(peer.state) << 8 |
                std::uint64_t{peer.heard} << 1 | std::uint64_t{peer.sequence_known});
}
/// What a participant is and knows, but for what the master knows of its slaves.
void add(Key& key, const Participant& participant, bool is_down) {
  key.push_back(std::uint64_t{participant.config().incarnation} << 1 | std::uint64_t{is_down});
  if (is_down) return;
  key.push_back(std::uint64_t{participant.run()} << 8 | handshake::index_of(participant.state()) << 1 |
                std::uint64_t{participant.waits_initialised()});
  add(key, participant.intent());
  if (participant.config().index != 0) add(key, participant.part_of(0).peer);
}

Key key_of(const GroupModel& model, const State& state, bool with_budgets) {
  const auto is_down = [&](std::size_t i) { return model.members()[state.member(i)].down; };
  const Participant& master = model.members().value(state.member(0));
  Key key;
  add(key, master, is_down(0));
  if (with_budgets) key.push_back(state.commands_left() << 8 | state.faults_left());
  std::vector<Key> slaves;
  for (std::size_t i = 1; i <= model.query().slaves; ++i) {
    Key& slave = slaves.emplace_back();
    add(slave, model.members().value(state.member(i)), is_down(i));
    if (!is_down(0)) add(slave, master.part_of(i - 1).peer);
  }
  std::sort(slaves.begin(), slaves.end());
  for (const Key& each : slaves) key.insert(key.end(), each.begin(), each.end());
  return key;
}

Key key_of(const PartsModel& model, const State& state, bool with_budgets) {
  const Parts& parts = model.parts();
  const bool master_is_down = parts.of_master(model.master(state)).down;
  Key key;
  add(key, parts.master_value(model.master(state)), master_is_down);
  if (with_budgets) key.push_back(state.commands_left() << 8 | state.faults_left());
  std::vector<Key> slaves;
  for (std::size_t i = 1; i <= model.query().slaves; ++i) {
    Key& slave = slaves.emplace_back();
    add(slave, parts.slave_value(model.slave(state, i)), parts.of_slave(model.slave(state, i)).down);
    if (!master_is_down) add(slave, parts.known(model.slave(state, i)).peer);
  }
  std::sort(slaves.begin(), slaves.end());
  for (const Key& each : slaves) key.insert(key.end(), each.begin(), each.end());
  return key;
}

struct HashOfState {
  std::size_t operator()(const State& state) const { return state.hash(); }
};

/// What participants can be and know together, whatever stands in registers.
template <class M>
std::set<Key> reached(const Query& query, bool with_budgets) {
  M model(query);
  Interner<State, HashOfState> states;
  for (const Beginning& each : model.beginnings()) states.intern(model.canonical(each.state));
  std::set<Key> keys;
  Next next;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const State state = states[i];
    keys.insert(key_of(model, state, with_budgets));
    for (const Action action : model.actions())
      if (model.act(state, action, next)) states.intern(model.canonical(next.state));
  }
  return keys;
}

Query asked(std::uint8_t slaves, std::uint32_t commands, std::uint32_t faults, std::initializer_list<Fault> classes) {
  Query query;
  query.slaves = slaves;
  query.fault_budget = faults;
  return with(query, commands, std::vector<Fault>(classes));
}

// Both directions: no run is lost, and none is made up.
TEST(PartsModel, ReachesJustWhatAGroupWithNamesReaches) {
  const Query queries[] = {
      asked(1, 3, 0, {}),
      asked(1, 1, 2, {Fault::crash, Fault::restart}),
      asked(1, 1, 1, {Fault::duplicate, Fault::reorder, Fault::crash, Fault::restart, Fault::timeout}),
      asked(2, 1, 0, {}),
      asked(2, 1, 1, {Fault::crash}),
      asked(2, 1, 1, {Fault::duplicate}),
      asked(2, 1, 1, {Fault::reorder}),
      asked(2, 0, 1, {Fault::restart, Fault::timeout}),
      asked(3, 1, 0, {}),
  };
  for (const Query& query : queries) {
    SCOPED_TRACE(query_line(query));
    const std::set<Key> with_names = reached<GroupModel>(query, true);
    EXPECT_GT(with_names.size(), 20U);
    EXPECT_EQ(reached<PartsModel>(query, true), with_names);
  }
}

// A lost word is one that is never heard: it leads nowhere else.
TEST(PartsModel, NeedsNoStepForALostWord) {
  for (std::uint8_t slaves = 1; slaves <= 2; ++slaves) {
    const Query query = asked(slaves, 1, 2, {Fault::loss});
    EXPECT_EQ(reached<PartsModel>(query, false), reached<GroupModel>(query, false));
  }
}

// The same verdicts where both can be asked.
TEST(PartsModel, DecidesWhatTheGroupWithNamesDecides) {
  for (std::uint8_t slaves = 1; slaves <= 3; ++slaves) {
    const Query query = slaves == 3
                            ? asked(3, 1, 1, {Fault::loss, Fault::crash})
                            : asked(slaves, 2, slaves == 1 ? 1 : 0, {Fault::crash, Fault::restart, Fault::timeout});
    const SearchResult in_parts = search<PartsModel>(query, [](const Progress&) { return true; });
    EXPECT_TRUE(in_parts.exhausted && in_parts.all_hold());
    EXPECT_EQ(in_parts.verdicts, ask(query).verdicts);
  }
}

struct Large {
  std::uint8_t slaves;
  std::uint32_t faults;  ///< crashes
  std::uint64_t states;
};

// Seven without a fault, and five with a crash. (Six take a minute: explore_size_test.)
TEST(PartsModel, ExploresGroupsOfMoreThanFour) {
#ifdef NDEBUG
  constexpr Large cases[] = {{5, 0, 9230}, {7, 0, 64542}, {5, 1, 527535}};
#else
  constexpr Large cases[] = {{5, 0, 9230}};
#endif
  for (const Large& each : cases) {
    const Query query = asked(each.slaves, 1, each.faults, {Fault::loss, Fault::crash});
    SCOPED_TRACE(query_line(query));
    const SearchResult result = ask(query);
    EXPECT_TRUE(result.exhausted && result.all_hold());
    EXPECT_EQ(result.states, each.states);
  }
}

/// Numbers that are the same everywhere.
std::size_t drawn(std::uint64_t& state, std::size_t count) {
  state = state * 6364136223846793005ULL + 1442695040888963407ULL;
  return static_cast<std::size_t>((state >> 33) % count);
}

// Told with `send`, each run is one of real participants with real registers, and all end in the same states.
TEST(PartsModel, RunsAreRunsOfRealGroups) {
  for (const int count : {1, 2, 3, 5, 7, 12}) {
    const auto slaves = static_cast<std::uint8_t>(count);
    const Query query = asked(
        slaves, 4, 3, {Fault::loss, Fault::duplicate, Fault::reorder, Fault::crash, Fault::restart, Fault::timeout});
    PartsModel model(query);
    std::vector<Action> likely;  // words that are far behind stand in few registers
    for (const Action each : model.actions())
      if (each.what <= 2 || each.kind == ActionKind::call || each.kind == ActionKind::silence ||
          each.kind == ActionKind::timeout)
        likely.push_back(each);
    std::size_t steps = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(testing::Message() << int{slaves} << " slaves, seed " << seed);
      std::uint64_t dice = seed;
      Trace trace;
      trace.beginning = drawn(dice, model.beginnings().size());
      State state = model.beginnings()[trace.beginning].state;
      std::uint32_t invariants = 0;
      for (std::size_t i = 0; i < 4000 && trace.actions.size() < 80; ++i) {
        const Action action = likely[drawn(dice, likely.size())];
        Next next;
        if (!is_network(action.kind) && drawn(dice, 6) != 0) continue;
        if (!model.act(state, action, next)) continue;
        state = next.state;
        invariants |= next.properties.bits & 0x1FU;
        trace.actions.push_back(action);
      }
      if (trace.actions.empty()) continue;
      steps += trace.actions.size();
      const Replay replayed = replay(query, model.told(model.beginnings()[trace.beginning]), model.told(trace));
      ASSERT_GE(replayed.steps.size(), trace.actions.size());
      const ReplayStep& last = replayed.steps.back();
      for (std::size_t i = 0; i <= slaves; ++i) {
        const bool is_down = i == 0 ? model.parts().of_master(model.master(state)).down
                                    : model.parts().of_slave(model.slave(state, i)).down;
        ASSERT_EQ(last.down[i], is_down);
        if (!is_down) {
          ASSERT_EQ(last.states[i], model.state_of(state, i)) << i;
        }
      }
      EXPECT_EQ(invariants, 0U);
      for (const ReplayStep& step : replayed.steps) EXPECT_TRUE(step.violations.empty() && step.broken.empty());
    }
    EXPECT_GT(steps, 1000U);
  }
}

}  // namespace
}  // namespace takt::explore
