// SPDX-License-Identifier: Apache-2.0
// What the explorer says about both variants. The numbers of states are those of the present rules and of the present
// network; they change with any rule, and a smaller one may mean that something is no longer explored.
#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>
#include <vector>

#include "../ask.hpp"
#include "explore/report/replay.hpp"

namespace takt::explore {
namespace {

using handshake::Variant;

constexpr Fault every_fault[] = {Fault::loss,  Fault::duplicate, Fault::reorder,
                                 Fault::crash, Fault::restart,   Fault::timeout};

Query query(Variant variant, std::uint8_t slaves, std::uint32_t commands, std::uint32_t faults,
            std::span<const Fault> classes) {
  Query result;
  result.variant = variant;
  result.slaves = slaves;
  result.fault_budget = faults;
  return with(result, commands, classes);
}

std::string verdicts(const SearchResult& result) {
  std::string text;
  for (std::size_t p = 0; p < property_count; ++p)
    text += std::string(property_names[p]) + " " + std::string(name_of(result.verdicts[p])) + "\n";
  return text;
}

struct BudgetCase {
  std::uint8_t slaves;
  std::uint32_t commands;
  std::uint32_t faults;
  std::uint64_t states;  ///< with symmetry
  std::uint64_t plain;   ///< without
};

TEST(Robust, HoldsInEveryOrderUnderEveryFault) {
#ifdef NDEBUG
  constexpr BudgetCase cases[] = {{1, 4, 0, 29273, 29273},
                                  {1, 2, 1, 57581, 57581},
                                  {2, 2, 0, 17952, 34797},
                                  {2, 1, 1, 328513, 579261},
                                  {3, 1, 0, 11775, 63231}};
#else
  constexpr BudgetCase cases[] = {{1, 2, 0, 0, 0}, {1, 1, 1, 0, 0}, {2, 1, 0, 0, 0}};
#endif
  for (const BudgetCase& each : cases) {
    SCOPED_TRACE(testing::Message() << int{each.slaves} << " slaves, " << each.commands << " calls, " << each.faults
                                    << " faults");
    Query asked = query(Variant::robust, each.slaves, each.commands, each.faults, every_fault);
    const SearchResult result = ask(asked);
    EXPECT_TRUE(result.exhausted);
    EXPECT_TRUE(result.all_hold()) << verdicts(result);
    EXPECT_EQ(result.symmetry, each.slaves > 1);
    if (each.states != 0) {
      EXPECT_EQ(result.states, each.states);
    }
    asked.symmetry = false;
    const SearchResult plain = ask(asked);
    if (each.plain != 0) {
      EXPECT_EQ(plain.states, each.plain);
    }
    EXPECT_EQ(verdicts(plain), verdicts(result));
    EXPECT_EQ(plain.depth, result.depth);
  }
}

struct FaultCase {
  Fault fault;
  std::uint64_t one_slave;      ///< states: 2 calls, 2 faults
  std::uint64_t two_slaves;     ///< 1 call, 1 fault, with symmetry
  std::uint64_t distinguished;  ///< and without
};

TEST(Robust, HoldsUnderEachClassOfFaultsByItself) {
  constexpr FaultCase cases[] = {{Fault::loss, 7328, 5306, 10360},         {Fault::duplicate, 16049, 9968, 19700},
                                 {Fault::reorder, 9850, 5459, 10710},      {Fault::crash, 4971, 9150, 17829},
                                 {Fault::restart, 201426, 118653, 212282}, {Fault::timeout, 45736, 28824, 56611}};
  for (const FaultCase& each : cases) {
    SCOPED_TRACE(name_of(each.fault));
    const Fault classes[] = {each.fault};
    const SearchResult one = ask(query(Variant::robust, 1, 2, 2, classes));
    EXPECT_TRUE(one.exhausted && one.all_hold()) << verdicts(one);
    EXPECT_EQ(one.states, each.one_slave);
    Query asked = query(Variant::robust, 2, 1, 1, classes);
    const SearchResult two = ask(asked);
    EXPECT_TRUE(two.exhausted && two.all_hold()) << verdicts(two);
    EXPECT_EQ(two.states, each.two_slaves);
    asked.symmetry = false;
    const SearchResult apart = ask(asked);
    EXPECT_EQ(apart.states, each.distinguished);
    EXPECT_EQ(verdicts(apart), verdicts(two));
  }
}

struct NetworkCase {
  std::uint8_t slaves;
  std::uint8_t capacity;  ///< 0: registers
  handshake::Subscription subscription;
  std::uint64_t states;
  std::uint64_t distinguished;
};

// 1 call and 1 fault of every class.
TEST(Robust, HoldsOnChannelsAndWithAllToAllSubscription) {
  using handshake::Subscription;
  constexpr NetworkCase cases[] = {{1, 1, Subscription::star, 14555, 14555},
                                   {1, 2, Subscription::star, 28271, 28271},
                                   {1, 3, Subscription::star, 32314, 32314}};
  const auto check = [](const NetworkCase& each, Query asked) {
    SCOPED_TRACE(testing::Message() << int{each.slaves} << " slaves, channels of " << int{each.capacity}
                                    << ", subscription " << static_cast<int>(each.subscription));
    asked.subscription = each.subscription;
    if (each.capacity != 0) {
      asked.network = Network::channels;
      asked.capacity = each.capacity;
    }
    const SearchResult result = ask(asked);
    EXPECT_TRUE(result.exhausted && result.all_hold()) << verdicts(result);
    EXPECT_EQ(result.states, each.states);
    EXPECT_EQ(result.symmetry, each.slaves > 1);
    asked.symmetry = false;
    const SearchResult apart = ask(asked);
    EXPECT_EQ(apart.states, each.distinguished);
    EXPECT_EQ(verdicts(apart), verdicts(result));
  };
  for (const NetworkCase& each : cases) check(each, query(Variant::robust, each.slaves, 1, 1, every_fault));
#ifdef NDEBUG
  constexpr Fault crash[] = {Fault::crash};
  check({2, 1, Subscription::star, 37751, 74500}, query(Variant::robust, 2, 1, 1, crash));
  check({2, 2, Subscription::star, 12842, 25264}, query(Variant::robust, 2, 1, 0, {}));
  check({2, 0, Subscription::all_to_all, 582170, 1117007}, query(Variant::robust, 2, 1, 1, crash));
#endif
}

// What fails on registers fails on channels and with all-to-all subscription, too.
TEST(Paper, FailsOnEveryNetwork) {
  for (const bool channels : {false, true}) {
    SCOPED_TRACE(channels);
    Query asked = query(Variant::paper, channels ? 1 : 2, channels ? 2 : 1, 0, {});
    if (channels)
      asked.network = Network::channels;
    else
      asked.subscription = handshake::Subscription::all_to_all;
    const SearchResult result = ask(asked);
    EXPECT_TRUE(result.exhausted);
    for (const Property property : {Property::S1, Property::S2, Property::L1})
      EXPECT_EQ(result[property], PropertyVerdict::violated) << name_of(property);
    for (const Property property : {Property::S4, Property::S5})
      EXPECT_EQ(result[property], PropertyVerdict::holds) << name_of(property);
    for (const Property property : {Property::S1, Property::S2}) {
      if (!result.traces[index_of(property)]) continue;
      const Trace& trace = *result.traces[index_of(property)];
      EXPECT_TRUE(observed(replay(asked, result.beginnings[trace.beginning], trace), property)) << name_of(property);
    }
  }
}

// Where nobody can fall silent nothing is said about silence; where somebody can, it is also seen.
TEST(Silence, IsAskedOnlyWhereSomebodyCanBeSilent) {
  const auto of_silence = [](std::initializer_list<Fault> classes, std::uint32_t budget) {
    const std::vector<Fault> all(classes);
    const SearchResult result = ask(query(Variant::robust, 1, 2, budget, all));
    EXPECT_TRUE(result.all_hold());
    return std::pair(result[Property::F1], result[Property::silence]);
  };
  EXPECT_EQ(of_silence({Fault::loss, Fault::restart}, 1),
            std::pair(PropertyVerdict::not_asked, PropertyVerdict::not_asked));
  EXPECT_EQ(of_silence({Fault::crash}, 0), std::pair(PropertyVerdict::not_asked, PropertyVerdict::not_asked));
  EXPECT_EQ(of_silence({Fault::crash}, 1), std::pair(PropertyVerdict::holds, PropertyVerdict::reached));
  EXPECT_EQ(of_silence({Fault::timeout}, 1), std::pair(PropertyVerdict::holds, PropertyVerdict::reached));
}

TEST(Paper, FailsAsTheReadmeOfTheHandshakeSays) {
  const SearchResult result = ask(query(Variant::paper, 1, 2, 1, every_fault));
  EXPECT_TRUE(result.exhausted);
  for (const Property property : {Property::S1, Property::S2, Property::S3, Property::F1, Property::L1})
    EXPECT_EQ(result[property], PropertyVerdict::violated) << name_of(property);
  for (const Property property : {Property::S4, Property::S5})
    EXPECT_EQ(result[property], PropertyVerdict::holds) << name_of(property);
  for (std::size_t p = index_of(Property::all_running); p < property_count; ++p)
    EXPECT_EQ(result.verdicts[p], PropertyVerdict::reached) << property_names[p];
}

// The counter-example of an invariant is one for the observer of all other tests, too.
TEST(Paper, TheObserverSeesWhatTheSearchSees) {
  for (std::uint8_t slaves = 1; slaves <= 2; ++slaves) {
    for (const bool finishes : {true, false}) {
      Query asked = query(Variant::paper, slaves, slaves == 1 ? 3 : 1, 1, every_fault);
      asked.finishes = finishes;
      const SearchResult result = ask(asked);
      for (const Property property : {Property::S1, Property::S2, Property::S3}) {
        if (result[property] != PropertyVerdict::violated) continue;
        const Trace& trace = *result.traces[index_of(property)];
        EXPECT_TRUE(observed(replay(asked, result.beginnings[trace.beginning], trace), property)) << name_of(property);
      }
    }
  }
}

// Suspend and resume that cross chase each other for ever: a cycle, and not only an end at the wrong place.
TEST(Paper, HasFairCyclesOutsideTheGoal) { EXPECT_GT(ask(query(Variant::paper, 1, 2, 0, {})).cyclic_states, 100U); }

// Without any call the paper's group stays where it is; with none, nothing can be reached either, and that is said.
TEST(Vacuity, NothingIsReachedWithoutCalls) {
  const SearchResult result = ask(query(Variant::robust, 1, 0, 0, {}));
  EXPECT_TRUE(result.exhausted);
  EXPECT_FALSE(result.all_hold());
  EXPECT_FALSE(result.any_violated());
  EXPECT_EQ(result[Property::T5], PropertyVerdict::unreached);
}

TEST(Limits, StatesAndDepth) {
  Query asked = query(Variant::robust, 1, 4, 0, {});
  asked.states = 1000;
  const SearchResult few = ask(asked);
  EXPECT_EQ(few.states, 1000U);
  EXPECT_FALSE(few.exhausted);
  EXPECT_EQ(few[Property::L1], PropertyVerdict::unknown);
  asked = query(Variant::robust, 1, 4, 0, {});
  asked.depth = 5;
  const SearchResult shallow = ask(asked);
  EXPECT_EQ(shallow.depth, 5U);
  EXPECT_FALSE(shallow.exhausted);
}

TEST(Limits, CanBeInterrupted) {
  const SearchResult result =
      explore(query(Variant::robust, 2, 2, 1, every_fault), [](const Progress&) { return false; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_FALSE(result.exhausted);
}

}  // namespace
}  // namespace takt::explore
