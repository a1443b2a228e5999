// SPDX-License-Identifier: Apache-2.0
// What an exploration says: a page for people, and JSON.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "explore/model/query.hpp"
#include "explore/parts/views.hpp"
#include "explore/search/search.hpp"
#include "json/type.hpp"

namespace takt::explore {

/// "robust" or "paper".
std::string_view variant_of(const Query& query);
/// Which may happen.
std::vector<std::string_view> faults_of(const Query& query);
/// The query in one line: who, which calls, which faults.
std::string query_line(const Query& query);
/// How much is said of a violation: its chart and why it happens, or also what is known after each step.
enum class Detail : std::uint8_t { why, knowledge };
/// Sizes, verdicts and, for each violated property, its chart. `cpu_s` was measured by whoever asked.
std::string text_report(const Query& query, const SearchResult& result, double cpu_s, Detail detail = Detail::why);

/// What `takt explore --format json` holds of a group.
struct Exploration {
  std::string program;  ///< of a scenario; else empty
  Query query;
  SearchResult result;
  double cpu_s = 0;  ///< as for text_report()
};
const json::Record& describe(json::Type<Exploration>);

/// What was proved for every number of slaves. Where a property is "not proved", `takt explore --slaves N` looks for a
/// run.
std::string text_report(const Query& query, const AnyNumber& proof, double cpu_s);

}  // namespace takt::explore
