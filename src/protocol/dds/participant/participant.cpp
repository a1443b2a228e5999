// SPDX-License-Identifier: Apache-2.0
#include "dds/participant/participant.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::dds {
namespace {

constexpr std::size_t least_message = 256;
constexpr std::size_t most_message = 65'507;      // what UDP over IPv4 carries
constexpr std::size_t most_sample = 0x7FFF'FFFF;  // sampleSize and most readers' limits

/// What of the presentation takt does not do.
void refuse_presentation(const Presentation& presentation, std::vector<std::string>& problems) {
  if (presentation.coherent_access) problems.push_back("presentation: coherent_access is not supported");
  if (presentation.ordered_access) problems.push_back("presentation: ordered_access is not supported");
  if (presentation.access_scope == PresentationScope::group)
    problems.push_back("presentation: access_scope GROUP is not supported");
}

template <class Config>
std::vector<std::string> problems_in(const Config& config) {
  std::vector<std::string> problems = problems_of(config.qos);
  refuse_presentation(config.qos.presentation, problems);
  if (config.topic.empty()) problems.push_back("topic: it needs a name");
  if (config.type.empty()) problems.push_back("type: it needs a name");
  if (config.storage != nullptr && config.persistence_guid.is_unknown())
    problems.push_back("storage: it needs a persistence GUID, under which things are found again");
  return problems;
}

}  // namespace

std::vector<std::string> problems_of(const ParticipantConfig& config) {
  std::vector<std::string> problems;
  if (const std::string problem = port_problem(config.domain, config.participant); !problem.empty())
    problems.push_back("domain: " + problem);
  if (config.prefix.is_unknown()) problems.push_back("prefix: a participant needs one of its own");
  if (config.max_message < least_message || config.max_message > most_message)
    problems.push_back("max_message: 256 to 65507 octets");
  std::set<std::string> names;
  for (const FlowControllerSettings& flow : config.flow_controllers) {
    if (const std::string problem = problem_of(flow); !problem.empty()) problems.push_back(problem);
    if (!names.insert(flow.name).second)
      problems.push_back("flow controller " + flow.name + ": there are two of this name");
  }
  return problems;
}

Participant::Participant(const ParticipantConfig& config, sim::LocalTime now)
    : config_(config), ports_(ports_of(config.domain, config.participant)), outbox_(config.prefix, config.max_message) {
  TAKT_CHECK(problems_of(config).empty(), "a participant's settings are sound");
  for (const FlowControllerSettings& flow : config.flow_controllers)
    flows_.emplace(flow.name, std::make_unique<FlowController>(flow, now));
  const Locator user = Locator::udp_v4(config.address, ports_.unicast_user);
  std::optional<Locator> group;
  if (config.multicast_group) group = Locator::udp_v4(*config.multicast_group, ports_.multicast_user);
  outbox_.set_own(user, group);
  if (!config.discovery) return;
  Discovery::Settings settings{*config.discovery, config.timing, config.max_message, config.epoch};
  const Locator everybody = Locator::udp_v4(discovery_group, ports_.multicast_metatraffic);
  const DiscoveryKind kind = config.discovery->kind;
  const bool announces = kind == DiscoveryKind::simple || kind == DiscoveryKind::static_;
  if (announces && settings.discovery.announce_to.empty()) settings.discovery.announce_to = {everybody};
  ParticipantData self;
  self.guid = {config.prefix, entity_id::participant};
  self.domain = config.domain;
  self.metatraffic_unicast = {
      Locator::udp_v4(config.address, config.metatraffic_port.value_or(ports_.unicast_metatraffic))};
  if (announces) self.metatraffic_multicast = {everybody};
  self.default_unicast = {user};
  if (group) self.default_multicast = {*group};
  self.entity_name = config.name;
  discovery_ = std::make_unique<Discovery>(settings, self);
  discovery_->start(now, outbox_);
}

void Participant::stop(sim::LocalTime now) {
  if (discovery_) discovery_->stop(now, outbox_);
}

