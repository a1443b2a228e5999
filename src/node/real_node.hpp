// A participant of a Program on this machine: a wire::ProgramEndpoint behind a socket, a clock and a loop.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "node/application.hpp"
#include "node/clock.hpp"
#include "node/config.hpp"
#include "node/control_socket.hpp"
#include "node/node_status.hpp"
#include "node/socket.hpp"
#include "node/statistics.hpp"
#include "node/transition_log.hpp"

namespace takt::node {

class RealNode final : private wire::EndpointHost {
 public:
  /// Null, and `problem` says why, if the machine does not give what the file asks for. What it can do without is a line of
  /// `warnings`. `log` outlives the node, and so does `application`, which may be null: then process data are zeros.
  static std::unique_ptr<RealNode> make(const LoadedConfig& loaded, std::FILE* log, Application* application, std::string& problem, std::string& warnings);

  /// Runs until the file's duration is over or `stop_requested` says so, which is asked after every wake-up.
  void run(bool (*stop_requested)(const void* context), const void* context);

  /// For applications, within a call of theirs by the loop or before `run`: method calls, and the end of the local process.
  program::StatusCode call(program::Method method);
  void finished() { endpoint_.finished(*this); }

  handshake::PublishedState state() const { return endpoint_.participant().state(); }
  /// State, peers and statistics as JSON.
  std::string status() const { return to_json(status_now()); }

 private:
  RealNode(const LoadedConfig& loaded, std::unique_ptr<Socket> socket, std::FILE* log, Application* application, std::uint32_t incarnation);

  sim::LocalTime now() const override { return clock_.now(); }
  void set_alarm(std::size_t alarm, sim::LocalTime time) override { alarms_[alarm] = time; }
  void publish(uadp::Octets network_message, const pubsub::Destination& destination) override;
  void stepped(const handshake::Outputs& outputs, const handshake::Word& after) override;
  void heard(std::size_t peer, const handshake::Word& word) override { peers_.heard(peer, word, now()); }
  void process_data(const wire::ProcessDataMessage& message) override;
  void fill(std::uint8_t data_set, std::span<std::byte> fields) override;

  NodeStatus status_now() const;
  /// When the alarm wakes the loop.
  sim::LocalTime due(std::size_t alarm) const;
  sim::LocalTime next_time() const;
  void wake_due(sim::LocalTime now);
  void wake_cycle(sim::LocalTime now);
  void take_received();
  void take_requests();
  std::string answer_to(std::string_view request);

  Config config_;
  std::unique_ptr<Socket> socket_;
  std::unique_ptr<ControlSocket> control_;  ///< null: none is wanted
  Application* application_;
  Clock clock_;
  AbsoluteTimer timer_;
  TransitionLog log_;
  wire::ProgramEndpoint endpoint_;
  std::uint32_t incarnation_;
  Duration lead_;                       ///< 0: no launch times
  std::vector<sim::LocalTime> alarms_;  ///< never(): not set
  sim::LocalTime started_;
  std::size_t next_call_ = 0;           ///< in the script, which is in the order of time
  CycleStatistics cycles_;
  std::int64_t cpu_at_last_cycle_ns_ = 0;
  PeerWatch peers_;
};

/// Asks the kernel for SCHED_FIFO and locked memory. An empty text, or what it did not permit.
std::string ask_for_real_time();

}  // namespace takt::node
