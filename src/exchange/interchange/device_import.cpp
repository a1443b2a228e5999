// SPDX-License-Identifier: Apache-2.0
#include "interchange/device_import.hpp"

#include <algorithm>

#include "interchange/ports.hpp"
#include "json/document.hpp"
#include "json/printable.hpp"
#include "scenario/resolved/resolved.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::interchange {
namespace {

using scenario::Egress;

bool says_nothing(const Egress& egress) {
  Egress nothing;
  nothing.to = egress.to;
  return egress == nothing;
}

/// The entry of a node that configures the port to `peer`.
const Egress* entry_for(const scenario::NodePorts& ports, const std::string& peer) {
  const Egress* chosen = nullptr;
  for (const Egress& egress : ports.egress)
    if (egress.to == peer || (!egress.to && chosen == nullptr)) chosen = &egress;
  return chosen;
}

class DeviceBuilder {
 public:
  DeviceBuilder(scenario::Scenario& scenario, const Names& names, Imported& imported, json::Diagnostics& diagnostics)
      : scenario_(scenario), names_(names), imported_(imported), diagnostics_(diagnostics) {}

  /// A network of its own: a host at each port.
  void add_to_nothing(const ImportedDevice& device) {
    scenario::Node node =
        device.forwards ? scenario::Node(scenario::SwitchNode{}) : scenario::Node(scenario::HostNode{});
    scenario_.network.nodes.emplace_back(device.name, node);
    const std::size_t own = scenario_.network.nodes.size() - 1;
    std::vector<std::pair<const ImportedPort*, std::string>> peers;
    for (const ImportedPort& port : device.ports) {
      std::string peer = device.name + "-" + port.interface;
      scenario_.network.nodes.emplace_back(peer, scenario::Node(scenario::HostNode{}));
      scenario::Link link;
      link.ends = {device.name, peer};
      if (port.rate) link.rate = *port.rate;
      scenario_.network.links.push_back(link);
      peers.emplace_back(&port, std::move(peer));
    }
    keep_interfaces(device, peers,
                    [&](std::size_t i) { return interface_name(device.forwards, static_cast<std::uint16_t>(i)); });
    set_ports(scenario_.network.nodes[own].second, device, peers);
    set_rest(scenario_.network.nodes[own].second, device, peers);
  }

  void add_to(const scenario::Topology& topology, const ImportedDevice& device) {
    const auto found = std::ranges::find(scenario_.network.nodes, device.name,
                                         [](const auto& each) -> const std::string& { return each.first; });
    const auto index = topology.find(device.name);
    if (!index || found == scenario_.network.nodes.end()) {
      diagnostics_.error(
          device.place, "a device that the network does not have",
          {json::quote(device.name),
           "the name of a node under /network/nodes, by NODE=FILE or by the file's name up to its first dot",
           scenario::suggest_node(topology, device.name, diagnostics_)});
      return;
    }
    std::vector<std::pair<const ImportedPort*, std::string>> peers;
    std::vector<std::uint16_t> numbers;
    for (const ImportedPort& port : device.ports) {
      const auto number = port_of_interface(port.interface);
      const auto& neighbours = topology.neighbours[*index];
      const auto named = peer_of(device.name, port.interface);
      const auto neighbour = std::ranges::find_if(neighbours, [&](const scenario::Neighbour& each) {
        return named ? topology.nodes[each.node].name == *named : number && each.port == *number;
      });
      if (neighbour == neighbours.end()) {
        if (says_nothing(port.egress)) continue;
        diagnostics_.error(
            port.place, "an interface at which the network has no link",
            {json::quote(port.interface) + " of " + json::quote(device.name),
             "a name that ends with the number of a port (" + ports_text(neighbours) + "), or a table of names (" +
                 std::string(names_file) + ") that has it under \"interfaces\""});
        continue;
      }
      peers.emplace_back(&port, topology.nodes[neighbour->node].name);
      numbers.push_back(neighbour->port);
    }
    keep_interfaces(device, peers, [&](std::size_t i) {
      return interface_name(device.forwards || scenario::relay_of(found->second) != nullptr, numbers[i]);
    });
    expand(topology, *index, found->second);
    set_ports(found->second, device, peers);
    set_rest(found->second, device, peers);
  }

