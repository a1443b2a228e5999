// SPDX-License-Identifier: Apache-2.0
// Several gPTP nodes on ideal links: what a simulated network does for the machines, in 200 lines.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/clock/local_clock.hpp"
#include "models/clock/oscillator.hpp"
#include "models/clock/timestamp_unit.hpp"
#include "models/gptp/clock_target.hpp"
#include "models/gptp/codec.hpp"
#include "models/gptp/hot_standby.hpp"
#include "models/gptp/node.hpp"

namespace takt::models::gptp {

using namespace sim::literals;

class Harness {
 public:
  struct NodeSetUp {
    OscillatorConfig oscillator = {};
    TimestampUnit timestamps = {};
    std::vector<InstanceConfig> instances = {InstanceConfig{}};
    LinkDelayConfig link = {};
    ServoConfig servo = {};
    sim::Duration initial_offset = {};
    sim::Duration send_latency = sim::Duration::from_ps(5'000'000);  // from "send" to the wire: turnaround, residence
    std::optional<HotStandbyConfig> standby = {};                    // instances 0 and 1 are primary and secondary
    std::optional<std::int8_t> log_gptp_capable_interval = {};
  };

  struct Station {
    explicit Station(const NodeSetUp& set_up_, const NodeConfig& config, std::uint64_t seed, const std::string& name)
        : set_up(set_up_),
          machine(config),
          oscillator(set_up_.oscillator, seed, name),
          target({.servo = set_up_.servo}),
          chance(seed, name, "timestamps") {
      if (set_up.standby) standby.emplace(*set_up.standby, target_config());
    }
    /// The instance that disciplines the clock.
    ClockTargetConfig target_config() const { return {.servo = set_up.servo}; }
    std::size_t active() const { return standby ? static_cast<std::size_t>(standby->active()) : 0; }
    NodeSetUp set_up;
    Node machine;
    Oscillator oscillator;
    LocalClock free;  // timestamps and timers
    LocalClock disciplined;
    ClockTarget target;
    std::optional<HotStandby> standby;
    sim::RandomStream chance;
    std::map<TimerId, sim::LocalTime> timers;
    std::uint64_t timers_generation = 0;
    std::vector<std::pair<std::size_t, PortNumber>> peers;  // of port n: [n - 1]
    std::vector<sim::Duration> delays;                      // towards the peer
    std::vector<bool> up;
    bool alive = true;
    int samples = 0;
    SyncSample last_sample;
    std::vector<ClockIdentity> grandmasters;
  };

  std::size_t add(const NodeSetUp& set_up) {
    set_ups_.push_back(set_up);
    peers_.emplace_back();
    return set_ups_.size() - 1;
  }
  void connect(std::size_t a, std::size_t b, sim::Duration forth, std::optional<sim::Duration> back = {}) {
    peers_[a].push_back({b, static_cast<PortNumber>(peers_[b].size() + 1), forth});
    peers_[b].push_back({a, static_cast<PortNumber>(peers_[a].size()), back.value_or(forth)});
  }
  static ClockIdentity identity(std::size_t node) {
    return ClockIdentity::from_number(0x0200'00FF'FE00'0000 + node + 1);
  }

  void start(std::uint64_t seed = 1) {
    for (std::size_t i = 0; i < set_ups_.size(); ++i) {
      const NodeConfig config{identity(i), std::vector<LinkDelayConfig>(peers_[i].size(), set_ups_[i].link),
                              set_ups_[i].instances, set_ups_[i].log_gptp_capable_interval};
      stations_.push_back(std::make_unique<Station>(set_ups_[i], config, seed, "node" + std::to_string(i)));
      Station& station = *stations_.back();
      for (const Peer& peer : peers_[i]) {
        station.peers.push_back({peer.node, peer.port});
        station.delays.push_back(peer.delay);
        station.up.push_back(true);
      }
      station.free.set_hardware_rate(now_, station.oscillator.rate());
      station.disciplined.set_hardware_rate(now_, station.oscillator.rate());
      if (set_ups_[i].initial_offset != sim::Duration()) station.disciplined.step(now_, set_ups_[i].initial_offset);
      follow_oscillator(i);
    }
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      const sim::TrueTime at = now_ + 7_us * static_cast<std::int64_t>(i * i + 1);  // nobody starts with the others
      post(at, [this, i] {
        Station& s = station(i);
        disciplined_is_source(i);
        Outputs outputs;
        s.machine.start(local(i), outputs);
        for (PortNumber port = 1; port <= s.peers.size(); ++port) s.machine.link_up(port, local(i), outputs);
        carry_out(i, outputs);
      });
    }
  }

