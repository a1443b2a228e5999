// SPDX-License-Identifier: Apache-2.0
// What is known of deliveries beyond the account that every stream has: accounts that begin later, and which frames
// have reached whom. Only streams for which that is asked are in it; the others cost nothing.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/ethernet/sequence_ledger.hpp"
#include "sim/histogram.hpp"

namespace takt::models {

/// The account of a stream's frames that were produced at `from` or later.
struct LaterAccount {
  sim::TrueTime from;
  std::uint64_t first_sequence = std::numeric_limits<std::uint64_t>::max();  ///< of the frames that have ended
  std::uint64_t delivered = 0;
  sim::Histogram latency;
  std::array<std::uint64_t, static_cast<std::size_t>(DropReason::count)> dropped{};
};

class DeliveryBook {
 public:
  /// Frames of the stream that are produced at `from` or later are counted apart as well. Before the run.
  void keep_account(StreamIndex stream, sim::TrueTime from);
  /// Frames of the stream may arrive at the listener several times: first copies are counted apart. Before the run.
  void keep_arrivals(StreamIndex stream, NodeIndex listener);
  /// Which frames reach the listener within so long is kept, one bit a frame. Before the run.
  void keep_timely(StreamIndex stream, NodeIndex listener, sim::Duration deadline);

  /// Whether anything is kept of the stream.
  bool concerns(StreamIndex stream) const { return stream.value < entries_.size() && entries_[stream.value].is_kept; }
  bool is_empty() const { return entries_.empty(); }

  /// What another part of a divided run has counted of the same streams counts here, too.
  void adopt(const DeliveryBook& other);

  void deliver(const Frame& frame, NodeIndex listener, sim::TrueTime now);
  void drop(const Frame& frame, DropReason reason);

  std::span<const LaterAccount> accounts(StreamIndex stream) const;
  struct Arrivals {
    NodeIndex listener;
    SequenceLedger ledger = {};
    std::vector<std::uint64_t> firsts = {};  ///< by account: the first sequence number of it that has come here
  };
  /// By listener; empty if every frame comes at most once.
  std::span<const Arrivals> arrivals(StreamIndex stream) const;
  struct Timely {
    NodeIndex listener;
    sim::Duration deadline;
    std::vector<bool> came = {};  ///< by sequence number, as far as the last one that came so
  };
  std::span<const Timely> timely(StreamIndex stream) const;

 private:
  struct Entry {
    bool is_kept = false;
    std::vector<LaterAccount> accounts;
    std::vector<Arrivals> arrivals;
    std::vector<Timely> timely;
  };
  Entry& entry_of(StreamIndex stream);
  static void arrive(Arrivals& arrivals, const Entry& entry, const Frame& frame);

  std::vector<Entry> entries_;  // by stream
};

}  // namespace takt::models
