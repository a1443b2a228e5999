// SPDX-License-Identifier: Apache-2.0
// One participant of a Program on a network: the handshake with its cycle, its time-outs and its messages, sans-IO. A
// part of ProgramNode.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "handshake/participant.hpp"
#include "sim/time.hpp"
#include "uadp/sequence_number.hpp"
#include "wire/node_outputs.hpp"
#include "wire/program_format.hpp"

namespace takt::wire {

class Nesting;

struct EndpointSettings {
  handshake::Config handshake;
  std::shared_ptr<const ProgramFormat> format;
  sim::Duration cycle;            ///< above 0
  sim::Duration offset;           ///< into the cycle, which begins at multiples of `cycle`
  sim::Duration receive_timeout;  ///< MessageReceiveTimeout
  sim::Duration initialisation;   ///< how long INIT takes
  std::vector<bool> on_demand;    ///< by data set: published by `publish_data` only; empty: all every cycle
  bool publish_on_change = false;
  std::uint8_t priority = 0;  ///< of its messages
};

/// What became of the messages that came.
struct EndpointCounts {
  std::uint64_t taken = 0;         ///< states that were stepped with, process data that the application got
  std::uint64_t foreign = 0;       ///< no message of this Program
  std::uint64_t unsubscribed = 0;  ///< of this Program, but of nobody whom this participant hears
  std::uint64_t stale = 0;         ///< repeated or overtaken
  std::uint64_t not_running = 0;   ///< process data while not both were Running in one run
};

/// What comes from one writer: which number was last.
struct Arrivals {
  uadp::SequenceWindow window;
  std::uint32_t life = 0;  ///< of the sender
  sim::LocalTime last;

  /// False for a repeated or overtaken message. After a silence of the time-out, and with another life of the sender,
  /// any number is the first.
  bool take(std::uint16_t sequence, std::uint32_t of_life, sim::LocalTime now, sim::Duration timeout);
};

/// What it does comes out of its turns.
class ProgramEndpoint {
 public:
  explicit ProgramEndpoint(EndpointSettings settings);

  /// From now on it publishes, at the next instant of its cycle.
  void start(const Turn& turn);
  /// It loses its memory, as in a crash, and is another incarnation. Publishes again after `start`.
  void forget(std::uint32_t incarnation);

  /// Its node is in another group, too (nesting.hpp); it is on this side.
  void join(Nesting& nesting, handshake::Side side) { nesting_ = &nesting, side_ = side; }

  /// From now on only words of this incarnation are taken from the peer, or none. What was heard before is forgotten.
  void expect(std::size_t peer, std::optional<std::uint32_t> incarnation);
  /// The same for all peers: none.
  void expect_nobody();

  /// Takes one step of the handshake.
  handshake::Outputs step(const Turn& turn, const handshake::Input& input);
  /// Publishes an own data set now, if the participant is Running. False if it is not.
  bool publish_data(const Turn& turn, std::uint8_t data_set);
  /// A NetworkMessage has come; of whom and whether it is sound is found out here.
  Verdict receive(const Turn& turn, uadp::Octets network_message);
  /// An alarm has come due.
  void wake(const Turn& turn, std::size_t alarm);

  /// The alarm at which it publishes.
  static constexpr std::size_t cycle_alarm = 0;
  /// The peer whose MessageReceiveTimeout an alarm is.
  std::optional<std::size_t> peer_of_alarm(std::size_t alarm) const {
    return alarm < first_peer_alarm || alarm >= alarm_count(participant_.peer_count())
               ? std::nullopt
               : std::optional(alarm - first_peer_alarm);
  }
  static constexpr std::size_t alarm_count(std::size_t peers) { return first_peer_alarm + peers; }

  const EndpointSettings& settings() const { return settings_; }
  const handshake::Participant<64>& participant() const { return participant_; }
  const EndpointCounts& counts() const { return counts_; }
  /// Cycles in which nothing was published because the alarm came too late.
  std::uint64_t missed_cycles() const { return missed_cycles_; }

 private:
  static constexpr std::size_t initialised_alarm = 1;
  static constexpr std::size_t first_peer_alarm = 2;  // one for each peer: its MessageReceiveTimeout

  Verdict receive_state(const Turn& turn, std::size_t peer, const StateMessage& message);
  Verdict receive_data(const Turn& turn, std::size_t peer, const ProcessDataMessage& message);
  void find_peers();
  void follow(const Turn& turn, const handshake::Outputs& outputs);
  bool is_new(Arrivals& arrivals, std::uint16_t sequence, std::uint32_t life, sim::LocalTime now);
  void publish_state(const Turn& turn);
  void publish_process_data(const Turn& turn);
  void cycle(const Turn& turn);
  void set_cycle_alarm(const Turn& turn);

  EndpointSettings settings_;
  handshake::Participant<64> participant_;
  static constexpr std::uint8_t nobody = 0xFF;
  std::vector<std::uint8_t> peer_from_;  ///< by participant: the peer that it is here, if it is heard; else nobody
  std::vector<std::uint8_t> cyclic_;     ///< the own data sets that are published every cycle
  std::vector<Arrivals> states_;         ///< by peer; their lives are incarnations, those of process data runs
  std::vector<KnownState> known_;        ///< by peer: its last message that was sound
  std::vector<std::optional<std::uint32_t>> expected_;  ///< by peer: its only incarnation; empty: any
  std::vector<Arrivals> data_;                          ///< by data set
  std::vector<std::uint16_t> data_sequence_;            ///< by data set, of the own ones
  std::uint16_t state_sequence_ = 0;
  std::uint32_t initialisation_run_ = 0;
  std::int64_t next_cycle_ = 0;
  std::uint64_t missed_cycles_ = 0;
  EndpointCounts counts_;
  Nesting* nesting_ = nullptr;
  handshake::Side side_ = handshake::Side::outer;
};

}  // namespace takt::wire
