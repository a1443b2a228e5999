// SPDX-License-Identifier: Apache-2.0
#include "dds/rtps/stateful_writer.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::dds {
namespace {

// Octets of what may stand in a message beside the payload: header, INFO_DST, INFO_TS, the submessage, PID_STATUS_INFO,
// PID_KEY_HASH and sentinel.
constexpr std::size_t beside_data = message_header_size + 16 + 12 + 24 + 32;
constexpr std::size_t beside_fragment = message_header_size + 16 + 12 + 36 + 32;
constexpr std::size_t heartbeat_size = 32;

}  // namespace

StatefulWriter::StatefulWriter(const Settings& settings) : settings_(settings), history_(settings.history) {
  TAKT_CHECK(settings_.max_message >= beside_fragment + 4 && settings_.max_message <= 65'507,
             "messages have room, and fit into UDP");
  const std::size_t original = settings_.brings_others ? 28 : 0;
  most_payload_ = (settings_.max_message - beside_data - original) & ~std::size_t{3};
  fragment_size_ = static_cast<std::uint16_t>((settings_.max_message - beside_fragment - original) & ~std::size_t{3});
}

void StatefulWriter::match(const MatchedReader& reader, sim::LocalTime now, Outbox& outbox) {
  readers_.erase(reader.guid);
  ReaderProxy& proxy = readers_[reader.guid];
  proxy.reader = reader;
  proxy.reader.reliable = reader.reliable && settings_.reliable;
  // Past samples need RELIABLE (DDS 1.4, 2.2.3.4).
  const bool past = reader.wants_history && proxy.reader.reliable && settings_.history.keeps_released;
  proxy.start = past ? first_sequence_number : history_.last() + 1;
  proxy.next_unsent = past ? history_.first() : proxy.start;
  proxy.acknowledged_below = proxy.next_unsent;
  plan_route();
  if (!proxy.reader.reliable) return;
  if (settings_.timing.greets_by_heartbeat) {
    proxy.next_unsent = history_.last() + 1;  // what is past counts as sent: the reader asks for it
    send_heartbeat(proxy, outbox);
    plan_heartbeat(now);
    return;
  }
  // The reader is told where its samples begin, so that it does not wait for others.
  if (proxy.next_unsent > first_sequence_number) gap(proxy, first_sequence_number, proxy.next_unsent, outbox);
  if (!settings_.asynchronous) push(now, outbox);
  proxy.heartbeat_at = now.plus_saturated(settings_.timing.initial_heartbeat_delay);
  plan_heartbeat(now);
}

void StatefulWriter::unmatch(const Guid& reader, sim::LocalTime now) {
  if (readers_.erase(reader) == 0) return;
  plan_route();
  release();
  plan_heartbeat(now);
}

/// One copy for each place; a group address where all listen to it, and more than one does or it shall be used even
/// then.
void StatefulWriter::plan_route() {
  std::set<Locator> unicast;
  std::set<Locator> common;
  bool is_first = true;
  for (const auto& [guid, proxy] : readers_) {
    if (!proxy.reader.unicast.empty()) unicast.insert(proxy.reader.unicast.front());
    const std::set<Locator> own(proxy.reader.multicast.begin(), proxy.reader.multicast.end());
    if (is_first) common = own;
    std::erase_if(common, [&](const Locator& locator) { return !own.contains(locator); });
    is_first = false;
  }
  route_to_all_ = {};
  route_to_all_.transport_priority = settings_.transport_priority;
  if (!common.empty() && (settings_.multicast_to_one || unicast.size() != 1))
    route_to_all_.destinations = {*common.begin()};
  else
    route_to_all_.destinations.assign(unicast.begin(), unicast.end());
}

Route StatefulWriter::route_to(const ReaderProxy& proxy) const {
  Route route;
  const std::vector<Locator>& where = proxy.reader.unicast.empty() ? proxy.reader.multicast : proxy.reader.unicast;
  if (!where.empty()) route.destinations = {where.front()};
  route.only = proxy.reader.guid.prefix;
  route.transport_priority = settings_.transport_priority;
  return route;
}

SequenceNumber StatefulWriter::write(ChangeKind kind, const InstanceKey& key, Octets payload, sim::LocalTime now,
                                     Outbox& outbox) {
  CacheChange change;
  change.kind = kind;
  change.key = key;
  change.source = now;
  change.payload.assign(payload.begin(), payload.end());
  return write(std::move(change), now, outbox);
}

