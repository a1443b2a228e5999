// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "interchange/device_import.hpp"
#include "interchange/gate_times.hpp"
#include "interchange/linux/linux.hpp"
#include "interchange/linux/ptp4l.hpp"
#include "interchange/linux/script.hpp"
#include "interchange/ports.hpp"
#include "json/printable.hpp"
#include "models/egress/gate_control_list.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::interchange {
namespace {

using models::TrafficClass;
using sim::Duration;

constexpr SettingInfo linux_export_table[] = {
    {"gates", "hardware|txtime-assist|software", "hardware",
     "who works gates, shapers and priorities: the interface, launch times that the kernel works out (gates alone), or "
     "the kernel"},
    {"timestamps", "hardware|software", "hardware",
     "who takes the time stamps of ptp4l: the interface, or the kernel, as on interfaces without a clock"},
    {"start", "a whole number of ns", "0",
     "is added to each base time: when the run begins, by the clock of the interfaces"},
    {"txtime-delay", "a whole number of ns", "300000", "of gates=txtime-assist"},
    {"etf-delta", "a whole number of ns", "200000", "how long before its launch time a frame goes to the driver"},
    {"verify", "on|off", "on", "whether ports verify that the other side understands preemption"},
};

/// The VLAN of frames without one, in a bridge of Linux.
constexpr int default_vlan = 1;

/// What Linux has a limit for, said once: the limit, and the ports at which so many entries are beyond it.
using LimitsOfLinux = std::map<std::string, std::vector<std::pair<std::string, std::size_t>>>;

class ScriptWriter {
 public:
  ScriptWriter(const ExportRequest& request, const Device& device, Exported& exported, LimitsOfLinux& limits)
      : r_(request.resolved),
        request_has_names_(request.interfaces.contains(device.name)),
        settings_(request.settings),
        device_(device),
        exported_(exported),
        limits_(limits) {}

  std::string write() {
    text_ = "#!/bin/sh\n";
    text_ += fmt::format("# takt: {} of scenario {}. {}\nset -e\n", json::printable(device_.name),
                         json::printable(r_.scenario.name),
                         request_has_names_ ? "Interfaces are called as the table of names beside it has them."
                                            : "Interfaces are called after takt's numbers of ports.");
    const std::size_t header = text_.size();
    if (device_.kind != models::NodeKind::host)
      write_bridge();
    else
      write_interfaces_of_host();
    // Before the gates: a qdisc that comes later resets those of its interface, and Linux 6.1 then stops their timer.
    if (device_.ingress != nullptr || (device_.kind != models::NodeKind::host && !offloads())) write_ingress();
    for (const DevicePort& port : device_.ports) write_port(port);
    const bool splits = std::ranges::any_of(r_.plan.host_splits, [&](const models::HostSplitPlan& each) {
      return r_.plan.streams[each.stream.value].talker.value == device_.node;
    });
    const bool recovers = std::ranges::any_of(
        r_.plan.host_recoveries, [&](const models::HostRecoveryPlan& each) { return each.host.value == device_.node; });
    if (splits || recovers) exported_.lose(device_.name, "redundancy (802.1CB) in the host");
    if (r_.scenario.clocks.gptp) write_clock();
    const std::string lost = losses_of_node();
    text_.insert(header, lost);
    return std::move(text_);
  }

 private:
  std::string where(const DevicePort& port) const { return device_.name + " to " + port.peer_name; }
  void lose(const DevicePort& port, std::string what) { exported_.lose(where(port), std::move(what)); }
  std::string losses_of_node() const {
    std::vector<Loss> own;
    for (const auto& [limit, ports] : limits_)
      for (const auto& [port, count] : ports)
        if (port.starts_with(device_.name + " to ")) own.push_back({port, std::to_string(count) + " " + limit});
    std::ranges::copy_if(exported_.losses, std::back_inserter(own), [&](const Loss& loss) {
      return loss.where.starts_with(device_.name + " ") || loss.where.ends_with(" " + device_.name) ||
             loss.where == device_.name;
    });
    return losses_as_comments(own, "# ");
  }

