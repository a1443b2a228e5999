// SPDX-License-Identifier: Apache-2.0
// Joining, leaving, crashes and silence in every order: a group with one role and few nodes, whose messages are sampled
// registers.
//
// A register holds what was last sent on it: later sending overwrites (loss), and the same may be heard again. What is
// counted in a run is its budget; sending and hearing cost nothing and may happen at any time.
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <map>
#include <tuple>
#include <unordered_set>

#include "roles.hpp"

namespace takt::handshake {
namespace {

struct Budget {
  int commands = 0;
  int memberships = 0;  ///< joins and leaves
  int restarts = 0;
  int silences = 0;  ///< of a peer, or of announcements
};

using Register = std::tuple<RoleMessage::Kind, std::size_t, std::size_t>;  ///< kind, from, to

struct State {
  RoleGroup group;
  std::map<Register, RoleMessage> registers;
  Budget left;
};

void send(State& state, std::size_t station) {
  for (RoleMessage& message : state.group.messages(station)) {
    message.sequence = 0;  // on registers whatever is heard is the newest, or the same again
    state.registers[{message.kind, message.from, message.to}] = message;
  }
}

class Hash {
 public:
  void mix(std::uint64_t value) {
    digest_ = (digest_ ^ value) * 0x9E3779B97F4A7C15ULL;
    digest_ ^= digest_ >> 31;
  }
  void mix(const Binding& binding) { mix(std::uint64_t{binding.candidate} << 32 | binding.life); }
  void mix(const Word& word) {
    mix(std::uint64_t{word.incarnation} << 32 | word.run);
    mix(index_of(word.state) | index_of(word.intent.kind) << 8 | std::uint64_t{word.intent.origin} << 16 |
        std::uint64_t{word.intent.number} << 32);
    mix(word.intent.run);
  }
  void mix(const Announcement& announcement) {
    mix(std::uint64_t{announcement.life} << 1 | (announcement.leaving ? 1 : 0));
  }
  std::uint64_t value() const { return digest_; }

