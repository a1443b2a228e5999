// SPDX-License-Identifier: Apache-2.0
// How the tests of the explorer ask.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <span>

#include "explore/report/report.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {

/// The query with so many calls, and a fault budget of 1 for these.
inline Query with(Query query, std::uint32_t commands, std::span<const Fault> faults) {
  query.commands = commands;
  for (const Fault each : faults) query.faults.insert(each);
  return query;
}

inline SearchResult ask(const Query& query) {
  return explore(query, [](const Progress&) { return true; });
}

/// All is searched and holds, and it is as large as it has always been.
struct Case {
  Query query;
  std::uint64_t states = 0;
  std::uint64_t transitions = 0;
};
inline SearchResult expect_to_hold(const Case& each) {
  SCOPED_TRACE(query_line(each.query));
  const SearchResult result = ask(each.query);
  EXPECT_TRUE(result.exhausted && result.all_hold()) << text_report(each.query, result, 0.0);
  EXPECT_EQ(result.states, each.states);
  EXPECT_EQ(result.transitions, each.transitions);
  return result;
}

}  // namespace takt::explore
