// SPDX-License-Identifier: Apache-2.0
// WriterProxy: which changes of a writer a reader has, lacks, or need not wait for (DDSI-RTPS 2.5, 8.4.10.4).
#pragma once

#include <map>

#include "dds/history/cache_change.hpp"
#include "dds/rtps/endpoint.hpp"
#include "dds/rtps/reassembly.hpp"

namespace takt::dds {

/// Bounds of what one writer may make a reader keep that it cannot deliver yet.
struct ReceiveLimits {
  std::size_t max_pending = 1024;  ///< changes that wait for earlier ones
  std::size_t max_pending_octets = 16u << 20;
  std::size_t max_reassemblies = 16;         ///< samples that lack fragments
  std::size_t max_sample_octets = 8u << 20;  ///< of a sample in fragments
  std::size_t max_gaps = 1024;               ///< separate ranges of changes that do not come
};

/// A change that came before those in front of it.
struct PendingChange {
  ChangeKind kind = ChangeKind::alive;
  InstanceKey key{};
  sim::LocalTime source;
  std::optional<OriginalWriter> original;
  std::vector<std::byte> payload;
};

struct WriterProxy {
  MatchedWriter writer;
  bool reliable = false;

  SequenceNumber next = first_sequence_number;  ///< all before are delivered, lost, or none of the reader's business
  bool is_new = true;                           ///< nothing has told yet where the writer's samples begin
  SequenceNumber announced{0};                  ///< the highest that the writer has told of
  std::map<SequenceNumber, PendingChange> pending;
  std::size_t pending_octets = 0;
  std::map<SequenceNumber, SequenceNumber>
      gaps;  ///< beyond `next`: begin and end of ranges that do not come; neither overlapping nor touching
  std::map<SequenceNumber, Reassembly> reassemblies;
  bool is_blocked = false;    ///< the history had no room for `next` ...
  InstanceKey blocked_key{};  ///< ... which is of this instance

  std::uint32_t last_heartbeat = 0;
  std::uint32_t last_heartbeat_frag = 0;
  std::optional<sim::LocalTime> heard_at;  ///< the last HEARTBEAT that was not passed over
  std::uint32_t ack_count = 0;
  std::uint32_t nack_frag_count = 0;
  sim::LocalTime answer_at = sim::LocalTime::never();
  bool answer_is_final = true;
  sim::Duration
      greeting_delay{};  ///< from the match, and then between ACKNACKs, until the writer is heard; 0: there are none
  sim::LocalTime repeat_at = sim::LocalTime::never();
  std::optional<sim::LocalTime> answered_at;
  SequenceNumberSet answered;

  bool is_alive = true;
  sim::LocalTime alive_until = sim::LocalTime::never();

  /// Neither here nor known not to come.
  bool is_missing(SequenceNumber number) const;
  /// What to ask for: from `next` on, without what comes in fragments.
  SequenceNumberSet missing() const;
  /// Whether anything that the writer has told of is missing, fragments included.
  bool lacks_anything() const;
  /// [from, to) does not come. False if there are too many ranges already.
  bool add_gap(SequenceNumber from, SequenceNumber to, const ReceiveLimits& limits);
  /// The end of the gap that `number` lies in, or `number` itself.
  SequenceNumber gap_end(SequenceNumber number) const;
  /// Forgets all below `next`.
  void tidy();
};

}  // namespace takt::dds
