// SPDX-License-Identifier: Apache-2.0
// Nested groups under random schedules: loss, delay, duplication, reordering, crash and restart, silence, any command
// at any node. S1 to S5 of each group and of the tree never break; once the faults end all agree (L1); a silent node
// halts the tree (F1).
//
// A schedule is a list of small actions made from its seed, so a failing one can be cut down and is printed.
#include <gtest/gtest.h>

#include <array>
#include <exception>
#include <string>
#include <vector>

#include "schedule.hpp"
#include "tree.hpp"

namespace takt::handshake {
namespace {

enum class Act : std::uint8_t { Publish, Deliver, Duplicate, Drop, Initialised, Call, Finish, Silent, Restart };
using Action = handshake::Action<Act>;  // a: a participant or a message under way

constexpr const char* act_names[]{"publish", "deliver", "duplicate", "drop",   "initialised",
                                  "call",    "finish",  "silent",    "restart"};

using Shape = std::vector<TreeGroup>;

/// Two or three levels, one to three slaves in each group; sometimes two inner groups beside each other.
Shape make_shape(std::uint64_t seed) {
  Dice dice(seed ^ 0x5EED);
  Shape shape{{2 + dice.below(3), 0, 0}};
  shape.push_back({2 + dice.below(3), 0, 1 + dice.below(static_cast<std::uint32_t>(shape[0].participants - 1))});
  switch (dice.below(3)) {
    case 0:
      break;
    case 1:
      shape.push_back({2 + dice.below(3), 1, 1 + dice.below(static_cast<std::uint32_t>(shape[1].participants - 1))});
      break;
    default:
      if (shape[0].participants > 2) shape.push_back({2 + dice.below(3), 0, shape[1].outer_index == 1 ? 2u : 1u});
  }
  return shape;
}

std::vector<Action> make_schedule(std::uint64_t seed, std::size_t participants, std::size_t length) {
  Dice dice(seed);
  // Faults and commands are rarer than progress, or nothing would ever run; how rare differs from schedule to schedule.
  const auto rarity = static_cast<std::uint32_t>((1 + dice.below(12)) * participants);
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
    action.a = dice.below(10'000);
    action.b = dice.below(1000);
    schedule.push_back(action);
  }
  return schedule;
}

/// A tree with a network that keeps words under way, and delivers them in any order.
class World {
 public:
  explicit World(const Shape& shape) : tree(shape) {}

  void act(const Action& action) {
    const std::size_t number = action.a % tree.participants();
    const auto [group, who] = tree.place(number);
    switch (action.act) {
      case Act::Publish:
        publish(group, who);
        break;
      case Act::Deliver:
        under_way.deliver(action.a, action.b, tree.participants(),
                          [this](const TreeMessage& message) { tree.deliver(message); });
        break;
      case Act::Duplicate:
        if (!under_way.empty()) tree.deliver(under_way[action.b % under_way.size()]);
        break;
      case Act::Drop:
        if (!under_way.empty()) under_way.take(action.b % under_way.size());
        break;
      case Act::Initialised:
        if (tree.initialising(number)) tree.initialised(number);
        break;
      case Act::Call:
        if (action.b % 3 == 0)
          tree.call(0, 0, program::Method::Start);
        else
          tree.call(group, who, program::methods[action.b % 5].method);
        break;
      case Act::Finish:
        tree.step(group, who, Input::finished());
        break;
      case Act::Silent:
        tree.step(group, who, Input::peer_silent(action.b % tree.member(group, who).peer_count()));
        break;
      case Act::Restart:
        tree.restart(action.a % tree.nodes());
        break;
    }
  }
  Tree tree;
  UnderWay<TreeMessage> under_way{60};