  void set_gptp(const ImportedDevice& device, const std::vector<std::pair<const ImportedPort*, std::string>>& peers) {
    if (device.gptp_of_all) {
      if (!scenario_.clocks.gptp) scenario_.clocks.gptp.emplace();
      const scenario::Gptp before = *scenario_.clocks.gptp;
      merge_into(*device.gptp_of_all, device.gptp_by_data_sets, *scenario_.clocks.gptp);
      const bool has_other_standby = seen_gptp_ && device.gptp_by_data_sets &&
                                     device.gptp_of_all->hot_standby != scenario_.clocks.gptp->hot_standby;
      if (seen_gptp_ && (has_other_standby || !(before == *scenario_.clocks.gptp)))
        diagnostics_.error(device.place, "gPTP that is set differently at two devices",
                           {json::quote(device.name) + " with other intervals, timeouts or thresholds",
                            "the same for all nodes, as takt has it"});
      seen_gptp_ = true;
      scenario_.clocks.model = scenario::ClockModel::free_running;
    }
    if (device.gptp && scenario_.clocks.gptp) {
      set_node(entry_of(scenario_.clocks.gptp->nodes, device.name, scenario::GptpNode{}), *device.gptp,
               device.gptp_by_data_sets || device.gptp_by_roles, peers);
      for (const scenario::GptpDomain& domain : device.gptp_domains) {
        auto found = std::ranges::find(scenario_.clocks.gptp->domains, domain.domain, &scenario::GptpDomain::domain);
        if (found == scenario_.clocks.gptp->domains.end()) {
          scenario::GptpDomain& made = scenario_.clocks.gptp->domains.emplace_back();
          made.domain = domain.domain;
          found = std::prev(scenario_.clocks.gptp->domains.end());
        }
        set_node(entry_of(found->nodes, device.name, scenario::GptpNode{}), domain.nodes.front().second,
                 device.gptp_by_data_sets, peers);
      }
      const auto& domains = scenario_.clocks.gptp->domains;
      if (device.gptp_of_all && device.gptp_of_all->hot_standby &&
          device.gptp_domains.front().domain != domains.front().domain)
        diagnostics_.error(device.place, "another secondary than the first of the domains",
                           {"domain " + std::to_string(device.gptp_domains.front().domain),
                            "domain " + std::to_string(domains.front().domain)});
    }
    if (device.clock) {
      scenario::Clock& clock =
          entry_of(scenario_.clocks.nodes, device.name, scenario_.clocks.all.value_or(scenario::Clock{}));
      clock.tx_correction = device.clock->tx_correction;
      clock.rx_correction = device.clock->rx_correction;
    }
  }

 private:
  /// The neighbour at an interface, by the table of names.
  std::optional<std::string> peer_of(const std::string& node, const std::string& interface) const {
    const auto found = names_.interfaces().find(node);
    if (found == names_.interfaces().end()) return std::nullopt;
    const auto named =
        std::ranges::find(found->second, interface, [](const auto& each) -> const std::string& { return each.first; });
    return named == found->second.end() ? std::nullopt : std::optional(named->second);
  }

  /// Names that an export would not give by itself.
  template <class Usual>
  void keep_interfaces(const ImportedDevice& device,
                       const std::vector<std::pair<const ImportedPort*, std::string>>& peers, Usual usual) {
    std::vector<std::pair<std::string, std::string>> names;
    bool differs = false;
    for (std::size_t i = 0; i < peers.size(); ++i) {
      names.emplace_back(peers[i].first->interface, peers[i].second);
      differs = differs || peers[i].first->interface != usual(i);
    }
    if (differs) imported_.interfaces[device.name] = std::move(names);
  }

  static std::string ports_text(const std::vector<scenario::Neighbour>& neighbours) {
    std::string text;
    for (const scenario::Neighbour& each : neighbours) text += (text.empty() ? "" : ", ") + std::to_string(each.port);
    return text.empty() ? "none" : text;
  }

  static void set_node(scenario::GptpNode& node, const scenario::GptpNode& said, bool says_roles,
                       const std::vector<std::pair<const ImportedPort*, std::string>>& peers) {
    node.priority1 = said.priority1;
    node.priority2 = said.priority2;
    node.clock_class = said.clock_class;
    node.clock_accuracy = said.clock_accuracy;
    if (said.time) node.time = said.time;
    if (!says_roles) return;
    node.roles.reset();
    if (!said.roles) return;
    node.roles.emplace();
    for (scenario::GptpPortRole role : *said.roles) {
      const auto peer = std::ranges::find(peers, role.to,
                                          [](const auto& each) -> const std::string& { return each.first->interface; });
      if (peer == peers.end() ||
          std::ranges::any_of(*node.roles, [&](const scenario::GptpPortRole& each) { return each.to == peer->second; }))
        continue;
      role.to = peer->second;
      node.roles->push_back(std::move(role));
    }
  }

