// SPDX-License-Identifier: Apache-2.0
// All of gPTP in one node: the delay mechanism of each port and the PTP instances (domains) that share it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/gptp/capability.hpp"
#include "models/gptp/link_delay.hpp"
#include "models/gptp/ptp_instance.hpp"

namespace takt::models::gptp {

struct NodeConfig {
  ClockIdentity identity = {};
  std::vector<LinkDelayConfig> ports = {};     // port n is ports[n - 1]
  std::vector<InstanceConfig> instances = {};  // distinct domains; the clock identity is filled in
  std::optional<std::int8_t> log_gptp_capable_interval =
      {};  // of Signaling with the gPTP-capable TLV; none is sent or asked for if absent
};

/// Sends every input to the machine that it belongs to. The host keeps the timers that are asked for, on the
/// free-running clock, sends messages, and reports the egress of event messages. All calls append to `outputs`.
class Node {
 public:
  explicit Node(const NodeConfig& config);

  void start(sim::LocalTime now, Outputs& outputs);
  void link_up(PortNumber port, sim::LocalTime now, Outputs& outputs);
  void link_down(PortNumber port, sim::LocalTime now, Outputs& outputs);
  /// `ingress`: the timestamp of an event message; of no meaning for others.
  void received(PortNumber port, const Message& message, sim::LocalTime ingress, sim::LocalTime now, Outputs& outputs);
  void transmitted(const EgressReport& report, sim::LocalTime now, Outputs& outputs);
  /// Asks the neighbour at that port for other intervals: Signaling with the message-interval request TLV, once. Only
  /// if the link is up.
  void ask_for_intervals(std::size_t instance, PortNumber port, const IntervalRequest& request, Outputs& outputs);
  void timer_expired(const TimerId& timer, sim::LocalTime now, Outputs& outputs);

  PtpInstance& instance(std::size_t index) { return instances_.at(index); }
  const PtpInstance& instance(std::size_t index) const { return instances_.at(index); }
  std::size_t instance_count() const { return instances_.size(); }
  const LinkDelay& link(PortNumber port) const;
  /// asCapable (11.2.2): the link is measured and short, and the neighbour has said that it is capable in the domain.
  bool is_capable(std::size_t instance, PortNumber port) const { return obstacle(instance, port) == NotCapable::none; }
  /// What keeps the port from it.
  NotCapable obstacle(std::size_t instance, PortNumber port) const;

 private:
  LinkDelay& mutable_link(PortNumber port);
  PtpInstance* instance_of(std::uint8_t domain);
  Capability& capability(std::size_t instance, PortNumber port);
  void take(const Signaling& signaling, std::size_t instance, PortNumber port, sim::LocalTime now, Outputs& outputs);
  LinkMeasure measure(PortNumber port, sim::LocalTime at) const;
  void follow_capability(PortNumber port, sim::LocalTime now, Outputs& outputs);

  std::vector<LinkDelay> links_;
  std::vector<PtpInstance> instances_;
  std::vector<Capability> capabilities_;  // by instance, then port
};

}  // namespace takt::models::gptp
