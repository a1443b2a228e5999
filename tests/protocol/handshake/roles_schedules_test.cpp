// SPDX-License-Identifier: Apache-2.0
// Plug and produce under random schedules: nodes join, leave, crash and come back, the master crashes, messages are
// lost, delayed, duplicated and reordered. S1 to S5 never break; once the faults end the roles are filled and a start
// succeeds (L1); a role whose node dies halts the group, and a spare takes it (F1).
//
// A schedule is a list of small actions made from its seed, so a failing one can be cut down and is printed.
#include <gtest/gtest.h>

#include <array>
#include <exception>
#include <string>
#include <vector>

#include "roles.hpp"
#include "schedule.hpp"

namespace takt::handshake {
namespace {

enum class Act : std::uint8_t {
  Publish,
  Deliver,
  Duplicate,
  Drop,
  Initialised,
  Call,
  Finish,
  Silent,
  Missed,
  Restart,
  Join,
  Leave
};
using Action = handshake::Action<Act>;  // a: a station or a message under way

constexpr const char* act_names[]{"publish", "deliver", "duplicate", "drop",    "initialised", "call",
                                  "finish",  "silent",  "missed",    "restart", "join",        "leave"};

struct Shape {
  std::vector<SkillId> roles;
  std::vector<std::vector<SkillId>> offers;
  bool restarts = false;
};

/// One to three roles of two skills, and up to three nodes more than roles; all can be filled.
Shape make_shape(std::uint64_t seed) {
  Dice dice(seed ^ 0x9106);
  Shape shape;
  const std::uint32_t roles = 1 + dice.below(3);
  for (std::uint32_t i = 0; i < roles; ++i) {
    shape.roles.push_back(1 + dice.below(2));
    shape.offers.push_back({shape.roles.back()});
    if (dice.below(3) == 0) shape.offers.back().push_back(3 - shape.roles.back());
  }
  for (std::uint32_t more = dice.below(4); more > 0; --more) shape.offers.push_back({1 + dice.below(2)});
  shape.restarts = dice.below(2) == 0;
  return shape;
}

std::vector<Action> make_schedule(std::uint64_t seed, std::size_t stations, std::size_t length) {
  Dice dice(seed);
  const auto rarity = static_cast<std::uint32_t>((1 + dice.below(12)) * stations);
  std::vector<Action> schedule;
  for (std::size_t i = 0; i < length; ++i) {
    Action action;
    const std::uint32_t face = dice.below(12 * rarity + 18);
    if (face < 5 * rarity)
      action.act = Act::Publish;
    else if (face < 10 * rarity)
      action.act = Act::Deliver;
    else if (face < 12 * rarity)
      action.act = Act::Initialised;
    else if (face < 12 * rarity + 6)
      action.act = Act::Call;
    else
      action.act = std::array{
          Act::Duplicate, Act::Duplicate, Act::Drop, Act::Drop, Act::Finish, Act::Silent,
          Act::Missed,    Act::Restart,   Act::Join, Act::Join, Act::Join,   Act::Leave}[face - 12 * rarity - 6];
    action.a = dice.below(10'000);
    action.b = dice.below(1000);
    schedule.push_back(action);
  }
  return schedule;
}

class World {
 public:
  explicit World(const Shape& shape) : group(shape.roles, shape.offers, shape.restarts) {}

  void act(const Action& action) {
    const std::size_t station = action.a % group.stations();
    const std::size_t c = action.a % (group.stations() - 1);
    switch (action.act) {
      case Act::Publish:
        for (const RoleMessage& message : group.messages(station)) under_way.put(message);
        break;
      case Act::Deliver:
        under_way.deliver(action.a, action.b, 2 * group.stations(),
                          [this](const RoleMessage& message) { group.deliver(message); });
        break;
      case Act::Duplicate:
        if (!under_way.empty()) group.deliver(RoleMessage(under_way[action.b % under_way.size()]));
        break;
      case Act::Drop:
        if (!under_way.empty()) under_way.take(action.b % under_way.size());
        break;
      case Act::Initialised:
        group.initialised(station);
        break;
      case Act::Call:
        if (action.b % 3 == 0)
          group.call(0, program::Method::Start);
        else
          group.call(station, program::methods[action.b % 5].method);
        break;
      case Act::Finish:
        group.finish(station);
        break;
      case Act::Silent:
        group.silent(station, action.b);
        break;
      case Act::Missed:
        group.announcement_missed(c);
        break;
      case Act::Restart:
        group.restart(station);
        break;
      case Act::Join:
        group.join(c);
        break;
      case Act::Leave:
        group.leave(c);
        break;
    }
  }
  RoleGroup group;
  UnderWay<RoleMessage> under_way{60};
};

/// A start from whatever the group has come to.
std::string start(RoleGroup& group, std::size_t silent_station, const char* when) {
  using program::Method;
  if (group.all_in(PublishedState::Running)) return {};
  const bool suspended = group.master().state() == PublishedState::Suspended;
  if (group.master().state() != PublishedState::HaltedInit) group.call(0, suspended ? Method::Resume : Method::Start);
  group.rounds(10, silent_station);
  return group.all_in(PublishedState::Running) ? std::string() : std::string(when) + "\n" + group.describe();
}

std::string judge(World& world, const std::vector<Action>& schedule, const Shape& shape, bool begin_running,
                  bool* ran) {
  RoleGroup& group = world.group;
  constexpr std::size_t nobody = ~std::size_t{0};
  if (begin_running) {
    for (std::size_t c = 0; c + 1 < group.stations(); ++c) group.join(c);
    group.rounds(6);
    if (const std::string wrong = start(group, nobody, "a fair start failed"); !wrong.empty()) return wrong;
  }
  for (const Action& action : schedule) {
    world.act(action);
    if (!group.observer.violations().empty()) return "violation\n" + group.describe();
    if (ran != nullptr && group.all_in(PublishedState::Running)) *ran = true;
  }
  // The faults end: what is under way still arrives, all nodes are there, then all is exchanged fairly.
  while (!world.under_way.empty()) group.deliver(world.under_way.take(0));
  for (std::size_t c = 0; c + 1 < group.stations(); ++c) group.join(c);
  group.rounds(12);
  if (!group.binder().complete()) return "L1: roles without a node\n" + group.describe();
  if (const std::string wrong = start(group, nobody, "L1: a fair start failed"); !wrong.empty()) return wrong;

  // F1: the node of a role dies. The others halt; if there is a spare, the group can run again without it.
  const std::size_t role = schedule.size() % group.roles();
  const std::size_t dead = group.binder().binding(role).candidate;
  group.silent(0, role);
  if (group.master().state() != PublishedState::Halted) return "F1: the master is not halted\n" + group.describe();
  group.announcement_missed(dead);
  group.rounds(2, dead + 1);
  if (!shape.restarts)
    for (std::size_t c = 0; c + 1 < group.stations(); ++c)
      if (c != dead && group.member(c) && group.member(c)->state() != PublishedState::Halted)
        return "F1: not halted\n" + group.describe();
  group.rounds(12, dead + 1);
  if (group.binder().complete())
    if (const std::string wrong = start(group, dead + 1, "F1: a start with the spare failed"); !wrong.empty())
      return wrong;
  // The dead one comes back and stops nobody.
  const bool was_running = group.all_in(PublishedState::Running);
  group.rounds(8);
  if (was_running && !group.all_in(PublishedState::Running))
    return "one that came back stopped the group\n" + group.describe();
  if (!group.observer.violations().empty()) return "violation at the end\n" + group.describe();
  return {};
}

/// What is wrong with a schedule; empty if nothing.
std::string run(const std::vector<Action>& schedule, const Shape& shape, bool begin_running, bool* ran = nullptr) {
  World world(shape);
  try {
    return judge(world, schedule, shape, begin_running, ran);
  } catch (const std::exception& failure) {
    return failure.what() + std::string("\n") + world.group.describe();
  }
}

std::string print(const Shape& shape, const std::vector<Action>& schedule) {
  std::string text = "  roles";
  for (const SkillId skill : shape.roles) text += " " + std::to_string(skill);
  text += shape.restarts ? ", restarts\n" : "\n";
  for (const auto& skills : shape.offers) {
    text += "  offers";
    for (const SkillId skill : skills) text += " " + std::to_string(skill);
    text += "\n";
  }
  return text + handshake::print(schedule, act_names);
}

TEST(RolesSchedules, NothingBreaksAndRolesAreFilledInTheEnd) {
  const std::uint64_t count = schedules_wanted(12'000, 400);
  std::uint64_t that_ran = 0;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    const Shape shape = make_shape(seed);
    const std::vector<Action> schedule =
        make_schedule(seed, shape.offers.size() + 1, 60 + seed % 300 * shape.offers.size());
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
  // A harness in which the group never gets to Running would prove nothing.
  EXPECT_GT(that_ran * 20, count / 2) << that_ran << " of " << count / 2 << " schedules brought everybody to Running";
  RecordProperty("that_ran", static_cast<int>(that_ran));
}

}  // namespace
}  // namespace takt::handshake