  /// What devices say of gPTP; the rest is as before.
  static void merge_into(const scenario::Gptp& from, bool by_data_sets, scenario::Gptp& to) {
    to.log_sync_interval = from.log_sync_interval;
    to.log_announce_interval = from.log_announce_interval;
    to.log_pdelay_interval = from.log_pdelay_interval;
    to.sync_receipt_timeout = from.sync_receipt_timeout;
    to.announce_receipt_timeout = from.announce_receipt_timeout;
    to.link_delay_threshold = from.link_delay_threshold;
    to.one_step = from.one_step;
    if (from.log_gptp_capable_interval) to.log_gptp_capable_interval = from.log_gptp_capable_interval;
    if (from.drift_tracking) to.drift_tracking = true;
    if (from.hot_standby) {
      to.hot_standby = true;
      to.standby_thresholds = from.standby_thresholds;
    }
    if (by_data_sets) return;
    to.servo.first_step_threshold = from.servo.first_step_threshold;
    to.servo.step_threshold = from.servo.step_threshold;
    to.servo.max_frequency = from.servo.max_frequency;
  }

  template <class T>
  static T& entry_of(json::NameMap<T>& map, const std::string& name, const T& usual) {
    const auto found = std::ranges::find(map, name, [](const auto& each) -> const std::string& { return each.first; });
    if (found != map.end()) return found->second;
    map.emplace_back(name, usual);
    return map.back().second;
  }

  /// An entry for each neighbour instead of one for all ports, so that single ones can be replaced.
  static void expand(const scenario::Topology& topology, std::uint32_t index, scenario::Node& node) {
    scenario::NodePorts& ports = scenario::ports_of(node);
    std::vector<Egress> expanded;
    for (const scenario::Neighbour& neighbour : topology.neighbours[index]) {
      const std::string& peer = topology.nodes[neighbour.node].name;
      const Egress* const entry = entry_for(ports, peer);
      if (entry == nullptr || std::ranges::any_of(expanded, [&](const Egress& each) { return each.to == peer; }))
        continue;
      expanded.push_back(*entry);
      expanded.back().to = peer;
    }
    ports.egress = std::move(expanded);
  }

  void set_ports(scenario::Node& node, const ImportedDevice& device,
                 const std::vector<std::pair<const ImportedPort*, std::string>>& peers) {
    scenario::NodePorts& ports = scenario::ports_of(node);
    const ImportedPort* first = nullptr;
    std::map<std::string, const ImportedPort*> by_peer;
    for (const auto& [port, peer] : peers) {
      if (port->classes) {
        if (first != nullptr && *first->classes != *port->classes)
          diagnostics_.error(port->place, "two maps from priorities to classes in one device",
                             {json::quote(port->interface) + " with another than " + json::quote(first->interface),
                              "one for all ports, as takt has it"});
        first = port;
        ports.traffic_classes = *port->classes;
      }
      if (const auto [other, is_new] = by_peer.try_emplace(peer, port); !is_new) {
        if (!(other->second->egress == port->egress))
          diagnostics_.error(port->place, "two links to one neighbour that are set differently",
                             {json::quote(port->interface) + " and " + json::quote(other->second->interface) + " to " +
                                  json::quote(peer),
                              "the same settings, as takt tells ports by their neighbour"});
        continue;
      }
      Egress egress = port->egress;
      egress.to = peer;
      keep_tags_before_a_switch(*port, peer, egress);
      if (const Egress* const before = entry_for(ports, peer);
          before != nullptr) {  // what no format of devices can say stays
        egress.cut_through = before->cut_through;
        egress.ets = before->ets;
      }
      std::erase_if(ports.egress, [&peer = peer](const Egress& each) { return each.to == peer; });
      if (!says_nothing(egress)) ports.egress.push_back(std::move(egress));
    }
    // One interface of a host: no need to say which.
    if (!device.forwards && device.ports.size() == 1 && ports.egress.size() == 1) ports.egress.front().to.reset();
  }