  /// What is not there yet is made, what is there stays: a script runs a second time.
  void write_bridge() {
    text_ +=
        "\n# The bridge: filtering entries along the paths of the streams\nip link show dev br0 >/dev/null 2>&1 || ip "
        "link add name br0 type bridge\nip link set dev br0 type bridge vlan_filtering 1 mcast_snooping 1\n";
    for (const DevicePort& port : device_.ports)
      text_ += fmt::format("ip link set dev {0} master br0\nip link set dev {0} up\n", port.interface);
    text_ += "ip link set dev br0 up\n";
    std::set<std::uint16_t> vlans;
    for (const models::FilteringPlan& entry : r_.plan.filtering)
      if (entry.node.value == device_.node && entry.vlan != 0) vlans.insert(entry.vlan);
    for (const DevicePort& port : device_.ports) {
      write_default_vlan(port);
      // Frames of a VLAN enter where they are not sent, too: every port is a member of every VLAN that is known here.
      for (const std::uint16_t vlan : vlans)
        text_ += fmt::format("bridge vlan add dev {} vid {}{}\n", port.interface, vlan,
                             port.config->untagged ? " untagged" : "");
    }
    write_filtering();
  }

  /// Frames without a VLAN are in VLAN 1 within the bridge. By default their tag is taken away with that of the VLAN,
  /// and the priority with it.
  void write_default_vlan(const DevicePort& port) {
    bool has_tagged = false, has_untagged = false;
    for (const models::FilteringPlan& entry : r_.plan.filtering) {
      if (entry.node.value != device_.node || entry.vlan != 0 || entry.port != port.port) continue;
      for (const models::StreamPlan& stream : r_.plan.streams) {
        if (stream.vlan != 0 || stream.destination != entry.address) continue;
        has_tagged = has_tagged || stream.priority;
        has_untagged = has_untagged || !stream.priority;
      }
    }
    const bool strips = port.config->untagged || (has_untagged && !has_tagged);
    if (has_untagged && !strips)
      lose(port, "frames without a tag beside those that have a priority tag alone: all leave with the tag of VLAN 1");
    text_ +=
        fmt::format("bridge vlan add dev {} vid {} pvid{}\n", port.interface, default_vlan, strips ? " untagged" : "");
  }

  void write_filtering() {
    std::set<std::string> written;
    std::map<std::pair<std::string, int>, std::string> port_of_address;
    for (const models::FilteringPlan& entry : r_.plan.filtering) {
      if (entry.node.value != device_.node) continue;
      const auto port = std::ranges::find(device_.ports, entry.port, &DevicePort::port);
      if (port == device_.ports.end()) continue;  // the internal port of a station
      const std::string address = mac_text(mac_of(r_, entry.address), ':');
      const int vlan = entry.vlan == 0 ? default_vlan : entry.vlan;
      const bool is_group = entry.address.value >= r_.plan.nodes.size();
      if (!is_group) {
        const auto [known, is_new] = port_of_address.try_emplace({address, vlan}, port->interface);
        if (!is_new && known->second != port->interface)
          exported_.lose(device_.name,
                         fmt::format("a second port ({} besides {}) for the address of {}: a bridge has one",
                                     port->interface, known->second, r_.plan.nodes[entry.address.value].name));
      }
      // `replace` is younger than `add` for groups, and `add` of what is there fails.
      const std::string group = fmt::format("dev br0 port {} grp {} permanent vid {}", port->interface, address, vlan);
      const std::string lines =
          is_group
              ? fmt::format("bridge mdb del {0} 2>/dev/null || true\nbridge mdb add {0}\n", group)
              : fmt::format("bridge fdb replace {} dev {} master static vlan {}\n", address, port->interface, vlan);
      if (written.insert(lines).second) text_ += lines;
    }
  }

