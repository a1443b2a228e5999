// SPDX-License-Identifier: Apache-2.0
// Why there is no schedule: claims that a checker can work out by itself from the problem.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "schedule/problem.hpp"

namespace takt::schedule {

/// What clauses speak of: "the stream starts on the link at least `at` later than it could if it had begun at 0 and had
/// not waited"; with a modulus the rest of that by it.
struct Threshold {
  StreamIndex stream = 0;
  LinkIndex link = 0;
  Ps modulus = 0;  ///< 0: none
  Ps at = 0;
  bool operator==(const Threshold&) const = default;
};

/// Literals n and -n: threshold n - 1 holds, or does not.
using Clause = std::vector<std::int32_t>;

/// Axioms each follow from what one stream may do on its links, or from what two may do on one. A step follows from
/// clauses before it (axioms first, then steps, counted from 0): if none of its literals holds, each of them in turn
/// leaves one literal more to hold, and the last none. The last step, or without steps the last axiom, is the empty
/// clause.
struct ClausalProof {
  struct Step {
    Clause clause;
    std::vector<std::uint32_t> from;
    bool operator==(const Step&) const = default;
  };
  std::optional<StreamIndex> anchor;  ///< begins at 0: nobody has a deadline, and all may be shifted together
  std::vector<Threshold> thresholds;
  std::vector<Clause> axioms;
  std::vector<Step> steps;
};

/// What the kinds claim. A stream must cross links if one of its listeners cannot be reached without them.
///
/// - latency: the fastest way of `streams[0]` to `listener` takes longer than its latency, or than from its release to
/// its deadline.
/// - load: the streams must cross the links, and bring more than there are links.
/// - interval: the jobs must be sent on the link between `from` and `until`, and take longer.
/// - folded: the streams must cross the link strictly periodically, and fill more than the modulus.
/// - pair: two strictly periodic streams of one listener each meet on some link that both must cross, whatever their
/// phases: they have too little time to wait for each other.
/// - clausal: strictly periodic streams of one listener each have no place beside each other; `clauses` leads to a
/// contradiction.
struct Certificate {
  enum class Kind : std::uint8_t { latency, load, interval, folded, pair, clausal };
  Kind kind = Kind::latency;
  std::vector<StreamIndex> streams;
  NodeIndex listener = 0;
  std::vector<LinkIndex> links;  ///< of an interval and a folded load the first one
  Ps from = 0;
  Ps until = 0;
  std::vector<std::pair<StreamIndex, std::uint64_t>> jobs;  ///< stream and repetition
  Ps modulus = 0;
  bool in_time = false;  ///< a way that is too slow for latency or deadline is none
  ClausalProof clauses;
};

}  // namespace takt::schedule
