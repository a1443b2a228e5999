// SPDX-License-Identifier: Apache-2.0
// A participant of one or several Programs on this machine: hosted programs behind a socket, a clock and a loop.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/application.hpp"
#include "node/clock.hpp"
#include "node/config.hpp"
#include "node/control_socket.hpp"
#include "node/following_socket.hpp"
#include "node/hosted_program.hpp"
#include "node/log.hpp"
#include "node/node_security.hpp"
#include "node/node_status.hpp"
#include "node/socket.hpp"
#include "node/sources.hpp"
#include "node/transition_log.hpp"

namespace takt::node {

class RealNode {
 public:
  /// Null, and `problem` says why, if the machine does not give what the file asks for. What it can do without is a
  /// line of `warnings`. `applications` by Program of the file that this node is in; where there is none, or null,
  /// process data are zeros. They, `log`, `hand_over`, which is null without a server, and `keys`, by which those of a
  /// key service come, outlive the node.
  static std::unique_ptr<RealNode> make(const LoadedConfig& loaded, Log& log,
                                        const std::vector<Application*>& applications, std::string& problem,
                                        std::string& warnings, HandOver* hand_over = nullptr,
                                        KeyMailbox* keys = nullptr);

  /// Runs until the file's duration is over or `stop_requested` says so, which is asked after every wake-up.
  void run(bool (*stop_requested)(const void* context), const void* context);

  /// For applications, within a call of theirs by the loop or before `run`: method calls, and the end of the local
  /// process. `program` counts those of the file that this node is in.
  program::StatusCode call(program::Method method, std::size_t program = 0) { return programs_[program]->call(method); }
  void finished(std::size_t program = 0) { programs_[program]->finished(); }
  /// A node that offers its skills joins or leaves.
  program::StatusCode change(Membership what, std::size_t program = 0) { return programs_[program]->change(what); }

  handshake::PublishedState state(std::size_t program = 0) const { return programs_[program]->state(); }
  /// State, peers and statistics as JSON.
  std::string status() const { return to_json(status_now()); }

 private:
  RealNode(const LoadedConfig& loaded, std::unique_ptr<FollowingSocket> socket, Log& log);
  void read_calls();
  void host(const LoadedConfig& loaded, Log& log, const std::vector<Application*>& applications, Duration lead);

  /// Of one of its Programs, or of all.
  NodeStatus status_now(std::optional<std::size_t> only = {}) const;
  sim::LocalTime next_time() const;
  void wake_due(sim::LocalTime now);
  void act(const LoadedCall& call);
  void read_received();
  wire::Verdict take(uadp::Octets message);
  void read_requests();
  /// Once a second: what no message brings.
  void look_around();
  std::string answer_to(std::string_view request);
  std::string answer_to_membership(Membership what, std::string_view of);
  std::string answer_of(const HostedProgram& hosted, std::string_view method, program::StatusCode status) const;
  /// The Program that a request is for; nothing, and `problem` says why, if that cannot be told.
  std::optional<std::size_t> program_for(std::string_view name, std::string& problem) const;

  Config config_;
  std::vector<LoadedCall> script_;        ///< in the order of time
  std::optional<std::size_t> outermost_;  ///< what a request is for that names no Program
  std::unique_ptr<FollowingSocket> socket_;
  std::unique_ptr<ControlSocket> control_;  ///< null: none is wanted
  HandOver* hand_over_ = nullptr;           ///< null: no server
  Clock clock_;
  AbsoluteTimer timer_;
  Log& out_;
  TransitionLog log_;
  std::optional<ServerState> server_;  ///< what it said of itself last
  SourceTable sources_;
  std::vector<SourceTable::Twins> told_twins_;
  sim::LocalTime looked_around_;
  std::unique_ptr<NodeSecurity> security_;
  std::uint32_t incarnation_;
  std::vector<std::unique_ptr<HostedProgram>> programs_;
  std::vector<std::unique_ptr<wire::Nesting>> nestings_;
  sim::LocalTime started_;
  std::size_t next_call_ = 0;  ///< in the script
};

/// Asks the kernel for SCHED_FIFO and locked memory. An empty text, or what it did not permit.
std::string ask_for_real_time();

}  // namespace takt::node