  /// Which priority is in the tag is said once for each VLAN.
  void write_interfaces_of_host() {
    if (std::ranges::any_of(r_.plan.talker_ats, [&](const models::TalkerAtsPlan& each) {
          return r_.plan.streams[each.stream.value].talker.value == device_.node;
        }))
      exported_.lose(device_.name, "ATS schedulers of what the host itself sends: there is no such qdisc");
    if (!device_.ports.empty()) text_ += "\n";
    for (const DevicePort& port : device_.ports) text_ += fmt::format("ip link set dev {} up\n", port.interface);
    std::set<std::uint16_t> vlans;
    for (const scenario::ResolvedStream& each : r_.streams) {
      const models::StreamPlan& stream = r_.plan.streams[each.index.value];
      const bool is_end =
          stream.talker.value == device_.node || std::ranges::any_of(each.paths, [&](const scenario::Path& path) {
            return !path.empty() && path.back() == device_.node;
          });
      if (is_end && stream.priority) vlans.insert(stream.vlan == 0 ? default_vlan : stream.vlan);
    }
    if (vlans.empty()) return;
    text_ += "\n# What is sent with a tag: the priority of the socket (SO_PRIORITY) is that of the tag\n";
    for (const DevicePort& port : device_.ports)
      for (const std::uint16_t vlan : vlans)
        text_ += fmt::format(
            "ip link show dev {0}.{1} >/dev/null 2>&1 || ip link add link {0} name {0}.{1} type vlan id {1}\nip link "
            "set dev {0}.{1} type vlan egress-qos-map 0:0 1:1 2:2 3:3 4:4 5:5 6:6 7:7\nip link set dev {0}.{1} up\n",
            port.interface, vlan);
  }

  static std::string map_and_queues(const models::PortConfig& config, bool one_queue) {
    std::string text = "num_tc 8 map";
    for (const TrafficClass q : config.traffic_class_of_priority) text += " " + std::to_string(q);
    text += " 7 7 7 7 7 7 7 7 queues";
    for (int q = 0; q < 8; ++q) text += fmt::format(" 1@{}", one_queue ? 0 : q);
    return text;
  }

