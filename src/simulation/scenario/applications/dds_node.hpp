// SPDX-License-Identifier: Apache-2.0
// The participant of an application in a domain of DDS, on a simulated host: datagrams to streams, streams to
// datagrams.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "dds/persistence/persistence_service.hpp"
#include "models/host/application.hpp"
#include "scenario/resolved/resolved_applications.hpp"
#include "scenario/resolved/resolved_dds.hpp"

namespace takt::scenario {

/// What a participant did, its crashes included.
struct ParticipantFigures {
  std::uint64_t messages_sent = 0;
  std::uint64_t octets_sent = 0;
  std::uint64_t messages_received = 0;
  std::uint64_t heartbeats_sent = 0;
  std::uint64_t acknacks_sent = 0;
  std::uint64_t resent = 0;              ///< samples or fragments
  std::uint64_t discovery_messages = 0;  ///< sent
  std::uint64_t discovery_octets = 0;
  std::uint64_t participants_found = 0;
  std::uint64_t participants_lost = 0;
  std::uint64_t matches = 0;
  std::optional<sim::Duration> time_to_match;  ///< from the last start to the last match since
  std::uint64_t deadlines_missed = 0;
  std::uint64_t liveliness_lost = 0;
  std::uint64_t samples_rejected = 0;
  std::uint64_t writes_timed_out = 0;
  std::uint64_t unroutable = 0;           ///< datagrams to nobody in the scenario
  std::vector<std::string> incompatible;  ///< what did not match and why, each once
};

/// What a persistence service did with a topic, its crashes included.
struct KeptFigures {
  std::string topic;
  std::uint64_t received = 0;  ///< samples, from their writers
  std::uint64_t restored = 0;  ///< samples that its last start found in its storage
  std::uint64_t kept = 0;      ///< samples now; before a crash, if it is down
};

class DdsNode {
 public:
  /// All references outlive it. `keeps`: of a persistence service.
  DdsNode(const ResolvedParticipant& participant, std::uint32_t number, std::vector<dds::DurableTopic> keeps = {});
  ~DdsNode();

  void start(models::HostServices& host);
  void crash();
  bool is_running() const { return participant_ != nullptr; }
  dds::Participant& participant() { return *participant_; }
  const dds::Participant& participant() const { return *participant_; }
  /// Keeps what survives a crash; null where nothing is to.
  dds::Storage* storage(plant::Durability durability);
  /// A name of an endpoint that survives restarts.
  dds::Guid persistence_guid(std::uint32_t thread) const;

  void receive(models::HostServices& host, models::StreamIndex stream, uadp::Octets message);
  void wake(models::HostServices& host);
  sim::LocalTime next_wake() const {
    return service_ ? std::min(participant_->next_wake(), service_->next_wake()) : participant_->next_wake();
  }
  /// Sends what the participant wants to send and hears what it tells. To be called after anything was done with it.
  void settle(models::HostServices& host);

  /// A write that had blocked can go on, or has timed out; asked once.
  bool is_write_possible(dds::WriterHandle writer);
  bool is_write_timed_out(dds::WriterHandle writer);

  const ResolvedParticipant& settings() const { return *settings_; }
  ParticipantFigures figures() const;
  /// By topic; none but of a persistence service.
  std::vector<KeptFigures> kept() const;

 private:
  void start_service(sim::LocalTime now);
  void send(models::HostServices& host, const dds::DatagramView& datagram);
  void hear(const dds::Event& event);
  void add_up(ParticipantFigures& figures) const;

  const ResolvedParticipant* settings_;
  std::uint32_t number_;
  std::uint32_t incarnation_ = 0;
  std::unique_ptr<dds::Participant> participant_;
  std::vector<dds::DurableTopic> keeps_;
  std::unique_ptr<dds::PersistenceService> service_;
  std::vector<KeptFigures> kept_;  // of keeps_
  dds::MemoryStorage transient_;
  dds::MemoryStorage persistent_;
  sim::LocalTime started_;
  std::vector<std::uint32_t> writable_;
  std::vector<std::uint32_t> timed_out_;
  ParticipantFigures figures_;  // what events tell, and what crashed participants had counted
};

}  // namespace takt::scenario
