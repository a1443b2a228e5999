// SPDX-License-Identifier: Apache-2.0
// `robust` under random schedules: loss, delay, duplication, reordering, crash and restart, silence, any command at any
// time. S1 to S5 never break; once the faults end all agree (L1); a silent peer halts all (F1).
//
// A schedule is a list of small actions made from its seed, so a failing one can be cut down and is printed.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "group.hpp"
#include "schedule.hpp"

namespace takt::handshake {
namespace {

enum class Act : std::uint8_t { Publish, Deliver, Duplicate, Drop, Initialised, Call, Finish, Silent, Restart };
using Action = handshake::Action<Act>;  // a: a participant or a message under way

constexpr const char* act_names[]{"publish", "deliver", "duplicate", "drop",   "initialised",
                                  "call",    "finish",  "silent",    "restart"};

std::vector<Action> make_schedule(std::uint64_t seed, std::size_t participants, std::size_t length) {
  Dice dice(seed);
  // Faults and commands are rarer than progress, or nothing would ever run; how rare differs from schedule to schedule.
  const auto rarity = static_cast<std::uint32_t>((1 + dice.below(10)) * participants);
  std::vector<Action> schedule;
  for (std::size_t i = 0; i < length; ++i) {
    Action action;
    const std::uint32_t face = dice.below(12 * rarity + 14);
    if (face < 5 * rarity)
      action.act = Act::Publish;
    else if (face < 10 * rarity)
      action.act = Act::Deliver;
    else if (face < 12 * rarity)
      action.act = Act::Initialised;
    else if (face < 12 * rarity + 7)
      action.act = Act::Call;
    else
      action.act = std::array{Act::Duplicate, Act::Duplicate, Act::Drop,   Act::Drop,
                              Act::Finish,    Act::Silent,    Act::Restart}[face - 12 * rarity - 7];
    action.a = dice.below(static_cast<std::uint32_t>(action.act == Act::Deliver ? 1000 : participants * 4));
    action.b = dice.below(1000);
    schedule.push_back(action);
  }
  return schedule;
}

/// A group with a network that keeps words under way, and delivers them in any order.
class World {
 public:
  explicit World(Variant variant, std::size_t slaves, Subscription subscription = Subscription::star)
      : group(variant, slaves, subscription) {}

  void act(const Action& action) {
    const std::size_t who = action.a % group.size();
    switch (action.act) {
      case Act::Publish:
        publish(who);
        break;
      case Act::Deliver:
        under_way.deliver(action.a, action.b, group.size(), [this](const Message& message) { group.deliver(message); });
        break;
      case Act::Duplicate:
        if (!under_way.empty()) group.deliver(Message(under_way[action.b % under_way.size()]));
        break;
      case Act::Drop:
        if (!under_way.empty()) under_way.take(action.b % under_way.size());
        break;
      case Act::Initialised:
        if (group.initialising(who)) group.initialised(who);
        break;
      case Act::Call:
        call(who, action.b);
        break;
      case Act::Finish:
        group.step(who, Input::finished());
        break;
      case Act::Silent:
        group.step(who, Input::peer_silent(action.b % group[who].peer_count()));
        break;
      case Act::Restart:
        group.restart(who);
        break;
    }
  }

  void publish(std::size_t from) {
    for (std::size_t peer = 0; peer < group[from].peer_count(); ++peer)
      under_way.put(group.message(from, group[from].participant_of(peer)));
  }
  void call(std::size_t who, std::uint32_t b) {
    // A start is worth trying more often than the rest, and only the master can.
    if (b % 3 == 0)
      group.call(0, program::Method::Start);
    else
      group.call(who, program::methods[b % 5].method);
  }

