// SPDX-License-Identifier: Apache-2.0
#include "models/network.hpp"

#include <algorithm>
#include <utility>

#include "models/host/cpu_load.hpp"

namespace takt::models {

Network::Network(sim::Simulation& simulation, NetworkPlan plan, Share share)
    : simulation_(&simulation), plan_(std::move(plan)), share_(share) {
  shared_.traffic = &traffic_;
  number_ports();
  make_clocks();
  make_nodes();
  for (const LinkPlan& link : plan_.links) {
    connect(link.a, link.b, link);
    connect(link.b, link.a, link);
  }
  add_streams();
  for (const FilteringPlan& entry : plan_.filtering)
    bridges_[entry.node.value]->filtering_database().add(entry.vlan, entry.address, entry.port);
  set_up_ingress();
  set_up_talker_ats();
  set_up_redundancy();
  set_up_faults();
  announce_cut_through();
  set_up_gptp();
  add_talkers();
  add_loads();
  for (const LinkPlan& link : plan_.links) {
    cross(link.a, link.b);
    cross(link.b, link.a);
  }
  for (std::size_t p = 0; p < first_port_.back(); ++p) ports_[p].prepare();
  fold_latencies();
  note_routes();
}

Network::~Network() = default;

/// What a host draws for each frame that comes by its only link. Links that may fail, and those of nodes that may, are
/// not plain.
void Network::fold_latencies() {
  for (const LinkPlan& link : plan_.links) {
    for (const auto& [from, to] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      EgressPort& port = mutable_ports(from->node)[from->port];
      if (plan_.nodes[to->node.value].forwards() || !hosts_[to->node.value] || !port.sends_plainly()) continue;
      port.link().fold_latency(hosts_[to->node.value]->drawn_latency());
    }
  }
}

/// Emits a trace record per arrival.
void Network::unfold_latencies() {
  for (const LinkPlan& link : plan_.links) {
    for (const auto& [from, to] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      Link& direction = mutable_ports(from->node)[from->port].link();
      if (!direction.folds_latency()) continue;
      direction.fold_latency(nullptr);
      hosts_[to->node.value]->arrive_for_recorder();
    }
  }
}

void Network::note_routes() {
  routes_.emplace(traffic_.streams().size());
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n)
    if (plan_.nodes[n].kind == NodeKind::bridge)
      bridges_[n]->note_routes(*routes_, static_cast<std::uint32_t>(first_port_[n]));
}

void Network::make_clocks() {
  clocks_.resize(plan_.nodes.size());
  followers_.resize(plan_.nodes.size());
  stations_.resize(plan_.nodes.size());
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    if (!plan_.nodes[n].clock) continue;
    clocks_[n] = std::make_unique<NodeClock>(*simulation_, *plan_.nodes[n].clock, plan_.nodes[n].name);
    followers_[n] = std::make_unique<Followers>();
    followers_[n]->network = this;
    followers_[n]->node = NodeIndex{n};
    clocks_[n]->disciplined().add_listener(*followers_[n]);
  }
}

void Network::Followers::clock_changed(const LocalClock&, sim::TrueTime) {
  for (EgressPort& port : network->mutable_ports(node))
    if (port.is_connected()) port.clock_changed(*network->simulation_);
  for (Talker* const talker : talkers) talker->clock_changed(*network->simulation_);
  for (Process* const process : processes) process->clock_changed();
}

void Network::set_up_gptp() {
  if (plan_.gptp.empty()) return;
  Stream record;
  record.name = "gPTP";
  record.destination = gptp_address;
  record.priority = 7;
  record.link_local = true;
  record.ether_type = 0x88F7;
  gptp_stream_ = traffic_.add_stream(std::move(record));
  shared_.link_local = this;
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    if (!plan_.gptp[n]) continue;
    TAKT_CHECK(clocks_[n] != nullptr, "a node with gPTP has a clock of its own");
    const std::span<EgressPort> ports = mutable_ports(NodeIndex{n});
    stations_[n] = std::make_unique<gptp::Station>(
        *simulation_, traffic_, ports, *clocks_[n], plan_.nodes[n].clock->timestamps,
        plan_.gptp_stations[*plan_.gptp[n]], NodeIndex{n}, *gptp_stream_, plan_.nodes[n].name);
    simulation_->group(stations_[n]->id(), component_of(NodeIndex{n}));
    if (cpus_[n] && plan_.nodes[n].cpu->gptp) stations_[n]->run_on(*cpus_[n], *plan_.nodes[n].cpu->gptp);
    if (bridges_[n]) bridges_[n]->set_link_local_receiver(stations_[n].get());
    if (hosts_[n]) hosts_[n]->set_link_local_receiver(stations_[n].get());
    for (std::uint16_t p = 0; p < ports.size(); ++p) {
      if (!ports[p].is_connected()) continue;
      if (port_of_component_.size() <= ports[p].id().index)
        port_of_component_.resize(ports[p].id().index + std::size_t{1});
      port_of_component_[ports[p].id().index] = {NodeIndex{n}, p};
    }
  }
}