std::vector<Locator> Participant::listens_to() const {
  std::vector<Locator> all{Locator::udp_v4(config_.address, ports_.unicast_user)};
  if (config_.multicast_group) all.push_back(Locator::udp_v4(*config_.multicast_group, ports_.multicast_user));
  if (discovery_) {
    const ParticipantData& self = discovery_->self();
    all.insert(all.end(), self.metatraffic_unicast.begin(), self.metatraffic_unicast.end());
    all.insert(all.end(), self.metatraffic_multicast.begin(), self.metatraffic_multicast.end());
  }
  return all;
}

Participant::~Participant() = default;

LocalWriter& Participant::local(WriterHandle writer) {
  const auto at = writers_.find(writer.number);
  TAKT_CHECK(at != writers_.end(), "the writer is one of this participant");
  return *at->second;
}

LocalReader& Participant::local(ReaderHandle reader) {
  const auto at = readers_.find(reader.number);
  TAKT_CHECK(at != readers_.end(), "the reader is one of this participant");
  return *at->second;
}

FlowController& Participant::flow_of(const WriterConfig& config, std::uint32_t number, sim::LocalTime now) {
  if (!config.flow_controller.empty()) return *flows_.at(config.flow_controller);
  FlowControllerSettings own;
  own.name = "/" + std::to_string(number);
  return *flows_.emplace(own.name, std::make_unique<FlowController>(own, now)).first->second;
}

Created<WriterHandle> Participant::create_writer(const WriterConfig& config, sim::LocalTime now) {
  std::vector<std::string> problems = problems_in(config);
  if (!config.flow_controller.empty() && !config.asynchronous)
    problems.push_back("flow_controller: only asynchronous writers have one");
  if (!config.flow_controller.empty() && !flows_.contains(config.flow_controller))
    problems.push_back("flow_controller: there is none of the name " + config.flow_controller);
  if (config.flow_share.priority < -10 || config.flow_share.priority > 10)
    problems.push_back("flow_share: priority is -10 to 10");
  if (config.flow_share.reservation > 100) problems.push_back("flow_share: reservation is 0 to 100 percent");
  if (!problems.empty()) return {std::nullopt, problems};
  const WriterHandle handle{++entities_};
  const Guid guid{config_.prefix, EntityId::user(handle.number, config.has_key ? EntityKind::writer_with_key
                                                                               : EntityKind::writer_no_key)};
  LocalWriter& writer =
      *writers_.emplace(handle.number, std::make_unique<LocalWriter>(handle, config, config_, guid)).first->second;
  writer.data.endpoint.unicast = {Locator::udp_v4(config_.address, ports_.unicast_user)};
  writers_by_id_[guid.entity] = &writer;
  if (config.asynchronous) {
    writer.flow = &flow_of(config, handle.number, now);
    writer.flow->add(writer.rtps, config.flow_share);
  }
  writer.assert_liveliness(now);
  plan_liveliness(now);
  if (discovery_) discovery_->announce(writer.data, now, outbox_);
  match_with_all(writer, now);
  settle(now);
  return {handle, {}};
}

Created<ReaderHandle> Participant::create_reader(const ReaderConfig& config, sim::LocalTime now) {
  std::vector<std::string> problems = problems_in(config);
  if (config.content_filter.empty() == static_cast<bool>(config.passes))
    problems.push_back("content_filter: an expression and what it lets pass belong together");
  if (!problems.empty()) return {std::nullopt, problems};
  const ReaderHandle handle{++entities_};
  const Guid guid{config_.prefix, EntityId::user(handle.number, config.has_key ? EntityKind::reader_with_key
                                                                               : EntityKind::reader_no_key)};
  LocalReader& reader =
      *readers_.emplace(handle.number, std::make_unique<LocalReader>(handle, config, config_, guid)).first->second;
  reader.data.endpoint.unicast = {Locator::udp_v4(config_.address, ports_.unicast_user)};
  if (config_.multicast_group)
    reader.data.endpoint.multicast = {Locator::udp_v4(*config_.multicast_group, ports_.multicast_user)};
  if (discovery_) discovery_->announce(reader.data, now, outbox_);
  match_with_all(reader, now);
  settle(now);
  return {handle, {}};
}

