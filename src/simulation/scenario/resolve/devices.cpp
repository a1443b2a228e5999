// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/devices.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "scenario/resolve/device_delays.hpp"

namespace takt::scenario {
namespace {

/// What says "device": a node, or a generator.
struct NamesDevice {
  std::optional<std::string>* device = nullptr;
  DeviceType* type = nullptr;
  const json::Source* where = nullptr;
  std::string name;                    ///< for diagnostics
  std::vector<DevicePort> ports = {};  ///< different ones
};

class DeviceReader {
 public:
  DeviceReader(Scenario& scenario, json::Diagnostics& diagnostics) : scenario_(scenario), diagnostics_(diagnostics) {}

  void run() {
    NetworkSection& network = scenario_.network;
    for (auto& [name, node] : network.nodes) {
      NodePorts& ports = ports_of(node);
      if (!ports.device) continue;
      const json::Source where = source_of(node);
      const NamesDevice named{&ports.device, &ports.type, &where, json::quote(name), ports_at(name)};
      const Device* const device = read(named);
      if (device == nullptr) continue;
      lower_ports(*device, where, ports);
      if (Relay* const relay = relay_of(node)) {
        const Octets mtu = ports.mtu.value_or(network.mtu);
        lower_delays(*device, named, mtu, relay->forwarding_delay, relay->forwarding_jitter);
      }
    }
    for (Generator& generator : network.generate) {
      if (!generator.device) continue;
      NamesDevice named{&generator.device, &generator.type, &generator.where, "the generator", {{generator.rate}}};
      if (generator.host_rate && *generator.host_rate != generator.rate) named.ports.push_back({*generator.host_rate});
      const Device* const device = read(named);
      if (device == nullptr) continue;
      lower_ports(*device, generator.where, generator);
      lower_delays(*device, named, generator.mtu.value_or(network.mtu), generator.forwarding_delay,
                   generator.forwarding_jitter);
    }
  }

 private:
  std::vector<DevicePort> ports_at(const std::string& name) {
    if (!knows_ports_) {
      for (const Link& link : scenario_.network.links)
        for (const std::string& end : link.ends) {
          std::vector<DevicePort>& ports = ports_[end.substr(0, end.find(':'))];
          const DevicePort port{rate_of(link), link.medium};
          if (std::ranges::find(ports, port) == ports.end()) ports.push_back(port);
        }
      knows_ports_ = true;
    }
    const auto found = ports_.find(name);
    return found == ports_.end() ? std::vector<DevicePort>() : found->second;
  }

  /// The device of the file, which the node keeps instead of the name; null if there are mistakes in it.
  const Device* read(const NamesDevice& named) {
    const json::Place place = named.where->at("device");
    if (diagnostics_.is_refused(place)) return nullptr;
    std::filesystem::path path(**named.device);
    if (path.is_relative()) path = std::filesystem::path(scenario_.where.place().file).parent_path() / path;
    const auto [known, is_new] = devices_.try_emplace(path.string());
    if (is_new) known->second = read_file(path, place);
    named.type->of = known->second;
    named.device->reset();
    return known->second.get();
  }

  std::shared_ptr<const Device> read_file(const std::filesystem::path& path, const json::Place& place) {
    std::error_code failure;
    std::ifstream file;
    if (std::filesystem::is_regular_file(path, failure)) file.open(path, std::ios::binary);
    if (!file.is_open()) {
      diagnostics_.error(place, "cannot read the device", {json::quote(path.string()), "a file with a type of device"});
      return nullptr;
    }
    std::ostringstream text;
    text << file.rdbuf();
    const auto document = json::parse(text.str(), path.string(), diagnostics_);
    if (!document) return nullptr;
    auto device = std::make_shared<Device>();
    const std::size_t errors_before = diagnostics_.errors();
    json::decode(*document, *device, diagnostics_);
    check(*device);
    return diagnostics_.errors() == errors_before ? device : nullptr;
  }

  void check(const Device& device) {
    const auto check_interval = [&](const json::Source& where, std::string_view key, Duration least,
                                    Duration greatest) {
      if (least > greatest)
        diagnostics_.error(where.at(key), "an interval that ends before it begins",
                           {json::to_text(greatest), "at least " + json::to_text(least)});
    };
    for (const DeviceDelay& delay : device.delays) {
      check_interval(delay.where, "greatest", delay.least, delay.greatest);
      check_interval(delay.where, "greatest_per_octet", delay.least_per_octet, delay.greatest_per_octet);
    }
    if (device.gptp_residence)
      check_interval(device.gptp_residence->where, "greatest", device.gptp_residence->least,
                     device.gptp_residence->greatest);
  }

  /// Of a node or a generator, whose keys are called alike.
  template <class Described>
  static void lower_ports(const Device& device, const json::Source& where, Described& described) {
    const auto lower = [&](const char* key, const auto& said, auto& kept) {
      if (said && !where.has(key)) kept = *said;
    };
    lower("traffic_classes", device.traffic_classes, described.traffic_classes);
    lower("queues", device.queues, described.queues);
    lower("mtu", device.mtu, described.mtu);
    lower("gate_limits", device.gate_limits, described.gate_limits);
    if (device.features.gates == false && !where.has("gates")) described.gates = NoGates::none;
  }

