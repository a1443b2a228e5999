// SPDX-License-Identifier: Apache-2.0
// The observer finds what is planted: each invariant can fail.
#include <gtest/gtest.h>

#include <vector>

#include "handshake/observer.hpp"

namespace takt::handshake {
namespace {

constexpr auto halted = PublishedState::Halted;
constexpr auto init = PublishedState::HaltedInit;
constexpr auto ready = PublishedState::Ready;
constexpr auto running = PublishedState::Running;
constexpr auto suspended = PublishedState::Suspended;

/// Moves a participant by hand, with the transition's right number.
class Puppet {
 public:
  Puppet(Variant variant, std::size_t participants) : observer(variant, participants), state_(participants, halted) {}
  void move(std::size_t i, PublishedState to, std::uint32_t run) {
    const program::Transition* transition = program::transition_between(base_state(state_[i]), base_state(to));
    observer.on_transition(i, {transition == nullptr ? std::uint8_t{0} : transition->number, state_[i], to},
                           Word{1, to, {}, run});
    state_[i] = to;
  }
  void make_ready(std::size_t i, std::uint32_t run) {
    move(i, init, 0);
    move(i, ready, run);
  }
  std::vector<Violation> violations() const { return {observer.violations().begin(), observer.violations().end()}; }

  Observer observer;

