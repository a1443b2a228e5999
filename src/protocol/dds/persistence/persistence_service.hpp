// SPDX-License-Identifier: Apache-2.0
// PersistenceService: keeps the last samples of durable topics for readers that come later, across the end of their
// writers (TRANSIENT) and of the service itself (PERSISTENT) (DDS 1.4, 2.2.3.4, 2.2.3.5). Sans-IO, like the participant
// that it speaks through.
#pragma once

#include <map>

#include "dds/participant/participant.hpp"

namespace takt::dds {

struct DurableTopic {
  std::string topic;
  std::string type;
  bool has_key = false;
  /// What the service's writer offers: as the topic's writers do, with durability TRANSIENT or PERSISTENT. Its
  /// durability_service tells how much is kept. OWNERSHIP EXCLUSIVE is refused: samples of a service have no strength.
  DataWriterQos qos;
};

/// Everything that it brings names its original writer, so that readers that have it already take it once.
class PersistenceService {
 public:
  /// `name`: the service's persistence GUID, by which it finds its topics in the storage again; its entity is not used.
  PersistenceService(Participant& participant, Storage& storage, const GuidPrefix& name)
      : participant_(participant), storage_(storage), name_(name) {}

  /// Problems, each as "policy or setting: what and why"; none: the topic is kept from now on.
  std::vector<std::string> add(const DurableTopic& topic, sim::LocalTime now);

  /// To be called after each call of the participant: takes what came, and keeps it.
  void run(sim::LocalTime now);
  /// When instances that have ended are cleaned up next.
  sim::LocalTime next_wake() const;

  /// Samples of the topic that it keeps now.
  std::size_t kept(const std::string& topic) const;
  /// Samples of the topic that it has taken from writers since it was made.
  std::uint64_t received(const std::string& topic) const;
  /// Its endpoints; nothing for a topic that it does not keep.
  std::optional<WriterHandle> writer_of(const std::string& topic) const;
  std::optional<ReaderHandle> reader_of(const std::string& topic) const;

 private:
  struct Place {
    ReaderHandle reader;
    WriterHandle writer;
    sim::Duration cleanup_delay;
    std::optional<Sample> held;  ///< waits for room
    std::uint64_t received = 0;
    bool cleanup_waits = false;  ///< for room, too
    std::map<std::pair<sim::LocalTime, InstanceKey>, OriginalWriter> cleanups;
  };
  /// False if there is no room.
  bool keep(Place& place, const Sample& sample, sim::LocalTime now);

  Participant& participant_;
  Storage& storage_;
  GuidPrefix name_;
  std::map<std::string, Place> places_;
};

}  // namespace takt::dds
