// SPDX-License-Identifier: Apache-2.0
// LocalReader: a DataReader of this participant: its place in RTPS, and what its application is told.
#pragma once

#include <deque>

#include "dds/discovery/data.hpp"
#include "dds/participant/event.hpp"
#include "dds/participant/participant_config.hpp"
#include "dds/persistence/kept_records.hpp"
#include "dds/rtps/stateful_reader.hpp"

namespace takt::dds {

struct LocalReader {
  LocalReader(ReaderHandle reader_handle, const ReaderConfig& reader_config, const ParticipantConfig& participant,
              const Guid& guid);
  LocalReader(const LocalReader&) = delete;

  ReaderHandle handle;
  ReaderConfig config;
  SubscriptionData data;  ///< what discovery tells of it
  std::optional<KeptNumbers> kept;
  StatefulReader rtps;

  MatchedStatus matched;
  IncompatibleQosStatus incompatible;

  std::optional<Sample> take(sim::LocalTime now, Outbox& outbox);
  /// The sample was dealt with and is not wanted again, not even after a restart.
  void commit(const SampleInfo& info);
  /// Tells of statuses that have changed since the last time.
  void report(sim::LocalTime now, std::deque<Event>& events);

 private:
  std::map<Guid, NumberRanges> taken_;
  std::uint64_t rejected_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t deadline_missed_ = 0;
  std::uint64_t liveliness_changes_ = 0;
};

}  // namespace takt::dds