  void lower_delays(const Device& device, const NamesDevice& named, Octets mtu, Duration& delay,
                    std::optional<Latency>& jitter) {
    if (device.delays.empty() || named.where->has("forwarding_delay") || named.where->has("forwarding_jitter")) return;
    std::optional<MissingDelay> missing;
    const auto interval = delays_between(device, named.ports, mtu + Octets{octets_around_msdu}, missing);
    if (missing)
      diagnostics_.error(device.where.at("delays"), "a delay that the device does not say",
                         {"none from " + to_text(missing->from) + " to " + to_text(missing->to) + " at " + named.name,
                          "an entry that holds for these ports, or \"forwarding_delay\" of the node"});
    if (interval) set_delays(*interval, device.delays.front().where, delay, jitter);
  }

  Scenario& scenario_;
  json::Diagnostics& diagnostics_;
  std::map<std::string, std::shared_ptr<const Device>> devices_;  // by path; null: with mistakes
  std::map<std::string, std::vector<DevicePort>, std::less<>> ports_;
  bool knows_ports_ = false;
};

/// What an entry of "egress" or the rest of a node asks for, and whether the device has it.
class FeatureCheck {
 public:
  FeatureCheck(const Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    for (std::uint32_t n = 0; n < r_.topology.nodes.size(); ++n) {
      const TopologyNode& node = r_.topology.nodes[n];
      const NodePorts& ports = ports_of(node.description);
      if (!ports.type.of) continue;
      node_ = &node;
      device_ = ports.type.of.get();
      for (const Egress& egress : ports.egress) check(egress);
      if (const Relay* const relay = relay_of(node.description); relay != nullptr && relay->ingress)
        check(*relay->ingress);
      check_links(n);
      check_gptp();
    }
    for (const ResolvedRedundancy& redundancy : r_.redundancies) check(redundancy);
  }

 private:
  void refuse(const json::Place& place, const std::string& asked, const std::string& expected) {
    if (!told_.insert(place.pointer + asked).second) return;  // generated nodes share theirs
    diagnostics_.error(
        place, "more than the device can",
        {asked + " at " + json::quote(node_->name),
         expected + ", as " + json::quote(device_->name) + " in " + device_->where.place().file + " has it"});
  }
  void refuse_without(const std::optional<bool>& feature, const json::Place& place, const char* what) {
    if (feature == false) refuse(place, what, std::string("no ") + what);
  }

  void check(const Egress& egress) {
    const DeviceFeatures& has = device_->features;
    if (egress.preemption) refuse_without(has.preemption, egress.where.at("preemption"), "frame preemption");
    if (!egress.cut_through.empty()) refuse_without(has.cut_through, egress.where.at("cut_through"), "cut-through");
    if (!egress.shapers.empty())
      refuse_without(has.credit_based_shaper, egress.where.at("shapers"), "credit-based shapers");
    if (!egress.ats.empty()) refuse_without(has.ats, egress.where.at("ats"), "ATS");
    if (!egress.ets.empty()) refuse_without(has.ets, egress.where.at("ets"), "enhanced transmission selection");
  }

  void check(const Ingress& ingress) {
    const DeviceFeatures& has = device_->features;
    if (!ingress.ats.empty()) refuse_without(has.ats, ingress.where.at("ats"), "ATS");
    if (!ingress.gates.empty()) refuse_without(has.policing, ingress.where.at("gates"), "stream gates");
    if (!ingress.meters.empty()) refuse_without(has.policing, ingress.where.at("meters"), "flow meters");
    if (ingress.cqf) refuse_without(has.policing, ingress.where.at("cqf"), "stream gates of cyclic queuing");
    if (ingress.cqf) refuse_without(has.gates, ingress.where.at("cqf"), "transmission gates of cyclic queuing");
  }

  void check_links(std::uint32_t n) {
    const std::size_t count = r_.topology.neighbours[n].size();
    const json::Place place = node_->where.at("device");
    if (device_->ports && count > *device_->ports)
      refuse(place, std::to_string(count) + " links", "at most " + std::to_string(*device_->ports));
    if (device_->rates.empty()) return;
    for (const models::LinkPlan& link : r_.topology.links) {
      if (link.a.node.value != n && link.b.node.value != n) continue;
      if (std::ranges::find(device_->rates, link.rate) != device_->rates.end()) continue;
      std::string rates;
      for (const DataRate rate : device_->rates) rates += (rates.empty() ? "" : ", ") + json::to_text(rate);
      refuse(place, "a link of " + json::to_text(link.rate), "ports of " + rates);
    }
  }

  void check_gptp() {
    const std::optional<Gptp>& gptp = r_.scenario.clocks.gptp;
    if (!gptp || std::ranges::find(gptp->without, node_->name) != gptp->without.end()) return;
    refuse_without(device_->features.gptp, node_->where.at("device"), "gPTP");
  }