void Network::transmission_starts(sim::Simulation&, sim::ComponentId port, FrameIndex frame) {
  const auto [node, number] = port_of_component_[port.index];
  stations_[node.value]->transmission_starts(number, frame);
}

void Network::add_streams() {
  traffic_.expect_streams(plan_.streams.size() + 1);  // gPTP has one
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
    record.ether_type = stream.ether_type;
    record.udp_port = stream.udp_port;
    record.udp_source_port = stream.udp_source_port;
    record.ip_group = stream.ip_group;
    record.listeners = static_cast<std::uint32_t>(stream.listeners.size());
    const StreamIndex index = traffic_.add_stream(std::move(record));
    for (const NodeIndex listener : stream.listeners) listen(listener, index, nullptr);
  }
}

void Network::add_talkers() {
  // Those that babble come first in the order of components, as they do at one instant.
  for (const bool babbles : {true, false})
    for (const TalkerPlan& talker : plan_.talkers)
      if (talker.babbles == babbles) add_talker(talker);
}

void Network::add_talker(const TalkerPlan& talker) {
  const StreamPlan& stream = plan_.streams[talker.stream.value];
  const NodePlan& node = plan_.nodes[stream.talker.value];
  HostOutput& output = output_of_host(stream.talker);
  talkers_.push_back(std::make_unique<Talker>(*simulation_, traffic_, output, clock_of(stream.talker),
                                              plan_.os_latencies[node.os_latency],
                                              node.name + "/" + (talker.name.empty() ? stream.name : talker.name),
                                              talker.stream, talker.payload, talker.schedule));
  simulation_->group(talkers_.back()->id(), component_of(stream.talker));
  talkers_.back()->set_until(talker.until);
  if (talker.babbles) {
    talkers_.back()->set_babbling();
    babblers_.emplace(talker.stream.value, talkers_.back().get());
  } else {
    for (auto [other, end] = babblers_.equal_range(talker.stream.value); other != end; ++other)
      other->second->share_latency(*talkers_.back());
  }
  if (node.cpu && node.cpu->transmit) talkers_.back()->send_on(*cpus_[stream.talker.value], *node.cpu->transmit);
  if (followers_[stream.talker.value]) followers_[stream.talker.value]->talkers.push_back(talkers_.back().get());
  if (stream.host_priority) talkers_.back()->set_host_priority(*stream.host_priority);
  if (!talker.launch && !stream.host_priority) return;
  if (talker.launch) {
    talkers_.back()->set_launch(*talker.launch);
    output.disable_fast_path();
  }
  for (EgressPort& port : mutable_ports(stream.talker)) port.link().check_arrivals();
}

void Network::set_up_ingress() {
  ingress_.resize(plan_.nodes.size());
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    const NodeIndex node{n};
    if (bridges_[n] == nullptr) continue;
    for (EgressPort& port : mutable_ports(node))
      if (port.is_connected() && port.untags()) bridges_[n]->set_untags();
    if (!plan_.nodes[n].ingress) continue;
    ingress_[n] = std::make_unique<IngressPipeline>(
        traffic_, plan_.ingress_configs[*plan_.nodes[n].ingress], clock_of(node), bridges_[n]->id(),
        static_cast<std::uint32_t>(plan_.nodes.size()), plan_.nodes[n].forwarding_delay);
    bridges_[n]->set_ingress_chain(ingress_[n].get());
    for (EgressPort& port : mutable_ports(node))
      if (port.is_connected()) port.link().check_arrivals();
  }
}

