// SPDX-License-Identifier: Apache-2.0
// Nested groups and joining slaves: verdicts and numbers of states, the observer of the tree, and the same walks with
// the handshake's own.
#include "../../../protocol/handshake/tree.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <random>

#include "../ask.hpp"
#include "explore/model/tree_model.hpp"
#include "explore/report/chart.hpp"

namespace takt::explore {
namespace {

using handshake::PublishedState;
using handshake::Side;

Query tree(std::uint8_t slaves, std::uint8_t inner, bool joining, std::uint32_t commands,
           std::initializer_list<Fault> faults) {
  Query query;
  query.slaves = slaves;
  query.inner_slaves = inner;
  query.joining = joining;
  return with(query, commands, faults);
}

TEST(Tree, HoldsInEveryOrder) {
  const Case cases[] = {
#ifndef NDEBUG
      {tree(1, 1, false, 1, {}), 2492, 8526},
#else
      {tree(1, 1, false, 2, {}), 47057, 155394},
      {tree(1, 1, false, 2, {Fault::crash}), 230190, 820420},
      {tree(1, 1, false, 1, {Fault::loss}), 10911, 48683},
      {tree(1, 1, false, 1, {Fault::restart}), 334400, 1188675},
      {tree(1, 1, false, 1, {Fault::timeout}), 68550, 254336},
      {tree(1, 2, false, 1, {}), 52859, 294197},
      {tree(2, 1, false, 1, {}), 58271, 325679},
      {tree(1, 0, true, 2, {Fault::loss, Fault::crash, Fault::restart, Fault::timeout}), 61121, 169836},
      {tree(2, 0, true, 1, {Fault::crash}), 137131, 557039},
      {tree(1, 1, true, 1, {Fault::crash}), 117752, 463170},
#endif
  };
  for (const Case& each : cases) EXPECT_FALSE(expect_to_hold(each).symmetry);
}

/// A group without an inner one is the group of the other model.
TEST(Tree, OneGroupHasAsManyStatesAsInTheOtherModel) {
  for (std::uint8_t slaves = 1; slaves <= 2; ++slaves) {
    Query query = tree(slaves, 0, false, 2, {Fault::crash});
    query.symmetry = false;
    const SearchResult other = ask(query);
    TreeModel model(query);
    Interner<State, decltype([](const State& state) { return static_cast<std::size_t>(state.hash()); })> seen;
    for (const Beginning& beginning : model.beginnings()) seen.intern(beginning.state);
    Next next;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const State state = seen[static_cast<std::uint32_t>(i)];
      for (const Action action : model.actions())
        if (model.act(state, action, next)) seen.intern(next.state);
    }
    EXPECT_EQ(seen.size(), other.states);
  }
}

Effect change(PublishedState from, PublishedState to, std::uint8_t transition, std::uint32_t run) {
  Effect effect;
  effect.change_count = 1;
  effect.change[0] = {transition, from, to};
  effect.run = run;
  return effect;
}

/// Outer master 0, node 1; inner master 2, inner slave 3.
class Watched : public testing::Test {
 protected:
  PropertySet init(std::size_t who) {
    return observer.on_effect(shape.tree(), who, change(PublishedState::Halted, PublishedState::HaltedInit, 0, 0));
  }
  PropertySet ready(std::size_t who, std::uint32_t run) {
    return observer.on_effect(shape.tree(), who, change(PublishedState::HaltedInit, PublishedState::Ready, 1, run));
  }
  PropertySet running(std::size_t who, std::uint32_t run) {
    return observer.on_effect(shape.tree(), who, change(PublishedState::Ready, PublishedState::Running, 2, run));
  }
  void started() {
    Effect effect = change(PublishedState::Halted, PublishedState::HaltedInit, 0, 0);
    effect.started_run = inner;
    effect.outer_run = outer;
    observer.on_effect(shape.tree(), 2, effect);
  }
  static constexpr std::uint32_t outer = 7, inner = 9;
  TreeShape shape{tree(1, 1, false, 1, {})};
  SmallObserver observer{handshake::Variant::robust, shape.tree()};
};

TEST_F(Watched, ARightStartViolatesNothing) {
  for (const std::size_t who : {0U, 1U, 3U}) init(who);
  started();
  PropertySet all;
  for (const std::size_t who : {3U, 1U, 0U}) all.bits |= ready(who, who == 3 ? inner : outer).bits;
  all.bits |= ready(2, inner).bits;
  all.bits |= running(3, inner).bits | running(2, inner).bits | running(1, outer).bits | running(0, outer).bits;
  EXPECT_EQ(all.bits, 0U);
}

TEST_F(Watched, RunningBeforeTheOuterMasterWasReadyIsSeen) {
  for (const std::size_t who : {0U, 1U, 3U}) init(who);
  started();
  ready(3, inner);
  ready(1, outer);
  ready(2, inner);
  EXPECT_TRUE(running(3, inner).contains(Property::S1));
}

TEST_F(Watched, ANodeThatIsReadyBeforeItsInnerGroupIsSeen) {
  for (const std::size_t who : {0U, 1U, 3U}) init(who);
  started();
  EXPECT_TRUE(ready(1, outer).contains(Property::S1));
}

TEST_F(Watched, ANodeThatRunsBeforeItsInnerGroupIsSeen) {
  for (const std::size_t who : {0U, 1U, 3U}) init(who);
  started();
  for (const std::size_t who : {3U, 1U, 0U}) ready(who, who == 3 ? inner : outer);
  EXPECT_TRUE(running(1, outer).contains(Property::S2));
}

TEST_F(Watched, ARunThatNobodyStartedFromOutsideIsSeen) {
  init(2);
  init(3);
  ready(3, inner);
  ready(2, inner);
  EXPECT_TRUE(running(3, inner).contains(Property::S1));
}

/// The same with the participants and the observer of the tests of the handshake.
/// Whether everybody was Running once.
bool walk(const Query& query, std::uint64_t seed, int length) {
  TreeModel model(query);
  const TreeShape& shape = model.tree();
  std::vector<handshake::TreeGroup> groups{{shape.size(0), 0, 0}};
  if (shape.groups() == 2) groups.push_back({shape.size(1), 0, shape.size(0) - 1});
  handshake::Tree real(groups);
  bool has_joined = !query.joining;
  State state = model.switched_on();
  state.set_commands_left(most_commands);
  state.set_faults_left(7);
  std::mt19937_64 dice(seed);
  bool ran = false;
  Next next;
  for (int i = 0; i < length; ++i) {
    // Most actions are the network's, or nobody would ever be Running.
    const std::span<const Action> choice = dice() % 150 != 0 ? model.network_actions() : model.actions();
    Action action = choice[dice() % choice.size()];
    if (i % 150 == 0)
      action = {ActionKind::call, 0, static_cast<std::uint8_t>(program::index_of(program::Method::Start))};
    if (i % 150 == 20 && !has_joined)
      action = {ActionKind::restart, static_cast<std::uint8_t>(shape.joining_node()), 0};
    if (!model.act(state, action, next)) continue;
    const bool of_channel =
        action.kind == ActionKind::send || action.kind == ActionKind::receive || action.kind == ActionKind::lose;
    const std::size_t participant =
        action.kind == ActionKind::receive ? shape.channel(action.who).receiver : action.who;
    const std::size_t group = shape.group_of(participant < shape.participants() ? participant : 0);
    const std::size_t index = shape.index_of(participant < shape.participants() ? participant : 0);
    switch (action.kind) {
      case ActionKind::receive:
        real.step(group, index,
                  handshake::Input::received(shape.channel(action.who).peer, model.word_in(state, action.who), 1));
        break;
      case ActionKind::initialised:
        real.step(group, index, handshake::Input::initialised(model.word(state, participant).intent.run));
        break;
      case ActionKind::silence:
      case ActionKind::timeout:
        real.step(group, index, handshake::Input::peer_silent(action.what));
        break;
      case ActionKind::call:
        EXPECT_TRUE(program::is_good(real.call(group, index, program::methods[action.what].method)));
        break;
      case ActionKind::finish:
        real.step(group, index, handshake::Input::finished());
        break;
      case ActionKind::restart:
        if (has_joined || action.who != shape.joining_node()) real.restart(action.who);
        has_joined = has_joined || action.who == shape.joining_node();
        break;
      default:
        EXPECT_TRUE(of_channel || action.kind == ActionKind::crash);
        break;
    }
    EXPECT_EQ(next.properties.bits & 0x7FU, 0U);
    state = next.state;
    ran = ran || model.all_running(state);
    for (std::size_t p = 0; p < shape.participants(); ++p) {
      if (model.is_down(state, p)) continue;
      EXPECT_EQ(real.member(shape.group_of(p), shape.index_of(p)).word(), model.word(state, p))
          << "step " << i << ", " << shape.name(p);
    }
  }
  EXPECT_TRUE(real.observer.violations().empty()) << real.describe();
  return ran;
}

TEST(Tree, WalksAsTheHandshakeDoes) {
  int ran = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    ran += walk(tree(2, 2, false, 8, {Fault::loss, Fault::crash, Fault::restart, Fault::timeout}), seed, 600);
    ran += walk(tree(1, 1, true, 8, {Fault::crash, Fault::restart}), seed, 600);
    ran += walk(tree(2, 0, true, 8, {Fault::crash, Fault::timeout}), seed, 600);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(ran, 10);
}

TEST(Tree, AChartNamesBothGroups) {
  Query query = tree(1, 1, true, 1, {});
  query.beginnings = Beginnings::switched_on;
  const SearchResult result = ask(query);
  ASSERT_EQ(result[Property::all_running], PropertyVerdict::reached);
  const Trace& trace = *result.traces[index_of(Property::all_running)];
  const std::string text = chart(query, result.beginnings[trace.beginning], trace);
  for (const char* part : {"master         slave 1        inner master   inner slave 1\n", "inner slave 1 comes up",
                           "Start is called at the master", "inner master hears inner slave 1: Ready",
                           "      Running        Running        Running        Running\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Tree, ACutSearchDecidesNoLiveness) {
  Query query = tree(1, 1, false, 2, {Fault::crash});
  query.states = 1000;
  const SearchResult result = ask(query);
  EXPECT_FALSE(result.exhausted);
  EXPECT_EQ(result.states, 1000U);
  EXPECT_EQ(result[Property::L1], PropertyVerdict::unknown);
  EXPECT_EQ(result[Property::F1], PropertyVerdict::unknown);
}

}  // namespace
}  // namespace takt::explore
