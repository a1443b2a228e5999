// SPDX-License-Identifier: Apache-2.0
// Cycles judged by another way: a greatest fixed point over the whole graph (Emerson and Lei) instead of components and
// participants that go round.
#include <gtest/gtest.h>

#include <vector>

#include "../ask.hpp"
#include "explore/model/group_model.hpp"
#include "explore/properties/recurrence.hpp"

namespace takt::explore {
namespace {

using handshake::Variant;

/// The graph of a small query, told apart: for each state where each network action leads.
class Whole {
 public:
  explicit Whole(const Query& query) : model_(query) {
    for (const Beginning& beginning : model_.beginnings()) states_.intern(beginning.state);
    Next next;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const State from = states_[i];
      for (const Action& action : model_.actions()) {
        const bool moves = model_.act(from, action, next);
        const std::uint32_t to = moves ? states_.intern(next.state) : static_cast<std::uint32_t>(i);
        if (is_network(action.kind)) to_.push_back(to);
      }
    }
  }
  std::size_t size() const { return states_.size(); }

  /// A fair run visits such states again and again. A state stays in the set while each action, and such a state, can
  /// be reached within it.
  template <class Wanted>
  bool fair_run_visits(Wanted&& wanted) {
    std::vector<bool> in(size(), true);
    const std::size_t actions = model_.network_actions().size();
    for (bool again = true; again;) {
      again = false;
      for (std::size_t constraint = 0; constraint <= actions; ++constraint) {
        std::vector<bool> reaches(size(), false);
        for (std::size_t i = 0; i < size(); ++i) {
          if (!in[i]) continue;
          reaches[i] = constraint < actions ? in[to_[i * actions + constraint]] : wanted(states_[i]);
        }
        spread(in, reaches);
        for (std::size_t i = 0; i < size(); ++i) {
          if (!in[i] || reaches[i]) continue;
          in[i] = false;
          again = true;
        }
      }
    }
    return std::find(in.begin(), in.end(), true) != in.end();
  }
  GroupModel& model() { return model_; }

 private:
  /// Whoever has a successor that reaches it, reaches it.
  void spread(const std::vector<bool>& in, std::vector<bool>& reaches) const {
    const std::size_t actions = to_.size() / size();
    for (bool again = true; again;) {
      again = false;
      for (std::size_t i = size(); i-- > 0;) {
        if (!in[i] || reaches[i]) continue;
        for (std::size_t a = 0; a < actions && !reaches[i]; ++a)
          reaches[i] = in[to_[i * actions + a]] && reaches[to_[i * actions + a]];
        again = again || reaches[i];
      }
    }
  }
  struct HashOfState {
    std::size_t operator()(const State& state) const { return state.hash(); }
  };
  GroupModel model_;
  Interner<State, HashOfState> states_;
  std::vector<std::uint32_t> to_;
};

Query small(Variant variant, std::uint8_t slaves, std::uint32_t commands, std::initializer_list<Fault> faults) {
  Query query;
  query.variant = variant;
  query.slaves = slaves;
  query.symmetry = false;
  return with(query, commands, faults);
}

void compare(const Query& query) {
  Whole whole(query);
  GroupModel& model = whole.model();
  const bool unsettled =
      whole.fair_run_visits([&](const State& state) { return !model.settled(state) && !model.anybody_down(state); });
  const bool unhalted =
      whole.fair_run_visits([&](const State& state) { return !model.settled(state) && model.anybody_down(state); });
  Query asked = query;
  for (const bool symmetry : {false, true}) {
    asked.symmetry = symmetry;
    const SearchResult result = ask(asked);
    EXPECT_EQ(result[Property::L1] == PropertyVerdict::violated, unsettled) << symmetry;
    if (query.asks_for_silence() && query.variant == Variant::robust) {
      EXPECT_EQ(result[Property::F1] == PropertyVerdict::violated, unhalted) << symmetry;
    }
  }
}

TEST(Liveness, RobustAgreesWithTheFixedPoint) {
  compare(small(Variant::robust, 1, 3, {}));
  compare(small(Variant::robust, 1, 1, {Fault::crash, Fault::reorder}));
  compare(small(Variant::robust, 2, 1, {}));
}

TEST(Liveness, PaperAgreesWithTheFixedPoint) {
  for (std::uint32_t commands = 0; commands <= 2; ++commands) compare(small(Variant::paper, 1, commands, {}));
  compare(small(Variant::paper, 2, 1, {}));
  compare(small(Variant::paper, 1, 1, {Fault::loss, Fault::crash}));
}

TEST(Liveness, ChannelsAgreeWithTheFixedPoint) {
  for (const Variant variant : {Variant::robust, Variant::paper}) {
    Query query = small(variant, 1, 2, {});
    query.network = Network::channels;
    compare(query);
    query = small(variant, 2, 0, {});
    query.network = Network::channels;
    query.capacity = 1;
    compare(query);
    query.faults.insert(Fault::crash);
    compare(query);
  }
}

// Only `paper` lets somebody go round: its suspend and resume chase each other.
TEST(Recurrence, NamesWhoGoesRound) {
  for (const Variant variant : {Variant::robust, Variant::paper}) {
    Whole whole(small(variant, 1, 2, {Fault::loss, Fault::crash}));
    const std::vector<bool> round = members_that_go_round(whole.model().members(), 1);
    EXPECT_EQ(std::find(round.begin(), round.end(), true) != round.end(), variant == Variant::paper);
  }
}

}  // namespace
}  // namespace takt::explore