void Network::set_up_talker_ats() {
  for (const TalkerAtsPlan& shaped : plan_.talker_ats) {
    const NodeIndex talker = plan_.streams[shaped.stream.value].talker;
    output_of_host(talker).shape(shaped.stream, shaped.committed_information_rate, shaped.committed_burst_size,
                                 shaped.media_overhead);
    for (EgressPort& port : mutable_ports(talker)) port.link().check_arrivals();
  }
}

void Network::set_up_redundancy() {
  for (const HostSplitPlan& split : plan_.host_splits)
    output_of_host(plan_.streams[split.stream.value].talker)
        .split(split.stream, split.split, hosts_[plan_.streams[split.stream.value].talker.value]->id());
  for (const HostRecoveryPlan& recovery : plan_.host_recoveries)
    hosts_[recovery.host.value]->recover(recovery.stream, recovery.recovery);
}

void Network::set_up_faults() {
  reasons_down_.assign(plan_.links.size(), 0);
  cuts_.assign(plan_.links.size(), 0);
  crashes_.assign(plan_.nodes.size(), 0);
  for (const LinkPlan& link : plan_.links) {
    if (!link.may_fail) continue;
    for (const auto& [from, to] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
      const std::string path = plan_.nodes[from->node.value].name + " to " + plan_.nodes[to->node.value].name + ":" +
                               std::to_string(to->port);
      mutable_ports(from->node)[from->port].link().expect_faults(*simulation_, path);
      if (outputs_[from->node.value]) outputs_[from->node.value]->disable_fast_path();
    }
  }
  for (const ImpairmentPlan& impairment : plan_.impairments) {
    const LinkPlan& link = plan_.links[impairment.link];
    const LinkPlan::End& from = impairment.from_a_to_b ? link.a : link.b;
    mutable_ports(from.node)[from.port].link().add_impairment(impairment.impairment);
  }
}

/// Tells the ports that send to a bridge of which priorities it wants to know the headers: those that another port of
/// it cuts through, and no port of it sends by eligibility times, which are counted from the last bit.
void Network::announce_cut_through() {
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    if (bridges_[n] == nullptr) continue;
    const std::span<EgressPort> ports = mutable_ports(NodeIndex{n});
    bool announced = false;
    std::uint8_t timed = 0;
    for (const EgressPort& port : ports)
      for (unsigned p = 0; port.is_connected() && p < 8; ++p)
        if (port.config().shaping.is_timed(port.config().traffic_class_of_priority[p]))
          timed = static_cast<std::uint8_t>(timed | 1u << p);
    for (EgressPort& port : ports) {
      std::uint8_t priorities = 0;
      for (const EgressPort& other : ports)
        for (unsigned p = 0; p < 8; ++p)
          if (&other != &port && other.is_connected() &&
              contains(other.config().cut_through, other.config().traffic_class_of_priority[p]))
            priorities = static_cast<std::uint8_t>(priorities | 1u << p);
      priorities = static_cast<std::uint8_t>(priorities & ~timed);
      if (priorities == 0 || !port.is_connected()) continue;
      port.incoming().notice_headers(priorities, plan_.nodes[n].cut_through_header);
      announced = true;
    }
    // A header may lead to any port, whether that cuts through or not.
    for (EgressPort& port : ports)
      if (announced && port.is_connected()) port.expect_headers();
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
  cpus_.resize(plan_.nodes.size());
  bridges_.resize(plan_.nodes.size());
  outputs_.resize(plan_.nodes.size());
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    const NodePlan& node = plan_.nodes[n];
    const std::span<EgressPort> ports = mutable_ports(NodeIndex{n});
    if (chooses_ports(NodeIndex{n})) bridges_[n] = std::make_unique<Bridge>(traffic_, ports, node.forwarding_delay);
    if (node.forwards()) bridges_[n]->set_id(simulation_->add(*bridges_[n]));
    if (node.forwarding_jitter) {
      jitters_.push_back(
          std::make_unique<ForwardingJitter>(*node.forwarding_jitter, simulation_->seed(), node.name, ports.size()));
      bridges_[n]->set_jitter(jitters_.back().get());
    }
    if (!node.is_end_station()) continue;
    hosts_[n] = std::make_unique<Host>(*simulation_, traffic_, NodeIndex{n}, plan_.os_latencies[node.os_latency],
                                       node.name, ports, clock_of(NodeIndex{n}), chooses_ports(NodeIndex{n}),
                                       node.cpu && node.cpu->receive);
    simulation_->group(hosts_[n]->id(), component_of(NodeIndex{n}));
    if (node.cpu) {
      cpus_[n] = std::make_unique<Cpu>(*simulation_, *node.cpu, NodeIndex{n}, node.name);
      simulation_->group(cpus_[n]->id(), component_of(NodeIndex{n}));
      if (node.cpu->receive) hosts_[n]->take_in_on(*cpus_[n], *node.cpu->receive);
    }
    if (!ports.empty()) outputs_[n] = std::make_unique<HostOutput>(traffic_, ports);
    if (!chooses_ports(NodeIndex{n})) continue;
    if (node.forwards())
      bridges_[n]->set_host(*hosts_[n]);
    else
      bridges_[n]->set_id(hosts_[n]->id());
    if (!ports.empty()) outputs_[n]->choose_by(*bridges_[n]);
  }
}

