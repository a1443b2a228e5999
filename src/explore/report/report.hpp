// What an exploration says: a page for people, and JSON.
#pragma once

#include <string>

#include "explore/model/query.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {

/// The query in one line: who, which calls, which faults.
std::string query_line(const Query& query);
/// Sizes, verdicts and, for each violated property, its chart. `cpu_s` was measured by whoever asked.
std::string text_report(const Query& query, const SearchResult& result, double cpu_s);
/// One object: variant, slaves, faults, states, depth, cpu_s, exhausted, properties and some more figures.
/// One object; without the member "program" if that is empty. A property that is not asked is left out.
std::string json_report(const std::string& program, const Query& query, const SearchResult& result, double cpu_s);

}  // namespace takt::explore