SequenceNumber StatefulWriter::write(CacheChange change, sim::LocalTime now, Outbox& outbox) {
  const SequenceNumber number = history_.add(std::move(change), now).number;
  heartbeats_since_write_ = 0;
  if (!settings_.asynchronous) push(now, outbox);
  release();
  plan_heartbeat(now);
  return number;
}

void StatefulWriter::push(sim::LocalTime now, Outbox& outbox) {
  while (const std::optional<Work> work = next_work(outbox)) transmit(*work, now, outbox);
}

std::size_t StatefulWriter::next_size(Outbox& outbox) {
  const std::optional<Work> work = next_work(outbox);
  return work ? size_of_work(*work) : 0;
}

std::size_t StatefulWriter::send_next(sim::LocalTime now, Outbox& outbox) {
  const std::optional<Work> work = next_work(outbox);
  TAKT_CHECK(work.has_value(), "there is something to send");
  const std::size_t octets = transmit(*work, now, outbox);
  release();
  plan_heartbeat(now);
  return octets;
}

SequenceNumber StatefulWriter::first_unsent() const {
  SequenceNumber first = history_.last() + 1;
  for (const auto& [guid, proxy] : readers_) first = std::min(first, proxy.next_unsent);
  return first;
}

bool StatefulWriter::is_within_sample() const {
  return std::any_of(readers_.begin(), readers_.end(), [](const auto& each) {
    const ReaderProxy& proxy = each.second;
    return proxy.next_fragment.value > 1 || (proxy.is_due && !proxy.requests.empty());
  });
}

/// What readers asked for comes before what is new.
std::optional<StatefulWriter::Work> StatefulWriter::next_work(Outbox& outbox) {
  if (std::optional<Work> work = next_request(outbox)) return work;
  return next_unsent(outbox);
}

std::optional<StatefulWriter::Work> StatefulWriter::next_request(Outbox& outbox) {
  for (auto& [guid, proxy] : readers_) {
    while (proxy.is_due && !proxy.requests.empty()) {
      const auto request = proxy.requests.begin();
      const CacheChange* const change = request->first < proxy.start ? nullptr : history_.find(request->first);
      if (change == nullptr) {
        // As far as nothing is there, in one GAP.
        const CacheChange* const later = history_.at_or_after(std::max(request->first, proxy.start));
        const SequenceNumber to = later == nullptr ? proxy.next_unsent : std::min(later->number, proxy.next_unsent);
        gap(proxy, request->first, std::max(to, request->first + 1), outbox);
        proxy.requests.erase(request, proxy.requests.lower_bound(std::max(to, request->first + 1)));
        continue;
      }
      return Work{change, request->second.empty() ? FragmentNumber{0} : *request->second.begin(), &proxy, true};
    }
    if (proxy.requests.empty()) proxy.is_due = false;
  }
  return std::nullopt;
}

std::optional<StatefulWriter::Work> StatefulWriter::next_unsent(Outbox& outbox) {
  while (true) {
    ReaderProxy* behind = nullptr;
    bool together = true;
    for (auto& [guid, proxy] : readers_) {
      if (behind == nullptr) {
        behind = &proxy;
        continue;
      }
      const auto place = std::pair(proxy.next_unsent, proxy.next_fragment);
      const auto furthest = std::pair(behind->next_unsent, behind->next_fragment);
      if (place != furthest) together = false;
      if (place < furthest) behind = &proxy;
    }
    if (behind == nullptr || behind->next_unsent > history_.last()) return std::nullopt;
    const CacheChange* const change = history_.at_or_after(behind->next_unsent);
    const SequenceNumber next = change == nullptr ? history_.last() + 1 : change->number;
    if (next == behind->next_unsent) {
      const FragmentNumber fragment{is_fragmented(*change) ? behind->next_fragment.value : 0};
      return Work{change, fragment, together && readers_.size() > 1 ? nullptr : behind, false};
    }
    if (behind->reader.reliable) gap(*behind, behind->next_unsent, next, outbox);
    behind->next_unsent = next;
    behind->next_fragment = FragmentNumber{1};
  }
}

std::uint32_t StatefulWriter::fragments_of_change(const CacheChange& change) const {
  return fragment_count(static_cast<std::uint32_t>(change.payload.size()), fragment_size_);
}

InlineQos StatefulWriter::inline_qos(const CacheChange& change) const {
  InlineQos qos;
  if (settings_.has_key) qos.key_hash = change.key;
  qos.original_writer = change.original;
  if (change.kind != ChangeKind::alive) qos.status_info = static_cast<std::uint32_t>(change.kind);
  return qos;
}

