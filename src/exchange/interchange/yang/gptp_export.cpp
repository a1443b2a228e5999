// SPDX-License-Identifier: Apache-2.0
// The data sets of each domain, as the scenario sets them.
#include <algorithm>

#include "interchange/yang/gptp.hpp"
#include "interchange/yang/modules.hpp"

namespace takt::interchange::yang {
namespace {

const scenario::GptpNode* node_in(const json::NameMap<scenario::GptpNode>& nodes, const std::string& name) {
  const auto found = std::ranges::find(nodes, name, [](const auto& each) -> const std::string& { return each.first; });
  return found == nodes.end() ? nullptr : &found->second;
}

class GptpWriter {
 public:
  GptpWriter(const scenario::Resolved& resolved, const Device& device, Exported& exported)
      : clocks_(resolved.scenario.clocks), gptp_(*clocks_.gptp), device_(device), exported_(exported) {
    const auto own = std::ranges::find(clocks_.nodes, device.name,
                                       [](const auto& each) -> const std::string& { return each.first; });
    clock_ = own != clocks_.nodes.end() ? &own->second : clocks_.all ? &*clocks_.all : nullptr;
  }

  void write(Data& ptp) {
    report_losses();
    Data& instances = ptp.make("instances");
    write_instance(instances.add("instance"), 0, 0, node_in(gptp_.nodes, device_.name));
    std::size_t index = 0;
    for (const scenario::GptpDomain& domain : gptp_.domains)
      write_instance(instances.add("instance"), ++index, domain.domain, node_in(domain.nodes, device_.name));
    if (gptp_.hot_standby)
      write_standby(ptp.make("common-services").make("hot-standby-service").add("hot-standby-system"));
  }

 private:
  void lose(bool is_said, std::string what) {
    if (is_said) exported_.lose("clock of " + device_.name, std::move(what));
  }

  void report_losses() {
    lose(gptp_.boundary, "boundary clocks: IEEE 802.1AS has relays only");
    lose(!gptp_.sync_locked, "bridges that are not sync-locked: the module has it as state");
    lose(std::ranges::any_of(gptp_.interval_requests,
                             [&](const scenario::IntervalRequest& each) { return each.node == device_.name; }),
         "interval requests to neighbours, which come during the run");
  }

  void write_instance(Data& instance, std::size_t index, std::uint8_t domain, const scenario::GptpNode* said) {
    const scenario::GptpNode node = said == nullptr ? scenario::GptpNode{} : *said;
    lose(node.boundary.value_or(false) && !gptp_.boundary, "boundary clocks: IEEE 802.1AS has relays only");
    instance.set("instance-index", std::to_string(index));
    Data& defaults = instance.make("default-ds");
    write_quality(defaults.make("clock-quality"), node);
    defaults.set("priority1", std::to_string(node.priority1.value_or(gptp_.hot_standby ? 255 : 248)));
    defaults.set("priority2", std::to_string(node.priority2));
    defaults.set("domain-number", std::to_string(domain));
    defaults.set("sdo-id", "256");  // majorSdoId 1: gPTP
    defaults.set("instance-enable", "true");
    defaults.set("external-port-config-enable", node.roles ? "true" : "false");
    if (node.time) write_time(instance.make("time-properties-ds"), *node.time);
    if (gptp_.drift_tracking) instance.make("drift-tracking-ds").set("drift-tracking-tlv-support", "true");
    if (gptp_.hot_standby && index < 2) write_thresholds(instance.make("ptp-instance-sync-ds"));
    Data& ports = instance.make("ports");
    for (const DevicePort& port : device_.ports) write_port(ports.add("port"), port, node);
  }

  /// Domain 0 is the primary, the first further one the secondary: instances 0 and 1.
  void write_standby(Data& system) {
    system.set("hot-standby-system-index", "0");
    Data& set = system.make("hot-standby-system-ds");
    set.set("primary-ptp-instance-index", "0");
    set.set("secondary-ptp-instance-index", "1");
    set.set("hot-standby-system-enable", "true");
    set.set("hot-standby-system-split-functionality", "false");
    set.set("primary-secondary-offset-thresh", scaled_ns(standby_.primary_secondary_offset));
    const auto exponent = log_of_seconds(standby_.waiting_time);
    lose(!exponent, "a waiting time of the hot standby that is no power of two of a second");
    if (exponent) set.set("hot-standby-system-log-sync-time-thresh", std::to_string(*exponent));
  }

  void write_thresholds(Data& set) {
    set.set("offset-from-time-transmitter-max", std::to_string(time_interval(standby_.offset_max)));
    set.set("rx-sync-count-time-receiver-p-thresh", std::to_string(standby_.rx_sync_count));
    set.set("offset-max-exceeded-count-thresh", std::to_string(standby_.offset_exceeded));
    set.set("offset-max-met-count-thresh", std::to_string(standby_.offset_met));
  }

