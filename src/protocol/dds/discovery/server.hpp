// SPDX-License-Identifier: Apache-2.0
// DiscoveryServer: tells each client of other clients' endpoints what it needs for its matches, and of their
// participants, and no more.
#pragma once

#include <map>

#include "dds/discovery/builtin_endpoints.hpp"
#include "dds/discovery/data.hpp"

namespace takt::dds {

/// What a server knows of a domain: participants and endpoints, its own among them.
struct KnownDomain {
  std::map<GuidPrefix, ParticipantData> participants;
  std::map<Guid, PublicationData> publications;
  std::map<Guid, SubscriptionData> subscriptions;
};

class DiscoveryServer {
 public:
  DiscoveryServer(const BuiltinSettings& settings, const ParticipantData& self);

  KnownDomain& domain() { return domain_; }

  /// The first thing that a client is told is the server itself.
  void add_client(const ParticipantData& client, sim::LocalTime now, Outbox& outbox);
  /// Preceded by the loss of the client's endpoints.
  void remove_client(const GuidPrefix& client, sim::LocalTime now, Outbox& outbox);
  bool is_client(const GuidPrefix& prefix) const { return clients_.contains(prefix); }

  /// The domain has changed: tells each client what is new for it.
  void update(sim::LocalTime now, Outbox& outbox);

  /// Acknowledgements of clients.
  bool receive(const GuidPrefix& from, const Submessage& submessage, sim::LocalTime now, Outbox& outbox);
  sim::LocalTime next_wake() const;
  void wake(sim::LocalTime now, Outbox& outbox);

  MessageCount sent() const { return sent_; }
  std::uint64_t forwarded() const { return forwarded_; }

 private:
  /// Each client has writers of its own, as far as it can see: one sequence of numbers for what it is told.
  struct Client {
    StatefulWriter participants;
    StatefulWriter publications;
    StatefulWriter subscriptions;
    KnownDomain told;
    std::array<StatefulWriter*, 3> writers() { return {&participants, &publications, &subscriptions}; }
    std::array<const StatefulWriter*, 3> writers() const { return {&participants, &publications, &subscriptions}; }
  };

  KnownDomain needs_of(const GuidPrefix& client) const;
  void update(const GuidPrefix& prefix, Client& client, sim::LocalTime now, Outbox& outbox);
  template <class Data>
  void tell(StatefulWriter& writer, const Guid& about, const Data& data, sim::LocalTime now, Outbox& outbox);
  void retract(StatefulWriter& writer, const Guid& about, sim::LocalTime now, Outbox& outbox);

  BuiltinSettings settings_;
  GuidPrefix self_;
  KnownDomain domain_;
  std::map<GuidPrefix, Client> clients_;
  MessageCount sent_;
  std::uint64_t forwarded_ = 0;
};

}  // namespace takt::dds