/// An upper bound: with INFO_DST, all inline QoS and a HEARTBEAT.
std::size_t StatefulWriter::size_of_work(const Work& work) const {
  const std::size_t heartbeat = settings_.reliable ? heartbeat_size : 0;
  const std::size_t beside = heartbeat + (settings_.brings_others ? 28 : 0);
  if (work.fragment.value == 0)
    return std::min(beside_data + rounded_up(work.change->payload.size(), 4) + beside, settings_.max_message);
  const std::size_t rest = work.change->payload.size() - std::size_t{work.fragment.value - 1} * fragment_size_;
  return std::min(beside_fragment + rounded_up(std::min<std::size_t>(rest, fragment_size_), 4) + beside,
                  settings_.max_message);
}

std::size_t StatefulWriter::transmit(const Work& work, sim::LocalTime now, Outbox& outbox) {
  const CacheChange& change = *work.change;
  // With one reader, "all" and "only it" are the same: it is named, but no INFO_DST is needed unless the message
  // repeats something.
  const bool is_directed = work.only != nullptr && (work.is_request || readers_.size() > 1);
  Route route = work.only != nullptr && is_directed ? route_to(*work.only) : route_to_all_;
  outbox.begin(route);
  outbox.add(InfoTimestamp{settings_.epoch.stamp(change.source)});
  const EntityId reader = work.only != nullptr ? work.only->reader.guid.entity : entity_id::unknown;
  const PayloadKind kind = change.payload.empty()             ? PayloadKind::none
                           : change.kind == ChangeKind::alive ? PayloadKind::data
                                                              : PayloadKind::key;
  const bool is_first_fragment = work.fragment.value <= 1;
  if (work.fragment.value == 0) {
    Data data{reader, settings_.guid.entity, change.number, inline_qos(change), kind, change.payload};
    outbox.add(data);
  } else {
    DataFrag data = fragments_of(change.payload, work.fragment, 1, fragment_size_);
    data.reader = reader;
    data.writer = settings_.guid.entity;
    data.sequence_number = change.number;
    data.payload_kind = kind;
    if (is_first_fragment) data.inline_qos = inline_qos(change);
    outbox.add(data);
  }
  if (work.is_request) {
    ++outbox.figures().resent;
    const auto request = work.only->requests.find(change.number);
    request->second.erase(work.fragment);
    if (request->second.empty()) work.only->requests.erase(request);
    if (settings_.timing.nack_suppression > sim::Duration()) work.only->sent_at[change.number] = now;
    if (settings_.timing.heartbeat_after_resend && work.only->requests.empty()) add_heartbeat(*work.only, outbox);
  } else {
    if (work.only != nullptr)
      advance(*work.only, change, work.fragment, now);
    else
      for (auto& [guid, proxy] : readers_) advance(proxy, change, work.fragment, now);
    piggyback(work, now, outbox);
  }
  const std::size_t octets = outbox.size();
  outbox.end();
  return octets;
}

void StatefulWriter::advance(ReaderProxy& proxy, const CacheChange& change, FragmentNumber fragment,
                             sim::LocalTime now) {
  if (settings_.timing.nack_suppression > sim::Duration() && proxy.reader.reliable) proxy.sent_at[change.number] = now;
  if (fragment.value != 0 && fragment.value < fragments_of_change(change)) {
    proxy.next_fragment = fragment.next();
    return;
  }
  proxy.next_unsent = change.number + 1;
  proxy.next_fragment = FragmentNumber{1};
}

/// A HEARTBEAT that travels with the last message of a sample.
void StatefulWriter::piggyback(const Work& work, sim::LocalTime now, Outbox& outbox) {
  const auto behind = work.only != nullptr ? work.only->next_unsent : readers_.begin()->second.next_unsent;
  if (behind <= work.change->number || !is_anyone_behind()) return;
  const TimingProfile& timing = settings_.timing;
  const HistorySettings& limits = settings_.history.history;
  const bool is_full = timing.piggyback_when_full && limits.keep_all && history_.size() >= limits.max_samples;
  const bool is_time = timing.piggyback_interval != TimingProfile::off &&
                       (!piggybacked_at_ || now - *piggybacked_at_ >= timing.piggyback_interval);
  if (!is_full && !is_time) return;
  Heartbeat made = heartbeat(work.only);
  made.is_final = !is_full && asked_at_ && now - *asked_at_ < timing.piggyback_answer_interval;
  if (!made.is_final) asked_at_ = now;
  piggybacked_at_ = now;
  outbox.add(made);
}

