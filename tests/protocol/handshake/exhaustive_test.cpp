// SPDX-License-Identifier: Apache-2.0
// `robust` in every order: small groups, few commands and faults, channels of one word that lose and delay.
//
// The explorer of takt will do this in general; here it guards the rules where they stand.
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "handshake/observer.hpp"
#include "handshake/participant.hpp"

namespace takt::handshake {
namespace {

using Member = Participant<4>;

struct Budget {
  int commands = 0;
  int restarts = 0;
  int silences = 0;
  int finishes = 0;
};

/// A channel holds the word last sent and not yet received; sending again overwrites it (loss).
struct Channel {
  bool full = false;
  Word word;
  std::uint32_t sent_in = 0;
};

struct State {
  std::vector<Member> members;
  std::vector<Channel> up;    ///< slave i + 1 to master
  std::vector<Channel> down;  ///< master to slave i + 1
  Observer observer;
  Budget left;

  Config config(std::size_t i, std::uint32_t incarnation) const {
    return {Variant::robust, i == 0 ? Role::master : Role::slave, static_cast<std::uint8_t>(i),
            static_cast<std::uint8_t>(up.size()), incarnation};
  }
  State(std::size_t slaves, Budget budget)
      : up(slaves), down(slaves), observer(Variant::robust, slaves + 1), left(budget) {
    for (std::size_t i = 0; i <= slaves; ++i) members.emplace_back(config(i, 1));
  }

