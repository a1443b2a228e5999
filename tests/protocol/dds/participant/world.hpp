// SPDX-License-Identifier: Apache-2.0
// World: participants in memory on a medium that delays, loses, duplicates and reorders as it is told.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "dds/message/decoder.hpp"
#include "dds/participant/participant.hpp"

namespace takt::dds {

inline constexpr sim::LocalTime start = sim::LocalTime::from_ps(0);

/// A message that a participant has sent.
struct Sent {
  sim::LocalTime at;
  std::size_t from = 0;  ///< which participant
  std::vector<Locator> destinations;
  std::vector<std::byte> octets;
  /// Its submessages, as "INFO_TS DATA HEARTBEAT".
  std::string kinds() const {
    std::string text;
    for (MessageDecoder decoder(octets); decoder.next();)
      text += (text.empty() ? "" : " ") + std::string(name_of(decoder.kind()));
    return text;
  }
};

class World {
 public:
  /// When one copy of a message arrives, after it was sent; nothing: it is lost.
  using Medium = std::function<std::vector<sim::Duration>(const Sent&)>;

  Medium medium = [](const Sent&) { return std::vector{sim::Duration::from_ps(100'000'000)}; };  // 100 us
  std::vector<Sent> log;
  bool keeps_log = true;
  std::vector<std::pair<std::size_t, Event>> events;
  sim::LocalTime now = start;

  static ParticipantConfig config(std::uint8_t number) {
    ParticipantConfig config;
    config.prefix.octets = {1, 0xFA, number};
    config.address = 0x0A000000u + number;
    return config;
  }
  Participant& add(const ParticipantConfig& config) {
    participants.push_back(std::make_unique<Participant>(config, now));
    collect();
    return *participants.back();
  }
  Participant& add() { return add(config(static_cast<std::uint8_t>(participants.size() + 1))); }
  /// The participant is gone without a word; what is under way to it is lost.
  void kill(std::size_t index) { participants[index].reset(); }

  /// Each knows the other's entity.
  void match(Participant& writing, WriterHandle writer, Participant& reading, ReaderHandle reader) {
    writing.match(writer, reading.data_of(reader), now);
    reading.match(reader, writing.data_of(writer), now);
    collect();
  }

  /// Takes what participants want to send and to tell, after each call of one.
  void collect() {
    for (std::size_t i = 0; i < participants.size(); ++i) {
      if (!participants[i]) continue;
      while (const std::optional<DatagramView> view = participants[i]->next_datagram())
        send({now, i, view->destinations, {view->octets.begin(), view->octets.end()}});
      while (std::optional<Event> event = participants[i]->next_event()) events.emplace_back(i, std::move(*event));
    }
  }
  sim::LocalTime next() const {
    sim::LocalTime next = arrivals_.empty() ? sim::LocalTime::never() : arrivals_.begin()->first.first;
    for (const auto& each : participants)
      if (each) next = std::min(next, each->next_wake());
    return next;
  }
  /// One thing happens, if anything is to happen by `end`.
  bool step(sim::LocalTime end) {
    collect();
    const sim::LocalTime next_time = next();
    if (next_time > end) return false;
    now = std::max(now, next_time);
    for (const auto& each : participants)
      if (each && each->next_wake() <= now) {
        each->wake(now);
        collect();
        return true;
      }
    const auto arrival = arrivals_.extract(arrivals_.begin());
    const auto& [to, octets] = arrival.mapped();
    if (participants[to]) participants[to]->receive(octets, {}, now);
    collect();
    return true;
  }
  void run_until(sim::LocalTime end) {
    while (step(end)) {
    }
    now = std::max(now, end);
  }
  void run_for(sim::Duration duration) { run_until(now + duration); }

  std::size_t count(EventKind kind, std::size_t participant) const {
    std::size_t sum = 0;
    for (const auto& [who, event] : events) sum += who == participant && event.kind == kind ? 1 : 0;
    return sum;
  }

  std::vector<std::unique_ptr<Participant>> participants;

 private:
  void send(const Sent& sent) {
    if (keeps_log) log.push_back(sent);
    for (const Locator& locator : sent.destinations) {
      for (std::size_t to = 0; to < participants.size(); ++to) {
        if (!participants[to] || to == sent.from) continue;
        const std::vector<Locator> listens = participants[to]->listens_to();
        if (std::find(listens.begin(), listens.end(), locator) == listens.end()) continue;
        for (const sim::Duration delay : medium(sent))
          arrivals_.emplace(std::pair(now + delay, serial_++), std::pair(to, sent.octets));
      }
    }
  }

  std::map<std::pair<sim::LocalTime, std::uint64_t>, std::pair<std::size_t, std::vector<std::byte>>> arrivals_;
  std::uint64_t serial_ = 0;
};

/// A payload of `size` octets, at least 8, that tells `value`.
inline std::vector<std::byte> payload_of(std::uint32_t value, std::size_t size = 12) {
  std::vector<std::byte> octets(std::max<std::size_t>(size, 8));
  octets[1] = std::byte{1};  // CDR_LE
  store(octets.data() + 4, value, ByteOrder::little);
  for (std::size_t i = 8; i < octets.size(); ++i) octets[i] = static_cast<std::byte>(value * 31 + i * 7);
  return octets;
}
/// The value if the payload is as payload_of() made it.
inline std::optional<std::uint32_t> value_of(const Sample& sample) {
  if (sample.payload.size() < 8) return std::nullopt;
  const auto value = load<std::uint32_t>(sample.payload.data() + 4, ByteOrder::little);
  return sample.payload == payload_of(value, sample.payload.size()) ? std::optional(value) : std::nullopt;
}
inline std::vector<std::uint32_t> drain_values(Participant& participant, ReaderHandle reader, sim::LocalTime now) {
  std::vector<std::uint32_t> all;
  while (const std::optional<Sample> sample = participant.take(reader, now))
    if (sample->info.valid_data) all.push_back(value_of(*sample).value_or(0xDEAD));
  return all;
}

inline WriterConfig writer_config(ReliabilityKind reliability = ReliabilityKind::reliable) {
  WriterConfig config;
  config.topic = "topic";
  config.type = "Type";
  config.qos.reliability.kind = reliability;
  return config;
}
inline ReaderConfig reader_config(ReliabilityKind reliability = ReliabilityKind::reliable) {
  ReaderConfig config;
  config.topic = "topic";
  config.type = "Type";
  config.qos.reliability.kind = reliability;
  config.qos.history.kind = HistoryKind::keep_all;
  return config;
}

}  // namespace takt::dds