/// What leaves the node leaves by a filtering entry.
void Network::trace_paths() {
  traffic_.trace_copies(*simulation_);
  unfold_latencies();
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    if (plan_.nodes[n].forwards())
      bridges_[n]->trace_arrivals();
    else if (hosts_[n])
      hosts_[n]->trace_arrivals();
  }
}

bool Network::chooses_ports(NodeIndex node) const {
  return plan_.nodes[node.value].forwards() || ports(node).size() > 1;
}

sim::Duration Network::fixed_delay_of(NodeIndex node) const {
  const NodePlan& plan = plan_.nodes[node.value];
  if (plan.forwards()) return plan.forwarding_delay;
  if (chooses_ports(node) || (plan.cpu && plan.cpu->receive)) return {};
  const sim::Distribution& receive = plan_.os_latencies[plan.os_latency].receive;
  return receive.is_constant() ? receive.greatest() : sim::Duration();
}

sim::ComponentId Network::component_of(NodeIndex node) const {
  return plan_.nodes[node.value].forwards() ? bridges_[node.value]->id() : hosts_[node.value]->id();
}

ReceptionChecks& Network::reception_checks_of(NodeIndex node) const {
  return plan_.nodes[node.value].forwards() ? bridges_[node.value]->reception_checks()
                                            : hosts_[node.value]->reception_checks();
}

void Network::connect(const LinkPlan::End& from, const LinkPlan::End& to, const LinkPlan& link) {
  TAKT_CHECK(link.rate.has_exact_octet_time(), "a link's octet lasts a whole number of picoseconds");
  mutable_ports(from.node)[from.port].connect(*simulation_, component_of(from.node), shared_, port_config_of(from),
                                              clock_of(from.node), link.rate.octet_time(),
                                              {component_of(to.node), to.port, link.delay + fixed_delay_of(to.node),
                                               fixed_delay_of(to.node), &reception_checks_of(to.node)},
                                              mutable_ports(to.node)[to.port].link());
  if (from.gates_may_stick) mutable_ports(from.node)[from.port].expect_stuck_gates();
}

const PortConfig& Network::port_config_of(const LinkPlan::End& end) const {
  return plan_.port_configs[end.port_config.value_or(plan_.nodes[end.node.value].port_config)];
}

HostOutput& Network::output_of_host(NodeIndex host) {
  TAKT_CHECK(outputs_[host.value] != nullptr, "a host that sends has a link");
  return *outputs_[host.value];
}

Process& Network::add_process(NodeIndex host, std::string_view name, std::unique_ptr<Application> application,
                              std::optional<std::uint32_t> turns, std::vector<std::optional<std::uint32_t>> threads) {
  return make_process(host, name, std::move(application), {turns, std::move(threads), {}}, turns);
}

