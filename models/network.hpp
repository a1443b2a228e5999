// A live network: nodes, ports, talkers and processes, built from a plan on top of one simulation.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "models/bridge/bridge.hpp"
#include "models/host/host.hpp"
#include "models/host/process.hpp"
#include "models/host/talker.hpp"
#include "models/plan.hpp"

namespace takt::models {

class Network {
 public:
  /// The plan is taken by value: latencies and port configurations stay alive with the network.
  Network(sim::Simulation& simulation, NetworkPlan plan);
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Puts an application on a host; `name` is unique on that host. The reference stays valid.
  Process& add_process(NodeIndex host, std::string_view name, std::unique_ptr<Application> application);
  /// The process, if any, that gets the octets of the stream at that listener. Listeners of the plan get none by default.
  void listen(NodeIndex host, StreamIndex stream, Process* process);

  /// Schedules the first events of talkers and starts the processes. Call once, at time zero.
  void start();

  /// Management sets ConfigChange at a port, at the present instant.
  ConfigChange request_gates(NodeIndex node, std::uint16_t port, const GateConfig& gates);

  sim::Simulation& simulation() { return *simulation_; }
  Traffic& traffic() { return traffic_; }
  const Traffic& traffic() const { return traffic_; }
  const NetworkPlan& plan() const { return plan_; }

  /// The ports of a node, by port number.
  std::span<const EgressPort> ports(NodeIndex node) const {
    return {ports_.get() + first_port_[node.value], first_port_[node.value + 1] - first_port_[node.value]};
  }
  const Bridge& bridge(NodeIndex node) const { return *bridges_[node.value]; }

 private:
  std::span<EgressPort> mutable_ports(NodeIndex node) {
    return {ports_.get() + first_port_[node.value], first_port_[node.value + 1] - first_port_[node.value]};
  }
  void number_ports();
  void make_nodes();
  void connect(const LinkPlan::End& from, const LinkPlan::End& to, const LinkPlan& link);
  const PortConfig& port_config_of(const LinkPlan::End& end) const;
  sim::Duration fixed_delay_of(NodeIndex node) const;
  sim::ComponentId component_of(NodeIndex node) const;
  EgressPort& port_of_host(NodeIndex host);

  sim::Simulation* simulation_;
  NetworkPlan plan_;
  Traffic traffic_;
  EgressPort::Shared shared_;
  LocalClock ideal_clock_;
  std::vector<std::size_t> first_port_;               // ports of node n: first_port_[n] .. first_port_[n + 1]
  std::unique_ptr<EgressPort[]> ports_;
  std::vector<std::unique_ptr<Host>> hosts_;          // by node; null for bridges
  std::vector<std::unique_ptr<Bridge>> bridges_;      // by node; null for hosts
  std::vector<std::unique_ptr<Talker>> talkers_;
  std::vector<std::unique_ptr<Process>> processes_;
};

}  // namespace takt::models