  void run(sim::Duration for_) {
    const sim::TrueTime until = now_ + for_;
    while (!queue_.empty() && queue_.begin()->first.first <= until) {
      auto event = queue_.extract(queue_.begin());
      now_ = event.key().first;
      event.mapped()();
    }
    now_ = until;
  }

  /// Somebody sets the node's clock.
  void step_clock(std::size_t i, sim::Duration by) { station(i).disciplined.step(now_, by); }
  Station& station(std::size_t i) { return *stations_[i]; }
  PtpInstance& instance(std::size_t i, std::size_t domain = 0) { return station(i).machine.instance(domain); }
  std::size_t size() const { return stations_.size(); }
  sim::TrueTime now() const { return now_; }
  /// How far the disciplined clock of `i` is ahead of that of `reference`, now.
  sim::Duration offset(std::size_t i, std::size_t reference) {
    return station(i).disciplined.local_at(now_) - station(reference).disciplined.local_at(now_);
  }

  void kill(std::size_t i) {
    station(i).alive = false;
    for (PortNumber port = 1; port <= station(i).peers.size(); ++port) set_link(i, port, false);
  }
  /// Both ends notice at once.
  void set_link(std::size_t i, PortNumber port, bool up) {
    const auto [peer, peer_port] = station(i).peers[port - 1u];
    for (const auto& [node, number] : {std::pair{i, port}, std::pair{peer, peer_port}}) {
      station(node).up[number - 1u] = up;
      Outputs outputs;
      if (up)
        station(node).machine.link_up(number, local(node), outputs);
      else
        station(node).machine.link_down(number, local(node), outputs);
      carry_out(node, outputs);
    }
  }
  /// A message comes at a port, out of nowhere.
  void receive(std::size_t i, PortNumber port, const Message& message) {
    std::vector<std::byte> octets;
    encode(message, octets);
    arrive(i, port, octets);
  }
  std::function<bool(const Message&)> is_lost = [](const Message&) { return false; };
  std::map<std::size_t, int> sent;  // by length of the message

 private:
  struct Peer {
    std::size_t node;
    PortNumber port;
    sim::Duration delay;
  };
  using Action = std::function<void()>;

  void post(sim::TrueTime at, Action action) { queue_.emplace(std::pair{at, serial_++}, std::move(action)); }
  sim::LocalTime local(std::size_t i) { return station(i).free.local_at(now_); }

  void follow_oscillator(std::size_t i) {
    const sim::TrueTime at = station(i).oscillator.next_change();
    if (at == sim::TrueTime::never()) return;
    post(at, [this, i] {
      Station& s = station(i);
      s.oscillator.advance();
      s.free.set_hardware_rate(now_, s.oscillator.rate());
      s.disciplined.set_hardware_rate(now_, s.oscillator.rate());
      rearm(i);
      follow_oscillator(i);
    });
  }

  /// All timers of a node, in one event for the earliest.
  void rearm(std::size_t i) {
    Station& s = station(i);
    if (s.timers.empty() || !s.alive) return;
    sim::LocalTime first = sim::LocalTime::never();
    for (const auto& [id, at] : s.timers) first = std::min(first, at);
    const std::uint64_t generation = ++s.timers_generation;
    post(std::max(s.free.true_at(first), now_), [this, i, generation] {
      if (station(i).timers_generation == generation) expire(i);
    });
  }
  void expire(std::size_t i) {
    Station& s = station(i);
    Outputs outputs;
    const std::map<TimerId, sim::LocalTime> timers = s.timers;
    for (const auto& [id, at] : timers) {
      if (at > local(i) || s.timers.count(id) == 0 || !s.alive) continue;
      s.timers.erase(id);
      outputs.clear();
      s.machine.timer_expired(id, local(i), outputs);
      carry_out(i, outputs, false);
    }
    rearm(i);
  }