void StatefulWriter::gap(const ReaderProxy& proxy, SequenceNumber from, SequenceNumber to, Outbox& outbox) {
  TAKT_CHECK(from < to, "a gap is not empty");
  outbox.begin(route_to(proxy));
  outbox.add(Gap{proxy.reader.guid.entity, settings_.guid.entity, from, SequenceNumberSet(to)});
  outbox.end();
}

void StatefulWriter::receive(const Guid& reader, const AckNack& ack, sim::LocalTime now, Outbox& outbox) {
  const auto at = readers_.find(reader);
  if (at == readers_.end() || !at->second.reader.reliable) return;
  ReaderProxy& proxy = at->second;
  if (ack.count <= proxy.last_ack) return;  // a duplicate, or overtaken
  proxy.last_ack = ack.count;
  if (ack.missing.base() > history_.last() + 1) return;  // acknowledges what was never written
  // Less than before, if it lost the writer, found it again and wants what it had already: heartbeats go on until it
  // has it.
  proxy.acknowledged_below = std::max(ack.missing.base(), proxy.start);
  proxy.requests.erase(proxy.requests.begin(), proxy.requests.lower_bound(proxy.acknowledged_below));
  proxy.sent_at.erase(proxy.sent_at.begin(), proxy.sent_at.lower_bound(proxy.acknowledged_below));
  ack.missing.for_each([&](SequenceNumber number) {
    if (number < proxy.next_unsent) ask(proxy, number, now);
  });
  // It wants to hear what there is, be it nothing.
  if (!ack.is_final && ack.missing.is_empty() && proxy.requests.empty()) {
    proxy.heartbeat_at = sim::LocalTime::never();
    send_heartbeat(proxy, outbox);
  }
  answer_later(proxy, now, outbox);
  release();
  plan_heartbeat(now);
  if (proxy.heartbeat_at <= now) wake(now, outbox);
}

void StatefulWriter::receive(const Guid& reader, const NackFrag& nack, sim::LocalTime now, Outbox& outbox) {
  const auto at = readers_.find(reader);
  if (at == readers_.end() || !at->second.reader.reliable || nack.count <= at->second.last_nack_frag) return;
  ReaderProxy& proxy = at->second;
  proxy.last_nack_frag = nack.count;
  const auto place = std::pair(nack.sequence_number, FragmentNumber{1});
  if (place >= std::pair(proxy.next_unsent, proxy.next_fragment)) return;  // nothing of it was sent
  ask(proxy, nack.sequence_number, now, &nack.missing);
  answer_later(proxy, now, outbox);
}

void StatefulWriter::ask(ReaderProxy& proxy, SequenceNumber number, sim::LocalTime now,
                         const FragmentNumberSet* fragments) {
  const auto sent = proxy.sent_at.find(number);
  if (sent != proxy.sent_at.end() && now - sent->second < settings_.timing.nack_suppression) return;
  const CacheChange* const change = history_.find(number);
  if (change == nullptr || !is_fragmented(*change)) {
    proxy.requests.try_emplace(number);
    return;
  }
  const bool is_partly_sent = number == proxy.next_unsent;
  const std::uint32_t last = is_partly_sent ? proxy.next_fragment.value - 1 : fragments_of_change(*change);
  std::set<FragmentNumber> wanted;
  if (fragments == nullptr) {
    for (std::uint32_t i = 1; i <= last; ++i) wanted.insert(FragmentNumber{i});
  } else {
    fragments->for_each([&](FragmentNumber fragment) {
      if (fragment.value >= 1 && fragment.value <= last) wanted.insert(fragment);
    });
  }
  if (!wanted.empty()) proxy.requests[number].merge(wanted);
}

void StatefulWriter::answer_later(ReaderProxy& proxy, sim::LocalTime now, Outbox& outbox) {
  if (proxy.requests.empty() || proxy.is_due) return;
  proxy.respond_at = std::min(proxy.respond_at, now.plus_saturated(settings_.timing.nack_response_delay));
  if (proxy.respond_at <= now) wake(now, outbox);
}

bool StatefulWriter::is_behind(const ReaderProxy& proxy) const {
  return proxy.reader.reliable && (proxy.acknowledged_below < proxy.next_unsent || proxy.next_fragment.value > 1);
}

bool StatefulWriter::is_anyone_behind() const {
  return std::any_of(readers_.begin(), readers_.end(), [&](const auto& each) { return is_behind(each.second); });
}

