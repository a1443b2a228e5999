// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/node.hpp"

#include "sim/check.hpp"

namespace takt::models::gptp {

Node::Node(const NodeConfig& config) {
  TAKT_CHECK(!config.ports.empty() && config.ports.size() < 0xFFFF, "ports from 1 to 65534");
  const auto ports = static_cast<PortNumber>(config.ports.size());
  for (PortNumber port = 1; port <= ports; ++port)
    links_.emplace_back(config.ports[port - 1u], PortIdentity{config.identity, port});
  for (const InstanceConfig& each : config.instances) {
    TAKT_CHECK(instance_of(each.domain) == nullptr, "a domain once in a node");
    InstanceConfig instance = each;
    instance.system.clock = config.identity;
    const auto index = static_cast<std::uint8_t>(instances_.size());
    instances_.emplace_back(instance, index, ports);
    for (PortNumber port = 1; port <= ports; ++port)
      capabilities_.emplace_back(config.log_gptp_capable_interval, PortIdentity{config.identity, port}, each.domain,
                                 index);
  }
}

void Node::start(sim::LocalTime now, Outputs& outputs) {
  for (PtpInstance& instance : instances_) instance.start(now, outputs);
}

void Node::link_up(PortNumber port, sim::LocalTime now, Outputs& outputs) {
  mutable_link(port).link_up(now, outputs);
  for (std::size_t i = 0; i < instances_.size(); ++i) capability(i, port).link_up(now, outputs);
}

void Node::link_down(PortNumber port, sim::LocalTime now, Outputs& outputs) {
  mutable_link(port).link_down(outputs);
  for (std::size_t i = 0; i < instances_.size(); ++i) capability(i, port).link_down(outputs);
  follow_capability(port, now, outputs);
}

void Node::received(PortNumber port, const Message& message, sim::LocalTime ingress, sim::LocalTime now,
                    Outputs& outputs) {
  LinkDelay& link = mutable_link(port);
  if (const auto* const request = std::get_if<PdelayReq>(&message)) {
    link.received(*request, ingress, outputs);
  } else if (const auto* const response = std::get_if<PdelayResp>(&message)) {
    link.received(*response, ingress, outputs);
  } else if (const auto* const response_follow_up = std::get_if<PdelayRespFollowUp>(&message)) {
    link.received(*response_follow_up, outputs);
  } else if (const auto* const signaling = std::get_if<Signaling>(&message)) {
    const PtpInstance* const instance = instance_of(signaling->header.domain);
    if (instance == nullptr) return;
    take(*signaling, static_cast<std::size_t>(instance - instances_.data()), port, now, outputs);
  } else if (PtpInstance* const instance = instance_of(header_of(message).domain);
             instance != nullptr && is_capable(static_cast<std::size_t>(instance - instances_.data()), port)) {
    if (const auto* const sync = std::get_if<Sync>(&message))
      instance->received(*sync, port, ingress, measure(port, ingress), now, outputs);
    if (const auto* const follow_up = std::get_if<FollowUp>(&message))
      instance->received(*follow_up, port, now, outputs);
    if (const auto* const announce = std::get_if<Announce>(&message)) instance->received(*announce, port, now, outputs);
    return;
  }
  follow_capability(port, now, outputs);
}

void Node::transmitted(const EgressReport& report, sim::LocalTime now, Outputs& outputs) {
  if (report.type == MessageType::sync) {
    if (PtpInstance* const instance = instance_of(report.domain)) instance->transmitted(report, outputs);
    return;
  }
  mutable_link(report.port).transmitted(report, outputs);
  follow_capability(report.port, now, outputs);
}

void Node::take(const Signaling& signaling, std::size_t instance, PortNumber port, sim::LocalTime now,
                Outputs& outputs) {
  if (!capability(instance, port).is_meant(signaling)) return;
  capability(instance, port).received(signaling, now, outputs);
  if (!signaling.request || !is_capable(instance, port)) return;
  mutable_link(port).interval_requested(signaling.request->link_delay, now, outputs);
  instances_[instance].received(*signaling.request, port, now, outputs);
}

void Node::ask_for_intervals(std::size_t instance, PortNumber port, const IntervalRequest& request, Outputs& outputs) {
  Capability& sender = capability(instance, port);
  if (!sender.is_up()) return;
  Signaling message = sender.next_message();
  message.request = request;
  outputs.push_back(SendMessage{port, message});
}

void Node::timer_expired(const TimerId& timer, sim::LocalTime now, Outputs& outputs) {
  if (timer.purpose == TimerPurpose::gptp_capable_interval)
    return capability(timer.instance, timer.port).interval_elapsed(now, outputs);
  if (timer.purpose == TimerPurpose::gptp_capable_receipt) {
    capability(timer.instance, timer.port).receipt_elapsed();
    return follow_capability(timer.port, now, outputs);
  }
  if (timer.instance != TimerId::no_instance)
    return instances_.at(timer.instance).timer_expired(timer.port, timer.purpose, now, outputs);
  mutable_link(timer.port).interval_elapsed(now, outputs);
  follow_capability(timer.port, now, outputs);
}

const LinkDelay& Node::link(PortNumber port) const {
  TAKT_CHECK(port >= 1 && port <= links_.size(), "a port of the node");
  return links_[port - 1u];
}
LinkDelay& Node::mutable_link(PortNumber port) {
  TAKT_CHECK(port >= 1 && port <= links_.size(), "a port of the node");
  return links_[port - 1u];
}

Capability& Node::capability(std::size_t instance, PortNumber port) {
  return capabilities_.at(instance * links_.size() + port - 1U);
}
NotCapable Node::obstacle(std::size_t instance, PortNumber port) const {
  if (!link(port).as_capable()) return link(port).obstacle();
  return capabilities_.at(instance * links_.size() + port - 1U).is_neighbor_capable()
             ? NotCapable::none
             : NotCapable::neighbor_not_capable;
}

PtpInstance* Node::instance_of(std::uint8_t domain) {
  for (PtpInstance& instance : instances_)
    if (instance.config().domain == domain) return &instance;
  return nullptr;
}

LinkMeasure Node::measure(PortNumber port, sim::LocalTime at) const {
  const LinkDelay& from = link(port);
  return {from.mean_link_delay() + from.delay_asymmetry(), from.neighbor_rate_ratio(at),
          from.neighbor_rate_ratio_drift()};
}

void Node::follow_capability(PortNumber port, sim::LocalTime now, Outputs& outputs) {
  for (std::size_t i = 0; i < instances_.size(); ++i)
    instances_[i].set_port_capable(port, is_capable(i, port), now, outputs);
}

}  // namespace takt::models::gptp