  void check(const ResolvedRedundancy& redundancy) {
    std::set<std::uint32_t> nodes = {redundancy.split, redundancy.merge, redundancy.number};
    for (const ResolvedRedundancy::Relay& relay : redundancy.relays) nodes.insert(relay.node);
    for (const std::uint32_t n : nodes) {
      if (n == ResolvedRedundancy::nobody) continue;
      node_ = &r_.topology.nodes[n];
      const DeviceType& type = ports_of(node_->description).type;
      if (!type.of) continue;
      device_ = type.of.get();
      refuse_without(device_->features.frer, redundancy.description->where.place(), "splitting and merging of streams");
    }
  }

  const Resolved& r_;
  json::Diagnostics& diagnostics_;
  const TopologyNode* node_ = nullptr;
  const Device* device_ = nullptr;
  std::set<std::string> told_;
};

/// The greatest latencies of the PHYs at the ports of a node.
DevicePhy phy_of(const Device& device, const Topology& topology, std::uint32_t node) {
  DevicePhy greatest;
  for (const models::LinkPlan& link : topology.links) {
    if (link.a.node.value != node && link.b.node.value != node) continue;
    for (const DevicePhy& phy : device.phys) {
      if (phy.rate ? *phy.rate != link.rate : phy.medium && rate_of(*phy.medium) != link.rate) continue;
      greatest.transmit = std::max(greatest.transmit, phy.transmit);
      greatest.receive = std::max(greatest.receive, phy.receive);
      greatest.variation = std::max(greatest.variation, phy.variation);
    }
  }
  return greatest;
}

}  // namespace

void read_devices(Scenario& scenario, json::Diagnostics& diagnostics) {
  for (Link& link : scenario.network.links) {
    if (!link.medium) continue;
    const DataRate rate = rate_of(link);
    if (rate != rate_of(*link.medium))
      diagnostics.error(link.where.at("rate"), "a rate that the medium does not have",
                        {json::to_text(rate) + " over " + std::string(spelling(*link.medium)),
                         json::to_text(rate_of(*link.medium)) + ", or no rate"});
    if (*link.medium == Medium::base_t1s_10)
      diagnostics.error(link.where.at("medium"), "a medium in half duplex",
                        {"10BASE-T1S, whose stations share one pair in turns (PLCA) or by collisions",
                         "a full-duplex medium, such as 10BASE-T1L: no stations of takt share a medium"});
    link.rate = rate;
  }
  DeviceReader(scenario, diagnostics).run();
  for (Link& link : scenario.network.links) link.medium.reset();  // its rate counts from here on
}

void set_device_clocks(const Topology& topology, Scenario& scenario) {
  Clocks& clocks = scenario.clocks;
  const bool are_free = clocks.model == ClockModel::free_running || clocks.all || clocks.gptp;
  std::map<std::string, std::size_t, std::less<>> own;
  for (std::size_t i = 0; i < clocks.nodes.size(); ++i) own.emplace(clocks.nodes[i].first, i);
  std::optional<DeviceResidence> residence;
  for (std::uint32_t n = 0; n < topology.nodes.size(); ++n) {
    const TopologyNode& node = topology.nodes[n];
    const std::shared_ptr<const Device>& device = ports_of(node.description).type.of;
    if (!device) continue;
    if (device->gptp_residence) {
      if (!residence) residence = *device->gptp_residence;
      residence->least = std::min(residence->least, device->gptp_residence->least);
      residence->greatest = std::max(residence->greatest, device->gptp_residence->greatest);
    }
    if (!device->time_stamps && device->phys.empty()) continue;
    const auto found = own.find(node.name);
    if (found == own.end() && !are_free) continue;  // its clock is true time
    if (found == own.end()) clocks.nodes.emplace_back(node.name, clocks.all.value_or(Clock{}));
    Clock& clock = found == own.end() ? clocks.nodes.back().second : clocks.nodes[found->second].second;
    const auto lower = [&](const char* key, Duration& kept, Duration said) {
      if (found == own.end() || !clock.where.has(key)) kept = said;
    };
    const DevicePhy phy = phy_of(*device, topology, n);
    if (device->time_stamps && device->time_stamps->granularity)
      lower("granularity", clock.granularity, *device->time_stamps->granularity);
    const Duration error = (device->time_stamps ? device->time_stamps->error : Duration()) + phy.variation;
    if (error > Duration()) lower("jitter", clock.jitter, error);
    if (phy.transmit > Duration()) lower("tx_latency", clock.tx_latency, phy.transmit);
    if (phy.receive > Duration()) lower("rx_latency", clock.rx_latency, phy.receive);
  }
  if (!residence || !clocks.gptp || clocks.gptp->processing) return;
  Latency& processing = clocks.gptp->processing.emplace();
  processing.where = residence->where;
  processing.uniform = Latency::Uniform{residence->least, residence->greatest};
}

void check_devices(const Resolved& resolved, json::Diagnostics& diagnostics) {
  FeatureCheck(resolved, diagnostics).run();
}

}  // namespace takt::scenario
