// A participant of a Program on this machine: a wire::ProgramEndpoint behind a socket, a clock and a loop.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "node/clock.hpp"
#include "node/config.hpp"
#include "node/socket.hpp"
#include "node/transition_log.hpp"

namespace takt::node {

class RealNode final : private wire::EndpointHost {
 public:
  /// Null, and `problem` says why, if the machine does not give what the file asks for.
  static std::unique_ptr<RealNode> make(const LoadedConfig& loaded, std::FILE* log, std::string& problem);

  /// Runs until the file's duration is over or `stop_requested` says so, which is asked after every wake-up.
  void run(bool (*stop_requested)(const void* context), const void* context);

  handshake::PublishedState state() const { return endpoint_.participant().state(); }

 private:
  RealNode(const LoadedConfig& loaded, std::unique_ptr<Socket> socket, std::FILE* log, std::uint32_t incarnation);

  sim::LocalTime now() const override { return clock_.now(); }
  void set_alarm(std::size_t alarm, sim::LocalTime time) override { alarms_[alarm] = time; }
  void publish(uadp::Octets network_message, const pubsub::Destination& destination) override { socket_->publish(network_message, destination); }
  void stepped(const handshake::Outputs& outputs, const handshake::Word& after) override;
  void process_data(const wire::ProcessDataMessage&) override {}

  sim::LocalTime next_time() const;
  void wake_due(sim::LocalTime now);
  void take_received();

  Config config_;
  std::unique_ptr<Socket> socket_;
  Clock clock_;
  AbsoluteTimer timer_;
  TransitionLog log_;
  wire::ProgramEndpoint endpoint_;
  std::uint32_t incarnation_;
  std::vector<sim::LocalTime> alarms_;  ///< never(): not set
  sim::LocalTime started_;
  std::size_t next_call_ = 0;           ///< in the script, which is in the order of time
  TransitionLog::Wakening wakening_;
};

/// Asks the kernel for SCHED_FIFO and locked memory. An empty text, or what it did not permit.
std::string ask_for_real_time();

}  // namespace takt::node
