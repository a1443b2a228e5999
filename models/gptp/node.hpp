// All of gPTP in one node: the delay mechanism of each port and the PTP instances (domains) that share it.
#pragma once

#include <vector>

#include "models/gptp/link_delay.hpp"
#include "models/gptp/ptp_instance.hpp"

namespace takt::models::gptp {

struct NodeConfig {
  ClockIdentity identity = {};
  std::vector<LinkDelayConfig> ports = {};          // port n is ports[n - 1]
  std::vector<InstanceConfig> instances = {};       // distinct domains; the clock identity is filled in
};

/// Sends every input to the machine that it belongs to. The host keeps the timers that are asked for, on the free-running
/// clock, sends messages, and reports the egress of event messages. All calls append to `outputs`.
class Node {
 public:
  explicit Node(const NodeConfig& config);

  void start(sim::LocalTime now, Outputs& outputs);
  void link_up(PortNumber port, sim::LocalTime now, Outputs& outputs);
  void link_down(PortNumber port, sim::LocalTime now, Outputs& outputs);
  /// `ingress`: the timestamp of an event message; of no meaning for others.
  void received(PortNumber port, const Message& message, sim::LocalTime ingress, sim::LocalTime now, Outputs& outputs);
  void transmitted(const EgressReport& report, sim::LocalTime now, Outputs& outputs);
  void timer_expired(const TimerId& timer, sim::LocalTime now, Outputs& outputs);

  PtpInstance& instance(std::size_t index) { return instances_.at(index); }
  const PtpInstance& instance(std::size_t index) const { return instances_.at(index); }
  std::size_t instance_count() const { return instances_.size(); }
  const LinkDelay& link(PortNumber port) const;

 private:
  LinkDelay& mutable_link(PortNumber port);
  PtpInstance* instance_of(std::uint8_t domain);
  LinkMeasure measure(PortNumber port, sim::LocalTime at) const;
  void follow_capability(PortNumber port, sim::LocalTime now, Outputs& outputs);

  std::vector<LinkDelay> links_;
  std::vector<PtpInstance> instances_;
};

}  // namespace takt::models::gptp