 private:
  std::vector<PublishedState> state_;
};

using Violations = std::vector<Violation>;

class Planted : public testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(Variants, Planted, testing::Values(Variant::paper, Variant::robust));

TEST_P(Planted, ACleanRunHasNoViolation) {
  Puppet puppet(GetParam(), 3);
  for (std::uint32_t run = 1; run < 4; ++run) {
    for (const std::size_t i : {1U, 2U, 0U}) puppet.make_ready(i, run);
    for (const std::size_t i : {1U, 2U, 0U}) puppet.move(i, running, run);
    puppet.observer.on_process_data(0, 1, puppet.observer.sending_run(0));
    puppet.observer.on_process_data(1, 2, puppet.observer.sending_run(1));
    for (const std::size_t i : {1U, 2U, 0U}) puppet.move(i, suspended, run);
    for (const std::size_t i : {1U, 2U, 0U}) puppet.move(i, running, run);
    for (const std::size_t i : {1U, 2U, 0U}) puppet.move(i, halted, 0);
  }
  EXPECT_EQ(puppet.violations(), Violations{});
}

TEST_P(Planted, S1OneIsRunningBeforeAllWereReady) {
  Puppet puppet(GetParam(), 3);
  puppet.make_ready(0, 1);
  puppet.make_ready(1, 1);
  puppet.move(1, running, 1);
  EXPECT_EQ(puppet.violations(), (Violations{{Invariant::S1, Finding::running_before_all_ready, 1}}));
}

TEST(Observer, S1RobustReadyInAnotherRunDoesNotCount) {
  Puppet puppet(Variant::robust, 2);
  puppet.make_ready(0, 1);
  puppet.make_ready(1, 1);
  puppet.move(0, halted, 0);
  puppet.make_ready(0, 2);
  puppet.move(1, running, 1);
  EXPECT_EQ(puppet.violations(), Violations{}) << "in its own run all have been Ready";
  puppet.move(0, running, 2);
  EXPECT_EQ(puppet.violations(), (Violations{{Invariant::S1, Finding::running_before_all_ready, 0},
                                             {Invariant::S2, Finding::master_before_slaves, 0}}));
}

TEST(Observer, S1PaperReadyBeforeTheRoundBeganDoesNotCount) {
  Puppet puppet(Variant::paper, 2);
  puppet.make_ready(0, 0);
  puppet.make_ready(1, 0);
  puppet.move(1, halted, 0);
  puppet.move(0, halted, 0);
  puppet.make_ready(0, 0);
  puppet.move(0, running, 0);
  EXPECT_EQ(puppet.violations(), (Violations{{Invariant::S1, Finding::running_before_all_ready, 0},
                                             {Invariant::S2, Finding::master_before_slaves, 0}}));
}

TEST(Observer, PaperOneWhoIsReadyAlreadyCountsAndOneWhoHaltsLaterIsNoViolation) {
  Puppet puppet(Variant::paper, 2);
  puppet.make_ready(1, 0);  // started from outside, before the master
  puppet.make_ready(0, 0);
  puppet.move(0, halted, 0);
  puppet.move(1, running, 0);  // the halt is under way
  EXPECT_EQ(puppet.violations(), Violations{});
}

TEST_P(Planted, S2TheMasterIsRunningBeforeASlave) {
  Puppet puppet(GetParam(), 3);
  for (const std::size_t i : {1U, 2U, 0U}) puppet.make_ready(i, 1);
  puppet.move(1, running, 1);
  puppet.move(0, running, 1);
  EXPECT_EQ(puppet.violations(), (Violations{{Invariant::S2, Finding::master_before_slaves, 0}}));
}

TEST_P(Planted, S3ProcessData) {
  Puppet puppet(GetParam(), 2);
  for (const std::size_t i : {1U, 0U}) puppet.make_ready(i, 5);
  puppet.move(1, running, 5);
  const std::uint32_t sent = puppet.observer.sending_run(1);
  EXPECT_NE(sent, 0U);
  puppet.observer.on_process_data(1, 0, sent);
  puppet.observer.on_process_data(0, 1, puppet.observer.sending_run(0));
  puppet.move(0, running, 5);
  puppet.observer.on_process_data(1, 0, sent);
  for (const std::size_t i : {1U, 0U}) puppet.move(i, halted, 0);
  for (const std::size_t i : {1U, 0U}) puppet.make_ready(i, 6);
  for (const std::size_t i : {1U, 0U}) puppet.move(i, running, 6);
  puppet.observer.on_process_data(1, 0, sent);  // of the run before
  puppet.observer.on_process_data(1, 0, puppet.observer.sending_run(1));
  EXPECT_EQ(puppet.violations(), (Violations{{Invariant::S3, Finding::data_to_one_not_running, 0},
                                             {Invariant::S3, Finding::data_of_one_not_running, 1},
                                             {Invariant::S3, Finding::data_of_another_run, 0}}));
}

TEST_P(Planted, S4RunningWithoutInit) {
  Puppet puppet(GetParam(), 2);
  puppet.make_ready(1, 1);
  puppet.move(0, ready, 1);  // transition 1 without INIT
  puppet.move(1, running, 1);
  EXPECT_EQ(puppet.violations(), Violations{});
  puppet.move(0, running, 1);
  EXPECT_EQ(puppet.violations(), (Violations{{Invariant::S4, Finding::running_without_init, 0}}));
}

TEST_P(Planted, S4INITOfAFormerLifeDoesNotCount) {
  Observer observer(GetParam(), 2);
  observer.on_transition(0, {0, halted, init}, {1, init, {}, 0});
  observer.on_restart(0);
  observer.on_transition(0, {1, halted, ready}, {2, ready, {}, 1});
  observer.on_transition(1, {0, halted, init}, {1, init, {}, 0});
  observer.on_transition(1, {1, init, ready}, {1, ready, {}, 1});
  observer.on_transition(1, {2, ready, running}, {1, running, {}, 1});
  observer.on_transition(0, {2, ready, running}, {2, running, {}, 1});
  ASSERT_EQ(observer.violations().size(), 1U);
  EXPECT_EQ(observer.violations()[0].invariant, Invariant::S4);
}

TEST_P(Planted, S5NoSuchTransitionAndJumps) {
  const auto first = [](StateChange change) {
    Observer observer(GetParam(), 2);
    observer.on_transition(1, change, {1, change.to, {}, 1});
    return observer.violations().empty() ? Violation{} : observer.violations()[0];
  };
  const Violation none{Invariant::S5, Finding::no_such_transition, 1};
  const Violation jump{Invariant::S5, Finding::state_jumped, 1};
  EXPECT_EQ(first({2, halted, running}), none);
  EXPECT_EQ(first({0, halted, ready}), none);
  EXPECT_EQ(first({1, halted, init}), none);
  EXPECT_EQ(first({10, halted, ready}), none);
  EXPECT_EQ(first({9, halted, ready}), none) << "the number of another transition";
  EXPECT_EQ(first({0, halted, halted}), none);
  EXPECT_EQ(first({9, ready, halted}), jump);
}

TEST(Observer, RobustOneWhoStaysReadyJoinsTheNewRunByItsWord) {
  Puppet puppet(Variant::robust, 2);
  puppet.make_ready(0, 1);
  puppet.make_ready(1, 1);
  puppet.observer.on_word(1, Word{1, ready, {}, 2});
  puppet.observer.on_word(0, Word{1, ready, {}, 2});
  puppet.move(1, running, 2);
  puppet.move(0, running, 2);
  EXPECT_EQ(puppet.violations(), Violations{});
}

TEST(Observer, IsAValue) {
  Puppet one(Variant::robust, 65);
  Puppet other(Variant::robust, 65);
  EXPECT_TRUE(one.observer == other.observer);
  one.make_ready(64, 1);
  EXPECT_FALSE(one.observer == other.observer);
  EXPECT_NE(one.observer.hash(), other.observer.hash());
  other.make_ready(64, 1);
  EXPECT_TRUE(one.observer == other.observer);
  EXPECT_EQ(one.observer.hash(), other.observer.hash());
}

}  // namespace
}  // namespace takt::handshake