  /// A bridge takes the tag of VLAN 1 off frames that came without one: between switches takt's stay as they are.
  void keep_tags_before_a_switch(const ImportedPort& port, const std::string& peer, Egress& egress) {
    const auto neighbour = std::ranges::find(scenario_.network.nodes, peer,
                                             [](const auto& each) -> const std::string& { return each.first; });
    if (!egress.untagged || neighbour == scenario_.network.nodes.end() ||
        scenario::relay_of(neighbour->second) == nullptr)
      return;
    egress.untagged = false;
    if (std::ranges::any_of(scenario_.streams, [](const scenario::Stream& stream) { return stream.pcp.has_value(); }))
      imported_.remark(RemarkKind::lost, port.place,
                       "tags taken off before " + json::quote(peer) +
                           ", which forgets the priorities there: in takt they stay between switches");
  }

  void set_rest(scenario::Node& node, const ImportedDevice& device,
                const std::vector<std::pair<const ImportedPort*, std::string>>& peers) {
    if (device.ingress) {
      if (scenario::Relay* const relay = scenario::relay_of(node))
        relay->ingress = device.ingress;
      else
        diagnostics_.error(device.place, "an ingress that polices in a host",
                           {json::quote(device.name), "a node that forwards"});
    }
    set_gptp(device, peers);
  }

  scenario::Scenario& scenario_;
  const Names& names_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  bool seen_gptp_ = false;
};

}  // namespace

void Names::read(const InputFile& file, json::Diagnostics& diagnostics) {
  const auto document = json::parse(file.text, file.name, diagnostics);
  if (!document) return;
  const auto read = [&](std::string_view key, std::map<std::string, std::string>& into) {
    const json::Node* const table = document->root().find(key);
    if (table == nullptr && document->root().find("interfaces") != nullptr) return;
    if (table == nullptr || table->kind != json::Kind::object) {
      diagnostics.error(json::place_of(*document->tree(), document->root()), "not a table of names",
                        {"no object " + json::quote(key), "what takt export writes as " + std::string(names_file)});
      return;
    }
    for (const json::Member& member : table->members) {
      if (member.value.kind == json::Kind::string)
        into[member.key] = member.value.text;
      else
        diagnostics.error(json::place_of(*document->tree(), member.value), "not a name",
                          {json::excerpt(member.value), "a text"});
    }
  };
  read("streams", streams_);
  read("nodes", nodes_);
  const json::Node* const interfaces = document->root().find("interfaces");
  if (interfaces == nullptr) return;
  const auto refuse = [&](const json::Node& node, const char* expected) {
    diagnostics.error(json::place_of(*document->tree(), node), "not a table of interfaces",
                      {json::excerpt(node), expected});
  };
  if (interfaces->kind != json::Kind::object) return refuse(*interfaces, "an object with a member for each node");
  for (const json::Member& node : interfaces->members) {
    if (node.value.kind != json::Kind::object) {
      refuse(node.value, "an object with the neighbour at each interface");
      continue;
    }
    for (const json::Member& each : node.value.members) {
      const bool is_name =
          !each.key.empty() && json::shell_word(each.key) == each.key && each.key.find('/') == std::string::npos;
      if (each.value.kind != json::Kind::string || !is_name)
        refuse(each.value, "the name of a neighbour, under an interface of letters, digits and _-.:@+,=");
      else
        interfaces_[node.key].emplace_back(each.key, each.value.text);
    }
  }
}

std::optional<std::string> Names::stream(const std::string& address) const {
  const auto found = streams_.find(address);
  return found == streams_.end() ? std::nullopt : std::optional(found->second);
}
std::optional<std::string> Names::node(const std::string& address) const {
  const auto found = nodes_.find(address);
  return found == nodes_.end() ? std::nullopt : std::optional(found->second);
}

namespace {

json::Node interfaces_node(const InterfaceNames& interfaces) {
  json::Node all = json::Node::object();
  for (const auto& [node, names] : interfaces) {
    json::Node of_node = json::Node::object();
    for (const auto& [interface, peer] : names) of_node.add(interface, json::Node::of_string(peer));
    all.add(node, std::move(of_node));
  }
  return all;
}

}  // namespace

