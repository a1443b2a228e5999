// SPDX-License-Identifier: Apache-2.0
#include "dds/rtps/stateful_reader.hpp"

#include <algorithm>

#include "dds/history/expiry.hpp"
#include "sim/check.hpp"

namespace takt::dds {

void StatefulReader::match(const MatchedWriter& writer, sim::LocalTime now) {
  TAKT_CHECK(!writers_.contains(writer.guid), "a writer is matched once");
  WriterProxy& proxy = writers_[writer.guid];
  proxy.writer = writer;
  proxy.reliable = settings_.reliable && writer.reliable;
  proxy.ack_count = ack_count_;
  proxy.nack_frag_count = ack_count_;
  ++liveliness_.alive_count;
  ++liveliness_.changes;
  proxy.alive_until = now.plus_saturated(writer.liveliness.lease_duration);
  if (proxy.reliable && settings_.timing.initial_acknack_delay != TimingProfile::off) {
    proxy.greeting_delay = settings_.timing.initial_acknack_delay;
    proxy.answer_at = now + proxy.greeting_delay;
    proxy.answer_is_final = false;
  }
}

void StatefulReader::unmatch(const Guid& writer, sim::LocalTime now) {
  const auto at = writers_.find(writer);
  if (at == writers_.end()) return;
  --(at->second.is_alive ? liveliness_.alive_count : liveliness_.not_alive_count);
  ++liveliness_.changes;
  ack_count_ = std::max({ack_count_, at->second.ack_count, at->second.nack_frag_count});
  writers_.erase(at);
  history_.writer_gone(writer, now);
}

InstanceKey StatefulReader::key_of(const InlineQos& qos, PayloadKind kind, Octets payload) const {
  if (!settings_.has_key) return no_key;
  if (qos.key_hash) return *qos.key_hash;
  return settings_.key_of ? settings_.key_of(kind, payload) : no_key;
}

/// Whether a change with this number can still be taken.
bool StatefulReader::is_wanted(const WriterProxy& proxy, SequenceNumber number) const {
  return number >= proxy.next && !proxy.pending.contains(number) && proxy.gap_end(number) == number;
}

namespace {

ChangeKind kind_of(const InlineQos& qos) { return static_cast<ChangeKind>(qos.status_info.value_or(0) & 3u); }

}  // namespace

void StatefulReader::receive(const Guid& writer, const Data& data, std::optional<Time> source, sim::LocalTime now,
                             Outbox&) {
  const auto at = writers_.find(writer);
  if (at == writers_.end() || data.sequence_number < first_sequence_number) return;
  WriterProxy& proxy = at->second;
  alive(proxy, now);
  if (!is_wanted(proxy, data.sequence_number)) {
    ++duplicates_;
    return;
  }
  PendingChange change{kind_of(data.inline_qos),
                       key_of(data.inline_qos, data.payload_kind, data.payload),
                       source ? settings_.epoch.local(*source) : now,
                       data.inline_qos.original_writer,
                       {}};
  accept_change(proxy, data.sequence_number, std::move(change), data.payload, now);
}

void StatefulReader::receive(const Guid& writer, const DataFrag& data, std::optional<Time> source, sim::LocalTime now,
                             Outbox&) {
  const auto at = writers_.find(writer);
  if (at == writers_.end() || data.sequence_number < first_sequence_number || data.fragment_size == 0 ||
      data.sample_size == 0)
    return;
  WriterProxy& proxy = at->second;
  alive(proxy, now);
  if (!is_wanted(proxy, data.sequence_number)) {
    ++duplicates_;
    return;
  }
  auto part = proxy.reassemblies.find(data.sequence_number);
  if (part == proxy.reassemblies.end()) {
    if (data.sample_size > settings_.limits.max_sample_octets) return;
    // A best-effort reader gives up the oldest; a reliable one will be sent the newest again.
    if (proxy.reassemblies.size() >= settings_.limits.max_reassemblies) {
      const auto victim = proxy.reliable ? std::prev(proxy.reassemblies.end()) : proxy.reassemblies.begin();
      if (proxy.reliable ? victim->first < data.sequence_number : victim->first > data.sequence_number) return;
      proxy.reassemblies.erase(victim);
    }
    part = proxy.reassemblies.emplace(data.sequence_number, Reassembly(data)).first;
  }
  if (!part->second.add(data, source ? settings_.epoch.local(*source) : now) || !part->second.is_complete()) return;
  const auto whole = proxy.reassemblies.extract(part);
  const Reassembly& sample = whole.mapped();
  PendingChange change{kind_of(sample.inline_qos()),
                       key_of(sample.inline_qos(), sample.payload_kind(), sample.payload()),
                       sample.source(),
                       sample.inline_qos().original_writer,
                       {}};
  accept_change(proxy, data.sequence_number, std::move(change), sample.payload(), now);
}

void StatefulReader::accept_change(WriterProxy& proxy, SequenceNumber number, PendingChange change, Octets payload,
                                   sim::LocalTime now) {
  if (!proxy.reliable) {
    if (!proxy.is_new) lost_.total_count += static_cast<std::uint64_t>(number - proxy.next);
    proxy.is_new = false;
    deliver(proxy, number, change, payload, now);
    proxy.next = number + 1;
    proxy.tidy();
    return;
  }
  proxy.announced = std::max(proxy.announced, number);
  proxy.repeat_at = sim::LocalTime::never();
  if (number == proxy.next) {
    if (!deliver(proxy, number, change, payload, now)) return;
    ++proxy.next;
    deliver_pending(proxy, now);
    return;
  }
  if (proxy.pending.size() >= settings_.limits.max_pending ||
      proxy.pending_octets + payload.size() > settings_.limits.max_pending_octets)
    return;
  change.payload.assign(payload.begin(), payload.end());
  proxy.pending_octets += payload.size();
  proxy.pending.emplace(number, std::move(change));
}

NumberRanges& StatefulReader::delivered_of(const Guid& identity) {
  const auto [at, is_new] = delivered_.try_emplace(identity);
  if (!is_new) return at->second;
  remembered_.push_back(identity);
  const auto is_matched = [&](const Guid& guid) {
    return std::any_of(writers_.begin(), writers_.end(), [&](const auto& each) {
      return each.first == guid || each.second.writer.persistence_guid == guid;
    });
  };
  for (std::size_t tries = remembered_.size(); delivered_.size() > most_remembered + writers_.size() && tries > 0;
       --tries) {
    const Guid oldest = remembered_.front();
    remembered_.pop_front();
    if (oldest == identity || is_matched(oldest))
      remembered_.push_back(oldest);
    else
      delivered_.erase(oldest);
  }
  return at->second;
}

bool StatefulReader::deliver(WriterProxy& proxy, SequenceNumber number, const PendingChange& change, Octets payload,
                             sim::LocalTime now) {
  NumberRanges* delivered = nullptr;
  const SequenceNumber counted = change.original ? change.original->number : number;
  const Guid& own_identity =
      proxy.writer.persistence_guid.is_unknown() ? proxy.writer.guid : proxy.writer.persistence_guid;
  const Guid& identity = change.original ? change.original->writer : own_identity;
  if (change.original || settings_.tracks_delivered || !proxy.writer.persistence_guid.is_unknown()) {
    delivered = &delivered_of(identity);
    if (delivered->contains(counted)) {
      ++duplicates_;
      return true;
    }
  }
  const Guid& writer = change.original ? change.original->writer : proxy.writer.guid;
  const Arrival arrival{writer,
                        proxy.writer.ownership_strength,
                        counted,
                        change.kind,
                        change.key,
                        change.source,
                        expiry_of(change.source, proxy.writer.lifespan),
                        payload,
                        change.original.has_value(),
                        identity};
  const Admission admission = history_.add(arrival, now);
  if (admission == Admission::accepted) ++arrived_;
  proxy.is_blocked = admission == Admission::rejected && proxy.reliable;
  if (proxy.is_blocked) proxy.blocked_key = change.key;
  if (delivered != nullptr && admission != Admission::rejected) delivered->insert(counted);
  return admission != Admission::rejected;
}

void StatefulReader::deliver_pending(WriterProxy& proxy, sim::LocalTime now) {
  while (true) {
    proxy.next = proxy.gap_end(proxy.next);
    const auto at = proxy.pending.find(proxy.next);
    if (at == proxy.pending.end()) break;
    if (!deliver(proxy, at->first, at->second, at->second.payload, now)) break;
    ++proxy.next;
  }
  proxy.tidy();
}

/// The writer no longer has what is below `first`: what is here counts, the rest is lost.
void StatefulReader::lose_below(WriterProxy& proxy, SequenceNumber first, sim::LocalTime now) {
  deliver_pending(proxy, now);
  while (proxy.next < first && !proxy.is_blocked) {
    const SequenceNumber up_to = proxy.pending.empty() ? first : std::min(first, proxy.pending.begin()->first);
    for (SequenceNumber number = proxy.next; number < up_to && !proxy.is_new;) {
      const SequenceNumber after = std::min(proxy.gap_end(number), up_to);
      if (after == number) {
        // As many as lie before the next gap.
        const auto gap = proxy.gaps.upper_bound(number);
        const SequenceNumber end = gap == proxy.gaps.end() ? up_to : std::min(gap->first, up_to);
        lost_.total_count += static_cast<std::uint64_t>(end - number);
        number = end;
      } else {
        number = after;
      }
    }
    proxy.next = up_to;
    deliver_pending(proxy, now);
  }
}

void StatefulReader::receive(const Guid& writer, const Heartbeat& heartbeat, sim::LocalTime now, Outbox& outbox) {
  const auto at = writers_.find(writer);
  if (at == writers_.end()) return;
  WriterProxy& proxy = at->second;
  if (heartbeat.is_liveliness) alive(proxy, now);
  if (!proxy.reliable || heartbeat.count <= proxy.last_heartbeat) return;  // a duplicate, or overtaken
  proxy.last_heartbeat = heartbeat.count;
  if (proxy.heard_at && now - *proxy.heard_at < settings_.timing.heartbeat_suppression) return;
  proxy.heard_at = now;
  unblock(proxy, now);
  lose_below(proxy, heartbeat.first, now);
  proxy.is_new = false;
  proxy.announced = std::max(proxy.announced, heartbeat.last);
  for (auto& [number, part] : proxy.reassemblies)
    if (number <= proxy.announced) part.announced = FragmentNumber{std::numeric_limits<std::uint32_t>::max()};
  const bool lacks = proxy.lacks_anything();
  if (!heartbeat.is_final)
    plan_answer(proxy, settings_.timing.heartbeat_response_delay, true, now, outbox);
  else if (lacks)
    plan_answer(proxy, settings_.timing.nack_delay_when_final, true, now, outbox);
}

void StatefulReader::receive(const Guid& writer, const HeartbeatFrag& heartbeat, sim::LocalTime now, Outbox& outbox) {
  const auto at = writers_.find(writer);
  if (at == writers_.end() || !at->second.reliable || heartbeat.count <= at->second.last_heartbeat_frag) return;
  WriterProxy& proxy = at->second;
  proxy.last_heartbeat_frag = heartbeat.count;
  const auto part = proxy.reassemblies.find(heartbeat.sequence_number);
  if (part == proxy.reassemblies.end()) return;  // without its size there is nothing to ask for by fragments
  part->second.announced = std::max(part->second.announced, heartbeat.last_fragment);
  if (!part->second.missing(part->second.announced).is_empty())
    plan_answer(proxy, settings_.timing.heartbeat_response_delay, true, now, outbox);
}

void StatefulReader::receive(const Guid& writer, const Gap& gap, sim::LocalTime now, Outbox&) {
  const auto at = writers_.find(writer);
  if (at == writers_.end() || gap.start < first_sequence_number) return;
  WriterProxy& proxy = at->second;
  if (!proxy.reliable) {
    if (gap.start > proxy.next) return;
    proxy.next = std::max(proxy.next, gap.list.base());
    proxy.is_new = false;
    return;
  }
  proxy.add_gap(gap.start, gap.list.base(), settings_.limits);
  gap.list.for_each([&](SequenceNumber number) { proxy.add_gap(number, number + 1, settings_.limits); });
  if (gap.start <= proxy.next) proxy.is_new = false;
  deliver_pending(proxy, now);
}

std::optional<Sample> StatefulReader::take(sim::LocalTime now, Outbox& outbox) {
  std::optional<Sample> sample = history_.take(now);
  if (!sample) return sample;
  for (auto& [guid, proxy] : writers_) {
    // What was turned away is asked for at once; if it waits here, the writer learns that there is room.
    if (proxy.is_blocked && unblock(proxy, now)) answer(proxy, true, now, outbox);
  }
  return sample;
}

bool StatefulReader::unblock(WriterProxy& proxy, sim::LocalTime now) {
  if (!proxy.is_blocked || !history_.has_room(proxy.blocked_key, now)) return false;
  proxy.is_blocked = false;
  deliver_pending(proxy, now);
  return true;
}

void StatefulReader::plan_answer(WriterProxy& proxy, sim::Duration delay, bool is_final, sim::LocalTime now,
                                 Outbox& outbox) {
  const sim::LocalTime at = now.plus_saturated(delay);
  if (at < proxy.answer_at || !proxy.answer_is_final) {
    proxy.answer_at = std::min(at, proxy.answer_at);
    proxy.answer_is_final = is_final;
  }
  if (proxy.answer_at <= now) {
    proxy.answer_at = sim::LocalTime::never();
    answer(proxy, proxy.answer_is_final, now, outbox);
    proxy.answer_is_final = true;
  }
}

void StatefulReader::answer(WriterProxy& proxy, bool is_final, sim::LocalTime now, Outbox& outbox) {
  const SequenceNumberSet missing = proxy.missing();
  if (proxy.answered_at && missing == proxy.answered && now - *proxy.answered_at < settings_.timing.ack_spacing) return;
  proxy.answered_at = now;
  proxy.answered = missing;
  Route route;
  if (!proxy.writer.unicast.empty()) route.destinations = {proxy.writer.unicast.front()};
  route.only = proxy.writer.guid.prefix;
  outbox.begin(route);
  outbox.add(AckNack{settings_.guid.entity, proxy.writer.guid.entity, missing, ++proxy.ack_count, is_final});
  for (const auto& [number, part] : proxy.reassemblies) {
    if (part.announced.value == 0 || proxy.is_blocked) continue;
    const FragmentNumberSet fragments = part.missing(part.announced);
    if (!fragments.is_empty())
      outbox.add(NackFrag{settings_.guid.entity, proxy.writer.guid.entity, number, fragments, ++proxy.nack_frag_count});
  }
  outbox.end();
  if (settings_.timing.nack_repeat != TimingProfile::off)
    proxy.repeat_at = proxy.lacks_anything() ? now + settings_.timing.nack_repeat : sim::LocalTime::never();
}

void StatefulReader::alive(WriterProxy& proxy, sim::LocalTime now) {
  proxy.alive_until = now.plus_saturated(proxy.writer.liveliness.lease_duration);
  if (proxy.is_alive) return;
  proxy.is_alive = true;
  ++liveliness_.alive_count;
  --liveliness_.not_alive_count;
  ++liveliness_.changes;
}

void StatefulReader::assert_alive(const Guid& writer, sim::LocalTime now) {
  const auto at = writers_.find(writer);
  if (at != writers_.end()) alive(at->second, now);
}

sim::LocalTime StatefulReader::next_wake() const {
  sim::LocalTime next = history_.next_deadline();
  for (const auto& [guid, proxy] : writers_) {
    next = std::min({next, proxy.answer_at, proxy.repeat_at});
    if (proxy.is_alive) next = std::min(next, proxy.alive_until);
  }
  return next;
}

void StatefulReader::wake(sim::LocalTime now, Outbox& outbox) {
  for (auto& [guid, proxy] : writers_) {
    if (proxy.is_alive && proxy.alive_until <= now) {
      proxy.is_alive = false;
      --liveliness_.alive_count;
      ++liveliness_.not_alive_count;
      ++liveliness_.changes;
      history_.writer_gone(guid, now);
    }
    if (proxy.repeat_at <= now) {
      proxy.repeat_at = sim::LocalTime::never();
      proxy.answer_at = std::min(proxy.answer_at, now);
    }
    if (proxy.answer_at <= now) {
      proxy.answer_at = sim::LocalTime::never();
      answer(proxy, std::exchange(proxy.answer_is_final, true), now, outbox);
      // The first ACKNACK, or the HEARTBEAT that it asks for, may be lost; a writer that takes all for acknowledged
      // would stay silent.
      if (proxy.greeting_delay > sim::Duration() && !proxy.heard_at) {
        proxy.greeting_delay =
            std::max(proxy.greeting_delay, std::min(2 * proxy.greeting_delay, settings_.timing.heartbeat_period_max));
        proxy.answer_at = now + proxy.greeting_delay;
        proxy.answer_is_final = false;
      }
    }
  }
  history_.advance(now);
}

}  // namespace takt::dds
