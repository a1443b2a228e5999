// SPDX-License-Identifier: Apache-2.0
#include "dds/discovery/discovery.hpp"

#include <algorithm>

#include "dds/discovery/server.hpp"
#include "sim/check.hpp"

namespace takt::dds {
namespace {

/// Large enough for names and locators of any sense; what is larger does not fit into messages either.
constexpr std::size_t most_data = 16'384;

constexpr std::uint32_t all_endpoints =
    builtin_endpoint::spdp | builtin_endpoint::sedp | builtin_endpoint::participant_message;

struct KindRow {
  DiscoveryKind kind;
  std::uint32_t builtin_endpoints;  ///< that such a participant announces
  std::vector<BuiltinUse> uses;
};

const KindRow& row_of(DiscoveryKind kind) {
  namespace topic = builtin_topic;
  static const std::array<KindRow, 4> rows{{
      {DiscoveryKind::simple, all_endpoints, {{topic::publications}, {topic::subscriptions}, {topic::messages}}},
      {DiscoveryKind::static_, builtin_endpoint::spdp | builtin_endpoint::participant_message, {{topic::messages}}},
      {DiscoveryKind::client,
       all_endpoints,
       {{topic::participants, false, true}, {topic::publications}, {topic::subscriptions}, {topic::messages}}},
      // Its writers are the DiscoveryServer's.
      {DiscoveryKind::server,
       builtin_endpoint::spdp | builtin_endpoint::sedp,
       {{topic::publications, false, true}, {topic::subscriptions, false, true}}},
  }};
  return rows[static_cast<std::size_t>(kind)];
}

}  // namespace

Discovery::Discovery(const Settings& settings, const ParticipantData& self)
    : settings_(settings),
      self_(self),
      builtin_({self.guid.prefix, settings.timing, settings.max_message, settings.epoch},
               row_of(settings.discovery.kind).uses) {
  self_.guid.entity = entity_id::participant;
  self_.lease_duration = settings_.discovery.profile.lease_duration;
  self_.builtin_endpoints = row_of(settings_.discovery.kind).builtin_endpoints;
  if (is(DiscoveryKind::server)) server_ = std::make_unique<DiscoveryServer>(builtin_settings(), self_);
}

Discovery::~Discovery() = default;

BuiltinSettings Discovery::builtin_settings() const {
  return {self_.guid.prefix, settings_.timing, settings_.max_message, settings_.epoch};
}

void Discovery::start(sim::LocalTime now, Outbox& outbox) {
  TAKT_CHECK(!is_running_, "discovery starts once");
  is_running_ = true;
  figures_.started_at = now;
  announce_self(now, outbox);
}

void Discovery::stop(sim::LocalTime now, Outbox& outbox) {
  if (!is_running_) return;
  is_running_ = false;
  announce_at_ = sim::LocalTime::never();
  Route route;
  route.destinations = is(DiscoveryKind::client) ? settings_.discovery.servers : settings_.discovery.announce_to;
  if (server_)
    for (const auto& [prefix, data] : found_)
      for (const Locator& locator : builtin_reader_of(data, builtin_topic::participants).unicast)
        route.destinations.push_back(locator);
  std::array<std::byte, 64> buffer;
  const Octets key = encode_key(buffer, self_.guid);
  figures_.participants_sent += count_sent(outbox, [&] {
    outbox.begin(route);
    outbox.add(InfoTimestamp{settings_.epoch.stamp(now)});
    outbox.add(Data{{},
                    entity_id::spdp_writer,
                    {2},
                    {status_info::disposed | status_info::unregistered, {}},
                    PayloadKind::key,
                    key});
  });
}

void Discovery::send_participant_data(const Route& route, sim::LocalTime now, Outbox& outbox) {
  std::array<std::byte, most_data> buffer;
  const Octets payload = encode(buffer, self_);
  figures_.participants_sent += count_sent(outbox, [&] {
    outbox.begin(route);
    outbox.add(InfoTimestamp{settings_.epoch.stamp(now)});
    // What is told is always the same change, so the number stays (8.5.3.2).
    outbox.add(Data{{}, entity_id::spdp_writer, first_sequence_number, {}, PayloadKind::data, payload});
  });
}

void Discovery::announce_self(sim::LocalTime now, Outbox& outbox) {
  Route route;
  route.destinations = is(DiscoveryKind::client) ? settings_.discovery.servers : settings_.discovery.announce_to;
  // A server answers its clients; it announces itself to nobody.
  if (!server_) send_participant_data(route, now, outbox);
  ++announced_;
  plan_announcement(now);
}

void Discovery::plan_announcement(sim::LocalTime now) {
  const DiscoveryProfile& profile = settings_.discovery.profile;
  sim::Duration period = profile.announcement_period;
  if (is(DiscoveryKind::client)) {
    if (!has_server_) period = profile.client_period;
  } else if (announced_ < profile.initial_announcements) {
    period = profile.initial_period;
  }
  announce_at_ = server_ ? sim::LocalTime::never() : now.plus_saturated(period);
}

/// Without what others know anyway: whose it is, and where, if that is where all of the participant's are. Nobody sends
/// to a writer's groups.
EndpointData Discovery::brief(EndpointData endpoint) const {
  if (endpoint.participant == self_.guid) endpoint.participant = {};
  const bool has_default_groups =
      endpoint.guid.entity.is_writer() ? endpoint.multicast.empty() : endpoint.multicast == self_.default_multicast;
  if (endpoint.unicast == self_.default_unicast && has_default_groups) {
    endpoint.unicast.clear();
    endpoint.multicast.clear();
  }
  return endpoint;
}

void Discovery::announce(const PublicationData& full, sim::LocalTime now, Outbox& outbox) {
  const PublicationData data{brief(full.endpoint), full.qos};
  if (server_) {
    server_->domain().publications[data.endpoint.guid] = data;
    server_->update(now, outbox);
  } else if (!is(DiscoveryKind::static_)) {
    std::array<std::byte, most_data> buffer;
    builtin_.tell(builtin_topic::publications, data.endpoint.guid, encode(buffer, data), now, outbox);
  }
}

void Discovery::announce(const SubscriptionData& full, sim::LocalTime now, Outbox& outbox) {
  const SubscriptionData data{brief(full.endpoint), full.qos, full.expects_inline_qos, full.content_filter};
  if (server_) {
    server_->domain().subscriptions[data.endpoint.guid] = data;
    server_->update(now, outbox);
  } else if (!is(DiscoveryKind::static_)) {
    std::array<std::byte, most_data> buffer;
    builtin_.tell(builtin_topic::subscriptions, data.endpoint.guid, encode(buffer, data), now, outbox);
  }
}

void Discovery::withdraw(const Guid& endpoint, sim::LocalTime now, Outbox& outbox) {
  if (server_) {
    server_->domain().publications.erase(endpoint);
    server_->domain().subscriptions.erase(endpoint);
    server_->update(now, outbox);
  } else if (!is(DiscoveryKind::static_)) {
    builtin_.dispose(endpoint.entity.is_writer() ? builtin_topic::publications : builtin_topic::subscriptions, endpoint,
                     now, outbox);
  }
}

void Discovery::assert_liveliness(ParticipantMessageData::Kind kind, sim::LocalTime now, Outbox& outbox) {
  if (server_) return;
  // One octet of data, as others send it; nobody reads it.
  const ParticipantMessageData message{self_.guid.prefix, kind, {std::byte{0}}};
  std::array<std::byte, 64> buffer;
  builtin_.tell(builtin_topic::messages, {self_.guid.prefix, {static_cast<std::uint32_t>(kind)}},
                encode(buffer, message), now, outbox);
}

bool Discovery::receive(const Interpretation& from, const Submessage& submessage, sim::LocalTime now, Outbox& outbox) {
  const std::optional<EntityId> writer = writer_of(submessage);
  if (!writer || !writer->is_built_in()) return false;
  // What was sent to a group comes back.
  if (from.source == self_.guid.prefix || !is_running_) return true;
  const bool is_spdp = *writer == entity_id::spdp_writer;
  ++(is_spdp                                            ? figures_.participants_received
     : *writer == entity_id::participant_message_writer ? figures_.liveliness_received
                                                        : figures_.endpoints_received);
  heard(from.source, now);
  if (const auto* const data = std::get_if<Data>(&submessage); data != nullptr && is_spdp)
    receive_participant(from, *data, now, outbox);
  if (!server_ || !server_->receive(from.source, submessage, now, outbox))
    builtin_.receive(from.source, from.timestamp, submessage, now, outbox);
  read_news(now, outbox);
  return true;
}

/// SPDP that a participant sends about itself. What a server forwards comes by the reliable reader.
void Discovery::receive_participant(const Interpretation& from, const Data& data, sim::LocalTime now, Outbox& outbox) {
  if (data.payload_kind == PayloadKind::key ||
      (data.inline_qos.status_info.value_or(0) & (status_info::disposed | status_info::unregistered)) != 0) {
    Guid gone;
    if (data.payload_kind == PayloadKind::key && decode_key(data.payload, gone) == DataVerdict::ok &&
        gone.prefix == from.source)
      lose_participant(from.source, now, outbox);
    return;
  }
  ParticipantData participant;
  if (decode(data.payload, participant) != DataVerdict::ok) {
    ++figures_.refused;
    return;
  }
  if (participant.guid.prefix != from.source) return;
  // A domain that is told must be ours (9.6.2.2.1); one that is not told is known by its ports.
  if (participant.domain && self_.domain && *participant.domain != *self_.domain) return;
  const bool is_new = !found_.contains(from.source);
  leases_[from.source] = {participant.lease_duration, now.plus_saturated(participant.lease_duration)};
  // Who names us as the destination knows us already.
  const bool knows_us = !from.destination.is_unknown();
  const bool answers = server_ ? !is_new
                               : is_new && !is(DiscoveryKind::client) &&
                                     settings_.discovery.profile.answers_new_participants && !knows_us;
  if (answers) {
    Route route;
    route.destinations = builtin_reader_of(participant, builtin_topic::participants).unicast;
    if (route.destinations.size() > 1) route.destinations.resize(1);
    route.only = from.source;
    send_participant_data(route, now, outbox);
  }
  found(participant, now, outbox);
  if (is_new && server_) server_->add_client(participant, now, outbox);
  if (is_new || !server_) builtin_.connect(participant, all_endpoints, now, outbox);
  if (is(DiscoveryKind::client) && !has_server_) {
    has_server_ = true;
    plan_announcement(now);
  }
}

void Discovery::heard(const GuidPrefix& participant, sim::LocalTime now) {
  const auto at = leases_.find(participant);
  if (at != leases_.end()) at->second.until = now.plus_saturated(at->second.duration);
}

void Discovery::tell(DiscoveryEvent::Kind kind, const Guid& subject, sim::LocalTime now) {
  events_.push_back({kind, now, subject, ParticipantMessageData::Kind::unknown});
}

void Discovery::found(const ParticipantData& data, sim::LocalTime now, Outbox&) {
  const auto [at, is_new] = found_.insert_or_assign(data.guid.prefix, data);
  if (!is_new) return;
  figures_.found_at.emplace(data.guid, now);
  tell(DiscoveryEvent::Kind::participant_found, data.guid, now);
  if (is(DiscoveryKind::static_)) add_static_endpoints(data, now);
}

void Discovery::add_static_endpoints(const ParticipantData& data, sim::LocalTime now) {
  for (const StaticParticipant& participant : settings_.discovery.participants) {
    if (participant.name != data.entity_name) continue;
    const auto add = [&](auto endpoint) {
      endpoint.endpoint.guid.prefix = data.guid.prefix;
      found(endpoint, now);
    };
    for (const PublicationData& publication : participant.publications) add(publication);
    for (const SubscriptionData& subscription : participant.subscriptions) add(subscription);
  }
}

void Discovery::found(const PublicationData& data, sim::LocalTime now) {
  const Guid& guid = data.endpoint.guid;
  const auto at = publications_.find(guid);
  if (at != publications_.end() && at->second == data) return;
  publications_.insert_or_assign(guid, data);
  figures_.found_at.emplace(guid, now);
  tell(DiscoveryEvent::Kind::publication_found, guid, now);
}

void Discovery::found(const SubscriptionData& data, sim::LocalTime now) {
  const Guid& guid = data.endpoint.guid;
  const auto at = subscriptions_.find(guid);
  if (at != subscriptions_.end() && at->second == data) return;
  subscriptions_.insert_or_assign(guid, data);
  figures_.found_at.emplace(guid, now);
  tell(DiscoveryEvent::Kind::subscription_found, guid, now);
}

void Discovery::lost(const Guid& endpoint, sim::LocalTime now) {
  if (publications_.erase(endpoint) != 0) tell(DiscoveryEvent::Kind::publication_lost, endpoint, now);
  if (subscriptions_.erase(endpoint) != 0) tell(DiscoveryEvent::Kind::subscription_lost, endpoint, now);
  if (!server_) return;
  server_->domain().publications.erase(endpoint);
  server_->domain().subscriptions.erase(endpoint);
}

void Discovery::lose_participant(const GuidPrefix& prefix, sim::LocalTime now, Outbox& outbox) {
  const auto at = found_.find(prefix);
  if (at == found_.end()) return;
  const Guid guid = at->second.guid;
  std::vector<Guid> endpoints;
  for (const auto& [each, data] : publications_)
    if (each.prefix == prefix) endpoints.push_back(each);
  for (const auto& [each, data] : subscriptions_)
    if (each.prefix == prefix) endpoints.push_back(each);
  for (const Guid& each : endpoints) lost(each, now);
  builtin_.disconnect(prefix, now);
  builtin_.read_news(now, outbox);  // that its endpoints are without a writer is nothing new
  found_.erase(at);
  leases_.erase(prefix);
  if (server_) server_->remove_client(prefix, now, outbox);
  tell(DiscoveryEvent::Kind::participant_lost, guid, now);
  // Of a client without servers: it looks for them again. Those that were told of by them stay until the data itself
  // ends.
  if (is(DiscoveryKind::client) && leases_.empty() && has_server_) {
    has_server_ = false;
    if (is_running_) plan_announcement(now);
  }
}

void Discovery::read_news(sim::LocalTime now, Outbox& outbox) {
  bool is_changed = false;
  for (const BuiltinEndpoints::News& news : builtin_.read_news(now, outbox)) {
    const auto take = [&](auto data, auto decode_data) {
      if (decode(news.payload, data) == DataVerdict::ok)
        decode_data(data);
      else
        ++figures_.refused;
    };
    if (news.writer == entity_id::participant_message_writer) {
      if (news.is_gone) continue;
      take(ParticipantMessageData{}, [&](const ParticipantMessageData& data) {
        tell(DiscoveryEvent::Kind::liveliness_asserted, {data.prefix, entity_id::participant}, now);
        events_.back().liveliness = data.kind;
      });
    } else if (news.writer == entity_id::spdp_writer) {
      // Of a client; the server's own data were taken as they came.
      if (news.about.prefix == news.from || news.about.prefix == self_.guid.prefix) continue;
      if (news.is_gone) {
        lose_participant(news.about.prefix, now, outbox);
      } else {
        take(ParticipantData{}, [&](const ParticipantData& data) {
          found(data, now, outbox);
          builtin_.connect(data, builtin_endpoint::participant_message, now, outbox);
        });
      }
    } else if (news.is_gone) {
      lost(news.about, now);
      is_changed = true;
    } else if (news.writer == entity_id::sedp_publications_writer) {
      take(PublicationData{}, [&](const PublicationData& data) {
        found(data, now);
        if (server_) server_->domain().publications[data.endpoint.guid] = data;
      });
      is_changed = true;
    } else {
      take(SubscriptionData{}, [&](const SubscriptionData& data) {
        found(data, now);
        if (server_) server_->domain().subscriptions[data.endpoint.guid] = data;
      });
      is_changed = true;
    }
  }
  if (server_ && is_changed) server_->update(now, outbox);
}

sim::LocalTime Discovery::next_wake() const {
  sim::LocalTime next = std::min(announce_at_, builtin_.next_wake());
  if (server_) next = std::min(next, server_->next_wake());
  for (const auto& [prefix, lease] : leases_) next = std::min(next, lease.until);
  return next;
}

void Discovery::wake(sim::LocalTime now, Outbox& outbox) {
  std::vector<GuidPrefix> expired;
  for (const auto& [prefix, lease] : leases_)
    if (lease.until <= now) expired.push_back(prefix);
  for (const GuidPrefix& prefix : expired) {
    ++figures_.leases_expired;
    lose_participant(prefix, now, outbox);
  }
  if (announce_at_ <= now) announce_self(now, outbox);
  builtin_.wake(now, outbox);
  if (server_) server_->wake(now, outbox);
  read_news(now, outbox);
}

std::optional<DiscoveryEvent> Discovery::next_event() {
  if (events_.empty()) return std::nullopt;
  const DiscoveryEvent event = events_.front();
  events_.pop_front();
  return event;
}

MatchedWriter Discovery::matched_writer(const PublicationData& data) const {
  MatchedWriter writer;
  writer.guid = data.endpoint.guid;
  writer.unicast = usable(data.endpoint.unicast);
  const auto owner = found_.find(writer.guid.prefix);
  if (writer.unicast.empty() && owner != found_.end()) writer.unicast = usable(owner->second.default_unicast);
  writer.reliable = data.qos.reliability.kind == ReliabilityKind::reliable;
  writer.has_history = data.qos.durability.kind != DurabilityKind::volatile_;
  writer.persistence_guid = data.endpoint.persistence_guid;
  writer.ownership_strength = data.qos.ownership_strength.value;
  writer.lifespan = data.qos.lifespan.duration;
  writer.liveliness = data.qos.liveliness;
  return writer;
}

MatchedReader Discovery::matched_reader(const SubscriptionData& data) const {
  MatchedReader reader;
  reader.guid = data.endpoint.guid;
  reader.unicast = usable(data.endpoint.unicast);
  reader.multicast = usable(data.endpoint.multicast);
  const auto owner = found_.find(reader.guid.prefix);
  if (reader.unicast.empty() && reader.multicast.empty() && owner != found_.end()) {
    reader.unicast = usable(owner->second.default_unicast);
    reader.multicast = usable(owner->second.default_multicast);
  }
  reader.reliable = data.qos.reliability.kind == ReliabilityKind::reliable;
  reader.wants_history = data.qos.durability.kind != DurabilityKind::volatile_;
  return reader;
}

DiscoveryFigures Discovery::figures() const {
  DiscoveryFigures figures = figures_;
  figures.endpoints_sent = builtin_.sent(entity_id::sedp_publications_writer);
  figures.endpoints_sent += builtin_.sent(entity_id::sedp_subscriptions_writer);
  figures.endpoints_sent +=
      builtin_.sent(entity_id::spdp_writer);  // of a client: acknowledgements of what a server forwards
  figures.liveliness_sent = builtin_.sent(entity_id::participant_message_writer);
  if (server_) {
    figures.endpoints_sent += server_->sent();
    figures.forwarded = server_->forwarded();
  }
  return figures;
}

}  // namespace takt::dds
