// SPDX-License-Identifier: Apache-2.0
// The search and the observer side by side: random walks through the model, each played again with the real
// participants, the real Observer and real sequence numbers.
#include <gtest/gtest.h>

#include <algorithm>

#include "explore/model/group_model.hpp"
#include "explore/report/replay.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {
namespace {

using handshake::Variant;

/// Numbers that are the same everywhere.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t count) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33) % count);
  }

 private:
  std::uint64_t state_;
};

struct Walk {
  Trace trace;
  std::vector<State> states;
  std::vector<PropertySet> properties;
};

/// All but what a stranger says.
constexpr Fault true_faults[] = {Fault::loss,  Fault::duplicate, Fault::reorder,
                                 Fault::crash, Fault::restart,   Fault::timeout};

/// Those that do not go with replays.
constexpr bool is_replayed_anyway(Fault fault) { return fault == Fault::duplicate || fault == Fault::reorder; }

/// `forgery`: of so many steps about one is a forged word.
Walk walk(GroupModel& model, std::uint64_t seed, std::size_t length, std::size_t forgery = 0) {
  Dice dice(seed);
  const auto forged =
      static_cast<std::size_t>(std::find_if(model.actions().begin(), model.actions().end(),
                                            [](const Action& each) {
                                              return each.kind == ActionKind::forge || each.kind == ActionKind::replay;
                                            }) -
                               model.actions().begin());
  Walk result;
  result.trace.beginning = dice.below(model.beginnings().size());
  State now = model.beginnings()[result.trace.beginning].state;
  for (std::size_t i = 0; i < 40 * length && result.trace.actions.size() < length; ++i) {
    const bool forges = forgery != 0 && dice.below(forgery) == 0;
    const Action action =
        model.actions()[forges ? forged + dice.below(model.actions().size() - forged) : dice.below(forged)];
    Next next;
    if (!forges && !is_network(action.kind) && dice.below(4) != 0) continue;
    if (!model.act(now, action, next)) continue;
    now = next.state;
    result.trace.actions.push_back(action);
    result.states.push_back(now);
    result.properties.push_back(next.properties);
  }
  return result;
}

std::uint32_t invariants_of(const ReplayStep& done) {
  PropertySet set;
  for (const handshake::Violation& each : done.violations) set.insert(static_cast<Property>(each.invariant));
  return set.bits;
}

void compare(Variant variant, std::uint8_t slaves, std::uint64_t walks, Query query = {}, std::size_t forgery = 0) {
  query.variant = variant;
  query.slaves = slaves;
  query.commands = 6;
  query.fault_budget = 4;
  for (const Fault fault : true_faults)
    if (!query.has_recordings() || !is_replayed_anyway(fault)) query.faults.insert(fault);
  if (forgery != 0 && !query.has_recordings()) query.faults.insert(Fault::forge);
  const bool is_judged = forgery == 0 || query.has_recordings();
  GroupModel model(query);
  std::size_t violations = 0;
  for (std::uint64_t seed = 0; seed < walks; ++seed) {
    const Walk taken = walk(model, seed, 60, forgery);
    const Replay replayed = replay(query, model.beginnings()[taken.trace.beginning], taken.trace);
    ASSERT_EQ(replayed.steps.size(), taken.states.size());
    for (std::size_t i = 0; i < replayed.steps.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", step " << i);
      for (std::size_t p = 0; p <= slaves; ++p) {
        const Members::Traits& member = model.members()[taken.states[i].member(p)];
        ASSERT_EQ(member.down, replayed.steps[i].down[p]);
        if (!member.down) {
          ASSERT_EQ(member.state, replayed.steps[i].states[p]);
        }
      }
      constexpr std::uint32_t safety = 0x1F;  // S1 to S5
      if (is_judged) {
        ASSERT_EQ(taken.properties[i].bits & safety, invariants_of(replayed.steps[i]));
      }
      violations += replayed.steps[i].violations.size();
    }
  }
  if (is_judged) {
    EXPECT_EQ(violations > 0, variant == Variant::paper);
  }
}

TEST(Walks, RobustDoesTheSameInTheModelAndInTheOpen) {
  for (std::uint8_t slaves = 1; slaves <= 3; ++slaves) compare(Variant::robust, slaves, 500);
}
TEST(Walks, PaperDoesTheSameInTheModelAndInTheOpen) {
  for (std::uint8_t slaves = 1; slaves <= 3; ++slaves) compare(Variant::paper, slaves, 500);
}

TEST(Walks, AllToAllDoesTheSameInTheModelAndInTheOpen) {
  Query query;
  query.subscription = handshake::Subscription::all_to_all;
  for (const Variant variant : {Variant::robust, Variant::paper})
    for (std::uint8_t slaves = 2; slaves <= 3; ++slaves) compare(variant, slaves, 500, query);
}
// What a stranger says is heard in the open as it is in the model. (There S1 to S5 are not judged while it may do
// harm.)
TEST(Walks, ForgedWordsDoTheSameInTheModelAndInTheOpen) {
  Query query;
  compare(Variant::robust, 1, 500, query, 20);
  compare(Variant::robust, 2, 500, query, 20);
  query.network = Network::channels;
  compare(Variant::robust, 2, 500, query, 20);
}
// Where the model takes a word that is handed over again, the real windows of a receiver take it.
TEST(Walks, ReplayedWordsDoTheSameInTheModelAndInTheOpen) {
  Query query;
  query.faults.insert(Fault::replay);
  for (std::uint8_t slaves = 1; slaves <= 3; ++slaves) compare(Variant::robust, slaves, 500, query, 5);
  query.is_signed = true;
  query.key_changes = 2;
  for (std::uint8_t slaves = 1; slaves <= 3; ++slaves) compare(Variant::robust, slaves, 500, query, 5);
  query.subscription = handshake::Subscription::all_to_all;
  compare(Variant::robust, 3, 500, query, 5);
}
TEST(Walks, ChannelsDoTheSameInTheModelAndInTheOpen) {
  Query query;
  query.network = Network::channels;
  // One message overtaken at a time in each channel: then the model's sequence numbers are exact (README.md).
  for (query.capacity = 1; query.capacity <= 2; ++query.capacity)
    for (const Variant variant : {Variant::robust, Variant::paper})
      for (std::uint8_t slaves = 1; slaves <= 3; ++slaves) compare(variant, slaves, 500, query);
}

// Other names, same behaviour: what a step does under other names is what it does, renamed.
TEST(Symmetry, StepsCommuteWithNames) {
  Query query;
  query.slaves = 3;
  query.commands = 6;
  query.fault_budget = 4;
  for (const Fault fault : true_faults) query.faults.insert(fault);
  for (int kind = 0; kind < 6; ++kind) {
    query.variant = kind % 2 == 0 ? Variant::robust : Variant::paper;
    query.subscription = kind / 2 == 1 ? handshake::Subscription::all_to_all : handshake::Subscription::star;
    query.network = kind / 2 == 2 ? Network::channels : Network::registers;
    SCOPED_TRACE(kind);
    GroupModel model(query);
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const Walk taken = walk(model, seed, 60);
      for (const State& state : taken.states) {
        const State once = model.canonical(state);
        EXPECT_EQ(model.canonical(once), once);
        EXPECT_EQ(model.settled(once), model.settled(state));
      }
    }
    EXPECT_TRUE(model.symmetric());
  }
}

}  // namespace
}  // namespace takt::explore
