// SPDX-License-Identifier: Apache-2.0
// One word of any content, said by a stranger: the group settles, starts again, and keeps S1 to S5 from the next halt
// on.
#include <gtest/gtest.h>

#include <array>
#include <bit>

#include "../ask.hpp"
#include "explore/model/forgery.hpp"
#include "tests/support/case_count.hpp"

namespace takt::explore {
namespace {

Query forging(std::uint8_t slaves, std::uint32_t commands) {
  Query query;
  query.slaves = slaves;
  return with(query, commands, std::array{Fault::forge});
}

void expect_to_recover(const Query& query, std::uint64_t states) {
  SCOPED_TRACE(query_line(query));
  const SearchResult result = ask(query);
  EXPECT_TRUE(result.exhausted);
  for (const Property property : {Property::S1, Property::S2, Property::S3, Property::S4, Property::S5, Property::L1})
    EXPECT_EQ(result[property], PropertyVerdict::holds) << text_report(query, result, 0.0);
  EXPECT_NE(result[Property::F1], PropertyVerdict::violated) << text_report(query, result, 0.0);
  EXPECT_EQ(result[Property::all_running], PropertyVerdict::reached);
  EXPECT_EQ(result.states, states);
}

#ifdef NDEBUG
constexpr bool is_optimised = true;
#else
constexpr bool is_optimised = false;
#endif
bool is_time_for_long_searches() { return is_optimised && !support::is_quick_tier(); }

TEST(Forge, AWordOfAnyContent) {
  if (is_time_for_long_searches())
    expect_to_recover(forging(1, 1), 1614677);
  else
    expect_to_recover(forging(1, 0), 106668);
}

TEST(Forge, AMessageOfAnyContentAmongOthers) {
  if (!is_time_for_long_searches()) GTEST_SKIP() << "a long search, for the full tier and optimised code";
  Query query = forging(1, 1);
  query.network = Network::channels;
  query.beginnings = Beginnings::switched_on;
  expect_to_recover(query, 1234210);
}

TEST(Forge, ToANodeOfTwoGroups) {
  if (!is_time_for_long_searches()) GTEST_SKIP() << "a long search, for the full tier and optimised code";
  Query query = forging(1, 0);
  query.inner_slaves = 1;
  expect_to_recover(query, 3289234);
}

// Words that no participant can say are not worth a search; of those that it can say every kind and state is among
// them.
TEST(Forge, WhatAStrangerMaySay) {
  handshake::Word said{1,
                       handshake::PublishedState::Running,
                       {2, handshake::IntentKind::Start, 0, handshake::run_of(1, 2)},
                       handshake::run_of(1, 2)};
  const std::vector<Letter> letters = forgeries(said, 2);
  std::size_t kinds = 0;
  std::size_t ahead = 0;
  for (const Letter& letter : letters) {
    EXPECT_TRUE(handshake::is_valid(letter.word, handshake::Variant::robust, 2));
    kinds |= std::size_t{1} << (handshake::index_of(letter.word.intent.kind) * handshake::published_state_count +
                                handshake::index_of(letter.word.state));
    if (letter.ahead) ++ahead;
  }
  EXPECT_EQ(std::popcount(kinds), 8) << "three states of a start, one of each other kind";
  EXPECT_EQ(3 * ahead, letters.size()) << "in turn, far ahead, and of another incarnation";
}

}  // namespace
}  // namespace takt::explore
