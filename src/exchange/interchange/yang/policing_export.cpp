// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/policing_export.hpp"

#include <algorithm>
#include <numeric>

#include "interchange/yang/modules.hpp"

namespace takt::interchange::yang {
namespace {

using sim::Duration;

class PolicingWriter {
 public:
  PolicingWriter(Data& root, const scenario::Resolved& resolved, const Device& device, std::uint64_t start_ns,
                 Exported& exported)
      : root_(root), r_(resolved), device_(device), ingress_(*device.ingress), start_(start_ns), exported_(exported) {}

  void write() {
    write_identities();
    Data& bridge = root_.make("bridges").add("bridge");
    bridge.set("name", device_.name);
    bridge.set("address", mac_text(mac_of(r_, {device_.node}), '-'));
    bridge.set("bridge-type", std::string(dot1q_m) + ":customer-vlan-bridge");
    Data& component = bridge.add("component");
    component.set("name", "c0");
    component.set("type", std::string(dot1q_m) + ":c-vlan-component");
    if (!ingress_.flow_meters.empty()) write_meters(component.make("flow-meters", psfp_bridge_m));
    const bool has_ats = !ingress_.ats_schedulers.empty();
    if (has_ats && (!ingress_.flow_meters.empty() || !ingress_.stream_gates.empty()))
      lose("gates and meters beside ATS schedulers: the modules have filters of their own for each");
    if (has_ats) {
      write_ats(component);
      return;
    }
    if (ingress_.stream_filters.empty()) return;
    write_gates(component.make("stream-gates", psfp_bridge_m));
    Data& filters = component.make("stream-filters", psfp_bridge_m);
    for (std::size_t i = 0; i < ingress_.stream_filters.size(); ++i)
      write_filter(filters.add("stream-filter-instance-table"), i);
  }

 private:
  void lose(std::string what) { exported_.lose(device_.name, std::move(what)); }
  /// Always open, for filters without a gate: in the standard each has one.
  std::string open_gate() const { return std::to_string(ingress_.stream_gates.size() + 1); }

  void write_identities() {
    std::size_t index = 0;
    for (const models::StreamIdentityEntry& entry : ingress_.stream_identity_table) {
      if (entry.member) continue;  // of redundancy
      Data& identity = root_.add("stream-identity");
      identity.set("index", std::to_string(++index));
      identity.set("handle", std::to_string(entry.stream.value + 1));
      Data& facing = identity.make("out-facing");
      for (const DevicePort& port : device_.ports) facing.add("input-port").text = port.interface;
      constexpr std::string_view tags[] = {"tagged", "priority", "all"};
      if (const auto* const null = std::get_if<models::AddressIdentification>(&entry.function)) {
        Data& function = identity.make("null-stream-identification");
        function.set("destination-mac", mac_text(mac_of(r_, null->destination), '-'));
        function.set("tagged", std::string(tags[static_cast<std::size_t>(null->tagged)]));
        function.set("vlan", std::to_string(null->vlan));
      } else if (const auto* const source = std::get_if<models::SourceMacAndVlanIdentification>(&entry.function)) {
        Data& function = identity.make("smac-vlan-stream-identification");
        function.set("source-mac", mac_text(source->source, '-'));
        function.set("tagged", std::string(tags[static_cast<std::size_t>(source->tagged)]));
        function.set("vlan", std::to_string(source->vlan));
      } else {
        lose("the identification of stream " + ingress_.streams[entry.stream.value] + " by masks");
        root_.children.pop_back();
      }
    }
  }

  void write_meters(Data& table) {
    for (std::size_t i = 0; i < ingress_.flow_meters.size(); ++i) {
      const models::FlowMeterConfig& meter = ingress_.flow_meters[i].meter;
      Data& entry = table.add("flow-meter-instance-table");
      entry.set("flow-meter-instance-id", std::to_string(i + 1));
      entry.set("committed-information-rate", std::to_string(meter.committed_information_rate.bits_per_second));
      entry.set("committed-burst-size", std::to_string(meter.committed_burst_size.count));
      entry.set("excess-information-rate", std::to_string(meter.excess_information_rate.bits_per_second));
      entry.set("excess-burst-size", std::to_string(meter.excess_burst_size.count));
      entry.set("coupling-flag", meter.coupling_flag ? "one" : "zero");
      entry.set("color-mode", meter.color_mode == models::ColorMode::color_blind ? "color-blind" : "color-aware");
      entry.set("drop-on-yellow", meter.drop_on_yellow ? "true" : "false");
      entry.set("mark-all-frames-red-enable", meter.mark_all_frames_red_enable ? "true" : "false");
    }
    table.set("max-flow-meter-instances", std::to_string(ingress_.flow_meters.size()));
  }

