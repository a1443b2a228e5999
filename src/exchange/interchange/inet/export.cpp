// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "interchange/gate_times.hpp"
#include "interchange/inet/inet.hpp"
#include "interchange/ports.hpp"
#include "json/quantity.hpp"
#include "models/egress/gate_control_list.hpp"

namespace takt::interchange {
namespace {

using models::TrafficClass;
using sim::Duration;

bool is_identifier(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !name.empty() && is_letter(name.front()) &&
         std::ranges::all_of(name, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

class InetWriter {
 public:
  InetWriter(const scenario::Resolved& resolved, Exported& exported) : r_(resolved), exported_(exported) {}

  void write() {
    name_nodes();
    for (std::size_t s = 0; s < r_.scenario.streams.size(); ++s) plan_stream(r_.scenario.streams[s], s);
    lose_of_the_whole();
    std::string ini = configuration();
    const std::string ned = network();  // losses of both are known now
    const std::string lost = exported_.losses.empty() ? "" : losses_as_comments(exported_.losses, "# ");
    exported_.files.push_back({network_name() + ".ned", ned});
    exported_.files.push_back(
        {"omnetpp.ini",
         "# takt: scenario " + r_.scenario.name +
             " for INET 4.6 (built with PhysicalLayerWirelessCommon, or credit-based shapers do nothing)\n" + lost +
             ini});
  }

 private:
  void lose(std::string where, std::string what) { exported_.lose(std::move(where), std::move(what)); }

  std::string network_name() const {
    std::string name;
    for (const char c : r_.scenario.name)
      name += is_identifier(std::string(1, c)) || (c >= '0' && c <= '9' && !name.empty()) ? c : '_';
    name[0] = static_cast<char>(name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + 'A' : name[0]);
    return name;
  }

  void name_nodes() {
    std::set<std::string> used = {network_name()};
    for (const models::NodePlan& node : r_.plan.nodes) {
      std::string name;
      for (const char c : node.name)
        name += is_identifier(std::string(1, c)) || (c >= '0' && c <= '9' && !name.empty()) ? c : '_';
      while (!used.insert(name).second) name += "_";
      if (name != node.name) lose(node.name, "its name, which is no identifier of NED: " + name);
      names_.push_back(std::move(name));
    }
    std::vector<std::uint32_t> next(r_.plan.nodes.size(), 0);
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* const end : {&link.a, &link.b}) {
        const std::uint32_t index = next[end->node.value]++;
        if (index != end->port)
          lose(r_.plan.nodes[end->node.value].name, "numbers of ports, which follow the order of links in NED");
        eth_[{end->node.value, end->port}] = index;
      }
  }

  std::string network() const {
    std::string text =
        "import inet.networks.base.TsnNetworkBase;\nimport inet.node.ethernet.EthernetLink;\nimport "
        "inet.node.tsn.TsnDevice;\nimport inet.node.tsn.TsnSwitch;\n\n";
    text += fmt::format("// takt: scenario {}\nnetwork {} extends TsnNetworkBase\n{{\n    submodules:\n",
                        r_.scenario.name, network_name());
    for (std::size_t n = 0; n < names_.size(); ++n)
      text += fmt::format("        {}: {};\n", names_[n],
                          r_.plan.nodes[n].kind == models::NodeKind::host ? "TsnDevice" : "TsnSwitch");
    text += "    connections:\n";
    for (const models::LinkPlan& link : r_.plan.links) {
      // A length where it gives the delay exactly (5 ps for a millimetre), else the delay.
      const std::int64_t ps = link.delay.ps();
      const std::string medium =
          ps % 5 == 0 ? fmt::format("length = {}.{:03}m;", ps / 5000, ps / 5 % 1000) : fmt::format("delay = {}ps;", ps);
      text += fmt::format("        {}.ethg++ <--> EthernetLink {{ datarate = {}bps; {} }} <--> {}.ethg++;\n",
                          names_[link.a.node.value], link.rate.bits_per_second, medium, names_[link.b.node.value]);
    }
    return text + "}\n";
  }

  static std::string time(Duration duration) {
    return duration.ps() % 1000 == 0 ? fmt::format("{}ns", duration.ps() / 1000) : fmt::format("{}ps", duration.ps());
  }

  struct App {
    std::string name;        ///< of the stream
    std::uint32_t port = 0;  ///< UDP
    std::uint32_t length = 0;
    std::string interval;
    Duration offset;
    std::uint32_t to = 0;
  };
  struct Marking {
    std::string name;
    std::uint32_t port = 0;
    std::optional<models::Priority> pcp;
    models::VlanId vlan = 0;
  };

  void plan_stream(const scenario::Stream& stream, std::size_t number) {
    const std::string where = "stream " + stream.name;
    const auto from = r_.topology.find(stream.from);
    const auto to = r_.topology.find(stream.to.names.front());
    if (stream.to.names.size() != 1 || !from || !to) return lose(where, "several listeners: groups are not written");
    if (stream.encapsulation != scenario::Encapsulation::udp) return lose(where, "frames without UDP");
    if (stream.normal || stream.trace) return lose(where, "times of a trace or a normal distribution");
    if (stream.jitter > Duration()) lose(where, "jitter of its production");
    if (stream.launch) lose(where, "launch times");
    if (stream.until) lose(where, "its end");
    if (std::ranges::any_of(r_.plan.talker_ats, [&](const models::TalkerAtsPlan& shaped) {
          return r_.plan.streams[shaped.stream.value].name == stream.name;
        }))
      lose(where, "its ATS scheduler at the talker");
    if (stream.host_priority) lose(where, "a priority in the host that is not on the wire");
    if (stream.path) lose(where, "its path: INET takes the shortest");
    const std::uint32_t port = 5000 + static_cast<std::uint32_t>(number);
    const Duration offset = stream.offset ? stream.offset->value : Duration();
    App app{stream.name, port, stream.payload.count, "", offset, *to};
    if (stream.every) {
      app.interval = time(*stream.every);
      sources_[*from].push_back(app);
    } else if (stream.exponential) {
      lose(where, "the sequence of its random gaps");
      app.interval = "exponential(" + time(stream.exponential->mean) + ")";
      sources_[*from].push_back(app);
    } else if (stream.burst) {
      app.interval = time(stream.burst->every);
      for (std::uint32_t i = 0; i < stream.burst->frames; ++i) {
        sources_[*from].push_back(app);
        app.offset += stream.burst->spacing;
      }
    }
    sinks_[*to].insert(port);
    if (stream.pcp) markings_[*from].push_back({stream.name, port, stream.pcp, stream.vlan});
    if (stream.redundancy) plan_redundancy(stream, port);
  }

  void plan_redundancy(const scenario::Stream& stream, std::uint32_t port) {
    lose("stream " + stream.name,
         "where its numbers begin: INET numbers at the talker, so that the first cable has 6 octets more, and keeps "
         "the tag behind the merge");
    for (const scenario::ResolvedRedundancy& redundancy : r_.redundancies) {
      if (r_.plan.streams[redundancy.stream.value].name != stream.name) continue;
      if (redundancy.is_ladder())
        return lose("stream " + stream.name, "the links of its ladder: trees do not meet again");
      const scenario::ResolvedStream& resolved = r_.streams[redundancy.stream.value];
      std::string trees;
      for (const scenario::Path& path : resolved.paths) {
        std::string nodes;
        for (const std::uint32_t node : path) nodes += (nodes.empty() ? "\"" : ", \"") + names_[node] + "\"";
        trees += (trees.empty() ? "[[" : ", [[") + nodes + "]]";
      }
      redundancies_ += fmt::format(
          "{}\n    {{name: \"{}\", packetFilter: expr(udp.destPort == {}), source: \"{}\", destination: \"{}\", pcp: "
          "{}, trees: [{}]}}",
          redundancies_.empty() ? "" : ",", stream.name, port,
          names_[r_.plan.streams[redundancy.stream.value].talker.value], names_[resolved.paths.front().back()],
          stream.pcp.value_or(0), trees);
      std::erase_if(markings_[r_.plan.streams[redundancy.stream.value].talker.value],
                    [&](const Marking& each) { return each.name == stream.name; });
    }
  }

  void lose_of_the_whole() {
    const scenario::Scenario& s = r_.scenario;
    for (const scenario::Program& program : s.programs) lose("program " + program.name, "programs, and what they send");
    for (const scenario::Application& application : s.applications)
      lose("application " + application.name, "applications and their topics");
    if (!s.gateways.empty()) lose("gateways", "gateways");
    if (!s.faults.empty()) lose("faults", "faults");
    if (!s.script.empty()) lose("script", "what is done during the run");
    if (s.rerouting) lose("rerouting", "rerouting");
    if (!(s.clocks == scenario::Clocks{})) lose("clocks", "clocks and gPTP");
    for (const scenario::TopologyNode& node : r_.topology.nodes)
      if (const scenario::EndStation* const station = scenario::end_station_of(node.description)) {
        if (!(station->os == scenario::OperatingSystem{})) lose(node.name, "the times of its operating system");
        if (station->cpu) lose(node.name, "its processor");
      }
    for (std::size_t n = 0; n < r_.plan.nodes.size(); ++n) {
      const models::NodePlan& node = r_.plan.nodes[n];
      if (node.kind == models::NodeKind::station) lose(node.name, "an end station with a bridge of its own");
      if (node.forwarding_jitter) lose(node.name, "jitter of forwarding");
      if (node.ingress) lose_of_ingress(node, r_.plan.ingress_configs[*node.ingress]);
    }
  }

  void lose_of_ingress(const models::NodePlan& node, const models::IngressConfig& ingress) {
    if (!ingress.stream_filters.empty()) lose(node.name, "policing, stream gates and ATS");
  }

  std::string configuration() {
    std::string ini =
        fmt::format("[General]\nnetwork = {}\nsim-time-limit = {}\n", network_name(), time(r_.scenario.duration));
    if (r_.scenario.seed < 1u << 31) ini += fmt::format("seed-set = {}\n", r_.scenario.seed);
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* const end : {&link.a, &link.b})
        ini += fmt::format("*.{}.eth[{}].bitrate = {}bps\n", names_[end->node.value],
                           eth_[{end->node.value, end->port}], link.rate.bits_per_second);
    write_traffic(ini);
    if (!redundancies_.empty())
      ini +=
          "\n*.*.hasStreamRedundancy = true\n*.streamRedundancyConfigurator.typename = "
          "\"StreamRedundancyConfigurator\"\n*.streamRedundancyConfigurator.configuration = [" +
          redundancies_ + "]\n";
    const bool has_priorities = std::ranges::any_of(
        r_.plan.streams, [](const models::StreamPlan& stream) { return stream.priority.has_value(); });
    for (const Device& device : devices_of(r_)) {
      ini += "\n";
      const models::NodePlan& node = r_.plan.nodes[device.node];
      if (node.forwards() && node.forwarding_delay > Duration())
        ini += fmt::format(
            "*.{0}.bridging.directionReverser.delayer.typename = "
            "\"PacketDelayer\"\n*.{0}.bridging.directionReverser.delayer.delay = {1}\n",
            names_[device.node], time(node.forwarding_delay));
      const bool is_plain = std::ranges::all_of(
          device.ports, [](const DevicePort& port) { return *port.config == models::PortConfig{}; });
      if (!is_plain || has_priorities) ini += fmt::format("*.{}.hasEgressTrafficShaping = true\n", names_[device.node]);
      for (const DevicePort& port : device.ports) write_port(device, port, ini);
    }
    return ini;
  }

  void write_traffic(std::string& ini) {
    for (std::uint32_t n = 0; n < names_.size(); ++n) {
      const auto& sources = sources_[n];
      const auto& sinks = sinks_[n];
      if (sources.empty() && sinks.empty()) continue;
      ini += fmt::format("\n*.{}.numApps = {}\n", names_[n], sources.size() + sinks.size());
      std::size_t i = 0;
      for (const App& app : sources) {
        const std::string prefix = fmt::format("*.{}.app[{}].", names_[n], i++);
        ini += fmt::format(
            "# stream {}\n{}typename = \"UdpSourceApp\"\n{}source.packetLength = {}B\n{}source.productionInterval = "
            "{}\n{}source.initialProductionOffset = {}\n{}io.destAddress = \"{}\"\n{}io.destPort = {}\n",
            app.name, prefix, prefix, app.length, prefix, app.interval, prefix, time(app.offset), prefix,
            names_[app.to], prefix, app.port);
      }
      for (const std::uint32_t port : sinks) {
        const std::string prefix = fmt::format("*.{}.app[{}].", names_[n], i++);
        ini += fmt::format("{}typename = \"UdpSinkApp\"\n{}io.localPort = {}\n", prefix, prefix, port);
      }
      if (!sinks.empty()) ini += fmt::format("*.{}.hasIncomingStreams = true\n", names_[n]);
      if (markings_[n].empty()) continue;
      ini += fmt::format("*.{}.hasOutgoingStreams = true\n", names_[n]);
      std::string filters, tags;
      for (const Marking& marking : markings_[n]) {
        filters += fmt::format("{}{{stream: \"{}\", packetFilter: expr(udp.destPort == {})}}",
                               filters.empty() ? "" : ", ", marking.name, marking.port);
        tags += fmt::format("{}{{stream: \"{}\", pcp: {}{}}}", tags.empty() ? "" : ", ", marking.name, *marking.pcp,
                            marking.vlan == 0 ? "" : fmt::format(", vlan: {}", marking.vlan));
      }
      ini += fmt::format(
          "*.{}.bridging.streamIdentifier.identifier.mapping = [{}]\n*.{}.bridging.streamCoder.encoder.mapping = "
          "[{}]\n",
          names_[n], filters, names_[n], tags);
    }
  }

  void write_port(const Device& device, const DevicePort& port, std::string& ini) {
    const models::PortConfig& config = *port.config;
    const std::string where = device.name + " to " + port.peer_name;
    const std::string queue =
        fmt::format("*.{}.eth[{}].macLayer.queue.", names_[device.node], eth_[{device.node, port.port}]);
    if (config.cut_through != 0) lose(where, "cut-through of single classes");
    if (config.preemption) lose(where, "preemption: INET has two MACs and no eight classes above them");
    if (config.untagged) lose(where, "frames that leave without tag");
    const bool has_untagged =
        std::ranges::any_of(r_.plan.streams, [](const models::StreamPlan& stream) { return !stream.priority; });
    const bool differs =
        config.shaping.gates &&
        std::ranges::any_of(config.shaping.gates->admin_control_list, [](const models::GateControlEntry& entry) {
          return (entry.gate_states & 1) != (entry.gate_states >> 1 & 1);
        });
    if (has_untagged && config.traffic_class_of_priority[0] != 0 &&
        (differs || !(config.shaping.selection[0] == config.shaping.selection[1])))
      lose(where, "the class of untagged frames, which INET puts into queue 0");
    if (config.traffic_class_of_priority != models::standard_traffic_classes) {
      std::string rows;
      for (const TrafficClass q : config.traffic_class_of_priority)
        rows +=
            fmt::format("{}[{}]", rows.empty() ? "" : ", ", fmt::format("{0}, {0}, {0}, {0}, {0}, {0}, {0}, {0}", q));
      ini += queue + "classifier.mapping = [" + rows + "]\n";
    }
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      const models::QueueLimit& limit = config.queue_limits[q];
      if (limit.drops_oldest) lose(where, "queues that drop the oldest frame");
      if (limit.frames != 0xFFFF'FFFF) ini += fmt::format("{}queue[{}].packetCapacity = {}\n", queue, q, limit.frames);
      if (limit.octets != 0xFFFF'FFFF) ini += fmt::format("{}queue[{}].dataCapacity = {}B\n", queue, q, limit.octets);
      if (config.shaping.queue_max_sdu[q].count != 0) lose(where, "the longest SDU of a class");
      if (config.shaping.is_shared(q)) lose(where, "shares of bandwidth (ETS)");
      if (std::holds_alternative<models::TimeBased>(config.shaping.selection[q]) &&
          device.kind != models::NodeKind::host)
        lose(where, "ATS");
      if (const models::CreditBased* const shaper = config.shaping.shaper_of(q))
        write_shaper(where, queue, q, *shaper, config.shaping, ini);
    }
    if (config.shaping.gates && !config.shaping.gates->admin_control_list.empty())
      write_gates(where, queue, config, ini);
  }

  /// INET's slope is that of the open window.
  void write_shaper(const std::string& where, const std::string& queue, TrafficClass q,
                    const models::CreditBased& shaper, const models::ShapingConfig& shaping, std::string& ini) {
    sim::int128 slope = shaper.idle_slope.bits_per_second;
    if (shaper.of_whole_cycle && shaping.gates && !shaping.gates->admin_control_list.empty()) {
      const models::OpenShare share =
          models::GateControlList(shaping.gates->admin_control_list, shaping.gates->admin_cycle_time).open_share(q);
      if (share.open.ps() == 0 || slope * share.cycle.ps() % share.open.ps() != 0)
        lose(where, fmt::format("the idle slope of class {} over the whole cycle", q));
      if (share.open.ps() != 0) slope = slope * share.cycle.ps() / share.open.ps();
    }
    ini += fmt::format(
        "{0}transmissionSelectionAlgorithm[{1}].typename = "
        "\"Ieee8021qCreditBasedShaper\"\n{0}transmissionSelectionAlgorithm[{1}].idleSlope = {2}bps\n",
        queue, q, static_cast<std::uint64_t>(slope));
  }

  /// Each class has its own list of durations, toggled in a circle.
  void write_gates(const std::string& where, const std::string& queue, const models::PortConfig& config,
                   std::string& ini) {
    DeviceGates gates = device_gates(*config.shaping.gates);
    if (gates.base > Duration()) {
      lose(where, "that gates are open before their first cycle: in INET the list is in force from 0 on");
      const Duration within = gates.base % gates.cycle;
      if (within > Duration()) gates.entries = rotated(gates.entries, gates.cycle - within);
    }
    for (TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      const auto is_open = [&](const models::GateControlEntry& entry) {
        return models::contains(entry.gate_states, q);
      };
      const std::string gate = fmt::format("{}transmissionGate[{}].", queue, q);
      const bool first = is_open(gates.entries.front());
      if (std::ranges::all_of(gates.entries, [&](const auto& entry) { return is_open(entry) == first; })) {
        ini += fmt::format("{}initiallyOpen = {}\n{}durations = []\n", gate, first, gate);
        continue;
      }
      // In a circle: begin where the state changes, and say how far that is before 0.
      std::vector<std::pair<bool, Duration>> runs;
      for (const models::GateControlEntry& entry : gates.entries) {
        if (!runs.empty() && runs.back().first == is_open(entry))
          runs.back().second += entry.interval;
        else
          runs.emplace_back(is_open(entry), entry.interval);
      }
      Duration offset;
      if (runs.front().first == runs.back().first) {  // the run at 0 began at the end of the cycle
        offset = runs.back().second;
        runs.front().second += offset;
        runs.pop_back();
      }
      std::string durations;
      for (const auto& [open, length] : runs) durations += (durations.empty() ? "" : ", ") + time(length);
      ini += fmt::format("{0}initiallyOpen = {1}\n{0}durations = [{2}]\n", gate, runs.front().first, durations);
      if (offset > Duration()) ini += fmt::format("{}offset = {}\n", gate, time(offset));
    }
  }

  const scenario::Resolved& r_;
  Exported& exported_;
  std::vector<std::string> names_;
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> eth_;
  std::map<std::uint32_t, std::vector<App>> sources_;
  std::map<std::uint32_t, std::set<std::uint32_t>> sinks_;
  std::map<std::uint32_t, std::vector<Marking>> markings_;
  std::string redundancies_;
};

}  // namespace

Exported export_inet(const ExportRequest& request) {
  Exported exported;
  InetWriter(request.resolved, exported).write();
  return exported;
}

}  // namespace takt::interchange