bool StatefulWriter::is_acknowledged() const {
  return std::all_of(readers_.begin(), readers_.end(), [&](const auto& each) {
    return !each.second.reader.reliable || each.second.acknowledged_below > history_.last();
  });
}

/// What was sent so far: what waits for a flow controller comes by itself.
Heartbeat StatefulWriter::heartbeat(const ReaderProxy* only) {
  Heartbeat made;
  made.writer = settings_.guid.entity;
  made.count = ++heartbeat_count_;
  SequenceNumber end = only != nullptr ? only->next_unsent : first_sequence_number;
  if (only != nullptr) {
    made.reader = only->reader.guid.entity;
  } else {
    for (const auto& [guid, proxy] : readers_) end = std::max(end, proxy.next_unsent);
  }
  made.last = end.previous();
  made.first = std::min(only != nullptr ? std::max(history_.first(), only->start) : history_.first(), end);
  return made;
}

void StatefulWriter::add_heartbeat(const ReaderProxy& proxy, Outbox& outbox) {
  outbox.add(heartbeat(&proxy));
  if (proxy.next_fragment.value > 1) {
    outbox.add(HeartbeatFrag{proxy.reader.guid.entity, settings_.guid.entity, proxy.next_unsent,
                             FragmentNumber{proxy.next_fragment.value - 1}, ++heartbeat_frag_count_});
  }
}

void StatefulWriter::send_heartbeat(const ReaderProxy& proxy, Outbox& outbox) {
  outbox.begin(route_to(proxy));
  add_heartbeat(proxy, outbox);
  outbox.end();
}

/// To all at once if more than one is behind and all have been sent the same.
void StatefulWriter::send_heartbeats(sim::LocalTime now, Outbox& outbox) {
  std::vector<const ReaderProxy*> behind;
  bool together = true;
  for (const auto& [guid, proxy] : readers_) {
    if (!is_behind(proxy)) continue;
    behind.push_back(&proxy);
    together = together && proxy.next_unsent == behind.front()->next_unsent && proxy.next_fragment.value == 1;
  }
  asked_at_ = now;
  if (behind.size() > 1 && together) {
    outbox.begin(route_to_all_);
    outbox.add(heartbeat(nullptr));
    outbox.end();
    return;
  }
  for (const ReaderProxy* const proxy : behind) send_heartbeat(*proxy, outbox);
}

void StatefulWriter::assert_liveliness(Outbox& outbox) {
  if (readers_.empty()) return;
  outbox.begin(route_to_all_);
  Heartbeat made = heartbeat(nullptr);
  made.is_final = true;
  made.is_liveliness = true;
  outbox.add(made);
  outbox.end();
}

void StatefulWriter::release() {
  SequenceNumber below = history_.last() + 1;
  for (const auto& [guid, proxy] : readers_)
    below = std::min({below, proxy.next_unsent, proxy.reader.reliable ? proxy.acknowledged_below : below});
  history_.release(below);
}

void StatefulWriter::plan_heartbeat(sim::LocalTime now) {
  if (!is_anyone_behind()) {
    heartbeat_at_ = sim::LocalTime::never();
    return;
  }
  if (heartbeat_at_ != sim::LocalTime::never()) return;
  sim::Duration period = settings_.timing.heartbeat_period;
  for (std::uint32_t n = settings_.timing.heartbeat_backoff_after;
       n < heartbeats_since_write_ && 2 * period < settings_.timing.heartbeat_period_max; ++n)
    period = 2 * period;
  heartbeat_at_ = now.plus_saturated(period);
}

sim::LocalTime StatefulWriter::next_wake() const {
  sim::LocalTime next = heartbeat_at_;
  for (const auto& [guid, proxy] : readers_) next = std::min({next, proxy.respond_at, proxy.heartbeat_at});
  return next;
}

void StatefulWriter::wake(sim::LocalTime now, Outbox& outbox) {
  for (auto& [guid, proxy] : readers_) {
    if (proxy.respond_at <= now) {
      proxy.respond_at = sim::LocalTime::never();
      proxy.is_due = true;
    }
    if (proxy.heartbeat_at <= now) {
      proxy.heartbeat_at = sim::LocalTime::never();
      send_heartbeat(proxy, outbox);
    }
  }
  if (!settings_.asynchronous) push(now, outbox);
  if (heartbeat_at_ <= now) {
    heartbeat_at_ = sim::LocalTime::never();
    ++heartbeats_since_write_;
    send_heartbeats(now, outbox);
  }
  release();
  plan_heartbeat(now);
}

}  // namespace takt::dds
