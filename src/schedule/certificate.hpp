// Why there is no schedule: claims that a checker can work out by itself from the problem.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "schedule/problem.hpp"

namespace takt::schedule {

/// What the kinds claim. A stream must cross links if one of its listeners cannot be reached without them.
///
/// - latency: the fastest way of `streams[0]` to `listener` takes longer than its latency, or than from its release to its deadline.
/// - load: the streams must cross the links, and bring more than there are links.
/// - interval: the jobs must be sent on the link between `from` and `until`, and take longer.
/// - folded: the streams must cross the link strictly periodically, and fill more than the modulus.
/// - pair: two strictly periodic streams of one listener each meet on some link that both must cross, whatever their phases: they have too little time to wait for each other.
struct Certificate {
  enum class Kind : std::uint8_t { latency, load, interval, folded, pair };
  Kind kind = Kind::latency;
  std::vector<StreamIndex> streams;
  NodeIndex listener = 0;
  std::vector<LinkIndex> links;                              ///< of an interval and a folded load the first one
  Ps from = 0;
  Ps until = 0;
  std::vector<std::pair<StreamIndex, std::uint64_t>> jobs;   ///< stream and repetition
  Ps modulus = 0;
  bool in_time = false;                                      ///< a way that is too slow for latency or deadline is none
};

}  // namespace takt::schedule
