// SPDX-License-Identifier: Apache-2.0
// Discovery: finds participants and their endpoints, and tells others about ours (DDSI-RTPS 8.5). Sans-IO: messages in,
// messages and events out.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>

#include "dds/discovery/builtin_endpoints.hpp"
#include "dds/discovery/figures.hpp"
#include "dds/discovery/settings.hpp"
#include "dds/message/decoder.hpp"

namespace takt::dds {

class DiscoveryServer;

/// What has become known. The data are in Discovery's tables; of what is lost, no longer.
struct DiscoveryEvent {
  enum class Kind : std::uint8_t {
    participant_found,
    participant_lost,   ///< after all its endpoints
    publication_found,  ///< or changed
    publication_lost,
    subscription_found,  ///< or changed
    subscription_lost,
    liveliness_asserted,  ///< by a ParticipantMessage; `subject` is the participant
  };
  Kind kind = Kind::participant_found;
  sim::LocalTime at;
  Guid subject;
  ParticipantMessageData::Kind liveliness = ParticipantMessageData::Kind::unknown;
};

class Discovery {
 public:
  struct Settings {
    DiscoverySettings discovery;
    TimingProfile timing;            ///< of the reliable built-in endpoints
    std::size_t max_message = 1472;  ///< octets of an RTPS message
    Epoch epoch;
  };
  /// `self` is what is announced; lease and built-in endpoints are filled in here.
  Discovery(const Settings& settings, const ParticipantData& self);
  ~Discovery();
  Discovery(const Discovery&) = delete;

  const ParticipantData& self() const { return self_; }

  void start(sim::LocalTime now, Outbox& outbox);
  /// Takes leave, so that others need not wait for the end of the lease.
  void stop(sim::LocalTime now, Outbox& outbox);

  /// An endpoint of ours that is new, or has other policies.
  void announce(const PublicationData& data, sim::LocalTime now, Outbox& outbox);
  void announce(const SubscriptionData& data, sim::LocalTime now, Outbox& outbox);
  void withdraw(const Guid& endpoint, sim::LocalTime now, Outbox& outbox);

  /// Tells all participants that writers of this kind of liveliness are alive.
  void assert_liveliness(ParticipantMessageData::Kind kind, sim::LocalTime now, Outbox& outbox);

  /// Whether a submessage is between built-in endpoints; then it was taken. The destination has been looked at before.
  bool receive(const Interpretation& from, const Submessage& submessage, sim::LocalTime now, Outbox& outbox);
  /// Any message of a participant says that it is there, and renews its lease.
  void heard(const GuidPrefix& participant, sim::LocalTime now);

  sim::LocalTime next_wake() const;
  void wake(sim::LocalTime now, Outbox& outbox);

  /// Events in the order in which they happened; nothing if there are no more.
  std::optional<DiscoveryEvent> next_event();

  // What is known of others, in the order of their GUIDs.
  const std::map<GuidPrefix, ParticipantData>& participants() const { return found_; }
  const std::map<Guid, PublicationData>& publications() const { return publications_; }
  const std::map<Guid, SubscriptionData>& subscriptions() const { return subscriptions_; }

  // How a found endpoint is reached; where it tells no locators, those of its participant hold. Only UDP over IPv4 is
  // used.
  MatchedWriter matched_writer(const PublicationData& data) const;
  MatchedReader matched_reader(const SubscriptionData& data) const;

  DiscoveryFigures figures() const;

 private:
  friend class DiscoveryServer;
  struct Lease {
    sim::Duration duration;
    sim::LocalTime until;
  };

  EndpointData brief(EndpointData endpoint) const;
  void send_participant_data(const Route& route, sim::LocalTime now, Outbox& outbox);
  void announce_self(sim::LocalTime now, Outbox& outbox);
  void plan_announcement(sim::LocalTime now);
  void receive_participant(const Interpretation& from, const Data& data, sim::LocalTime now, Outbox& outbox);
  void found(const ParticipantData& data, sim::LocalTime now, Outbox& outbox);
  void add_static_endpoints(const ParticipantData& data, sim::LocalTime now);
  void lose_participant(const GuidPrefix& prefix, sim::LocalTime now, Outbox& outbox);
  void read_news(sim::LocalTime now, Outbox& outbox);
  void found(const PublicationData& data, sim::LocalTime now);
  void found(const SubscriptionData& data, sim::LocalTime now);
  void lost(const Guid& endpoint, sim::LocalTime now);
  void tell(DiscoveryEvent::Kind kind, const Guid& subject, sim::LocalTime now);
  bool is(DiscoveryKind kind) const { return settings_.discovery.kind == kind; }
  BuiltinSettings builtin_settings() const;

  Settings settings_;
  ParticipantData self_;
  BuiltinEndpoints builtin_;
  std::unique_ptr<DiscoveryServer> server_;  ///< of a server
  std::map<GuidPrefix, ParticipantData> found_;
  std::map<GuidPrefix, Lease> leases_;  ///< of those that we hear ourselves
  std::map<Guid, PublicationData> publications_;
  std::map<Guid, SubscriptionData> subscriptions_;
  std::deque<DiscoveryEvent> events_;
  std::uint32_t announced_ = 0;
  bool has_server_ = false;  ///< of a client: one has answered
  sim::LocalTime announce_at_ = sim::LocalTime::never();
  bool is_running_ = false;
  DiscoveryFigures figures_;
};

}  // namespace takt::dds