void Participant::remove(WriterHandle handle, sim::LocalTime now) {
  LocalWriter& writer = local(handle);
  const Guid guid = writer.rtps.guid();
  if (discovery_) discovery_->withdraw(guid, now, outbox_);
  for (auto& [number, reader] : readers_) end_match(*reader, guid, now);
  if (writer.flow != nullptr) writer.flow->remove(writer.rtps);
  if (writer.flow != nullptr && writer.config.flow_controller.empty()) flows_.erase(writer.flow->settings().name);
  writers_by_id_.erase(guid.entity);
  writers_.erase(handle.number);
  settle(now);
}

void Participant::remove(ReaderHandle handle, sim::LocalTime now) {
  const Guid guid = local(handle).rtps.guid();
  if (discovery_) discovery_->withdraw(guid, now, outbox_);
  for (auto& [number, writer] : writers_) end_match(*writer, guid, now);
  readers_.erase(handle.number);
  settle(now);
}

namespace {

CacheChange change_of(ChangeKind kind, const InstanceKey& key, Octets payload, sim::LocalTime source) {
  CacheChange change;
  change.kind = kind;
  change.key = key;
  change.source = source;
  change.payload.assign(payload.begin(), payload.end());
  return change;
}

}  // namespace

WriteResult Participant::write(WriterHandle writer, const InstanceKey& key, Octets payload, sim::LocalTime now) {
  return write(writer, change_of(ChangeKind::alive, key, payload, now), now);
}

WriteResult Participant::dispose(WriterHandle writer, const InstanceKey& key, sim::LocalTime now, Octets key_payload) {
  return write(writer, change_of(ChangeKind::disposed, key, key_payload, now), now);
}

WriteResult Participant::unregister(WriterHandle writer, const InstanceKey& key, sim::LocalTime now,
                                    Octets key_payload) {
  const bool disposes = local(writer).config.qos.data_lifecycle.autodispose_unregistered_instances;
  return write(
      writer, change_of(disposes ? ChangeKind::disposed_unregistered : ChangeKind::unregistered, key, key_payload, now),
      now);
}

WriteResult Participant::write_for(WriterHandle writer, const OriginalWriter& original, ChangeKind kind,
                                   const InstanceKey& key, Octets payload, sim::LocalTime source, sim::LocalTime now) {
  TAKT_CHECK(local(writer).config.brings_others, "such a writer leaves room for the name of the other one");
  CacheChange change = change_of(kind, key, payload, source);
  change.original = original;
  return write(writer, std::move(change), now);
}

WriteResult Participant::write(WriterHandle handle, CacheChange change, sim::LocalTime now) {
  LocalWriter& writer = local(handle);
  const InstanceKey key = change.key;
  const auto refused = [](std::string reason) {
    return WriteResult{WriteVerdict::refused, {}, sim::LocalTime::never(), std::move(reason)};
  };
  if (!writer.config.has_key && key != no_key) return refused("bad parameter: the topic has no key");
  if (!writer.config.has_key && change.kind != ChangeKind::alive)
    return refused("illegal operation: only instances of a topic with key are disposed or unregistered");
  if (change.kind == ChangeKind::alive && change.payload.size() < 4)
    return refused("bad parameter: a payload begins with its encapsulation header");
  if (change.payload.size() > most_sample)
    return refused("bad parameter: a payload has at most " + std::to_string(most_sample) + " octets");
  if (const std::optional<NoRoom> obstacle = writer.rtps.history().obstacle(key, now)) {
    if (*obstacle == NoRoom::max_instances) return refused("out of resources: max_instances");
    const sim::Duration patience = writer.config.qos.reliability.max_blocking_time;
    if (patience <= sim::Duration()) return refused("timeout: the history is full, and max_blocking_time is 0");
    if (!writer.wait) writer.wait = {key, now.plus_saturated(patience)};
    writer.wait->key = key;
    return {WriteVerdict::would_block, {}, writer.wait->until, {}};
  }
  writer.write(std::move(change), now, outbox_);
  if (writer.flow != nullptr) writer.flow->notify(writer.rtps, now);
  const SequenceNumber number = writer.rtps.history().last();
  settle(now);
  return {WriteVerdict::written, number, sim::LocalTime::never(), {}};
}