  Outputs step(std::size_t i, const Input& input) {
    const Outputs outputs = members[i].step(input);
    observer.on_step(i, outputs, members[i].word());
    return outputs;
  }
  void send(std::size_t from, Channel& channel) { channel = {true, members[from].word(), observer.sending_run(from)}; }
  void receive(std::size_t from, std::size_t to, Channel& channel) {
    const Channel taken = channel;
    channel = {};
    const std::size_t peer = members[to].peer_of(from);
    const Outputs outputs = step(to, Input::received(peer, taken.word, 0));
    if (taken.sent_in != 0 && !outputs.ignored && members[to].process_data_counts(peer))
      observer.on_process_data(from, to, taken.sent_in);
  }
  /// The initialisation that is under way, if any, ends.
  void initialise(std::size_t i) {
    if (members[i].state() == PublishedState::HaltedInit) step(i, Input::initialised(members[i].intent().run));
  }
  void restart(std::size_t i) {
    members[i] = Member(config(i, members[i].config().incarnation + 1));
    observer.on_restart(i);
  }
  bool agreed() const {
    for (const Member& member : members)
      if (member.intent() != members[0].intent() || member.state() != goal_of(member.intent().kind)) return false;
    return true;
  }
  std::uint64_t hash() const {
    std::uint64_t digest = observer.hash();
    const auto mix = [&digest](std::uint64_t value) {
      digest = (digest ^ value) * 0x9E3779B97F4A7C15ULL;
      digest ^= digest >> 31;
    };
    for (const Member& member : members) mix(member.hash());
    for (const std::vector<Channel>* channels : {&up, &down})
      for (const Channel& each : *channels) {
        mix(each.full);
        if (!each.full) continue;
        const Word& word = each.word;
        mix(std::uint64_t{word.incarnation} << 32 | word.run);
        mix(index_of(word.state) | index_of(word.intent.kind) << 8 | std::uint64_t{word.intent.origin} << 16 |
            std::uint64_t{word.intent.number} << 32);
        mix(std::uint64_t{word.intent.run} << 32 | each.sent_in);
      }
    mix(static_cast<std::uint64_t>(left.commands + 8 * left.restarts + 64 * left.silences + 512 * left.finishes));
    return digest;
  }
};

/// All states that one action leads to.
void successors(const State& state, const std::function<void(State&&)>& found) {
  const auto with = [&](auto&& change) {
    State next = state;
    change(next);
    found(std::move(next));
  };
  for (std::size_t i = 0; i < state.members.size(); ++i) {
    const Member& member = state.members[i];
    if (member.state() == PublishedState::HaltedInit) with([i](State& s) { s.initialise(i); });
    if (state.left.commands > 0) {
      for (const program::MethodInfo& method : program::methods) {
        State next = state;
        --next.left.commands;
        if (program::is_good(next.step(i, Input::command(method.method)).status)) found(std::move(next));
      }
    }
    if (state.left.finishes > 0 && member.state() == PublishedState::Running)
      with([i](State& s) {
        --s.left.finishes;
        s.step(i, Input::finished());
      });
    if (state.left.restarts > 0)
      with([i](State& s) {
        --s.left.restarts;
        s.restart(i);
      });
    if (state.left.silences > 0 && member.state() != PublishedState::Halted)
      with([i](State& s) {
        --s.left.silences;
        s.step(i, Input::peer_silent(0));
      });
  }
  for (std::size_t c = 0; c < state.up.size(); ++c) {
    with([c](State& s) { s.send(c + 1, s.up[c]); });
    with([c](State& s) { s.send(0, s.down[c]); });
    if (state.up[c].full) with([c](State& s) { s.receive(c + 1, 0, s.up[c]); });
    if (state.down[c].full) with([c](State& s) { s.receive(0, c + 1, s.down[c]); });
  }
}

/// L1: whatever the state, a few fair rounds without new commands and faults lead to agreement.
bool settles(State state) {
  for (int round = 0; round < 8; ++round) {
    for (std::size_t c = 0; c < state.up.size(); ++c) {
      if (state.up[c].full) state.receive(c + 1, 0, state.up[c]);
      if (state.down[c].full) state.receive(0, c + 1, state.down[c]);
    }
    for (std::size_t i = 0; i < state.members.size(); ++i) state.initialise(i);
    for (std::size_t c = 0; c < state.up.size(); ++c) {
      state.send(c + 1, state.up[c]);
      state.send(0, state.down[c]);
    }
  }
  return state.agreed() && state.observer.violations().empty();
}

std::size_t explore(std::size_t slaves, Budget budget) {
  std::unordered_set<std::uint64_t> seen;  // hash compaction: enough for a test
  std::deque<State> open{State(slaves, budget)};
  seen.insert(open.front().hash());
  while (!open.empty()) {
    const State state = std::move(open.front());
    open.pop_front();
    if (!state.observer.violations().empty()) {
      ADD_FAILURE() << name_of(state.observer.violations()[0].invariant);
      break;
    }
    if (!settles(state)) {
      ADD_FAILURE() << "L1: no agreement";
      break;
    }
    successors(state, [&](State&& next) {
      if (seen.insert(next.hash()).second) open.push_back(std::move(next));
    });
  }
  return seen.size();
}

struct Bound {
  std::size_t slaves;
  Budget budget;  ///< commands, restarts, silences, finishes
  std::size_t states;
};

// The counts are those of the present rules; they change with any rule, and a smaller one may mean a dead branch.
#ifdef NDEBUG
constexpr Bound bounds[]{{1, {5, 0, 0, 0}, 41829}, {1, {3, 1, 0, 0}, 60481},  {1, {2, 2, 0, 0}, 111635},
                         {1, {3, 0, 1, 1}, 60668}, {1, {2, 1, 1, 1}, 185137}, {2, {2, 0, 0, 0}, 62122},
                         {2, {1, 0, 1, 0}, 99210}, {2, {1, 1, 0, 0}, 285901}, {2, {1, 0, 0, 1}, 11756}};
#else
constexpr Bound bounds[]{
    {1, {3, 0, 0, 0}, 3074}, {1, {2, 1, 0, 0}, 13142}, {1, {1, 0, 1, 1}, 1636}, {2, {1, 0, 0, 0}, 9292}};
#endif

TEST(Exhaustive, NoOrderBreaksAnInvariantAndAllSettle) {
  for (const Bound& bound : bounds) {
    const Budget& budget = bound.budget;
    SCOPED_TRACE(testing::Message() << bound.slaves << " slaves, " << budget.commands << " commands, "
                                    << budget.restarts << " restarts, " << budget.silences << " silences, "
                                    << budget.finishes << " finishes");
    EXPECT_EQ(explore(bound.slaves, budget), bound.states);
  }
}

}  // namespace
}  // namespace takt::handshake
