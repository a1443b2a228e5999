// SPDX-License-Identifier: Apache-2.0
// The redundancy of an end station: what a talker's stack does to frames before they are queued, and a listener's
// before they are delivered (IEEE 802.1CB clause 8, talker and listener end systems).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "models/frer/stream_recovery.hpp"
#include "models/frer/stream_split.hpp"

namespace takt::models {

/// Of one talking host: the streams that it splits. A frame passes it where Talker and Process hand it to a port,
/// behind the operating system's transmit latency.
class TalkerRedundancy {
 public:
  struct Outgoing {
    FrameIndex frame;
    std::uint16_t port = 0;
    bool operator==(const Outgoing&) const = default;
  };

  /// `where`: see StreamSplit.
  void add(StreamIndex stream, const StreamSplitConfig& config, sim::ComponentId where = {});
  bool is_empty() const { return streams_.empty(); }

  /// The frames that the host sends instead of this one, and through which of its ports; none if its stream is not
  /// split here. The span lives until the next call.
  std::span<const Outgoing> send(Traffic& traffic, FrameIndex frame);

  /// Null if the stream is not split here.
  StreamSplit* find(StreamIndex stream);

 private:
  struct Entry {
    StreamIndex stream;
    StreamSplit split;
  };
  std::vector<Entry> streams_;  // ascending streams
  std::vector<Outgoing> outgoing_;
};

/// Of one listening host: the streams that it recovers. A frame passes it where its last bit is in, before the
/// operating system's receive latency.
class ListenerRedundancy {
 public:
  /// `where`: see StreamRecovery.
  void add(StreamIndex stream, const StreamRecoveryConfig& config, sim::ComponentId where = {});
  bool is_empty() const { return streams_.empty(); }

  /// The record with which the frame goes on to the listener; nothing if it is a copy too many, which the caller drops
  /// as DropReason::duplicate. `now` as in StreamRecovery::receive.
  std::optional<FrameIndex> receive(Traffic& traffic, FrameIndex frame, std::uint16_t port, sim::LocalTime now);

  /// Null if the stream is not recovered here.
  StreamRecovery* find(StreamIndex stream);
  /// For reports, with the counters of `now`.
  template <class Visit>
  void for_each(sim::LocalTime now, Visit&& visit) {
    for (Entry& entry : streams_) {
      entry.recovery.catch_up(now);
      visit(entry.stream, static_cast<const StreamRecovery&>(entry.recovery));
    }
  }

 private:
  struct Entry {
    StreamIndex stream;
    StreamRecovery recovery;
  };
  std::vector<Entry> streams_;  // ascending streams
};

}  // namespace takt::models