std::optional<Sample> Participant::take(ReaderHandle reader, sim::LocalTime now) {
  std::optional<Sample> sample = local(reader).take(now, outbox_);
  settle(now);
  return sample;
}

void Participant::mark_delivered(ReaderHandle reader, const OriginalWriter& change) {
  NumberRanges numbers;
  numbers.insert(change.number);
  local(reader).rtps.restore_delivered(change.writer, numbers);
}

std::vector<Sample> Participant::read(ReaderHandle reader, sim::LocalTime now) {
  return local(reader).rtps.history().read(now);
}

void Participant::assert_liveliness(WriterHandle handle, sim::LocalTime now) {
  LocalWriter& asserted = local(handle);
  const LivelinessKind kind = asserted.config.qos.liveliness.kind;
  if (kind == LivelinessKind::manual_by_topic) {
    asserted.assert_liveliness(now);
    asserted.rtps.assert_liveliness(outbox_);
  } else if (kind == LivelinessKind::manual_by_participant) {
    for (auto& [number, writer] : writers_)
      if (writer->config.qos.liveliness.kind == kind) writer->assert_liveliness(now);
    if (discovery_) discovery_->assert_liveliness(ParticipantMessageData::Kind::manual, now, outbox_);
    assert_writers_of(config_.prefix, kind, now);
  }
  settle(now);
}

/// Often enough for the shortest lease.
void Participant::plan_liveliness(sim::LocalTime now) {
  sim::Duration shortest = infinite;
  for (const auto& [number, writer] : writers_)
    if (writer->config.qos.liveliness.kind == LivelinessKind::automatic)
      shortest = std::min(shortest, writer->config.qos.liveliness.lease_duration);
  if (shortest == infinite) return;
  liveliness_period_ = shortest / 100 * config_.timing.liveliness_percent;
  liveliness_at_ = std::min(liveliness_at_, now);
}

sim::LocalTime Participant::next_wake() const {
  sim::LocalTime next = liveliness_at_;
  if (discovery_) next = std::min(next, discovery_->next_wake());
  for (const auto& [number, writer] : writers_) next = std::min(next, writer->next_wake());
  for (const auto& [number, reader] : readers_) next = std::min(next, reader->rtps.next_wake());
  for (const auto& [name, flow] : flows_) next = std::min(next, flow->next_wake());
  return next;
}

void Participant::wake(sim::LocalTime now) {
  if (discovery_) discovery_->wake(now, outbox_);
  if (liveliness_at_ <= now) {
    liveliness_at_ = now.plus_saturated(liveliness_period_);
    if (discovery_) discovery_->assert_liveliness(ParticipantMessageData::Kind::automatic, now, outbox_);
    assert_writers_of(config_.prefix, LivelinessKind::automatic, now);
  }
  for (auto& [number, writer] : writers_) {
    writer->rtps.wake(now, outbox_);
    writer->wake(now, events_);
  }
  for (auto& [number, reader] : readers_) reader->rtps.wake(now, outbox_);
  for (auto& [name, flow] : flows_) flow->wake(now, outbox_);
  settle(now);
}

void Participant::settle(sim::LocalTime now) {
  accept_discovered(now);
  while (const std::optional<std::vector<std::byte>> own = outbox_.drain_looped()) dispatch(*own, now);
  for (auto& [number, writer] : writers_) {
    if (writer->flow != nullptr && writer->rtps.next_size(outbox_) != 0) writer->flow->notify(writer->rtps, now);
    writer->check_wait(now, events_);
  }
  for (auto& [number, reader] : readers_) reader->report(now, events_);
}

std::optional<DatagramView> Participant::next_datagram() {
  const OutgoingDatagram* const datagram = outbox_.next();
  if (datagram == nullptr) return std::nullopt;
  return DatagramView{datagram->destinations, datagram->octets, datagram->transport_priority};
}

std::optional<Event> Participant::next_event() {
  if (events_.empty()) return std::nullopt;
  Event event = std::move(events_.front());
  events_.pop_front();
  return event;
}

void Participant::tell(EventKind kind, std::uint32_t entity, const Guid& remote, std::uint64_t count,
                       sim::LocalTime now) {
  events_.push_back({kind, now, entity, remote, {}, count, {}, {}});
}

}  // namespace takt::dds