  std::uint64_t whole_ns(Duration duration, const std::string& gate) {
    if (duration.ps() % 1000 != 0) lose("times of stream gate " + gate + " that are no whole numbers of ns");
    return static_cast<std::uint64_t>(duration.ps() / 1000);
  }
  static std::string ipv(const std::optional<models::Priority>& value) {
    return value ? std::string(digit_word(*value)) : "null";
  }

  void write_gates(Data& table) {
    std::size_t longest_list = 1;
    Duration longest_cycle = Duration::from_ps(1'000'000'000'000);
    std::uint64_t longest_interval = 999'999'999;
    for (std::size_t i = 0; i < ingress_.stream_gates.size(); ++i) {
      const models::StreamGateConfig& gate = ingress_.stream_gates[i];
      Data& entry = table.add("stream-gate-instance-table");
      entry.set("stream-gate-instance-id", std::to_string(i + 1));
      entry.set("gate-enable", "true");
      entry.set("admin-gate-states", gate.admin_gate_open ? "open" : "closed");
      entry.set("admin-ipv", ipv(gate.admin_ipv));
      entry.set("gate-closed-due-to-invalid-rx-enable", gate.closed_due_to_invalid_rx_enable ? "true" : "false");
      entry.set("gate-closed-due-octets-exceeded-enable", gate.closed_due_to_octets_exceeded_enable ? "true" : "false");
      Data& cycle = entry.make("admin-cycle-time");
      if (gate.admin_control_list.empty()) {
        cycle.set("numerator", "0");
        cycle.set("denominator", "1");
        continue;
      }
      std::size_t index = 0;
      for (const models::StreamGateEntry& line : gate.admin_control_list) {
        Data& made = entry.make("admin-control-list").add("gate-control-entry");
        made.set("index", std::to_string(index++));
        made.set("operation-name", std::string(psfp_m) + ":set-gate-and-ipv");
        const std::uint64_t interval = whole_ns(line.interval, gate.name);
        if (interval > 0xFFFF'FFFF) lose("an entry of stream gate " + gate.name + " of more than 32 bits of ns");
        longest_interval = std::max(longest_interval, interval);
        made.set("time-interval-value", std::to_string(interval));
        made.set("gate-state-value", line.open ? "open" : "closed");
        made.set("ipv-spec", ipv(line.ipv));
        if (line.interval_octet_max) made.set("interval-octet-max", std::to_string(*line.interval_octet_max));
      }
      longest_list = std::max(longest_list, gate.admin_control_list.size());
      longest_cycle = std::max(longest_cycle, gate.admin_cycle_time);
      const std::uint64_t length = whole_ns(gate.admin_cycle_time, gate.name),
                          common = std::gcd(length, std::uint64_t{1'000'000'000});
      cycle.set("numerator", std::to_string(length / common));
      cycle.set("denominator", std::to_string(1'000'000'000 / common));
      entry.set("admin-cycle-time-extension", std::to_string(whole_ns(gate.admin_cycle_time_extension, gate.name)));
      Duration base = gate.admin_base_time.since_start();
      if (base < Duration()) {
        base = base % gate.admin_cycle_time;
        if (base < Duration()) base += gate.admin_cycle_time;
        if (gate.is_running && base > Duration())
          lose("stream gate " + gate.name + ", which is in force before its first cycle");
      }
      const std::uint64_t at = start_ + whole_ns(base, gate.name);
      Data& base_time = entry.make("admin-base-time");
      base_time.set("seconds", std::to_string(at / 1'000'000'000));
      base_time.set("nanoseconds", std::to_string(at % 1'000'000'000));
      entry.set("config-change", "true");
    }
    Data& open = table.add("stream-gate-instance-table");
    open.set("stream-gate-instance-id", open_gate());
    open.set("gate-enable", "false");
    open.set("admin-gate-states", "open");
    Data& none = open.make("admin-cycle-time");
    none.set("numerator", "0");
    none.set("denominator", "1");
    table.set("supported-list-max", std::to_string(longest_list));
    Data& longest = table.make("supported-cycle-max");
    longest.set("numerator", std::to_string((longest_cycle.ps() + 999'999'999'999) / 1'000'000'000'000));
    longest.set("denominator", "1");
    table.set("supported-interval-max", std::to_string(longest_interval));
  }

  void write_match(Data& entry, std::size_t number) {
    const models::StreamFilterConfig& filter = ingress_.stream_filters[number];
    entry.set("stream-filter-instance-id", std::to_string(number));
    if (filter.stream_handle)
      entry.set("stream-handle", std::to_string(filter.stream_handle->value + 1));
    else
      entry.make("wildcard");
    entry.set("priority-spec", filter.priority ? std::string(digit_word(*filter.priority)) : "wildcard");
    entry.set("max-sdu-size", std::to_string(filter.maximum_sdu_size.count));
    entry.set("stream-blocked-due-to-oversize-frame-enabled",
              filter.stream_blocked_due_to_oversize_frame_enable ? "true" : "false");
  }

  void write_filter(Data& entry, std::size_t number) {
    const models::StreamFilterConfig& filter = ingress_.stream_filters[number];
    write_match(entry, number);
    entry.set("stream-gate-ref",
              filter.stream_gate.is_none() ? open_gate() : std::to_string(filter.stream_gate.value + 1));
    if (filter.flow_meter.is_none()) return;
    entry.set("flow-meter-ref", std::to_string(filter.flow_meter.value + 1));
    entry.set("flow-meter-enable", "true");
  }

  /// A scheduler stands in the filter that uses it, with its group.
  void write_ats(Data& component) {
    Data& gates = component.make("stream-gates", ats_bridge_m);
    Data& gate = gates.add("stream-gate-instance-table");
    gate.set("stream-gate-instance-id", "1");
    gate.set("gate-enable", "false");
    gate.set("admin-gate-states", "open");
    Data& filters = component.make("stream-filters", ats_bridge_m);
    for (std::size_t i = 0; i < ingress_.stream_filters.size(); ++i) {
      const models::StreamFilterConfig& filter = ingress_.stream_filters[i];
      Data& entry = filters.add("stream-filter-instance-table");
      write_match(entry, i);
      entry.set("stream-gate-ref", "1");
      if (filter.ats_scheduler.is_none()) continue;
      const models::AtsSchedulerConfig& scheduler = ingress_.ats_schedulers[filter.ats_scheduler.value];
      if (!scheduler.media_overhead)
        lose("ATS scheduler " + scheduler.name + ", which counts frames without preamble and gap");
      if (scheduler.group.is_none())
        lose("ATS scheduler " + scheduler.name + " in the group of its port and class: the modules name every group");
      Data& made = entry.make("schedulers").add("scheduler-instance-table");
      made.set("scheduler-instance-id", std::to_string(filter.ats_scheduler.value + 1));
      made.set("committed-information-rate", std::to_string(scheduler.committed_information_rate.bits_per_second));
      made.set("committed-burst-size",
               std::to_string(static_cast<std::uint64_t>(scheduler.committed_burst_size.count) * 8));
      const std::uint32_t group = scheduler.group.is_none() ? 0 : scheduler.group.value;
      made.set("scheduler-group-ref", std::to_string(group + 1));
      Data& of_group = entry.make("scheduler-groups").add("scheduler-group-instance-table");
      of_group.set("scheduler-group-instance-id", std::to_string(group + 1));
      const Duration longest = scheduler.group.is_none() ? ingress_.maximum_residence_time
                                                         : ingress_.ats_groups[group].maximum_residence_time;
      const bool is_limited = longest < Duration::from_ps(4'294'967'295'000);
      of_group.set("max-residence-time", std::to_string(is_limited ? whole_ns(longest, scheduler.name) : 0xFFFF'FFFFu));
      Data& use = entry.make("scheduler");
      use.set("scheduler-ref", std::to_string(filter.ats_scheduler.value + 1));
      use.set("scheduler-enable", "true");
    }
  }

  Data& root_;
  const scenario::Resolved& r_;
  const Device& device_;
  const models::IngressConfig& ingress_;
  std::uint64_t start_;
  Exported& exported_;
};

}  // namespace

void write_policing(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect,
                    std::uint64_t start_ns, Exported& exported) {
  const bool has_policing = !device.ingress->stream_filters.empty();
  if (!has_policing) return;
  if (dialect == Dialect::of_2018)
    return exported.lose(device.name, "policing: in the dialect of 2018 gates, sizes and preemption are written");
  PolicingWriter(root, resolved, device, start_ns, exported).write();
}

}  // namespace takt::interchange::yang