  void carry_out(std::size_t i, const Outputs& outputs, bool rearms = true) {
    Station& s = station(i);
    for (const Output& output : outputs) {
      if (const auto* const send = std::get_if<SendMessage>(&output)) transmit(i, *send);
      if (const auto* const arm = std::get_if<ArmTimer>(&output)) s.timers[arm->timer] = arm->at;
      if (const auto* const cancel = std::get_if<CancelTimer>(&output)) s.timers.erase(cancel->timer);
      if (const auto* const sample = std::get_if<SyncSample>(&output)) discipline(i, *sample);
      if (const auto* const change = std::get_if<GrandmasterChange>(&output)) {
        if (change->instance == 0) s.grandmasters.push_back(change->grandmaster);
        const PtpInstance& changed = s.machine.instance(change->instance);
        if (s.standby)
          s.standby->set_grandmaster(static_cast<HotStandbyRole>(change->instance),
                                     changed.is_grandmaster() && changed.grandmaster_present(), local(i));
        disciplined_is_source(i);
      }
      if (const auto* const lost = std::get_if<SyncLost>(&output)) {
        if (lost->instance == s.active()) s.target.sync_lost();
        if (s.standby) s.standby->sync_lost(static_cast<HotStandbyRole>(lost->instance), local(i));
      }
    }
    if (rearms) rearm(i);
  }

  /// A grandmaster gives the time of its disciplined clock, and so does a boundary clock.
  void disciplined_is_source(std::size_t i) {
    Station& s = station(i);
    const SourceTime source{local(i), sim::PtpTime::from_ps(s.disciplined.local_at(now_).ps()),
                            s.disciplined.rate() / s.free.rate()};
    for (std::size_t each = 0; each < s.machine.instance_count(); ++each)
      if (s.machine.instance(each).gives_own_time()) s.machine.instance(each).set_source_time(source);
  }

  void discipline(std::size_t i, const SyncSample& sample) {
    Station& s = station(i);
    const sim::LocalTime shown = s.disciplined.local_at(s.free.true_at(sample.at));
    if (s.standby) s.standby->sample(static_cast<HotStandbyRole>(sample.instance), sample, shown, local(i));
    if (sample.instance != s.active()) return;
    s.last_sample = sample;
    ++s.samples;
    const ServoAction action = s.target.sample(sample, shown);
    s.disciplined.step_and_adjust(now_, action.step, action.adjustment);
    disciplined_is_source(i);
  }

  void transmit(std::size_t i, const SendMessage& send) {
    Station& s = station(i);
    if (!s.alive || !s.up[send.port - 1u]) return;
    post(now_ + s.set_up.send_latency, [this, i, send] { leave(i, send); });
  }

  void leave(std::size_t i, const SendMessage& send) {
    Station& s = station(i);
    if (!s.alive || !s.up[send.port - 1u]) return;
    const sim::LocalTime egress = s.set_up.timestamps.egress(local(i), s.chance);
    Message message = send.message;
    if (send.one_step) send.one_step->apply(message, egress);
    std::vector<std::byte> octets;
    encode(message, octets);
    ++sent[octets.size()];
    const auto [peer, port] = s.peers[send.port - 1u];
    if (!is_lost(message))
      post(now_ + s.delays[send.port - 1u], [this, octets, peer = peer, port = port] { arrive(peer, port, octets); });
    if (!is_event(message)) return;
    Outputs outputs;
    const Header& header = header_of(message);
    const MessageType type = std::holds_alternative<Sync>(message)        ? MessageType::sync
                             : std::holds_alternative<PdelayReq>(message) ? MessageType::pdelay_req
                                                                          : MessageType::pdelay_resp;
    s.machine.transmitted({send.port, type, header.domain, header.sequence_id, egress}, local(i), outputs);
    carry_out(i, outputs);
  }

  void arrive(std::size_t i, PortNumber port, const std::vector<std::byte>& octets) {
    Station& s = station(i);
    if (!s.alive || !s.up[port - 1u]) return;
    const std::optional<Message> message = decode(octets);
    TAKT_CHECK(message.has_value(), "what was encoded is decoded");
    const sim::LocalTime ingress = s.set_up.timestamps.ingress(local(i), s.chance);
    Outputs outputs;
    s.machine.received(port, *message, ingress, local(i), outputs);
    carry_out(i, outputs);
  }

  std::vector<NodeSetUp> set_ups_;
  std::vector<std::vector<Peer>> peers_;
  std::vector<std::unique_ptr<Station>> stations_;
  std::map<std::pair<sim::TrueTime, std::uint64_t>, Action> queue_;
  std::uint64_t serial_ = 0;
  sim::TrueTime now_;
};

}  // namespace takt::models::gptp
