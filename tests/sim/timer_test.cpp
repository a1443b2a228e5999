// SPDX-License-Identifier: Apache-2.0
#include "sim/timer.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "sim/random.hpp"
#include "tests/sim/recorder.hpp"

namespace takt::sim {
namespace {

using test::at_ps;

constexpr EventKind time_out = 7;
constexpr EventKind command = 8;

/// One timer; it notes when it fires. Commands, run at given times, use the timer.
class Owner final : public Component {
 public:
  explicit Owner(Simulation& simulation)
      : source(simulation.add(*this)), timer(source.id(), Phase::timer, time_out), simulation_(&simulation) {}

  void at(std::int64_t time, std::function<void()> what) {
    commands_.push_back(std::move(what));
    simulation_->schedule(source, at_ps(time), Phase::control, source.id(), command, commands_.size() - 1);
  }
  void arm(std::int64_t deadline) { timer.arm(*simulation_, source, at_ps(deadline)); }

  void handle(Simulation& simulation, const Event& event) override {
    if (event.kind() == command) {
      commands_[event.argument]();
      return;
    }
    ++events;
    if (timer.fired(simulation, source, event)) {
      fired.push_back(simulation.now().ps());
      if (on_fired) on_fired();
    }
  }

  EventSource source;
  Timer timer;
  std::vector<std::int64_t> fired;
  int events = 0;  // events of the timer, true time-outs and traces
  std::function<void()> on_fired;

 private:
  Simulation* simulation_;
  std::vector<std::function<void()>> commands_;
};

using Times = std::vector<std::int64_t>;

class TimerTest : public testing::Test {
 protected:
  void run() { EXPECT_TRUE(simulation.run(at_ps(10'000))); }
  Simulation simulation{1};
  Owner owner{simulation};
};

TEST_F(TimerTest, FiresOnce) {
  EXPECT_FALSE(owner.timer.armed());
  owner.arm(100);
  EXPECT_TRUE(owner.timer.armed());
  EXPECT_EQ(owner.timer.deadline(), at_ps(100));
  run();
  EXPECT_EQ(owner.fired, Times{100});
  EXPECT_EQ(owner.events, 1);
  EXPECT_FALSE(owner.timer.armed());
}

// A watchdog that is fed every 10 ps, 50 times: armed at 0, 10, .. 500 for 100 later. Its event comes due at 100
// (deadline is then 200), at 200 (300), 300 (400), 400 (500), 500 (600; the feeding at 500 is in an earlier phase),
// 600: six events, not 51.
TEST_F(TimerTest, PostponingCostsNoEvent) {
  for (std::int64_t t = 0; t <= 500; t += 10) owner.at(t, [this, t] { owner.arm(t + 100); });
  run();
  EXPECT_EQ(owner.fired, Times{600});
  EXPECT_EQ(owner.events, 6);
}

TEST_F(TimerTest, MovedEarlierFiresEarlierAndOnlyOnce) {
  owner.arm(100);
  owner.at(20, [this] { owner.arm(50); });
  run();
  EXPECT_EQ(owner.fired, Times{50});
  EXPECT_EQ(owner.events, 2);  // at 50, and the stale one at 100
}

TEST_F(TimerTest, MovedEarlierThenLaterAgain) {
  owner.arm(100);
  owner.at(20, [this] { owner.arm(50); });
  owner.at(30, [this] { owner.arm(100); });
  run();
  EXPECT_EQ(owner.fired, Times{100});
  EXPECT_EQ(owner.events, 3);  // at 50 (moves on to 100), at 100 the stale first one and the true one
}

TEST_F(TimerTest, CancelledNeverFires) {
  owner.arm(100);
  owner.at(99, [this] { owner.timer.cancel(); });
  run();
  EXPECT_EQ(owner.fired, Times{});
  EXPECT_EQ(owner.events, 1);
  EXPECT_FALSE(owner.timer.armed());
}

TEST_F(TimerTest, CancelledInTheInstantOfItsDeadline) {
  owner.arm(100);
  owner.at(100, [this] { owner.timer.cancel(); });  // control comes before timer
  run();
  EXPECT_EQ(owner.fired, Times{});
}

TEST_F(TimerTest, CancelledAndReArmedLaterUsesTheOldEvent) {
  owner.arm(100);
  owner.at(40, [this] { owner.timer.cancel(); });
  owner.at(60, [this] { owner.arm(150); });
  run();
  EXPECT_EQ(owner.fired, Times{150});
  EXPECT_EQ(owner.events, 2);  // at 100 (moves on), at 150
}

TEST_F(TimerTest, ReArmedAfterTheTraceOfACancelledOne) {
  owner.arm(100);
  owner.at(40, [this] { owner.timer.cancel(); });
  owner.at(120, [this] { owner.arm(130); });
  run();
  EXPECT_EQ(owner.fired, Times{130});
  EXPECT_EQ(owner.events, 2);
}

TEST_F(TimerTest, ReArmsItselfFromItsTimeOut) {
  owner.on_fired = [this] {
    if (owner.fired.size() < 4) owner.arm(simulation.now().ps() + 25);
  };
  owner.arm(25);
  run();
  EXPECT_EQ(owner.fired, (Times{25, 50, 75, 100}));
  EXPECT_EQ(owner.events, 4);
}

TEST_F(TimerTest, ArmedForThePresentInstantFiresInIt) {
  owner.at(70, [this] { owner.arm(70); });
  run();
  EXPECT_EQ(owner.fired, Times{70});
}

TEST_F(TimerTest, ArmedForNeverIsCancelled) {
  owner.arm(100);
  owner.timer.arm(simulation, owner.source, TrueTime::never());
  EXPECT_FALSE(owner.timer.armed());
  run();
  EXPECT_EQ(owner.fired, Times{});
}

// Random commands against the definition: it fires when the clock reaches the deadline that was set last, once.
TEST(Timer, FollowsTheLastSetting) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Simulation simulation(seed);
    Owner owner(simulation);
    RandomStream chance(seed, "timer", "commands");
    Times expected;
    std::int64_t deadline = INT64_MAX;
    for (std::int64_t now = 1; now < 3'000; now += 1 + static_cast<std::int64_t>(chance.below(40))) {
      if (deadline < now) {  // at `now` itself a command comes first (control before timer)
        expected.push_back(deadline);
        deadline = INT64_MAX;
      }
      if (chance.below(4) == 0) {
        owner.at(now, [&owner] { owner.timer.cancel(); });
        deadline = INT64_MAX;
      } else {
        const std::int64_t wanted = now + static_cast<std::int64_t>(chance.below(100));
        owner.at(now, [&owner, wanted] { owner.arm(wanted); });
        deadline = wanted;
      }
    }
    if (deadline != INT64_MAX) expected.push_back(deadline);
    simulation.run(at_ps(10'000));
    EXPECT_EQ(owner.fired, expected) << "seed " << seed;
  }
}

}  // namespace
}  // namespace takt::sim
