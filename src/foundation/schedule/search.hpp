// SPDX-License-Identifier: Apache-2.0
// From a problem to a schedule.
//
// Many attempts, each with a number that says in which order it places streams and how it goes on when one does not
// fit: then whoever is in the way at the cheapest place is taken out and placed again, and becomes dearer each time.
// Attempts share nothing, and of those that succeed the one of the lowest number counts, so the result is a function of
// problem and options, whatever the number of jobs. Only a stop from outside (a limit of time) can make a search end
// undecided earlier on a slower machine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "schedule/certificate.hpp"
#include "schedule/routes.hpp"
#include "schedule/solution.hpp"

namespace takt::schedule {

/// What is better of two schedules; less is better.
using Score = std::function<std::int64_t(const Solution&)>;

/// Why a certificate proves nothing; empty: it proves what it claims.
using Judge = std::function<std::string(const Problem&, const Certificate&)>;

/// Asked often, from several threads; true: give up.
using Stop = std::function<bool()>;

struct SearchOptions {
  RouteChoice routes = RouteChoice::search;
  std::uint64_t seed = 1;
  unsigned jobs = 1;
  std::uint32_t first = 0;              ///< number of the first attempt
  std::uint32_t attempts = 64;          ///< number behind the last one
  std::vector<std::uint64_t> hardness;  ///< by stream, of attempts before: those that were moved most are placed first
                                        ///< by some attempts; empty: nothing is known
  std::uint32_t most_ways = 16;         ///< of a stream without prescribed route
  Score score;  ///< if there is one, the first `scored` attempts all count, and the best of them is taken
  std::uint32_t scored = 12;
  Stop stop = [] { return false; };
  Judge judge;  ///< of certificates: what it rejects is not proved, and the search goes on; empty: all are taken
};

/// A stream that is left over, and who stands in its way at the cheapest place.
struct LeftOver {
  StreamIndex stream = 0;
  std::vector<StreamIndex> in_the_way;
};

struct SearchResult {
  Solution solution;  ///< complete if nothing is left over, else the best partial one
  std::vector<LeftOver> left_over;
  bool is_complete() const { return left_over.empty(); }
  std::uint32_t attempt = 0;            ///< the one that it is from
  std::uint64_t steps = 0;              ///< of that attempt: streams placed or placed again
  std::vector<std::uint64_t> hardness;  ///< by stream: how often attempts moved it, these and those before
};

/// One quick try: each stream once, on its first way, nobody taken out.
SearchResult place_once(const Problem& problem, const SearchOptions& options);

/// All attempts, from `first` on.
SearchResult search(const Problem& problem, const SearchOptions& options);

}  // namespace takt::schedule