Process& Network::make_process(NodeIndex host, std::string_view name, std::unique_ptr<Application> application,
                               Process::CpuThreads threads, std::optional<std::uint32_t> woken) {
  const NodePlan& node = plan_.nodes[host.value];
  const OsLatency* latency = &plan_.os_latencies[node.os_latency];
  if (woken && node.cpu->threads[*woken].wake_up) {
    thread_latencies_.push_back(std::make_unique<OsLatency>(*latency));
    thread_latencies_.back()->wake_up = *node.cpu->threads[*woken].wake_up;
    latency = thread_latencies_.back().get();
  }
  processes_.push_back(std::make_unique<Process>(*simulation_, traffic_, output_of_host(host), clock_of(host), *latency,
                                                 node.name + "/" + std::string(name), std::move(application)));
  simulation_->group(processes_.back()->id(), component_of(host));
  if (node.cpu) {
    threads.transmit = node.cpu->transmit;
    processes_.back()->run_on(*cpus_[host.value], std::move(threads));
  }
  host_of_process_.push_back(host);
  if (followers_[host.value]) followers_[host.value]->processes.push_back(processes_.back().get());
  return *processes_.back();
}

void Network::add_loads() {
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    if (!plan_.nodes[n].cpu) continue;
    const std::vector<CpuThreadPlan>& threads = plan_.nodes[n].cpu->threads;
    for (std::uint32_t t = 0; t < threads.size(); ++t)
      if (threads[t].load)
        make_process(NodeIndex{n}, "cpu/" + threads[t].name, std::make_unique<CpuLoad>(*threads[t].load, 0),
                     {{}, {t}, {}}, t);
  }
}

void Network::listen(NodeIndex host, StreamIndex stream, Process* process) {
  TAKT_CHECK(hosts_[host.value] != nullptr, "only hosts listen");
  hosts_[host.value]->listen(stream, process);
}

void Network::keep_account(StreamIndex stream, sim::TrueTime from) {
  traffic_.book().keep_account(stream, from);
  if (stream.value >= plan_.streams.size()) return;  // that of gPTP, which no host delivers
  for (const NodeIndex listener : plan_.streams[stream.value].listeners) hosts_[listener.value]->keep_book();
}

void Network::keep_arrivals(StreamIndex stream) {
  for (const NodeIndex listener : plan_.streams[stream.value].listeners) {
    traffic_.book().keep_arrivals(stream, listener);
    hosts_[listener.value]->keep_book();
  }
}

void Network::keep_timely(StreamIndex stream, sim::Duration deadline) {
  for (const NodeIndex listener : plan_.streams[stream.value].listeners) {
    traffic_.book().keep_timely(stream, listener, deadline);
    hosts_[listener.value]->keep_book();
  }
}

void Network::start() {
  find_single_talker_ports();
  for (std::uint32_t n = 0; n < clocks_.size(); ++n)
    if (clocks_[n] && has(NodeIndex{n})) clocks_[n]->start(*simulation_);
  for (std::uint32_t n = 0; n < stations_.size(); ++n)
    if (stations_[n] && has(NodeIndex{n})) stations_[n]->start();
  for (const auto& talker : talkers_)
    if (has(traffic_.stream(talker->stream()).talker)) talker->start(*simulation_);
  for (std::size_t p = 0; p < processes_.size(); ++p)
    if (has(host_of_process_[p])) processes_[p]->start();
}

void Network::cross(const LinkPlan::End& from, const LinkPlan::End& to) {
  if (has(from.node) && !has(to.node))
    mutable_ports(from.node)[from.port].link().cross(*share_.exchange, share_.part_of(to.node));
}

std::vector<NodeIndex> Network::nodes_of_components() const {
  std::vector<NodeIndex> nodes;
  const auto know = [&](sim::ComponentId component, NodeIndex node) {
    if (nodes.size() <= component.index) nodes.resize(component.index + std::size_t{1});
    nodes[component.index] = node;
  };
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
    const NodeIndex node{n};
    for (const EgressPort& port : ports(node))
      if (port.is_connected()) know(port.id(), node);
    if (plan_.nodes[n].forwards()) know(bridges_[n]->id(), node);
    if (hosts_[n]) know(hosts_[n]->id(), node);
    if (stations_[n]) know(stations_[n]->id(), node);
  }
  for (const auto& talker : talkers_) know(talker->id(), traffic_.stream(talker->stream()).talker);
  for (std::size_t p = 0; p < processes_.size(); ++p) know(processes_[p]->id(), host_of_process_[p]);
  return nodes;
}

void Network::adopt(const Network& other) {
  if (adopted_.empty()) adopted_.assign(plan_.nodes.size(), this);
  for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n)
    if (other.has(NodeIndex{n})) adopted_[n] = &other;
  traffic_.adopt(other.traffic_);
}

}  // namespace takt::models