std::string names_table(const scenario::Resolved& resolved, const InterfaceNames& interfaces) {
  json::Node streams = json::Node::object(), nodes = json::Node::object();
  for (std::uint32_t n = 0; n < resolved.plan.nodes.size(); ++n)
    nodes.add(mac_text(mac_of(resolved, {n}), ':'), json::Node::of_string(resolved.plan.nodes[n].name));
  for (const models::StreamPlan& stream : resolved.plan.streams) {
    const std::string address = mac_text(mac_of(resolved, stream.destination), ':');
    if (stream.destination.value >= resolved.plan.nodes.size() && streams.find(address) == nullptr)
      streams.add(address, json::Node::of_string(stream.name));
  }
  json::Node table = json::Node::object();
  table.add("scenario", json::Node::of_string(resolved.scenario.name));
  table.add("nodes", std::move(nodes));
  table.add("streams", std::move(streams));
  if (!interfaces.empty()) table.add("interfaces", interfaces_node(interfaces));
  return json::pretty(table);
}

std::string interfaces_table(const InterfaceNames& interfaces) {
  json::Node table = json::Node::object();
  table.add("interfaces", interfaces_node(interfaces));
  return json::pretty(table);
}

std::string names_file_of(const std::string& scenario_file) {
  return (scenario_file.ends_with(".json") ? scenario_file.substr(0, scenario_file.size() - 5) : scenario_file) +
         ".names.json";
}

bool is_names_file(const InputFile& file) { return file.name.ends_with(".names.json"); }

scenario::IdentifiedStream identity_of(const std::string& name, const std::string& address, std::uint16_t vlan,
                                       scenario::TaggedFrames tagged, const Names& names, const json::Place& place,
                                       Imported& imported) {
  scenario::IdentifiedStream stream;
  stream.name = name;
  const auto of_stream = names.stream(address);
  const auto of_node = names.node(address);
  if (of_stream || of_node) {
    scenario::NullIdentity& identity = stream.null.emplace();
    identity.stream = of_stream;
    if (!of_stream) identity.destination = of_node;
    identity.vlan = vlan;
    identity.tagged = tagged;
    return stream;
  }
  scenario::MaskIdentity& identity = stream.mask.emplace();
  identity.destination = address;
  std::ranges::transform(identity.destination, identity.destination.begin(), [](unsigned char c) {
    return c == ':' ? '-' : static_cast<char>(c >= 'a' && c <= 'f' ? c - 'a' + 'A' : c);
  });
  identity.destination_mask = "FF-FF-FF-FF-FF-FF";
  if (vlan != 0)
    imported.remark(RemarkKind::lost, place,
                    "the VLAN " + std::to_string(vlan) + " of the address " + address + ", which no table of names (" +
                        std::string(names_file) + ") gives to a node or stream: frames of all VLANs are meant");
  return stream;
}

scenario::NetworkSection written_out(const scenario::Topology& topology) {
  scenario::NetworkSection network;
  for (const scenario::TopologyNode& node : topology.nodes) network.nodes.emplace_back(node.name, node.description);
  for (const models::LinkPlan& plan : topology.links) {
    scenario::Link link;
    for (const models::LinkPlan::End* const end : {&plan.a, &plan.b})
      link.ends.push_back(topology.nodes[end->node.value].name + ":" + std::to_string(end->port));
    link.rate = plan.rate;
    link.delay = plan.delay;
    network.links.push_back(std::move(link));
  }
  return network;
}

void build_scenario(std::vector<ImportedDevice> devices, const ImportRequest& request, const Names& names,
                    Imported& imported, json::Diagnostics& diagnostics) {
  scenario::Scenario scenario;
  if (request.base != nullptr) {
    scenario = *request.base;
  } else {
    scenario.name = devices.size() == 1 ? devices.front().name : "imported";
    scenario.duration = sim::Duration::from_ps(100'000'000'000);
  }
  DeviceBuilder builder(scenario, names, imported, diagnostics);
  std::optional<scenario::Topology> topology;
  if (request.base != nullptr) {
    topology = scenario::build_topology(request.base->network, diagnostics);
    if (!scenario.network.generate.empty())
      scenario.network = written_out(*topology);  // so that single nodes can be set
  }
  bool has_gates = false;
  for (const ImportedDevice& device : devices) {
    has_gates = has_gates || std::ranges::any_of(
                                 device.ports, [](const ImportedPort& port) { return port.egress.gates.has_value(); });
    if (topology)
      builder.add_to(*topology, device);
    else
      builder.add_to_nothing(device);
  }
  if (has_gates && scenario.gates && scenario.gates->plan != scenario::GatePlanning::none) {
    imported.remark(RemarkKind::changed, devices.front().place,
                    "the gates of the devices take the place of those that \"gates\" of the base lays");
    scenario.gates.reset();
  }
  if (!diagnostics.has_errors()) imported.scenario = std::move(scenario);
}

}  // namespace takt::interchange