 private:
  void publish(std::size_t group, std::size_t from) {
    for (std::size_t peer = 0; peer < tree.member(group, from).peer_count(); ++peer) {
      under_way.put(tree.message(group, from, tree.member(group, from).participant_of(peer)));
    }
  }
};

/// F1: the node of a participant falls silent; whoever listens to it notices, and all the others hear of it.
std::string silence(Tree& tree, std::size_t silent_node) {
  const auto is_silent = [&](std::size_t group, std::size_t i) {
    return tree.node_of(tree.shape().number_of(group, i)) == silent_node;
  };
  for (std::size_t n = 0; n < tree.participants(); ++n) {
    const auto [group, i] = tree.place(n);
    if (is_silent(group, i)) continue;
    for (std::size_t peer = 0; peer < tree.member(group, i).peer_count(); ++peer)
      if (is_silent(group, tree.member(group, i).participant_of(peer))) tree.step(group, i, Input::peer_silent(peer));
  }
  for (int round = 0; round < 6; ++round)
    for (std::size_t n = 0; n < tree.participants(); ++n) {
      const auto [group, i] = tree.place(n);
      for (std::size_t peer = 0; peer < tree.member(group, i).peer_count(); ++peer) {
        const std::size_t to = tree.member(group, i).participant_of(peer);
        if (!is_silent(group, i) && !is_silent(group, to)) tree.deliver(tree.message(group, i, to));
      }
    }
  for (std::size_t n = 0; n < tree.participants(); ++n) {
    const auto [group, i] = tree.place(n);
    if (!is_silent(group, i) && tree.member(group, i).state() != PublishedState::Halted)
      return "F1: not halted\n" + tree.describe();
  }
  return {};
}

std::string judge(World& world, const std::vector<Action>& schedule, bool begin_running, bool* ran) {
  Tree& tree = world.tree;
  if (begin_running) {
    tree.call(0, 0, program::Method::Start);
    tree.rounds(12);
    if (!tree.all_in(PublishedState::Running)) return "a fair start failed\n" + tree.describe();
  }
  for (const Action& action : schedule) {
    world.act(action);
    if (!tree.observer.violations().empty()) return "violation\n" + tree.describe();
    if (ran != nullptr && tree.all_in(PublishedState::Running)) *ran = true;
  }
  // The faults end: what is under way still arrives, then words are exchanged fairly.
  while (!world.under_way.empty()) tree.deliver(world.under_way.take(0));
  tree.rounds(20);
  if (!tree.observer.violations().empty()) return "violation at the end\n" + tree.describe();
  if (!tree.agreed()) return "L1: no agreement\n" + tree.describe();
  // A start from whatever has come of it succeeds.
  if (!tree.all_in(PublishedState::Running)) {
    if (tree.all_in(PublishedState::Suspended))
      tree.call(0, 0, program::Method::Resume);
    else
      tree.call(0, 0, program::Method::Start);
    tree.rounds(14);
    if (!tree.all_in(PublishedState::Running)) return "L1: a fair start failed\n" + tree.describe();
  }
  const std::string wrong = silence(tree, schedule.size() % tree.nodes());
  if (!wrong.empty()) return wrong;
  // The silent one comes back: it follows into Halted as well.
  tree.rounds(5);
  if (!tree.agreed()) return "L1 after silence: no agreement\n" + tree.describe();
  if (!tree.observer.violations().empty()) return "violation after silence\n" + tree.describe();
  return {};
}

/// What is wrong with a schedule; empty if nothing.
std::string run(const std::vector<Action>& schedule, const Shape& shape, bool begin_running, bool* ran = nullptr) {
  World world(shape);
  try {
    return judge(world, schedule, begin_running, ran);
  } catch (const std::exception& failure) {
    return failure.what() + std::string("\n") + world.tree.describe();
  }
}

std::string print(const Shape& shape, const std::vector<Action>& schedule) {
  std::string text;
  for (const TreeGroup& group : shape)
    text += "  group of " + std::to_string(group.participants) + " nested at " + std::to_string(group.outer) + "." +
            std::to_string(group.outer_index) + "\n";
  return text + handshake::print(schedule, act_names);
}

TEST(NestedSchedules, NothingBreaksAndTheTreeAgreesInTheEnd) {
  const std::uint64_t count = schedules_wanted(12'000, 400);
  std::uint64_t that_ran = 0;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    const Shape shape = make_shape(seed);
    std::size_t participants = 0;
    for (const TreeGroup& group : shape) participants += group.participants;
    const std::vector<Action> schedule = make_schedule(seed, participants, 60 + seed % 300 * participants / 2);
    const bool begin_running = seed % 2 != 0;
    bool ran = false;
    const std::string wrong = run(schedule, shape, begin_running, &ran);
    if (!begin_running) that_ran += ran ? 1 : 0;
    if (wrong.empty()) continue;
    const std::vector<Action> least = shrink(
        schedule, [&](const std::vector<Action>& shorter) { return run(shorter, shape, begin_running).empty(); });
    FAIL() << "seed " << seed << (begin_running ? ", running" : "") << ": " << wrong << "cut down to:\n"
           << print(shape, least) << run(least, shape, begin_running);
  }
  // A harness in which the tree never gets to Running would prove nothing.
  EXPECT_GT(that_ran * 20, count / 2) << that_ran << " of " << count / 2 << " schedules brought everybody to Running";
  RecordProperty("that_ran", static_cast<int>(that_ran));
}

}  // namespace
}  // namespace takt::handshake
