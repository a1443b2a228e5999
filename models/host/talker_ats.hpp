// SPDX-License-Identifier: Apache-2.0
// Asynchronous traffic shaping at the talker: what an end station sends gets its eligibility time where it comes to the
// network interface. Each stream has a scheduler of its own, alone in its group (IEEE 802.1Q clause 8.6.5.6: a talker's
// stream comes by no reception port that it would share with others), and no maximum residence time: its own host has
// nobody else to be protected from.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "models/ethernet/sizes.hpp"
#include "models/ethernet/traffic.hpp"
#include "models/ingress/ats_scheduler.hpp"

namespace takt::models {

class TalkerAts {
 public:
  bool is_empty() const { return streams_.empty(); }

  /// `burst` as in AtsSchedulerConfig; `counts_overhead`: preamble and inter-packet gap count.
  void add(StreamIndex stream, sim::DataRate rate, Octets burst, bool counts_overhead) {
    const auto at = std::lower_bound(streams_.begin(), streams_.end(), stream,
                                     [](const Entry& entry, StreamIndex s) { return entry.stream < s; });
    TAKT_CHECK(at == streams_.end() || at->stream != stream, "a stream has one scheduler at its talker");
    streams_.insert(at, {stream, counts_overhead, AtsScheduler(rate, std::uint64_t{8} * burst.count), {}});
  }

  /// Gives a frame of a stream that is shaped here its eligibility time. Frames have a class by their priority as
  /// before.
  void shape(Frame& frame, sim::LocalTime now) {
    const auto at = std::lower_bound(streams_.begin(), streams_.end(), frame.stream,
                                     [](const Entry& entry, StreamIndex s) { return entry.stream < s; });
    if (at == streams_.end() || at->stream != frame.stream) return;
    const Octets length = at->counts_overhead ? wire_length(Octets{frame.length}) : Octets{frame.length};
    const std::optional<sim::LocalTime> eligible = at->scheduler.process(length, now, at->group);
    TAKT_CHECK(eligible.has_value(), "a talker's scheduler holds a frame as long as it takes");
    frame.eligible = *eligible;
    frame.marked = true;
  }

 private:
  struct Entry {
    StreamIndex stream;
    bool counts_overhead = true;
    AtsScheduler scheduler;
    AtsGroup group;
  };
  std::vector<Entry> streams_;  // ascending streams
};

}  // namespace takt::models
