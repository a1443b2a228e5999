// SPDX-License-Identifier: Apache-2.0
// Which links a stream cannot do without, and how soon it can be anywhere.
#pragma once

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "schedule/timing.hpp"

namespace takt::schedule {

inline constexpr Ps never = std::numeric_limits<Ps>::max();

class Crossings {
 public:
  explicit Crossings(const Problem& problem);

  /// Least time from the start at the talker to the start on each link, by link; `never` where there is no way. Over
  /// the prescribed links, or all that do not pass through end stations.
  std::vector<Ps> earliest_starts(const Stream& stream) const;
  /// The same from a start on that link on.
  std::vector<Ps> earliest_starts_from(const Stream& stream, LinkIndex first) const;
  /// Until all is at the listener, given those starts.
  Ps arrival(const Stream& stream, NodeIndex listener, const std::vector<Ps>& starts) const;
  /// Links without which some listener cannot be reached; with `in_time`, or not within latency and deadline.
  std::vector<LinkIndex> needed(const Stream& stream, bool in_time) const;
  /// Whether the listener can be reached without links that are `without`.
  bool reaches(const Stream& stream, NodeIndex listener, const std::vector<std::uint8_t>& without) const;
  bool reaches_in_time(const Stream& stream, NodeIndex listener, LinkIndex without) const;
  const Timing& timing() const { return timing_; }

 private:
  std::vector<Ps> spread(const Stream& stream, const std::vector<std::pair<Ps, LinkIndex>>& from,
                         std::optional<LinkIndex> without = std::nullopt) const;
  bool may_use(const Stream& stream, LinkIndex link) const;

  const Problem* problem_;
  Timing timing_;
  std::vector<std::vector<LinkIndex>> leaving_;
};

}  // namespace takt::schedule