  void write_quality(Data& quality, const scenario::GptpNode& node) {
    const auto name = identity_of_number("clock-class", node.clock_class);
    lose(!name, "clockClass " + std::to_string(node.clock_class) + ": the module has names, and none for it");
    if (name) quality.set("clock-class", std::string(ptp_m) + ":" + std::string(*name));
    if (node.clock_accuracy == 0xFE) return;  // unknown, which is not said
    const auto accuracy = identity_of_number("clock-accuracy", node.clock_accuracy);
    lose(!accuracy, "clockAccuracy " + std::to_string(node.clock_accuracy) + ": the module has names, and none for it");
    if (accuracy) quality.set("clock-accuracy", std::string(ptp_m) + ":" + std::string(*accuracy));
  }

  void write_time(Data& properties, const scenario::AnnouncedTime& time) {
    const auto truth = [](bool value) { return value ? "true" : "false"; };
    properties.set("current-utc-offset", std::to_string(time.utc_offset));
    properties.set("current-utc-offset-valid", truth(time.utc_offset_valid));
    properties.set("leap59", truth(time.leap == scenario::LeapSecond::leap59));
    properties.set("leap61", truth(time.leap == scenario::LeapSecond::leap61));
    properties.set("time-traceable", truth(time.time_traceable));
    properties.set("frequency-traceable", truth(time.frequency_traceable));
    properties.set("ptp-timescale", "true");
    const auto source = identity_of_number("time-source", time.source);
    lose(!source, "timeSource " + std::to_string(time.source) + ": the module has names, and none for it");
    if (source) properties.set("time-source", std::string(ptp_m) + ":" + std::string(*source));
  }

  void write_port(Data& entry, const DevicePort& port, const scenario::GptpNode& node) {
    entry.set("port-index", std::to_string(port.port + 1));
    entry.set("underlying-interface", port.interface);
    Data& set = entry.make("port-ds");
    // What it begins with, and what management sets: the same.
    set.set("log-announce-interval", std::to_string(gptp_.log_announce_interval));
    set.set("announce-receipt-timeout", std::to_string(gptp_.announce_receipt_timeout));
    set.set("log-sync-interval", std::to_string(gptp_.log_sync_interval));
    set.set("delay-mechanism", "p2p");
    set.set("log-min-pdelay-req-interval", std::to_string(gptp_.log_pdelay_interval));
    set.set("port-enable", "true");
    if (gptp_.link_delay_threshold)
      set.set("mean-link-delay-thresh",
              std::to_string(time_interval(*gptp_.link_delay_threshold)));  // otherwise that of the medium
    set.set("initial-log-announce-interval", std::to_string(gptp_.log_announce_interval));
    set.set("initial-log-sync-interval", std::to_string(gptp_.log_sync_interval));
    set.set("initial-log-pdelay-req-interval", std::to_string(gptp_.log_pdelay_interval));
    if (gptp_.log_gptp_capable_interval)
      set.set("initial-log-gptp-cap-interval", std::to_string(*gptp_.log_gptp_capable_interval));
    set.set("gptp-capable-state-machines-enabled", gptp_.log_gptp_capable_interval ? "true" : "false");
    set.set("sync-receipt-timeout", std::to_string(gptp_.sync_receipt_timeout));
    set.set("initial-one-step-tx-oper", gptp_.one_step ? "true" : "false");
    if (clock_ != nullptr && clock_->tx_correction)
      entry.make("timestamp-correction-port-ds")
          .set("egress-latency", std::to_string(time_interval(*clock_->tx_correction)));
    if (clock_ != nullptr && clock_->rx_correction)
      entry.make("timestamp-correction-port-ds")
          .set("ingress-latency", std::to_string(time_interval(*clock_->rx_correction)));
    if (!node.roles) return;
    const auto role = std::ranges::find(*node.roles, port.peer_name, &scenario::GptpPortRole::to);
    const scenario::GptpRole desired = role == node.roles->end() ? scenario::GptpRole::time_transmitter : role->role;
    entry.make("external-port-config-port-ds").set("desired-state", std::string(scenario::spelling(desired)));
  }

  const scenario::Clocks& clocks_;
  const scenario::Gptp& gptp_;
  const scenario::StandbyThresholds standby_ = gptp_.standby_thresholds.value_or(scenario::StandbyThresholds());
  const Device& device_;
  Exported& exported_;
  const scenario::Clock* clock_ = nullptr;
};

}  // namespace

void write_gptp(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect,
                Exported& exported) {
  const auto& gptp = resolved.scenario.clocks.gptp;
  if (!gptp || std::ranges::find(gptp->without, device.name) != gptp->without.end() || device.ports.empty()) return;
  if (dialect == Dialect::of_2018)
    return exported.lose("clock of " + device.name, "gPTP: there is no module of 2018 for it");
  GptpWriter(resolved, device, exported).write(root.make("ptp"));
}

}  // namespace takt::interchange::yang
