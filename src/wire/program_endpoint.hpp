// One participant of a Program on a network: the handshake with its cycle, its time-outs and its messages, sans-IO.
//
// The simulated host and the real node own one each and differ only in the EndpointHost that they put behind it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "handshake/participant.hpp"
#include "pubsub/stack.hpp"
#include "sim/time.hpp"
#include "uadp/sequence_number.hpp"
#include "wire/program_format.hpp"

namespace takt::wire {

class Nesting;

/// What an endpoint asks of the machine it is on, and tells it. A message goes to the Destination with its WriterGroupId.
class EndpointHost : public pubsub::PublishedData {
 public:
  /// By the clock that all participants share.
  virtual sim::LocalTime now() const = 0;
  /// Calls ProgramEndpoint::wake at that time; replaces the alarm's earlier setting.
  virtual void set_alarm(std::size_t alarm, sim::LocalTime time) = 0;
  /// The participant has taken a step and this is its word now.
  virtual void stepped(const handshake::Outputs& outputs, const handshake::Word& after) = 0;
  /// Process data has come that the application may use.
  virtual void process_data(const ProcessDataMessage& message) = 0;
  /// A state of a peer has been taken.
  virtual void heard(std::size_t peer, const handshake::Word& word) { static_cast<void>(peer), static_cast<void>(word); }
  /// Puts the user's fields of an own data set, all zeros so far.
  virtual void fill(std::uint8_t data_set, std::span<std::byte> fields) { static_cast<void>(data_set), static_cast<void>(fields); }
  /// `paper` has no run; what goes with its process data instead. No participant reads it.
  virtual std::uint32_t run_of_paper() const { return 0; }
};

struct EndpointSettings {
  handshake::Config handshake;
  std::shared_ptr<const ProgramFormat> format;
  sim::Duration cycle;            ///< above 0
  sim::Duration offset;           ///< into the cycle, which begins at multiples of `cycle`
  sim::Duration receive_timeout;  ///< MessageReceiveTimeout
  sim::Duration initialisation;   ///< how long INIT takes
  std::vector<bool> on_demand;    ///< by data set: published by `publish_data` only; empty: all every cycle
  bool publish_on_change = false;
  std::uint8_t priority = 0;      ///< of its messages
};

/// What became of the messages that came.
struct EndpointCounts {
  std::uint64_t taken = 0;      ///< states that were stepped with, process data that the application got
  std::uint64_t foreign = 0;    ///< no message of this Program
  std::uint64_t unsubscribed = 0;  ///< of this Program, but of nobody whom this participant hears
  std::uint64_t stale = 0;      ///< repeated or overtaken
  std::uint64_t not_running = 0;  ///< process data while not both were Running in one run
};

/// What comes from one writer: which number was last.
struct Arrivals {
  uadp::SequenceWindow window;
  std::uint32_t life = 0;  ///< of the sender
  sim::LocalTime last;

  /// False for a repeated or overtaken message. After a silence of the time-out, and with another life of the sender, any number is
  /// the first.
  bool take(std::uint16_t sequence, std::uint32_t of_life, sim::LocalTime now, sim::Duration timeout);
};

class ProgramEndpoint {
 public:
  explicit ProgramEndpoint(EndpointSettings settings);

  /// From now on it publishes, at the next instant of its cycle.
  void start(EndpointHost& host);
  /// It loses its memory, as in a crash, and is another incarnation. Publishes again after `start`.
  void forget(std::uint32_t incarnation);

  /// Its node is in another group, too (nesting.hpp).
  void join(Nesting* nesting) { nesting_ = nesting; }

  /// From now on only words of this incarnation are taken from the peer, or none. What was heard before is forgotten.
  void expect(std::size_t peer, std::optional<std::uint32_t> incarnation);
  /// The same for all peers: none.
  void expect_nobody();

  /// A method call by a client or the user of this node; what came of it.
  program::StatusCode call(EndpointHost& host, program::Method method);
  /// The local process has ended by itself.
  void finished(EndpointHost& host) { step(host, handshake::Input::finished()); }
  /// Publishes an own data set now, if the participant is Running. False if it is not.
  bool publish_data(EndpointHost& host, std::uint8_t data_set);
  /// Of the message of an own data set that was published last.
  std::uint16_t last_data_sequence(std::size_t data_set) const { return static_cast<std::uint16_t>(data_sequence_[data_set] - 1); }
  /// A NetworkMessage has come; of whom and whether it is sound is found out here.
  void receive(EndpointHost& host, uadp::Octets network_message);
  /// An alarm has come due.
  void wake(EndpointHost& host, std::size_t alarm);

  /// The alarm at which it publishes.
  static constexpr std::size_t cycle_alarm = 0;
  /// The peer whose MessageReceiveTimeout an alarm is.
  std::optional<std::size_t> peer_of_alarm(std::size_t alarm) const {
    return alarm < first_peer_alarm ? std::nullopt : std::optional(alarm - first_peer_alarm);
  }

  static constexpr std::size_t alarm_count(std::size_t peers) { return first_peer_alarm + peers; }
  std::size_t alarm_count() const { return alarm_count(participant_.peer_count()); }

  const EndpointSettings& settings() const { return settings_; }
  const handshake::Participant<64>& participant() const { return participant_; }
  const EndpointCounts& counts() const { return counts_; }
  /// Cycles in which nothing was published because the alarm came too late.
  std::uint64_t missed_cycles() const { return missed_cycles_; }

 private:
  friend class Nesting;     // takes steps here that follow from the other group
  friend class PlugMaster;  // and from bindings of roles
  static constexpr std::size_t initialised_alarm = 1;
  static constexpr std::size_t first_peer_alarm = 2;  // one for each peer: its MessageReceiveTimeout

  handshake::Outputs step(EndpointHost& host, const handshake::Input& input);
  void receive_state(EndpointHost& host, std::size_t peer, const StateMessage& message);
  void receive_data(EndpointHost& host, std::size_t peer, const ProcessDataMessage& message);
  bool is_new(Arrivals& arrivals, std::uint16_t sequence, std::uint32_t life, sim::LocalTime now);
  void publish_state(EndpointHost& host);
  void publish_process_data(EndpointHost& host);
  void cycle(EndpointHost& host);
  void set_cycle_alarm(EndpointHost& host);

  EndpointSettings settings_;
  handshake::Participant<64> participant_;
  std::vector<Arrivals> states_;              ///< by peer; their lives are incarnations, those of process data runs
  std::vector<std::optional<std::uint32_t>> expected_;  ///< by peer: its only incarnation; empty: any
  std::vector<Arrivals> data_;                ///< by data set
  std::vector<std::uint16_t> data_sequence_;  ///< by data set, of the own ones
  std::uint16_t state_sequence_ = 0;
  std::uint32_t initialisation_run_ = 0;
  std::int64_t next_cycle_ = 0;
  std::uint64_t missed_cycles_ = 0;
  EndpointCounts counts_;
  Nesting* nesting_ = nullptr;
  std::array<std::byte, 1500> buffer_;
};

}  // namespace takt::wire