 private:
  std::uint64_t digest_ = 1;
};

std::uint64_t hash_of(const State& state) {
  Hash hash;
  hash.mix(state.group.hash());
  for (const auto& [at, message] : state.registers) {
    hash.mix(static_cast<std::uint64_t>(std::get<0>(at)) << 16 | std::get<1>(at) << 8 | std::get<2>(at));
    hash.mix(message.word);
    hash.mix(std::uint64_t{message.sent_in} << 32 | message.sender);
    hash.mix(message.announcement);
    for (const Binding& binding : message.table) hash.mix(binding);
    hash.mix(message.used_life);
  }
  hash.mix(static_cast<std::uint64_t>(state.left.commands + 16 * state.left.memberships + 256 * state.left.restarts +
                                      4096 * state.left.silences));
  return hash.value();
}

void successors(const State& state, const std::function<void(State&&)>& found) {
  const auto with = [&](auto&& change) {
    State next = state;
    change(next);
    found(std::move(next));
  };
  for (std::size_t station = 0; station < state.group.stations(); ++station) {
    with([&](State& s) { send(s, station); });
    with([&](State& s) { s.group.initialised(station); });
    if (state.left.restarts > 0) with([&](State& s) { --s.left.restarts, s.group.restart(station); });
    if (state.left.silences > 0) with([&](State& s) { --s.left.silences, s.group.silent(station, 0); });
    for (const program::MethodInfo& method : program::methods) {
      if (state.left.commands == 0) break;
      State next = state;
      --next.left.commands;
      if (program::is_good(next.group.call(station, method.method))) found(std::move(next));
    }
    if (station == 0) continue;
    const std::size_t candidate = station - 1;
    if (state.left.silences > 0) with([&](State& s) { --s.left.silences, s.group.announcement_missed(candidate); });
    if (state.left.memberships == 0) continue;
    if (state.group.candidate(candidate).announces())
      with([&](State& s) { --s.left.memberships, s.group.leave(candidate); });
    else
      with([&](State& s) { --s.left.memberships, s.group.join(candidate); });
  }
  for (const auto& each : state.registers) with([&](State& s) { s.group.deliver(each.second); });
}

/// Fair rounds without new calls and faults, in which whoever announces nothing is missed, lead to agreement: whoever
/// announces itself is known, the role has a node if there is one, and all in it have reached what was asked for last.
bool settles(State state) {
  for (const auto& [at, message] : state.registers) state.group.deliver(message);
  for (int round = 0; round < 16; ++round) {
    state.group.round();
    for (std::size_t c = 0; c + 1 < state.group.stations(); ++c)
      if (!state.group.candidate(c).announces()) state.group.announcement_missed(c);
  }
  bool is_there = false;
  for (std::size_t c = 0; c + 1 < state.group.stations(); ++c) {
    const Candidate& candidate = state.group.candidate(c);
    is_there = is_there || (candidate.announces() && !candidate.announcement().leaving);
    if (candidate.announcement().leaving) return false;  // it was to be let go
  }
  if (!state.group.observer.violations().empty() || state.group.binder().complete() != is_there) return false;
  return is_there ? state.group.all_in(goal_of(state.group.master().intent().kind))
                  : state.group.master().state() == PublishedState::Halted;
}

/// How many states there are; `running`: which candidates have had the role while all were Running.
std::size_t explore(std::size_t candidates, bool restarts, const Budget& budget, std::uint64_t& running) {
  const SkillId skill = skill_id("welding");
  State first{RoleGroup({skill}, std::vector<std::vector<SkillId>>(candidates, {skill}), restarts), {}, budget};
  first.group.join(0);
  std::unordered_set<std::uint64_t> seen;  // hash compaction: enough for a test
  std::deque<State> open{std::move(first)};
  seen.insert(hash_of(open.front()));
  while (!open.empty()) {
    const State state = std::move(open.front());
    open.pop_front();
    if (!state.group.observer.violations().empty()) {
      ADD_FAILURE() << "an invariant is violated:\n" << state.group.describe();
      break;
    }
    if (!settles(state)) {
      ADD_FAILURE() << "it does not settle:\n" << state.group.describe();
      break;
    }
    if (state.group.all_in(PublishedState::Running))
      running |= std::uint64_t{1} << state.group.binder().binding(0).candidate;
    successors(state, [&](State&& next) {
      if (seen.insert(hash_of(next)).second) open.push_back(std::move(next));
    });
  }
  return seen.size();
}

struct Bound {
  std::size_t candidates;
  bool restarts;        ///< the master starts again by itself
  Budget budget;        ///< commands, joins and leaves, restarts, silences
  std::size_t running;  ///< so many candidates can be Running in the role
  std::size_t states;
};

// The counts are those of the present rules; they change with any rule, and a smaller one may mean a dead branch.
#ifdef NDEBUG
constexpr Bound bounds[]{{1, false, {1, 2, 0, 0}, 1, 1007},  {1, true, {2, 1, 0, 1}, 1, 26839},
                         {1, true, {1, 1, 1, 1}, 1, 149678}, {2, false, {1, 2, 0, 0}, 2, 10628},
                         {2, true, {1, 2, 0, 0}, 2, 22050},  {2, true, {1, 1, 1, 0}, 2, 89006},
                         {2, true, {1, 1, 0, 1}, 2, 71388}};
#else
constexpr Bound bounds[]{{1, false, {1, 2, 0, 0}, 1, 1007}, {2, false, {1, 2, 0, 0}, 2, 10628}};
#endif

TEST(RolesExhaustive, NoOrderBreaksAnInvariantAndAllSettle) {
  for (const Bound& bound : bounds) {
    SCOPED_TRACE(testing::Message() << bound.candidates << " candidates, " << bound.budget.commands << " commands, "
                                    << bound.budget.memberships << " joins and leaves, " << bound.budget.restarts
                                    << " restarts, " << bound.budget.silences << " silences");
    std::uint64_t running = 0;
    EXPECT_EQ(explore(bound.candidates, bound.restarts, bound.budget, running), bound.states);
    EXPECT_EQ(running, (std::uint64_t{1} << bound.running) - 1);
  }
}

}  // namespace
}  // namespace takt::handshake
