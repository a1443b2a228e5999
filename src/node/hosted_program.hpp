// One of a node's Programs: what the node is in it, and what that asks of the machine: alarms, messages, log, statistics.
#pragma once

#include <memory>
#include <vector>

#include "node/application.hpp"
#include "node/clock.hpp"
#include "node/config.hpp"
#include "node/group_member.hpp"
#include "node/node_status.hpp"
#include "node/socket.hpp"
#include "node/statistics.hpp"
#include "node/transition_log.hpp"
#include "wire/nesting.hpp"

namespace takt::node {

/// CPU time of this thread, in nanoseconds.
std::int64_t thread_cpu_ns();

/// The node's loop drives it: gives it what has come, and wakes it by `next_time`.
class HostedProgram final : private wire::PlugHost {
 public:
  /// What it shares with the node's other Programs; all outlive it.
  struct Node {
    const Config& config;
    Socket& socket;
    const Clock& clock;
    std::uint32_t incarnation = 0;
    Duration lead;  ///< 0: no launch times
  };
  /// `application` may be null; it outlives this.
  HostedProgram(const LoadedProgram& loaded, const Node& node, TransitionLog log, Application* application);

  /// Joins two Programs of a node, where one is nested in the other. Both outlive what is returned, which outlives their use.
  static std::unique_ptr<wire::Nesting> nest(HostedProgram& outer, HostedProgram& inner);

  void start();
  program::StatusCode call(program::Method method);
  /// BadInvalidState where the node offers no skills.
  program::StatusCode plug(Plug what);
  void finished() { member_.finished(*this); }
  /// A message of any Program has come.
  void receive(uadp::Octets message) { member_.receive(*this, message); }

  /// When it has to be woken next.
  sim::LocalTime next_time() const;
  /// Publishes if the instant of its cycle has come.
  void wake_cycle(sim::LocalTime now);
  /// Its other alarms that have come due. What they set anew waits for the next turn of the loop.
  void wake_others(sim::LocalTime now);

  bool knows(uadp::Octets message) const { return format_->decode(message) || (plug_format_ && plug_format_->decode(message)); }
  const std::string& name() const { return program_.name; }
  handshake::PublishedState state() const { return member_.state(); }
  bool is_candidate() const { return member_.candidate() != nullptr; }
  ProgramStatus status() const { return {program_, member_, cycles_, peers_}; }

 private:
  sim::LocalTime now() const override { return node_.clock.now(); }
  void set_alarm(std::size_t alarm, sim::LocalTime time) override { alarms_[alarm] = time; }
  void publish(uadp::Octets network_message, const pubsub::Destination& destination) override;
  void stepped(const handshake::Outputs& outputs, const handshake::Word& after) override;
  void heard(std::size_t peer, const handshake::Word& word) override { peers_.heard(peer, word, now()); }
  void process_data(const wire::ProcessDataMessage& message) override;
  void fill(std::uint8_t data_set, std::span<std::byte> fields) override;
  void role_bound(std::size_t role, const handshake::Binding& binding) override;
  void role_taken(std::size_t role, const handshake::Binding& self) override;
  void role_dropped(std::size_t role, const handshake::Binding& self) override;

  std::int64_t now_ns() const { return node_.clock.nanoseconds_at(now()); }
  /// When the alarm wakes the loop.
  sim::LocalTime due(std::size_t alarm) const;

  Program program_;
  Node node_;
  TransitionLog log_;
  Application* application_;
  std::shared_ptr<const wire::ProgramFormat> format_;
  std::shared_ptr<const wire::PlugFormat> plug_format_;  ///< null without roles
  GroupMember member_;
  std::vector<sim::LocalTime> alarms_;  ///< never(): not set
  CycleStatistics cycles_;
  std::int64_t cpu_at_last_cycle_ns_ = 0;
  PeerWatch peers_;
};

}  // namespace takt::node
