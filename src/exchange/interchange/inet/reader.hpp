// SPDX-License-Identifier: Apache-2.0
// The reader of INET's networks: values and nodes (import.cpp), sources and streams (streams.cpp), ports, gates and
// filters (ports.cpp), clocks (clocks.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "interchange/inet/expression.hpp"
#include "interchange/inet/ini.hpp"
#include "interchange/inet/ned_network.hpp"
#include "json/quantity.hpp"

namespace takt::interchange::inet {

using sim::Duration;

/// Modules of INET that are no nodes: they configure, draw or write.
inline bool is_no_node(const std::string& type) {
  return type.ends_with("Configurator") || type.ends_with("Visualizer") || type == "PcapRecorder" ||
         type == "CanvasRecorder";
}

class InetReader {
 public:
  InetReader(const ImportRequest& request, Imported& imported, json::Diagnostics& diagnostics)
      : request_(request), imported_(imported), diagnostics_(diagnostics) {}

  void run() {
    std::vector<NedType> types;
    const auto run = request_.settings.number("run", 1'000'000);
    if (!run) return error({"", 0, 0, ""}, "setting run", json::quote(request_.settings["run"]), "the number of a run");
    for (const InputFile& file : request_.files) {
      if (file.name.ends_with(".ned")) {
        for (NedType& type : read_ned(file, diagnostics_)) types.push_back(std::move(type));
      } else if (file.name.ends_with(".ini")) {
        ini_.read(file, request_.settings["config"], *run, imported_.remarks, diagnostics_);
      } else {
        diagnostics_.error({file.name, 0, 0, ""}, "a file of unknown kind",
                           {json::quote(file.name), "a name that ends with .ned or .ini"});
      }
    }
    if (diagnostics_.has_errors()) return;
    if (!choose(types)) return;
    read_general();
    read_nodes();
    read_links();
    if (diagnostics_.has_errors()) return;
    read_redundancy();
    for (const Submodule& node : network_.submodules)
      if (!is_no_node(node.type)) read_sources(node);
    for (const Submodule& node : network_.submodules)
      if (!is_no_node(node.type)) read_node(node);
    // In the order of their ports, which is that of the file if takt wrote it.
    std::ranges::stable_sort(scenario_.streams, {},
                             [&](const scenario::Stream& stream) { return port_of_stream_[stream.name]; });
    add_redundant();
    end_clocks();
    read_schedule();
    refuse_the_rest();
    if (!diagnostics_.has_errors()) imported_.scenario = std::move(scenario_);
  }

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)});
  }

  bool choose(const std::vector<NedType>& types) {
    const IniLine* const name = ini_.find_global("network");
    std::string wanted = name == nullptr ? "" : name->value;
    if (wanted.starts_with('"') && wanted.size() > 1) wanted = wanted.substr(1, wanted.size() - 2);
    wanted = wanted.substr(wanted.rfind('.') == std::string::npos ? 0 : wanted.rfind('.') + 1);
    const auto is_network = [](const NedType& each) { return each.kind == NedType::Kind::network; };
    if (name == nullptr && std::ranges::count_if(types, is_network) == 1)
      wanted = std::ranges::find_if(types, is_network)->name;
    auto network = network_of(types, wanted, ini_, diagnostics_);
    if (!network) {
      if (diagnostics_.has_errors()) return false;
      error(name == nullptr ? json::Place{request_.files.front().name, 0, 0, ""} : name->place, "no network",
            name == nullptr
                ? "no \"network =\" and " + std::to_string(std::ranges::count_if(types, is_network)) + " networks"
                : json::quote(wanted),
            "a network of the NED files");
      return false;
    }
    network_ = std::move(*network);
    scenario_.name = network_.name;
    return true;
  }

  // Values.
  static constexpr sim::int128 ps_per_second = 1'000'000'000'000;
  /// An expression, in which parameters of the network may stand.
  std::optional<Value> worked_out(const std::string& text) {
    return evaluate(text, [&](const std::string& name) -> std::optional<Value> {
      const IniLine* const found = line(name);
      return found == nullptr || found->value == text ? std::nullopt : evaluate(found->value);
    });
  }
  std::optional<sim::Octets> octets(const std::string& value, const json::Place& place) {
    const auto parsed = worked_out(value);
    if (parsed && parsed->unit == Unit::octet && parsed->amount >= 0 && parsed->amount % ps_per_second == 0 &&
        parsed->amount / ps_per_second <= 0xFFFF'FFFF)
      return sim::Octets{static_cast<std::uint32_t>(parsed->amount / ps_per_second)};
    error(place, "not a length that is read", json::quote(value), "octets, such as 100B");
    return std::nullopt;
  }
  const IniLine* line(const std::string& path) { return ini_.find(network_.name + "." + path); }
  std::optional<std::string> text(const std::string& path) {
    const IniLine* const found = line(path);
    if (found == nullptr) return std::nullopt;
    if (const auto value = worked_out(found->value); value && value->kind == Value::Kind::text) return value->text;
    error(found->place, "not a text", found->value, "a text in quotes");
    return std::nullopt;
  }
  bool truth(const std::string& path, bool otherwise = false) {
    const IniLine* const found = line(path);
    if (found == nullptr) return otherwise;
    const auto value = worked_out(found->value);
    if (value && value->kind == Value::Kind::truth) return value->truth;
    error(found->place, "not a truth value", json::quote(found->value), "true or false");
    return otherwise;
  }
  std::optional<std::uint64_t> number(const std::string& path, std::uint64_t most) {
    const IniLine* const found = line(path);
    if (found == nullptr) return std::nullopt;
    const auto value = worked_out(found->value);
    const auto whole = value ? value->whole() : std::nullopt;
    if (whole && *whole >= 0 && static_cast<std::uint64_t>(*whole) <= most) return static_cast<std::uint64_t>(*whole);
    error(found->place, "not a number that fits", json::quote(found->value),
          "a whole number up to " + std::to_string(most));
    return std::nullopt;
  }
  std::optional<Duration> duration(const std::string& value, const json::Place& place) {
    const auto parsed = worked_out(value);
    if (parsed && parsed->kind == Value::Kind::number && parsed->unit == Unit::second &&
        parsed->amount <= std::numeric_limits<std::int64_t>::max())
      return Duration::from_ps(static_cast<std::int64_t>(parsed->amount));
    error(place, "not a time that is read", json::quote(value), "a number with a unit, such as 500us");
    return std::nullopt;
  }
  std::optional<Duration> duration(const std::string& path) {
    const IniLine* const found = line(path);
    return found == nullptr ? std::nullopt : duration(found->value, found->place);
  }
  std::optional<sim::DataRate> rate(const std::string& value, const json::Place& place) {
    const auto parsed = worked_out(value);
    if (parsed && parsed->unit == Unit::bit_per_second && parsed->amount > 0 && parsed->amount % ps_per_second == 0)
      return sim::DataRate{static_cast<std::uint64_t>(parsed->amount / ps_per_second)};
    error(place, "not a rate that is read", json::quote(value), "a number with a unit, such as 100Mbps");
    return std::nullopt;
  }
  std::optional<json::Node> value(const std::string& path, json::Kind kind, const char* expected) {
    const IniLine* const found = line(path);
    if (found == nullptr) return std::nullopt;
    auto parsed = parse_value(found->value);
    if (parsed && parsed->kind == kind) return parsed;
    error(found->place, "not what is read", json::quote(found->value), expected);
    return std::nullopt;
  }

  void read_general() {
    const IniLine* const limit = ini_.find_global("sim-time-limit");
    scenario_.duration = Duration::from_ps(100'000'000'000);
    if (limit != nullptr)
      scenario_.duration = duration(limit->value, limit->place).value_or(scenario_.duration);
    else
      imported_.remark(RemarkKind::odd, network_.place, "no sim-time-limit: 100 ms");
    if (const IniLine* const seed = ini_.find_global("seed-set")) {
      std::uint64_t number = 0;
      const auto [stop, failed] = std::from_chars(seed->value.data(), seed->value.data() + seed->value.size(), number);
      if (failed == std::errc() && stop == seed->value.data() + seed->value.size() && number < 1u << 31)
        scenario_.seed = number;
      else
        imported_.remark(RemarkKind::ignored, seed->place, "seed-set, which is no number");
    }
  }

  void read_nodes() {
    for (const Submodule& node : network_.submodules) {
      if (is_no_node(node.type)) continue;
      if (node.type == "ScenarioManager") {
        if (line(node.name + ".script") != nullptr)
          imported_.remark(RemarkKind::lost, node.place,
                           "what a ScenarioManager changes during the run: write it as \"faults\" and \"script\"");
        continue;
      }
      if (node.type == "TsnDevice" || node.type == "StandardHost" || node.type == "TsnClock")
        scenario_.network.nodes.emplace_back(node.name, scenario::Node(scenario::HostNode{}));
      else if (node.type == "TsnSwitch" || node.type == "EthernetSwitch")
        scenario_.network.nodes.emplace_back(node.name, scenario::Node(scenario::SwitchNode{}));
      else
        error(node.place, "a type of node that is not read", json::quote(node.type),
              "TsnDevice, TsnSwitch, TsnClock, StandardHost or EthernetSwitch");
    }
  }

  std::optional<sim::DataRate> rate_of_end(const std::string& node, std::uint32_t eth) {
    const IniLine* const found = line(node + ".eth[" + std::to_string(eth) + "].bitrate");
    return found == nullptr ? std::nullopt : rate(found->value, found->place);
  }

  void read_links() {
    for (const Connection& each : network_.connections) {
      scenario::Link link;
      for (const std::string* const end : {&each.a, &each.b})
        if (std::ranges::none_of(network_.submodules, [&](const Submodule& node) { return node.name == *end; }))
          error(each.place, "an end that is no submodule", json::quote(*end), "a submodule of the network");
      link.ends = {each.a + ":" + std::to_string(each.a_eth), each.b + ":" + std::to_string(each.b_eth)};
      ports_[each.a][each.a_eth] = each.b;
      ports_[each.b][each.b_eth] = each.a;
      std::optional<sim::DataRate> chosen;
      const std::map<std::string, std::uint64_t> channels = {{"Eth10M", 10'000'000},     {"Eth100M", 100'000'000},
                                                             {"Eth1G", 1'000'000'000},   {"Eth10G", 10'000'000'000},
                                                             {"Eth40G", 40'000'000'000}, {"Eth100G", 100'000'000'000}};
      if (const auto channel = channels.find(each.channel); channel != channels.end())
        chosen = sim::DataRate{channel->second};
      else if (each.channel != "EthernetLink" && !each.channel.empty())
        error(each.place, "a channel that is not read", json::quote(each.channel),
              "EthernetLink, Eth100M, Eth1G and the like");
      if (each.datarate) chosen = rate(*each.datarate, each.place);
      for (const auto& [node, eth] : {std::pair(each.a, each.a_eth), std::pair(each.b, each.b_eth)}) {
        const auto own = rate_of_end(node, eth);
        if (own && chosen && !(*own == *chosen))
          error(each.place, "two rates of one link",
                json::to_text(*own) + " at " + node + ", " + json::to_text(*chosen) + " elsewhere",
                "the same bitrate at both ends, and as datarate");
        if (own) chosen = own;
      }
      if (!chosen) {
        error(each.place, "a link without a rate", each.a + " to " + each.b,
              "datarate, or *.*.eth[*].bitrate in the ini file");
        continue;
      }
      link.rate = *chosen;
      if (each.delay)
        link.delay = duration(*each.delay, each.place);
      else if (each.length) {
        const auto parsed = worked_out(*each.length);
        if (parsed && parsed->unit == Unit::metre && parsed->amount >= 0 && parsed->amount % 1'000'000'000 == 0)
          link.length = sim::Length{static_cast<std::int64_t>(parsed->amount / 1'000'000'000)};
        else
          error(each.place, "not a length that is read", json::quote(*each.length),
                "a number with a unit, such as 10m");
      }
      scenario_.network.links.push_back(std::move(link));
    }
  }

  void read_clock(const Submodule& node);
  std::optional<std::vector<scenario::GptpPortRole>> roles_of(const Submodule& node, const std::string& prefix);
  void read_oscillator(const Submodule& node, bool counts);
  void end_clocks();
  void read_schedule();
  void read_sources(const Submodule& node) {
    const auto found = std::ranges::find(scenario_.network.nodes, node.name,
                                         [](const auto& each) -> const std::string& { return each.first; });
    if (found != scenario_.network.nodes.end() && std::holds_alternative<scenario::HostNode>(found->second))
      read_apps(node);
  }

  void read_node(const Submodule& node) {
    auto found = std::ranges::find(scenario_.network.nodes, node.name,
                                   [](const auto& each) -> const std::string& { return each.first; });
    if (found == scenario_.network.nodes.end()) return;
    const bool is_shaped = truth(node.name + ".hasEgressTrafficShaping");
    read_clock(node);
    truth(node.name + ".hasStreamRedundancy");
    truth(node.name + ".hasIncomingStreams");
    if (scenario::relay_of(found->second) != nullptr) {
      truth(node.name + ".hasOutgoingStreams");
      line(node.name + ".bridging.streamCoder.encoder.mapping");
    }
    value(node.name + ".bridging.streamCoder.decoder.mapping", json::Kind::array,
          "[{pcp: N, stream: \"s\"}, ..]");  // takt's streams keep their names
    if (scenario::Relay* const relay = scenario::relay_of(found->second)) {
      const auto type = text(node.name + ".bridging.directionReverser.delayer.typename");
      const auto delay = duration(node.name + ".bridging.directionReverser.delayer.delay");
      if (type && *type == "PacketDelayer" && delay)
        relay->forwarding_delay = *delay;
      else if (type)
        error(line(node.name + ".bridging.directionReverser.delayer.typename")->place, "a delayer that is not read",
              json::quote(*type), "PacketDelayer with a delay");
    }
    if (scenario::Relay* const relay = scenario::relay_of(found->second);
        relay != nullptr && truth(node.name + ".hasIngressTrafficFiltering"))
      read_filters(node, *relay);
    for (const auto& [eth, peer] : ports_[node.name])
      read_port(node, eth, peer, is_shaped, scenario::ports_of(found->second));
  }

  /// Meters by streams: token buckets that drop, or those of asynchronous shaping.
  void read_filters(const Submodule& node, scenario::Relay& relay);

  struct App {
    std::uint64_t port = 0;
    std::string to;
    std::uint32_t length = 0;
    Duration interval, offset;
    bool is_exponential = false;
    json::Place place;
  };

  void read_apps(const Submodule& node);

  /// Which stream the frames to a port are, and what tag they get.
  void add_streams(const Submodule& node, std::vector<App>& apps);

  std::string unique(const std::string& name) const;

  /// expr(udp.destPort == 5000)
  static std::optional<std::uint64_t> port_of_filter(std::string filter);

  struct Redundant {
    std::string name;
    std::optional<std::uint8_t> pcp;
    scenario::Redundancy redundancy;
  };

  void read_redundancy();
  void add_redundant();

  void read_port(const Submodule& node, std::uint32_t eth, const std::string& peer, bool is_shaped,
                 scenario::NodePorts& ports);

  /// The priorities of a class, of so many, as classes of takt, which has one for each priority.
  static std::vector<std::uint8_t> classes_of(std::size_t q, std::size_t count);
  /// Of a class with several priorities that which streams have; one credit for several queues does not exist.
  std::optional<std::uint8_t> class_of(std::size_t q, std::size_t count, const json::Place& place);

  void read_map(const std::string& queue, scenario::NodePorts& ports);

  void read_limits(const std::string& queue, std::uint8_t q, scenario::NodePorts& ports);

  /// One list for a port of eight: the least common cycle, and an entry at each change; the lists are in force from 0
  /// on.
  void read_gates(const std::string& queue, std::size_t count, scenario::Egress& egress);

  void refuse_the_rest() {
    constexpr std::string_view of_no_account[] = {
        "record", "isualiz",  "display",          "description",        "result-dir",  "cmdenv",
        "qtenv",  "vector",   "scalar",           "statistic",          "debug",       "eventlog",
        "print",  "abstract", "packetNameFormat", "simtime-resolution", "clockModule", "interfaceName"};
    for (const IniLine& each : ini_.lines()) {
      if (each.is_used) continue;
      if (each.is_of_ned) {
        imported_.remark(RemarkKind::ignored, each.place, each.key);
        continue;
      }
      if (std::ranges::any_of(of_no_account,
                              [&](std::string_view word) { return each.key.find(word) != std::string::npos; }))
        imported_.remark(RemarkKind::ignored, each.place, each.key);
      else
        error(each.place, "a setting that is not understood, or matches nothing", json::quote(each.key),
              "what docs/interchange.md lists");
    }
  }

  const ImportRequest& request_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  Ini ini_;
  Network network_;
  scenario::Scenario scenario_;
  std::map<std::string, std::map<std::uint32_t, std::string>>
      ports_;                                              // by node: its interfaces and the neighbours at them
  std::set<std::string> synchronised_;                     // nodes with gPTP
  std::map<std::string, std::string> identity_of_stream_;  // what INET calls it
  std::map<std::string, std::uint64_t> port_of_stream_;
  std::map<std::uint64_t, Redundant> redundant_;  // by UDP port
};

}  // namespace takt::interchange::inet
