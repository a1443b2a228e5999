// SPDX-License-Identifier: Apache-2.0
// One of a node's Programs: what the node is in it, and what that asks of the machine: alarms, messages, log,
// statistics.
#pragma once

#include <memory>
#include <vector>

#include "node/application.hpp"
#include "node/clock.hpp"
#include "node/config.hpp"
#include "node/node_security.hpp"
#include "node/node_status.hpp"
#include "node/program_reporter.hpp"
#include "node/socket.hpp"
#include "node/statistics.hpp"
#include "node/transition_log.hpp"
#include "wire/nesting.hpp"
#include "wire/program_node.hpp"

namespace takt::node {

/// CPU time of this thread, in nanoseconds.
std::int64_t thread_cpu_ns();

/// The node's loop drives it: gives it what has come, and wakes it by `next_time`.
class HostedProgram {
 public:
  /// What it shares with the node's other Programs; all outlive it.
  struct Node {
    const Config& config;
    Socket& socket;
    const Clock& clock;
    std::uint32_t incarnation = 0;
    Duration lead;                     ///< 0: no launch times
    NodeSecurity* security = nullptr;  ///< if its messages are secured
    HandOver* hand_over = nullptr;     ///< to the node's server, if it has one
  };
  /// `number` among the node's Programs. `application` may be null; it outlives this.
  HostedProgram(const LoadedProgram& loaded, const Node& node, std::size_t number, TransitionLog log,
                Application* application);

  /// Joins two Programs of a node, where one is nested in the other. Both outlive what is returned, which outlives
  /// their use.
  static std::unique_ptr<wire::Nesting> nest(HostedProgram& outer, HostedProgram& inner);

  void start();
  program::StatusCode call(program::Method method);
  /// BadInvalidState where the node offers no skills.
  program::StatusCode change(Membership what);
  void finished() { carry_out(part_.finished(now())); }
  /// A message of any Program has come.
  wire::Verdict receive(uadp::Octets message) {
    wire::NodeOutputs& outputs = part_.receive(now(), message);
    const wire::Verdict verdict = outputs.verdict;
    carry_out(outputs);
    return verdict;
  }

  /// When it has to be woken next.
  sim::LocalTime next_time() const;
  /// Publishes if the instant of its cycle has come.
  void wake_cycle(sim::LocalTime now);
  /// Its other alarms that have come due. What they set anew waits for the next turn of the loop.
  void wake_others(sim::LocalTime now);

  bool knows(uadp::Octets message) const {
    return loaded_.endpoint.format->decode(message) || (loaded_.roles && loaded_.roles->format->decode(message));
  }
  const std::string& name() const { return loaded_.program.name; }
  handshake::PublishedState state() const { return part_.state(); }
  bool is_candidate() const { return part_.candidate() != nullptr; }
  ProgramStatus status(sim::LocalTime now, std::uint64_t send_failures) const {
    return {&loaded_.program, &part_, &cycles_, &peers_, now, send_failures};
  }

 private:
  /// In order. What an application does in between comes behind it.
  void carry_out(wire::NodeOutputs& outputs);
  void act(const wire::SetAlarm& alarm) { alarms_[alarm.alarm] = alarm.time; }
  void act(const wire::Publish& message);
  void act(const wire::Stepped& step);
  void act(const wire::Heard& heard);
  void act(const wire::ProcessDataMessage& message);
  void act(const wire::RoleBound& bound);
  void act(const wire::RoleTaken& taken);
  void act(const wire::RoleDropped& dropped);

  sim::LocalTime now() const { return node_.clock.now(); }
  std::int64_t now_ns() const { return node_.clock.nanoseconds_at(now()); }
  /// When the alarm wakes the loop.
  sim::LocalTime due(std::size_t alarm) const;

  LoadedProgram loaded_;
  Node node_;
  TransitionLog log_;
  Application* application_;
  wire::ProgramNode part_;  ///< in the Program
  handshake::Side side_ = handshake::Side::outer;
  HostedProgram* other_ = nullptr;  ///< nested with this one
  bool carries_out_ = false;
  std::vector<sim::LocalTime> alarms_;  ///< never(): not set
  CycleStatistics cycles_;
  std::int64_t cpu_at_last_cycle_ns_ = 0;
  PeerWatch peers_;
  ProgramReporter reporter_;
};

}  // namespace takt::node