  void write_port(const DevicePort& port) {
    const models::PortConfig& config = *port.config;
    const models::ShapingConfig& shaping = config.shaping;
    text_ += fmt::format("\n# {} to {}, {}\n", port.interface, port.peer_name, json::to_text(port.rate));
    for (const std::string& requirement : requirements_at(r_, device_.node, port.peer))
      text_ += "# serves: " + requirement + "\n";
    if (config.preemption) write_merge(port);
    const bool has_sizes = std::ranges::any_of(shaping.queue_max_sdu, [](sim::Octets size) { return size.count != 0; });
    const bool has_gates = shaping.gates && !shaping.gates->admin_control_list.empty();
    if (has_gates || has_sizes)
      write_taprio(port, has_gates);
    else
      text_ += fmt::format(
          "tc qdisc del dev {0} root 2>/dev/null || true\ntc qdisc add dev {0} parent root handle 100 mqprio \\\n    "
          "{1}{2} hw {3}\n",
          port.interface, map_and_queues(config, false), preemption_text(config),
          offloads() ? 1 : 0);  // mqprio cannot be changed
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q) write_algorithm(port, q);
    if (config.cut_through != 0) lose(port, "cut-through: there is no such setting");
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q)
      if (config.queue_limits[q].is_finite() || config.queue_limits[q].drops_oldest) lose(port, "limits of queues");
  }

  static std::string preemption_text(const models::PortConfig& config) {
    if (!config.preemption) return "";
    std::string text = " \\\n    fp";
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q)
      text += models::contains(config.preemption->preemptable, q) ? " P" : " E";
    return text;
  }

  void write_merge(const DevicePort& port) {
    const models::PreemptionConfig& preemption = *port.config->preemption;
    if (preemption.preemptable == models::every_class)
      lose(port, "preemption without an express class: such a set is refused");
    if (preemption.hold_advance) lose(port, "hold_advance, which the interface has by itself");
    if (preemption.release_advance > Duration()) lose(port, "release_advance, which the interface has by itself");
    const int fragment = 64 * (1 + static_cast<int>(preemption.add_frag_size.value())) - 4;
    text_ += fmt::format("ethtool --set-mm {} pmac-enabled on tx-enabled on verify-enabled {} tx-min-frag-size {}\n",
                         port.interface, settings_["verify"], fragment);
  }

  void write_taprio(const DevicePort& port, bool has_gates) {
    const models::PortConfig& config = *port.config;
    DeviceGates gates;
    if (has_gates) {
      gates = device_gates(*config.shaping.gates);
    } else {
      gates.cycle = Duration::from_ps(1'000'000'000);
      gates.entries.push_back({models::GateOperation::set_gate_states, models::all_gates_open, gates.cycle});
    }
    const std::string& way = settings_["gates"];
    text_ +=
        fmt::format("tc qdisc replace dev {} parent root handle 100 taprio \\\n    {}{}", port.interface,
                    map_and_queues(config, way == "txtime-assist"), way == "hardware" ? preemption_text(config) : "");
    if (config.preemption && way != "hardware") lose(port, "preemption, which needs gates=hardware");
    if (std::ranges::any_of(config.shaping.queue_max_sdu, [](sim::Octets size) { return size.count != 0; })) {
      text_ += " \\\n    max-sdu";
      for (const sim::Octets size : config.shaping.queue_max_sdu) text_ += " " + std::to_string(size.count);
    }
    const auto ns = [&](Duration duration, const char* what) {
      if (duration.ps() % 1000 != 0)
        lose(port, std::string(what) + " that is no whole number of ns (" + json::to_text(duration) + ")");
      return duration.ps() / 1000;
    };
    const std::uint64_t start = settings_.number("start", 9'000'000'000'000'000'000ULL).value_or(0);
    text_ += fmt::format(" \\\n    base-time {} cycle-time {}",
                         start + static_cast<std::uint64_t>(ns(gates.base, "a base time")), ns(gates.cycle, "a cycle"));
    if (gates.extension > Duration())
      text_ += fmt::format(" cycle-time-extension {}", ns(gates.extension, "an extension"));
    const Duration least = Duration::from_ps(port.rate.octet_time().ps() * 60);
    const Widened widened = widen_short_entries(gates.entries, least);
    const std::string short_ones = fmt::format(
        "entries shorter than 60 octets last on the link ({}), which the kernel refuses", json::to_text(least));
    const std::string remedy = fmt::format(
        "; \"gate_limits\": {{\"least_interval\": \"{}\"}} has takt schedule make none", json::to_text(least));
    if (widened.lengthened > 0)
      limits_[short_ones + ": lengthened at the cost of the entries before them" + remedy].emplace_back(
          where(port), widened.lengthened);
    if (widened.too_short > 0) limits_[short_ones + remedy].emplace_back(where(port), widened.too_short);
    const std::size_t most = most_entries(way, gates);
    if (gates.entries.size() > most)
      limits_[fmt::format("entries of a gate list of which tc sends at most {0} in its message of 1,024 octets "
                          "(iproute2 6.1); \"gate_limits\": {{\"entries\": {0}}} has takt schedule keep to it",
                          most)]
          .emplace_back(where(port), gates.entries.size());
    for (const models::GateControlEntry& entry : gates.entries) {
      constexpr char operations[] = {'S', 'H', 'R'};
      text_ += fmt::format(" \\\n    sched-entry {} {:02x} {}", operations[static_cast<std::size_t>(entry.operation)],
                           entry.gate_states, ns(entry.interval, "an entry"));
    }
    if (way == "hardware")
      text_ += " \\\n    flags 0x2\n";
    else if (way == "software")
      text_ += " \\\n    clockid CLOCK_TAI\n";
    else
      text_ += fmt::format(" \\\n    flags 0x1 txtime-delay {} clockid CLOCK_TAI\n", settings_["txtime-delay"]);
  }

  /// Whether interfaces work what is set here, and not the kernel.
  bool offloads() const { return settings_["gates"] != "software"; }

  /// How many entries tc can send: its message has headers, the kind, the classes and 28 octets for each entry.
  std::size_t most_entries(const std::string& way, const DeviceGates& gates) const {
    std::size_t octets = 16 + 20 + 12 + 4 + 88 + 12 + 12 + 4 +
                         8;  // headers, kind, options, classes, base time, cycle, list, clock or flags
    if (gates.extension > Duration()) octets += 12;
    if (way == "txtime-assist") octets += 8 + 8;  // its delay, and both clock and flags
    return (1024 - octets) / 28;
  }

  void write_algorithm(const DevicePort& port, TrafficClass q) {
    const models::ShapingConfig& shaping = port.config->shaping;
    if (const models::CreditBased* const shaper = shaping.shaper_of(q)) {
      write_shaper(port, q, *shaper);
      if (shaper->has_launch_times)
        lose(port, fmt::format("launch times besides the credit-based shaper of class {}: a queue has one qdisc", q));
    } else if (std::holds_alternative<models::TimeBased>(shaping.selection[q])) {
      if (device_.kind == models::NodeKind::host)
        text_ += fmt::format("tc qdisc replace dev {} parent 100:{} etf clockid CLOCK_TAI delta {}{}\n", port.interface,
                             q + 1, settings_["etf-delta"], offloads() ? " offload" : "");
      else
        lose(port, fmt::format("ATS of class {}: there is no such qdisc", q));
    } else if (shaping.is_shared(q)) {
      lose(port, fmt::format("the share of class {} (ETS)", q));
    }
  }

  void write_shaper(const DevicePort& port, TrafficClass q, const models::CreditBased& shaper) {
    sim::int128 slope = shaper.idle_slope.bits_per_second;
    const models::ShapingConfig& shaping = port.config->shaping;
    if (shaper.of_whole_cycle && shaping.gates && !shaping.gates->admin_control_list.empty()) {
      const models::OpenShare share =
          models::GateControlList(shaping.gates->admin_control_list, shaping.gates->admin_cycle_time).open_share(q);
      const sim::int128 scaled = slope * share.cycle.ps();
      if (share.open.ps() == 0 || scaled % share.open.ps() != 0)
        lose(port, fmt::format("the idle slope of class {} over the whole cycle: while the gate is open it is no whole "
                               "number of bit/s",
                               q));
      slope = share.open.ps() == 0 ? slope : scaled / share.open.ps();
    }
    if (slope % 1000 != 0) lose(port, fmt::format("the idle slope of class {}, which is no whole number of kbit/s", q));
    const auto idle = static_cast<std::int64_t>(slope / 1000);
    const auto rate = static_cast<std::int64_t>(port.rate.bits_per_second / 1000);
    const std::int64_t send = idle - rate;
    const auto use = use_of_port(r_, device_.node, port.port);
    // The longest frame that may be in the way, of any class, and the longest of its own; with preamble and gap, as
    // slopes count.
    constexpr std::int64_t longest = 1542;
    const std::int64_t own =
        use[q].longest_frame.count == 0 ? longest : models::wire_length(use[q].longest_frame).count;
    const std::int64_t high = (idle * longest + rate - 1) / rate;
    const std::int64_t low = -((-send * own) / rate);
    text_ += fmt::format(
        "tc qdisc replace dev {} parent 100:{} cbs idleslope {} sendslope {} hicredit {} locredit {} offload {}\n",
        port.interface, q + 1, idle, send, high, low, offloads() ? 1 : 0);
  }

  void write_ingress() {
    static const models::IngressConfig nothing{};
    const models::IngressConfig& ingress = device_.ingress != nullptr ? *device_.ingress : nothing;
    if (!ingress.splits.empty() || !ingress.recoveries.empty())
      exported_.lose(device_.name, "redundancy (802.1CB): there is no tc action that splits or eliminates");
    if (!ingress.ats_schedulers.empty()) exported_.lose(device_.name, "ATS schedulers: there is no such action");
    const bool sets_priorities = device_.kind != models::NodeKind::host && !offloads();
    if (ingress.stream_filters.empty() && !sets_priorities) return;
    text_ += ingress.stream_filters.empty()
                 ? "\n# A bridge in software does not take the class of a frame from its tag\n"
                 : "\n# What comes in is policed alike at all ports\n";
    std::set<std::string> defined;
    // The gates of all ports are one action each: all filters that hold them go before new ones come.
    for (const DevicePort& port : device_.ports)
      text_ += fmt::format("tc qdisc del dev {} clsact 2>/dev/null || true\n", port.interface);
    for (const DevicePort& port : device_.ports) {
      text_ += fmt::format("tc qdisc add dev {} clsact\n", port.interface);
      int preference = 0;
      if (sets_priorities)
        for (int p = 1; p < 8; ++p)
          text_ += fmt::format(
              "tc filter add dev {} ingress protocol 802.1Q pref {} flower vlan_prio {} action skbedit priority {} "
              "continue\n",
              port.interface, ++preference, p, p);
      for (const models::StreamFilterConfig& filter : ingress.stream_filters)
        write_filter(port, filter, ++preference, defined);
    }
  }

  void write_filter(const DevicePort& port, const models::StreamFilterConfig& filter, int preference,
                    std::set<std::string>& defined) {
    const models::IngressConfig& ingress = *device_.ingress;
    std::string match;
    if (filter.stream_handle) {
      std::size_t entries = 0;
      for (const models::StreamIdentityEntry& entry : ingress.stream_identity_table) {
        if (entry.stream != *filter.stream_handle) continue;
        ++entries;
        const auto* const address = std::get_if<models::AddressIdentification>(&entry.function);
        if (address == nullptr || address->tagged == models::Tagged::priority) {
          exported_.lose(device_.name, "the identification of stream " + ingress.streams[entry.stream.value] +
                                           ", which is not by destination and VLAN");
          continue;
        }
        if (address->vlan != 0) match += fmt::format(" vlan_id {}", address->vlan);
        match += " dst_mac " + mac_text(mac_of(r_, address->destination), ':');
      }
      if (entries != 1)
        exported_.lose(device_.name,
                       "stream " + ingress.streams[filter.stream_handle->value] + ", which several entries identify");
    }
    if (filter.priority) match += fmt::format(" vlan_prio {}", *filter.priority);
    if (filter.maximum_sdu_size.count != 0) exported_.lose(device_.name, "the longest SDU of a stream filter");
    if (filter.stream_blocked_due_to_oversize_frame_enable)
      exported_.lose(device_.name, "the blocking of streams with frames that are too long");
    text_ += fmt::format("tc filter add dev {} ingress protocol {} pref {} flower{}", port.interface,
                         filter.priority || match.find("vlan_id") != std::string::npos ? "802.1Q" : "all", preference,
                         match);
    // The gate before the meter, as in 802.1Q 8.6.5; behind the tables of rates of a meter tc has no room for a gate.
    if (!filter.stream_gate.is_none())
      write_gate(ingress.stream_gates[filter.stream_gate.value], filter.stream_gate.value + 1, defined);
    if (!filter.flow_meter.is_none())
      write_meter(ingress.flow_meters[filter.flow_meter.value], filter.flow_meter.value + 1, defined);
    text_ += "\n";
  }

  void write_meter(const models::NamedFlowMeterConfig& named, std::uint32_t index, std::set<std::string>& defined) {
    const models::FlowMeterConfig& meter = named.meter;
    if (meter.excess_information_rate.bits_per_second != 0 || meter.excess_burst_size.count != 0 ||
        meter.coupling_flag || meter.color_mode != models::ColorMode::color_blind || meter.mark_all_frames_red_enable)
      exported_.lose(device_.name,
                     "the excess rate, coupling, colours or blocking of meter " + named.name + ": police has one rate");
    text_ += fmt::format(" \\\n    action police rate {}bit burst {} conform-exceed drop/pipe index {}",
                         meter.committed_information_rate.bits_per_second, meter.committed_burst_size.count, index);
    defined.insert("meter " + named.name);
  }

  void write_gate(const models::StreamGateConfig& gate, std::uint32_t index, std::set<std::string>& defined) {
    if (gate.closed_due_to_invalid_rx_enable || gate.closed_due_to_octets_exceeded_enable)
      exported_.lose(device_.name, "stream gate " + gate.name + ", which closes for good");
    if (gate.admin_cycle_time_extension > Duration())
      exported_.lose(device_.name, "the extension of stream gate " + gate.name);
    const bool is_first = defined.insert("gate " + gate.name).second;
    text_ += fmt::format(" \\\n    action gate index {}", index);
    if (!is_first) return;
    if (gate.admin_ipv) text_ += fmt::format(" priority {}", *gate.admin_ipv);
    if (gate.admin_control_list.empty()) {
      text_ += fmt::format(" clockid CLOCK_TAI base-time 0 cycle-time 1000000 sched-entry {} 1000000 -1 -1",
                           gate.admin_gate_open ? "open" : "close");
      return;
    }
    Duration base = gate.admin_base_time.since_start();
    if (base < Duration()) {
      base = base % gate.admin_cycle_time;
      if (base < Duration()) base += gate.admin_cycle_time;
      if (gate.is_running && base > Duration())
        exported_.lose(device_.name, "stream gate " + gate.name + ", which is in force before its first cycle");
    }
    const auto whole = [&](Duration duration) {
      if (duration.ps() % 1000 != 0)
        exported_.lose(device_.name, "times of stream gate " + gate.name + " that are no whole numbers of ns");
      return duration.ps() / 1000;
    };
    text_ += fmt::format(
        " clockid CLOCK_TAI base-time {} cycle-time {}",
        settings_.number("start", 9'000'000'000'000'000'000ULL).value_or(0) + static_cast<std::uint64_t>(whole(base)),
        whole(gate.admin_cycle_time));
    Duration sum;
    for (const models::StreamGateEntry& entry : gate.admin_control_list) {
      if (sum >= gate.admin_cycle_time) break;
      const Duration interval = std::min(entry.interval, gate.admin_cycle_time - sum);
      sum += interval;
      text_ += fmt::format(" \\\n    sched-entry {} {} {} {}", entry.open ? "open" : "close", whole(interval),
                           entry.ipv ? static_cast<int>(*entry.ipv) : -1,
                           entry.interval_octet_max ? static_cast<std::int64_t>(*entry.interval_octet_max) : -1);
    }
    if (sum < gate.admin_cycle_time) {
      const models::StreamGateEntry& last = gate.admin_control_list.back();
      text_ += fmt::format(" \\\n    sched-entry {} {} {} -1", last.open ? "open" : "close",
                           whole(gate.admin_cycle_time - sum), last.ipv ? static_cast<int>(*last.ipv) : -1);
      if (last.interval_octet_max)
        exported_.lose(device_.name, "the octets of the last entry of stream gate " + gate.name +
                                         ", which is shorter than its cycle");
    }
  }

  void write_clock() {
    const bool in_software = settings_["timestamps"] == "software";
    const std::vector<linux_tc::Ptp4lFile> files = linux_tc::ptp4l_files(r_, device_, in_software, exported_);
    if (files.empty()) return;
    text_ += in_software ? "\n# gPTP, which sets the clock of the system\n"
                         : "\n# gPTP; then the clock of the system after that of the interface\n";
    for (const linux_tc::Ptp4lFile& file : files) {
      const std::string name = files.size() == 1 ? device_.name + ".ptp4l.conf"
                                                 : fmt::format("{}.domain{}.ptp4l.conf", device_.name, file.domain);
      text_ += "#   ptp4l -f " + json::shell_word(json::file_name(name));
      for (const DevicePort& port : device_.ports) text_ += " -i " + port.interface;
      text_ += "\n";
      exported_.files.push_back({name, file.content});
    }
    if (!device_.ports.empty() && !in_software)
      text_ += fmt::format("#   phc2sys -s {} -c CLOCK_REALTIME -w --transportSpecific=1\n",
                           device_.ports.front().interface);
  }

  const scenario::Resolved& r_;
  bool request_has_names_;
  const Settings& settings_;
  const Device& device_;
  Exported& exported_;
  LimitsOfLinux& limits_;
  std::string text_;
};

