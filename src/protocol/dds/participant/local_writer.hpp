// SPDX-License-Identifier: Apache-2.0
// LocalWriter: a DataWriter of this participant: its place in RTPS, and what its application is told.
#pragma once

#include <deque>

#include "dds/discovery/data.hpp"
#include "dds/participant/event.hpp"
#include "dds/participant/participant_config.hpp"
#include "dds/persistence/kept_records.hpp"
#include "dds/rtps/stateful_writer.hpp"

namespace takt::dds {

struct LocalWriter {
  LocalWriter(WriterHandle writer_handle, const WriterConfig& writer_config, const ParticipantConfig& participant,
              const Guid& guid);
  LocalWriter(const LocalWriter&) = delete;

  WriterHandle handle;
  WriterConfig config;
  PublicationData data;  ///< what discovery tells of it
  std::optional<KeptChanges> kept;
  StatefulWriter rtps;
  FlowController* flow = nullptr;

  struct Wait {
    InstanceKey key;
    sim::LocalTime until;
  };
  std::optional<Wait> wait;                              ///< a write that would block
  sim::LocalTime lease_until = sim::LocalTime::never();  ///< of manual liveliness
  bool is_alive = true;

  MatchedStatus matched;
  IncompatibleQosStatus incompatible;
  DeadlineMissedStatus deadline_missed;
  LivelinessLostStatus liveliness_lost;

  void write(CacheChange change, sim::LocalTime now, Outbox& outbox);
  void assert_liveliness(sim::LocalTime now);
  sim::LocalTime next_wake() const;
  /// Deadlines, leases, waiting writes.
  void wake(sim::LocalTime now, std::deque<Event>& events);
  /// A waiting write may have found room.
  void check_wait(sim::LocalTime now, std::deque<Event>& events);
};

}  // namespace takt::dds
