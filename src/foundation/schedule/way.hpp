// SPDX-License-Identifier: Apache-2.0
// A way that a stream may take, with all that the search asks about it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "schedule/timing.hpp"

namespace takt::schedule {

struct Way {
  std::vector<LinkIndex> links;       ///< a tree, each behind the one that it continues
  std::vector<std::int32_t> parents;  ///< index of that one; -1 at the talker
  std::vector<Ps> lags;               ///< from the start at the talker to the earliest start on the link
  std::vector<Ps> occupied;           ///< how long on each link
  std::vector<Ps> tails;  ///< from the start on the link until the last listener behind it has all, if nothing waits
  bool delays_trains = false;  ///< frames of a train stand in a bridge until its last can go behind them
  Ps arrival = 0;              ///< from the start at the talker until the last listener has all, if nothing waits
};

/// The way along these links, each behind the one that it continues. Nothing if they are no such tree, end at no
/// listener, or cannot be taken (a train that nothing may delay comes to a faster link), or in less than the stream's
/// latency.
std::optional<Way> make_way(const Timing& timing, const Stream& stream, std::span<const LinkIndex> links);

/// When a stream may start at its talker on this way: [first, last], at most one period; last < first if there is no
/// such time.
struct StartWindow {
  Ps first = 0;
  Ps last = -1;
  bool is_empty() const { return last < first; }
};
StartWindow start_window(const Stream& stream, const Way& way);

}  // namespace takt::schedule
