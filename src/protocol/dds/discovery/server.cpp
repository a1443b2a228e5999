// SPDX-License-Identifier: Apache-2.0
#include "dds/discovery/server.hpp"

#include <algorithm>
#include <set>

namespace takt::dds {
namespace {

/// Topics of the endpoints that a participant has.
template <class Data>
std::set<std::string_view> topics_of(const std::map<Guid, Data>& endpoints, const GuidPrefix& owner) {
  std::set<std::string_view> topics;
  for (auto at = endpoints.lower_bound({owner, {}}); at != endpoints.end() && at->first.prefix == owner; ++at)
    topics.insert(at->second.endpoint.topic_name);
  return topics;
}

/// Endpoints of others whose topic is among these. A topic in common is enough: a client tells its user itself why
/// types or QoS do not match.
template <class Data>
std::map<Guid, Data> wanted(const std::map<Guid, Data>& endpoints, const std::set<std::string_view>& topics,
                            const GuidPrefix& client) {
  std::map<Guid, Data> list;
  for (const auto& [guid, data] : endpoints)
    if (guid.prefix != client && topics.contains(data.endpoint.topic_name)) list.emplace_hint(list.end(), guid, data);
  return list;
}

}  // namespace

DiscoveryServer::DiscoveryServer(const BuiltinSettings& settings, const ParticipantData& self)
    : settings_(settings), self_(self.guid.prefix) {
  domain_.participants[self_] = self;
}

void DiscoveryServer::add_client(const ParticipantData& data, sim::LocalTime now, Outbox& outbox) {
  const GuidPrefix& prefix = data.guid.prefix;
  Client& client = clients_
                       .insert_or_assign(prefix, Client{make_builtin_writer(builtin_topic::participants, settings_),
                                                        make_builtin_writer(builtin_topic::publications, settings_),
                                                        make_builtin_writer(builtin_topic::subscriptions, settings_),
                                                        {}})
                       .first->second;
  domain_.participants[prefix] = data;
  sent_ += count_sent(outbox, [&] {
    client.participants.match(builtin_reader_of(data, builtin_topic::participants), now, outbox);
    client.publications.match(builtin_reader_of(data, builtin_topic::publications), now, outbox);
    client.subscriptions.match(builtin_reader_of(data, builtin_topic::subscriptions), now, outbox);
    client.told.participants[self_] = domain_.participants[self_];
    tell(client.participants, {self_, entity_id::participant}, domain_.participants[self_], now, outbox);
  });
}

void DiscoveryServer::remove_client(const GuidPrefix& client, sim::LocalTime now, Outbox& outbox) {
  clients_.erase(client);
  domain_.participants.erase(client);
  update(now, outbox);
}

KnownDomain DiscoveryServer::needs_of(const GuidPrefix& client) const {
  KnownDomain needs;
  needs.publications = wanted(domain_.publications, topics_of(domain_.subscriptions, client), client);
  needs.subscriptions = wanted(domain_.subscriptions, topics_of(domain_.publications, client), client);
  std::set<GuidPrefix> owners{self_};
  for (const auto& [guid, data] : needs.publications) owners.insert(guid.prefix);
  for (const auto& [guid, data] : needs.subscriptions) owners.insert(guid.prefix);
  for (const GuidPrefix& owner : owners)
    if (const auto at = domain_.participants.find(owner); at != domain_.participants.end())
      needs.participants.insert(*at);
  return needs;
}

void DiscoveryServer::update(sim::LocalTime now, Outbox& outbox) {
  sent_ += count_sent(outbox, [&] {
    for (auto& [prefix, client] : clients_) update(prefix, client, now, outbox);
  });
}

template <class Data>
void DiscoveryServer::tell(StatefulWriter& writer, const Guid& about, const Data& data, sim::LocalTime now,
                           Outbox& outbox) {
  std::array<std::byte, 16'384> buffer;
  const Octets payload = encode(buffer, data);
  if (payload.empty()) return;
  writer.write(ChangeKind::alive, key_hash_of(about), payload, now, outbox);
}

void DiscoveryServer::retract(StatefulWriter& writer, const Guid& about, sim::LocalTime now, Outbox& outbox) {
  std::array<std::byte, 64> buffer;
  writer.write(ChangeKind::disposed_unregistered, key_hash_of(about), encode_key(buffer, about), now, outbox);
}

// Participants come before their endpoints and go after them, so that a client always knows whose an endpoint is.
void DiscoveryServer::update(const GuidPrefix& prefix, Client& client, sim::LocalTime now, Outbox& outbox) {
  KnownDomain needs = needs_of(prefix);
  const auto announce_new = [&](StatefulWriter& writer, const auto& wanted_now, const auto& told, auto guid_of_key) {
    for (const auto& [key, data] : wanted_now) {
      const auto at = told.find(key);
      if (at != told.end() && at->second == data) continue;
      tell(writer, guid_of_key(key), data, now, outbox);
      ++forwarded_;
    }
  };
  const auto retract_old = [&](StatefulWriter& writer, const auto& wanted_now, const auto& told, auto guid_of_key) {
    for (const auto& [key, data] : told)
      if (!wanted_now.contains(key)) retract(writer, guid_of_key(key), now, outbox);
  };
  const auto same = [](const Guid& guid) { return guid; };
  const auto of_participant = [](const GuidPrefix& owner) { return Guid{owner, entity_id::participant}; };
  announce_new(client.participants, needs.participants, client.told.participants, of_participant);
  announce_new(client.publications, needs.publications, client.told.publications, same);
  announce_new(client.subscriptions, needs.subscriptions, client.told.subscriptions, same);
  retract_old(client.publications, needs.publications, client.told.publications, same);
  retract_old(client.subscriptions, needs.subscriptions, client.told.subscriptions, same);
  retract_old(client.participants, needs.participants, client.told.participants, of_participant);
  client.told = std::move(needs);
}

bool DiscoveryServer::receive(const GuidPrefix& from, const Submessage& submessage, sim::LocalTime now,
                              Outbox& outbox) {
  const auto at = clients_.find(from);
  if (at == clients_.end()) return false;
  bool taken = false;
  const auto give = [&](const auto& ack) {
    for (StatefulWriter* const writer : at->second.writers()) {
      if (writer->guid().entity != ack.writer) continue;
      sent_ += count_sent(outbox, [&] { writer->receive(Guid{from, ack.reader}, ack, now, outbox); });
      taken = true;
    }
  };
  if (const auto* const ack = std::get_if<AckNack>(&submessage)) give(*ack);
  if (const auto* const nack = std::get_if<NackFrag>(&submessage)) give(*nack);
  return taken;
}

sim::LocalTime DiscoveryServer::next_wake() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const auto& [prefix, client] : clients_)
    for (const StatefulWriter* const writer : client.writers()) next = std::min(next, writer->next_wake());
  return next;
}

void DiscoveryServer::wake(sim::LocalTime now, Outbox& outbox) {
  sent_ += count_sent(outbox, [&] {
    for (auto& [prefix, client] : clients_)
      for (StatefulWriter* const writer : client.writers())
        if (writer->next_wake() <= now) writer->wake(now, outbox);
  });
}

}  // namespace takt::dds
