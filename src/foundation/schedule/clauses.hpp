// SPDX-License-Identifier: Apache-2.0
// Clauses that hold in every schedule of some strictly periodic streams.
//
// For each stream and link that it must cross there is a number u: by how much later it starts there than it could if
// it had begun at 0 and had not waited. Where it may not wait, u is the same on all links. A literal says that u, or
// its rest by a modulus, is at least a threshold; thresholds stand a `width` apart. All that matters is a multiple of a
// unit (lengths, ways, moduli, slacks), so there is a schedule only if there is one in which all starts are multiples
// of it, and with a width of one unit the clauses say all that is known of the links that streams must cross.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "schedule/certificate.hpp"
#include "schedule/crossings.hpp"

namespace takt::schedule {

/// A stream at the links that it must cross to be in time.
struct Course {
  struct At {
    LinkIndex link = 0;
    Ps lag = 0;  ///< from the start at the talker to the earliest start here
    Ps work = 0;
  };
  std::vector<At> links;   ///< in order of the lags
  Ps slack = 0;            ///< how long it may wait altogether
  Ps first = 0, last = 0;  ///< when it may start at its talker
};

/// Nothing for streams that no clauses can be made of: several listeners, or all the time there is.
std::optional<Course> course_of(const Crossings& crossings, const Stream& stream);

struct Clauses {
  std::optional<StreamIndex> anchor;
  std::vector<Threshold> thresholds;
  std::vector<Clause> clauses;
  std::vector<std::pair<StreamIndex, StreamIndex>> about;  ///< by clause: two streams, or one twice
};

class ClauseMaker {
 public:
  /// Of these streams, all with a course.
  ClauseMaker(const Problem& problem, std::span<const StreamIndex> streams,
              std::span<const std::optional<Course>> courses);

  Ps unit() const { return unit_; }
  /// How many thresholds there would be with that width, roughly.
  std::uint64_t size(Ps width) const;
  /// All clauses; `width` is a multiple of the unit.
  Clauses make(Ps width);

 private:
  struct Line;  ///< one number and its thresholds
  struct Member {
    StreamIndex stream = 0;
    Ps period = 0;
    Ps slack = 0;
    Ps first = 0, last = 0;         ///< of u on any link
    std::vector<Course::At> links;  ///< that others of the streams cross, too
    std::optional<std::size_t> place(LinkIndex link) const;
  };

  std::vector<Member> members_;
  std::optional<std::size_t> anchor_;
  Ps unit_ = 0;
};

}  // namespace takt::schedule