  Group group;
  UnderWay<Message> under_way{40};
};

/// What is wrong with a schedule; empty if nothing.
enum class Begin : std::uint8_t { New, Running };
std::string run(const std::vector<Action>& schedule, std::size_t slaves, Begin begin, bool* ran = nullptr,
                Subscription subscription = Subscription::star) {
  World world(Variant::robust, slaves, subscription);
  if (begin == Begin::Running) {
    world.call(0, 0);
    world.group.rounds(4);
    if (!world.group.all_in(PublishedState::Running)) return "a fair start failed\n" + world.group.describe();
  }
  for (const Action& action : schedule) {
    world.act(action);
    if (!world.group.observer.violations().empty()) return "violation\n" + world.group.describe();
    if (ran != nullptr && world.group.all_in(PublishedState::Running)) *ran = true;
  }
  // The faults end: what is under way still arrives, then words are exchanged fairly.
  while (!world.under_way.empty()) world.group.deliver(world.under_way.take(0));
  world.group.rounds(10);
  if (!world.group.observer.violations().empty()) return "violation at the end\n" + world.group.describe();
  if (!world.group.agreed()) return "L1: no agreement\n" + world.group.describe();

  // F1: somebody falls silent; whoever listens to it notices, and all the others hear of it.
  const std::size_t silent = schedule.size() % world.group.size();
  for (std::size_t i = 0; i < world.group.size(); ++i) {
    if (i != silent && (i == 0 || silent == 0)) world.group.step(i, Input::peer_silent(world.group[i].peer_of(silent)));
  }
  for (int round = 0; round < 3; ++round)
    for (std::size_t i = 0; i < world.group.size(); ++i)
      if (i != silent && silent != 0) {
        if (i != 0)
          world.group.tell(i, 0);
        else
          for (std::size_t to = 1; to < world.group.size(); ++to)
            if (to != silent) world.group.tell(0, to);
      }
  for (std::size_t i = 0; i < world.group.size(); ++i)
    if (i != silent && world.group[i].state() != PublishedState::Halted)
      return "F1: not halted\n" + world.group.describe();
  // The silent one comes back: it follows into Halted as well.
  world.group.rounds(3);
  if (!world.group.agreed()) return "L1 after silence: no agreement\n" + world.group.describe();
  return {};
}

class Schedules : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Slaves, Schedules, testing::Range(1, 9));

TEST_P(Schedules, NothingBreaksAndAllAgreeInTheEnd) {
  const auto slaves = static_cast<std::size_t>(GetParam());
  const std::uint64_t count = schedules_wanted(4000, 400);
  std::uint64_t that_ran = 0;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    const std::vector<Action> schedule = make_schedule(seed, slaves + 1, 60 + seed % 300 * slaves);
    const Begin begin = seed % 2 == 0 ? Begin::New : Begin::Running;
    bool ran = false;
    const std::string wrong = run(schedule, slaves, begin, &ran);
    if (begin == Begin::New) that_ran += ran ? 1 : 0;
    if (wrong.empty()) continue;
    const std::vector<Action> least =
        shrink(schedule, [&](const std::vector<Action>& shorter) { return run(shorter, slaves, begin).empty(); });
    FAIL() << "seed " << seed << ", " << slaves << " slaves" << (begin == Begin::Running ? ", running" : "") << ": "
           << wrong << "cut down to:\n"
           << print(least, act_names) << run(least, slaves, begin);
  }
  // A harness in which the group never gets to Running would prove nothing.
  EXPECT_GT(that_ran * 10, count / 2) << that_ran << " of " << count / 2 << " schedules brought everybody to Running";
  RecordProperty("that_ran", static_cast<int>(that_ran));
}

TEST_P(Schedules, AllToAllNothingBreaksEither) {
  const auto slaves = static_cast<std::size_t>(GetParam());
  std::uint64_t that_ran = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const std::vector<Action> schedule = make_schedule(seed, slaves + 1, 60 + seed % 300 * slaves);
    bool ran = false;
    const std::string wrong =
        run(schedule, slaves, seed % 2 == 0 ? Begin::New : Begin::Running, &ran, Subscription::all_to_all);
    that_ran += ran ? 1 : 0;
    ASSERT_TRUE(wrong.empty()) << "seed " << seed << ", " << slaves << " slaves: " << wrong
                               << print(schedule, act_names);
  }
  EXPECT_GT(that_ran, 1000u);  // the thousand that begin so, and some more
}

// `paper` breaks S1 to S3 and never settles under such schedules (weakness_test.cpp), but its machine stays the
// standard's.
TEST_P(Schedules, PaperKeepsS4AndS5) {
  const auto slaves = static_cast<std::size_t>(GetParam());
  bool broke_s1 = false;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    World world(Variant::paper, slaves);
    for (const Action& action : make_schedule(seed, slaves + 1, 60 + seed % 300 * slaves)) world.act(action);
    for (const Violation& violation : world.group.observer.violations()) {
      EXPECT_NE(violation.invariant, Invariant::S4) << "seed " << seed;
      EXPECT_NE(violation.invariant, Invariant::S5) << "seed " << seed;
      broke_s1 = broke_s1 || violation.invariant == Invariant::S1;
    }
  }
  EXPECT_TRUE(broke_s1 || slaves == 1) << "what robust is measured against finds nothing in paper";
}

}  // namespace
}  // namespace takt::handshake
