// SPDX-License-Identifier: Apache-2.0
// The published sequences, Fig. 3 to 6 of the paper, in exact order; both variants must show them.
#include <gtest/gtest.h>

#include "group.hpp"

namespace takt::handshake {
namespace {

using program::Method;

/// Parameter: variant and number of slaves.
class Figures : public testing::TestWithParam<std::tuple<Variant, int>> {
 protected:
  Variant variant() const { return std::get<0>(GetParam()); }
  std::size_t slaves() const { return static_cast<std::size_t>(std::get<1>(GetParam())); }
  /// "1:X 2:X ... n:X "
  std::string each_slave(const std::string& state) const {
    std::string text;
    for (std::size_t i = 1; i <= slaves(); ++i) text += std::to_string(i) + ":" + state + " ";
    return text;
  }
};

TEST_P(Figures, Figure3Start) {
  Group group(variant(), slaves());
  const Outputs start = group.call(0, Method::Start);
  EXPECT_TRUE(start.begin_initialisation);
  EXPECT_TRUE(start.publish);
  EXPECT_EQ(group.drain_journal(), "0:Halted.INIT ");
  group.notify_all(0);
  EXPECT_EQ(group.drain_journal(), each_slave("Halted.INIT"));
  group.initialised(0);
  EXPECT_EQ(group.drain_journal(), "") << "the master waits in INIT until all slaves are Ready (1)";
  for (std::size_t i = 1; i <= slaves(); ++i) group.initialised(i);
  EXPECT_EQ(group.drain_journal(), each_slave("Ready"));
  for (std::size_t i = 1; i <= slaves(); ++i) {
    EXPECT_EQ(group[0].state(), PublishedState::HaltedInit);
    group.notify_all(i);  // (2)
  }
  EXPECT_EQ(group.drain_journal(), "0:Ready ") << "(3)";
  for (std::size_t i = 1; i <= slaves(); ++i) {
    const Outputs outputs = group.tell(0, i);  // (4)
    EXPECT_TRUE(outputs.process_started);
  }
  EXPECT_EQ(group.drain_journal(), each_slave("Running")) << "(5)";
  for (std::size_t i = 1; i <= slaves(); ++i) {
    EXPECT_EQ(group[0].state(), PublishedState::Ready);
    group.notify_all(i);  // (6)
  }
  EXPECT_EQ(group.drain_journal(), "0:Running ") << "(7)";
  for (std::size_t i = 1; i <= slaves(); ++i) {
    EXPECT_FALSE(group[i].process_data_counts(0)) << "the slave has not heard that the master is Running";
    EXPECT_TRUE(group[0].process_data_counts(i - 1)) << "(8)";
  }
  group.notify_all(0);
  for (std::size_t i = 1; i <= slaves(); ++i) EXPECT_TRUE(group[i].process_data_counts(0)) << "(8)";
  EXPECT_EQ(group[0].machine().last_transition(), 2);
  EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
}

TEST_P(Figures, MasterInitialisedLast) {
  Group group(variant(), slaves());
  group.call(0, Method::Start);
  group.notify_all(0);
  for (std::size_t i = 1; i <= slaves(); ++i) {
    group.initialised(i);
    group.notify_all(i);
  }
  EXPECT_EQ(group[0].state(), PublishedState::HaltedInit);
  group.initialised(0);
  EXPECT_EQ(group[0].state(), PublishedState::Ready);
}

/// Fig. 4 to 6 have one shape: somebody changes (1), tells (2), and the others follow (3).
struct Case {
  Method method;
  Method before;  ///< called at the master and spread first; Halt: nothing
  const char* goal;
  std::uint8_t number;  ///< of the transition
};
constexpr std::array<Case, 5> cases{{{Method::Halt, Method::Halt, "Halted", 3},
                                     {Method::Halt, Method::Suspend, "Halted", 7},
                                     {Method::Suspend, Method::Halt, "Suspended", 5},
                                     {Method::Resume, Method::Suspend, "Running", 6},
                                     {Method::Reset, Method::Suspend, "Ready", 8}}};

TEST_P(Figures, Figures4aTo6aByTheMaster) {
  for (const Case& each : cases) {
    SCOPED_TRACE(each.goal);
    Group group = started(variant(), slaves());
    if (each.before != Method::Halt) {
      group.call(0, each.before);
      group.round();
      group.drain_journal();
    }
    const std::string goal = each.goal;
    EXPECT_EQ(group.call(0, each.method).status, program::StatusCode::Good);
    EXPECT_EQ(group.drain_journal(), "0:" + goal + " ") << "(1a)";
    group.notify_all(0);  // (2a)
    EXPECT_EQ(group.drain_journal(), each_slave(goal)) << "(3a)";
    for (std::size_t i = 0; i <= slaves(); ++i) EXPECT_EQ(group[i].machine().last_transition(), each.number);
    group.rounds(3);
    EXPECT_EQ(group.drain_journal(), "") << "it stays so";
    EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
  }
}

TEST_P(Figures, Figures4bTo6bByASlave) {
  for (const Case& each : cases) {
    SCOPED_TRACE(each.goal);
    Group group = started(variant(), slaves());
    if (each.before != Method::Halt) {
      group.call(0, each.before);
      group.round();
      group.drain_journal();
    }
    const std::string goal = each.goal;
    EXPECT_EQ(group.call(1, each.method).status, program::StatusCode::Good);
    EXPECT_EQ(group.drain_journal(), "1:" + goal + " ") << "(1b)";
    group.tell(1, 0);  // (2b)
    EXPECT_EQ(group.drain_journal(), "0:" + goal + " ") << "(3b)";
    for (std::size_t i = 2; i <= slaves(); ++i) {
      group.tell(0, i);
      EXPECT_EQ(group.drain_journal(), std::to_string(i) + ":" + goal + " ");
    }
    EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
  }
}

// Fig. 4 from INIT and Ready too: "HALTED can be reached from all other states".
TEST_P(Figures, HaltDuringTheStart) {
  for (int rounds_before = 0; rounds_before < 3; ++rounds_before) {
    for (std::size_t by = 0; by <= slaves(); ++by) {
      Group group(variant(), slaves());
      group.call(0, Method::Start);
      group.notify_all(0);
      for (std::size_t i = 1; i <= slaves(); ++i) group.notify_all(i);
      group.rounds(rounds_before);
      EXPECT_EQ(group.call(by, Method::Halt).status, program::StatusCode::Good);
      EXPECT_FALSE(group.initialising(by));
      group.rounds(4);
      EXPECT_TRUE(group.all_in(PublishedState::Halted)) << group.describe();
      EXPECT_EQ(group.call(0, Method::Start).status, program::StatusCode::Good);
      group.rounds(4);
      EXPECT_TRUE(group.all_in(PublishedState::Running)) << group.describe();
      EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
    }
  }
}

std::string name(const testing::TestParamInfo<std::tuple<Variant, int>>& info) {
  return std::string(std::get<0>(info.param) == Variant::paper ? "paper" : "robust") +
         std::to_string(std::get<1>(info.param));
}
INSTANTIATE_TEST_SUITE_P(Groups, Figures,
                         testing::Combine(testing::Values(Variant::paper, Variant::robust), testing::Range(1, 9)),
                         name);

}  // namespace
}  // namespace takt::handshake