/// What is written is read back and checked as any other set of commands.
void check_own(const OutputFile& script, const Device& device, Exported& exported) {
  json::Diagnostics diagnostics;
  linux_tc::Machine machine;
  linux_tc::read_script(script.content, script.name, machine, diagnostics);
  linux_tc::CheckOptions options;
  options.classes_may_stay_closed = true;  // as the scenario says it
  for (const DevicePort& port : device.ports)
    machine.interface(port.interface, {script.name, 0, 0, ""}).rate = port.rate.bits_per_second;
  linux_tc::check(machine, options, diagnostics);
  for (const json::Diagnostic& mistake : diagnostics.sorted())
    exported.lose(device.name, "what takt would refuse to read: " + json::to_text(mistake));
}

void report_foreign_features(const scenario::Resolved& resolved, Exported& exported) {
  for (const scenario::ScriptEntry& entry : resolved.scenario.script)
    if (entry.set_gates) exported.lose("script", "gate lists that are set during the run");
}

}  // namespace

const std::span<const SettingInfo> linux_export_settings = linux_export_table;

Exported export_linux(const ExportRequest& request) {
  Exported exported;
  for (const char* const key : {"start", "txtime-delay", "etf-delta"})
    if (!request.settings.number(key, 9'000'000'000'000'000'000ULL))
      exported.mistake = "setting " + std::string(key) + ": found " + json::quote(request.settings[key]) +
                         ", expected a whole number of ns";
  if (request.settings["gates"] == "txtime-assist" &&
      request.settings.number("txtime-delay", 1'000'000'000) <= request.settings.number("etf-delta", 1'000'000'000))
    exported.mistake = "setting txtime-delay: expected more than etf-delta, or launch times come too late";
  if (!exported.mistake.empty()) return exported;
  report_foreign_features(request.resolved, exported);
  LimitsOfLinux limits;
  for (const Device& device : devices_of(request.resolved, request.interfaces)) {
    if (!request.concerns(device.node)) continue;
    ScriptWriter writer(request, device, exported, limits);
    OutputFile script{device.name + ".sh", writer.write(), true};
    check_own(script, device, exported);
    exported.files.push_back(std::move(script));
  }
  for (const auto& [limit, ports] : limits) {
    const auto greatest = std::ranges::max_element(ports, {}, [](const auto& each) { return each.second; });
    std::string where = ports.front().first;
    if (ports.size() > 1)
      where = fmt::format("{} and {} other port{}", greatest->first, ports.size() - 1, ports.size() == 2 ? "" : "s");
    exported.lose(where, fmt::format("{}{} {}", ports.size() > 1 ? "up to " : "", greatest->second, limit));
  }
  exported.files.push_back({std::string(names_file), names_table(request.resolved, request.interfaces)});
  return exported;
}

}  // namespace takt::interchange
