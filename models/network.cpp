#include "models/network.hpp"

#include <algorithm>
#include <utility>

namespace takt::models {

Network::Network(sim::Simulation& simulation, NetworkPlan plan) : simulation_(&simulation), plan_(std::move(plan)) {
  shared_.traffic = &traffic_;
  number_ports();
  make_nodes();
  for (const LinkPlan& link : plan_.links) {
    connect(link.a, link.b, link);
    connect(link.b, link.a, link);
  }
  for (const StreamPlan& stream : plan_.streams) {
    Stream record;
    record.name = stream.name;
    record.talker = stream.talker;
    record.source = AddressIndex{stream.talker.value};
    record.destination = stream.destination;
    record.vlan = stream.vlan;
    record.priority = stream.priority.value_or(0);
    record.tagged = stream.priority.has_value();
    record.headers = stream.headers;
    record.listeners = static_cast<std::uint32_t>(stream.listeners.size());
    const StreamIndex index = traffic_.add_stream(std::move(record));
    for (const NodeIndex listener : stream.listeners) listen(listener, index, nullptr);
  }
  for (const FilteringPlan& entry : plan_.filtering)
    bridges_[entry.bridge.value]->filtering_database().add(entry.vlan, entry.address, entry.port);
  for (const TalkerPlan& talker : plan_.talkers) {
    const StreamPlan& stream = plan_.streams[talker.stream.value];
    const NodePlan& node = plan_.nodes[stream.talker.value];
    talkers_.push_back(std::make_unique<Talker>(simulation, traffic_, port_of_host(stream.talker), ideal_clock_,
                                                plan_.os_latencies[node.os_latency], node.name + "/" + stream.name, talker.stream,
                                                talker.payload, talker.schedule));
  }
}

void Network::number_ports() {
  std::vector<std::size_t> counts(plan_.nodes.size() + 1, 0);
  for (const LinkPlan& link : plan_.links)
    for (const LinkPlan::End& end : {link.a, link.b})
      counts[end.node.value] = std::max<std::size_t>(counts[end.node.value], end.port + std::size_t{1});
  first_port_.assign(plan_.nodes.size() + 1, 0);
  for (std::size_t n = 0; n < plan_.nodes.size(); ++n) first_port_[n + 1] = first_port_[n] + counts[n];
  ports_ = std::make_unique<EgressPort[]>(first_port_.back());
}

void Network::make_nodes() {
  hosts_.resize(plan_.nodes.size());
  bridges_.resize(plan_.nodes.size());
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    const NodePlan& node = plan_.nodes[n];
    if (node.kind == NodeKind::host) {
      hosts_[n] = std::make_unique<Host>(*simulation_, traffic_, NodeIndex{n}, plan_.os_latencies[node.os_latency], node.name);
    } else {
      bridges_[n] = std::make_unique<Bridge>(traffic_, mutable_ports(NodeIndex{n}));
      bridges_[n]->set_id(simulation_->add(*bridges_[n]));
    }
  }
}

sim::Duration Network::fixed_delay_of(NodeIndex node) const {
  const NodePlan& plan = plan_.nodes[node.value];
  if (plan.kind == NodeKind::bridge) return plan.forwarding_delay;
  const sim::Distribution& receive = plan_.os_latencies[plan.os_latency].receive;
  return receive.is_constant() ? receive.greatest() : sim::Duration();
}

sim::ComponentId Network::component_of(NodeIndex node) const {
  return hosts_[node.value] ? hosts_[node.value]->id() : bridges_[node.value]->id();
}

void Network::connect(const LinkPlan::End& from, const LinkPlan::End& to, const LinkPlan& link) {
  TAKT_CHECK(link.rate.has_exact_octet_time(), "a link's octet lasts a whole number of picoseconds");
  mutable_ports(from.node)[from.port].connect(*simulation_, shared_, port_config_of(from), ideal_clock_,
                                              link.rate.octet_time(),
                                              {component_of(to.node), to.port, link.delay + fixed_delay_of(to.node)});
}

const PortConfig& Network::port_config_of(const LinkPlan::End& end) const {
  return plan_.port_configs[end.port_config.value_or(plan_.nodes[end.node.value].port_config)];
}

ConfigChange Network::request_gates(NodeIndex node, std::uint16_t port, const GateConfig& gates) {
  return mutable_ports(node)[port].request_gates(*simulation_, gates);
}

EgressPort& Network::port_of_host(NodeIndex host) {
  const std::span<EgressPort> ports = mutable_ports(host);
  TAKT_CHECK(!ports.empty(), "a host that sends has a link");
  return ports[0];
}

Process& Network::add_process(NodeIndex host, std::string_view name, std::unique_ptr<Application> application) {
  const NodePlan& node = plan_.nodes[host.value];
  processes_.push_back(std::make_unique<Process>(*simulation_, traffic_, port_of_host(host), ideal_clock_,
                                                 plan_.os_latencies[node.os_latency], node.name + "/" + std::string(name),
                                                 std::move(application)));
  return *processes_.back();
}

void Network::listen(NodeIndex host, StreamIndex stream, Process* process) {
  TAKT_CHECK(hosts_[host.value] != nullptr, "only hosts listen");
  hosts_[host.value]->listen(stream, process);
}

void Network::start() {
  for (const auto& talker : talkers_) talker->start(*simulation_);
  for (const auto& process : processes_) process->start();
}

}  // namespace takt::models
