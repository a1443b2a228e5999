// SPDX-License-Identifier: Apache-2.0
// Participants that have nothing but discovery, in a network in memory: each message takes the same time, and may be
// lost.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dds/discovery/discovery.hpp"
#include "dds/dissector.hpp"

namespace takt::dds::test {

using namespace sim::literals;

constexpr sim::LocalTime at(sim::Duration since_start) { return sim::LocalTime() + since_start; }

/// A participant on a host of its own, 10.0.0.number.
struct Node {
  std::uint8_t number = 0;
  Outbox outbox;
  Discovery discovery;
  sim::LocalTime starts;
  bool is_running = false;
  std::vector<DiscoveryEvent> events;

  Node(std::uint8_t node_number, const ParticipantData& self, const Discovery::Settings& settings)
      : number(node_number), outbox(self.guid.prefix, settings.max_message), discovery(settings, self) {}

  Guid writer(std::uint32_t key) const {
    return {discovery.self().guid.prefix, EntityId::user(key, EntityKind::writer_with_key)};
  }
  Guid reader(std::uint32_t key) const {
    return {discovery.self().guid.prefix, EntityId::user(key, EntityKind::reader_with_key)};
  }
  std::size_t count(DiscoveryEvent::Kind kind) const {
    return static_cast<std::size_t>(
        std::count_if(events.begin(), events.end(), [&](const DiscoveryEvent& event) { return event.kind == kind; }));
  }
};

inline PublicationData publication(const Guid& guid, const std::string& topic) {
  PublicationData data;
  data.endpoint.guid = guid;
  data.endpoint.topic_name = topic;
  data.endpoint.type_name = "Type";
  return data;
}
inline SubscriptionData subscription(const Guid& guid, const std::string& topic) {
  SubscriptionData data;
  data.endpoint = publication(guid, topic).endpoint;
  return data;
}

class Network {
 public:
  sim::Duration one_way = 100_us;
  /// Whether the message with this number, from 1 on, is lost.
  std::function<bool(std::uint64_t number)> loses = [](std::uint64_t) { return false; };

  static Locator metatraffic(std::uint8_t number) { return Locator::udp_v4({10, 0, 0, number}, 7410); }
  static Locator group() { return Locator::udp_v4(discovery_group, 7400); }

  Node& add(DiscoverySettings settings, TimingProfile timing = timing::fast_dds, const std::string& name = {}) {
    const auto number = static_cast<std::uint8_t>(nodes.size() + 1);
    ParticipantData self;
    self.guid.prefix = {{0x01, 0xFA, 0, 0, 0, 0, 0, 0, 0, 0, 0, number}};
    self.domain = 0;
    self.metatraffic_unicast = {metatraffic(number)};
    self.metatraffic_multicast = {group()};
    self.default_unicast = {Locator::udp_v4({10, 0, 0, number}, 7411)};
    self.entity_name = name;
    if (settings.kind == DiscoveryKind::simple || settings.kind == DiscoveryKind::static_)
      settings.announce_to = {group()};
    nodes.push_back(std::make_unique<Node>(number, self, Discovery::Settings{settings, timing, 1472, {}}));
    return *nodes.back();
  }

  void start(Node& node) {
    node.is_running = true;
    node.discovery.start(now, node.outbox);
    flush(node);
  }
  /// Silently, as by a crash.
  void crash(Node& node) { node.is_running = false; }
  void stop(Node& node) {
    node.discovery.stop(now, node.outbox);
    flush(node);
    node.is_running = false;
  }
  void announce(Node& node, const auto& data) {
    node.discovery.announce(data, now, node.outbox);
    flush(node);
  }
  void withdraw(Node& node, const Guid& guid) {
    node.discovery.withdraw(guid, now, node.outbox);
    flush(node);
  }

  void run_until(sim::LocalTime end) {
    while (true) {
      sim::LocalTime next = in_flight_.empty() ? sim::LocalTime::never() : in_flight_.front().arrives;
      for (const auto& node : nodes)
        if (node->is_running) next = std::min(next, node->discovery.next_wake());
      if (next > end) break;
      now = std::max(now, next);
      if (!in_flight_.empty() && in_flight_.front().arrives <= now) {
        deliver();
        continue;
      }
      for (const auto& node : nodes) {
        if (!node->is_running || node->discovery.next_wake() > now) continue;
        node->discovery.wake(now, node->outbox);
        flush(*node);
      }
    }
    now = end;
  }

  std::vector<std::unique_ptr<Node>> nodes;
  std::vector<Datagram> log;
  sim::LocalTime now;

 private:
  struct Flight {
    sim::LocalTime arrives;
    Locator to;
    std::vector<std::byte> octets;
    std::uint8_t from = 0;
  };

  void flush(Node& node) {
    while (const OutgoingDatagram* const datagram = node.outbox.next()) {
      for (const Locator& to : datagram->destinations) {
        log.push_back({now.ps() / 1'000'000, 0x0A000000U + node.number, 7410, to.ip_v4(),
                       static_cast<std::uint16_t>(to.port), datagram->octets});
        if (!loses(log.size())) in_flight_.push_back({now + one_way, to, datagram->octets, node.number});
      }
    }
    while (const auto event = node.discovery.next_event()) node.events.push_back(*event);
  }

  void deliver() {
    const Flight flight = std::move(in_flight_.front());
    in_flight_.pop_front();
    for (const auto& node : nodes) {
      const bool is_for_it =
          flight.to.is_multicast() ? node->number != flight.from : flight.to == metatraffic(node->number);
      if (!is_for_it || !node->is_running) continue;
      MessageDecoder decoder(flight.octets);
      while (decoder.next()) {
        const GuidPrefix& only = decoder.interpretation().destination;
        if (only.is_unknown() || only == node->discovery.self().guid.prefix)
          node->discovery.receive(decoder.interpretation(), decoder.submessage(), now, node->outbox);
      }
      flush(*node);
    }
  }

  std::deque<Flight> in_flight_;
};

}  // namespace takt::dds::test
