// SPDX-License-Identifier: Apache-2.0
// A live network: nodes, ports, talkers and processes, built from a plan on top of one simulation.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/bridge/bridge.hpp"
#include "models/gptp/station.hpp"
#include "models/host/host.hpp"
#include "models/host/process.hpp"
#include "models/host/talker.hpp"
#include "models/ingress/ingress_pipeline.hpp"
#include "models/parts/share.hpp"
#include "models/plan.hpp"

namespace takt::models {

class Network final : private LinkLocalSender {
 public:
  /// The plan is taken by value: latencies and port configurations stay alive with the network.
  /// Of a share only its nodes act, and what they send to others goes by its exchange, which outlives the network.
  Network(sim::Simulation& simulation, NetworkPlan plan, Share share = {});
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Puts an application on a host; `name` is unique on that host. The reference stays valid.
  /// On a host with a processor, `turns` and `threads` are the threads of its plan on which the application runs
  /// (Process::CpuThreads).
  Process& add_process(NodeIndex host, std::string_view name, std::unique_ptr<Application> application,
                       std::optional<std::uint32_t> turns = {}, std::vector<std::optional<std::uint32_t>> threads = {});
  /// The process, if any, that gets the octets of the stream at that listener. Listeners of the plan get none by
  /// default.
  void listen(NodeIndex host, StreamIndex stream, Process* process);

  /// Enters the stream in Traffic::book(): an account of its frames that are produced at `from` or later. Before
  /// start().
  void keep_account(StreamIndex stream, sim::TrueTime from);
  /// The same: which of its frames have reached each of its listeners, as they may come several times.
  void keep_arrivals(StreamIndex stream);
  /// The same: which of its frames reach each of its listeners within so long.
  void keep_timely(StreamIndex stream, sim::Duration deadline);

  /// Schedules the first events of talkers and starts the processes. Call once, at time zero.
  void start();

  /// Whether the node acts in this network.
  bool has(NodeIndex node) const { return share_.has(node); }
  /// At the end of a divided run: the nodes of another part's network, which outlives this one, are found here, too, as
  /// are the accounts of streams.
  void adopt(const Network& other);

  /// Management sets ConfigChange at a port, at the present instant.
  ConfigChange request_gates(NodeIndex node, std::uint16_t port, const GateConfig& gates);

  // Faults, at the present instant.
  /// A link goes down or comes back. What is down for several reasons is up when the last one ends. Precondition: it
  /// may_fail.
  void set_link(std::uint32_t link, bool up);
  /// The bypass relay of a station that is down joins the cables at its ports 0 and 1, or parts them. Precondition:
  /// their links may_fail and have one rate.
  void set_bypass(NodeIndex node, bool joins);
  /// A node crashes, or starts again: with empty queues, its programs without memory. Its links, which may_fail, go
  /// with it.
  void set_node(NodeIndex node, bool up);
  /// See PortShaping::force_gate.
  void force_gate(NodeIndex node, std::uint16_t port, TrafficClass q, std::optional<bool> open);
  /// A node's clock jumps, or its oscillator gets another offset. Precondition: the node has a clock of its own.
  void step_clock(NodeIndex node, sim::Duration by);
  void set_frequency_offset(NodeIndex node, sim::FrequencyOffset offset);
  /// Another static filtering entry: frames to the address leave the node, which forwards or has several ports, through
  /// these ports.
  void reroute(NodeIndex node, VlanId vlan, AddressIndex address, std::span<const std::uint16_t> ports);

  /// Whoever records the run (Simulation::set_trace) is told also where frames come from and what becomes of copies:
  /// `arrived` and `separated`. It takes time, and changes nothing.
  void trace_paths();

  /// Where what trace records name as their place is, by component; none: no record names it. Of processes those that
  /// have been added.
  std::vector<NodeIndex> nodes_of_components() const;
  /// Notifies the listener of changes of a node's clock until it is removed. Precondition: node_clock(node) is not
  /// null.
  void add_clock_listener(NodeIndex node, ClockListener& listener) {
    clocks_[node.value]->disciplined().add_listener(listener);
  }
  void remove_clock_listener(NodeIndex node, ClockListener& listener) {
    clocks_[node.value]->disciplined().remove_listener(listener);
  }

  sim::Simulation& simulation() { return *simulation_; }
  Traffic& traffic() { return traffic_; }
  const Traffic& traffic() const { return traffic_; }
  const NetworkPlan& plan() const { return plan_; }

  /// The ports of a node, by port number.
  std::span<const EgressPort> ports(NodeIndex node) const {
    const Network& from = network_of(node);
    return {from.ports_.get() + first_port_[node.value], first_port_[node.value + 1] - first_port_[node.value]};
  }
  /// Precondition: it forwards, or has several ports.
  const Bridge& bridge(NodeIndex node) const { return *network_of(node).bridges_[node.value]; }
  /// What the node shows as time.
  const LocalClock& clock(NodeIndex node) const {
    return clocks_[node.value] ? network_of(node).clocks_[node.value]->disciplined() : ideal_clock_;
  }
  /// Null where the node knows true time.
  const NodeClock* node_clock(NodeIndex node) const { return network_of(node).clocks_[node.value].get(); }
  /// Null where there is no gPTP.
  const gptp::Station* station(NodeIndex node) const { return network_of(node).stations_[node.value].get(); }
  /// The stream in which all gPTP messages are counted, if there is gPTP.
  std::optional<StreamIndex> gptp_stream() const { return gptp_stream_; }
  /// The ingress chain of a node that forwards, or null.
  IngressPipeline* ingress(NodeIndex node) const { return network_of(node).ingress_[node.value].get(); }
  /// Null where programs and the protocol stack take no time.
  Cpu* cpu(NodeIndex node) const { return network_of(node).cpus_[node.value].get(); }
  /// Null for bridges.
  Host* host(NodeIndex node) const { return network_of(node).hosts_[node.value].get(); }
  /// Null for hosts that are not connected, and for bridges.
  HostOutput* output(NodeIndex node) const { return network_of(node).outputs_[node.value].get(); }

 private:
  /// Two ports whose cables bypasses have joined.
  struct JoinedEnd {
    LinkPlan::End end;
    Link::Reception before;
    bool operator==(const JoinedEnd& other) const { return end.node == other.end.node && end.port == other.end.port; }
  };
  struct Joint {
    std::array<JoinedEnd, 2> ends;
    std::vector<NodeIndex> over;  ///< the nodes that are bypassed
    sim::Duration delay;
    bool is_up = false;
    bool operator==(const Joint& other) const { return ends == other.ends; }
  };
  std::span<EgressPort> mutable_ports(NodeIndex node) {
    return {ports_.get() + first_port_[node.value], first_port_[node.value + 1] - first_port_[node.value]};
  }
  /// In which network the node acts, as far as that is known here.
  const Network& network_of(NodeIndex node) const { return adopted_.empty() ? *this : *adopted_[node.value]; }
  void note_routes();
  void fold_latencies();
  void unfold_latencies();
  void find_single_talker_ports();
  bool may_serve_one(const LinkPlan::End& end) const;
  void cross(const LinkPlan::End& from, const LinkPlan::End& to);
  void number_ports();
  void make_nodes();
  void add_loads();
  Process& make_process(NodeIndex host, std::string_view name, std::unique_ptr<Application> application,
                        Process::CpuThreads threads, std::optional<std::uint32_t> woken);
  void connect(const LinkPlan::End& from, const LinkPlan::End& to, const LinkPlan& link);
  void transmission_starts(sim::Simulation& simulation, sim::ComponentId port, FrameIndex frame) override;
  void make_clocks();
  void set_up_gptp();
  const LocalClock& clock_of(NodeIndex node) const { return clock(node); }
  void add_streams();
  void add_talkers();
  void add_talker(const TalkerPlan& talker);
  void set_up_ingress();
  void set_up_talker_ats();
  void set_up_redundancy();
  void set_up_faults();
  void change_link(std::uint32_t link, bool up);
  void set_port(const LinkPlan::End& end, bool up);
  std::optional<Joint> joint_at(NodeIndex node) const;
  void refresh_joints();
  void join(Joint& joint);
  void set_joint(Joint& joint, bool up);
  void open_joints(const std::function<bool(const Joint&)>& which);
  void announce_cut_through();
  const PortConfig& port_config_of(const LinkPlan::End& end) const;
  bool chooses_ports(NodeIndex node) const;
  sim::Duration fixed_delay_of(NodeIndex node) const;
  sim::ComponentId component_of(NodeIndex node) const;
  ReceptionChecks& reception_checks_of(NodeIndex node) const;
  HostOutput& output_of_host(NodeIndex host);

  sim::Simulation* simulation_;
  NetworkPlan plan_;
  Share share_;
  std::vector<const Network*> adopted_;  // by node: where it acts; empty until adopt()
  Traffic traffic_;
  EgressPort::Shared shared_;
  /// Notifies those that wait for a time of a node's clock when the clock changes.
  struct Followers final : ClockListener {
    void clock_changed(const LocalClock& clock, sim::TrueTime now) override;
    Network* network = nullptr;
    NodeIndex node;
    std::vector<Talker*> talkers;
    std::vector<Process*> processes;
  };
  LocalClock ideal_clock_;
  std::vector<std::unique_ptr<NodeClock>> clocks_;                      // by node; null: ideal
  std::vector<std::unique_ptr<Followers>> followers_;                   // by node; null: ideal
  std::vector<std::unique_ptr<gptp::Station>> stations_;                // by node; null: no gPTP
  std::vector<std::pair<NodeIndex, std::uint16_t>> port_of_component_;  // for stations
  std::optional<StreamIndex> gptp_stream_;
  std::vector<std::size_t> first_port_;  // ports of node n: first_port_[n] .. first_port_[n + 1]
  std::unique_ptr<EgressPort[]> ports_;
  std::vector<std::unique_ptr<Cpu>> cpus_;                    // by node; null where nothing takes time
  std::vector<std::unique_ptr<OsLatency>> thread_latencies_;  // of processes on threads with a law of their own
  std::vector<std::unique_ptr<Host>> hosts_;                  // by node; null for bridges
  std::optional<Routes> routes_;
  std::vector<std::unique_ptr<Bridge>> bridges_;            // by node; null for hosts with one port
  std::vector<std::unique_ptr<ForwardingJitter>> jitters_;  // of bridges that have one
  std::vector<std::unique_ptr<HostOutput>> outputs_;        // by node; null for bridges
  std::vector<std::unique_ptr<IngressPipeline>> ingress_;   // by node; null where there is none
  std::vector<bool> bypassed_;                              // by node; empty until a bypass acts
  std::vector<Joint> joints_;  // one that is down stays until another link takes its place: frames that it has lost
                               // have not all come to their end
  std::vector<std::uint32_t> cuts_;          // by link: those of the reasons that are its own
  std::vector<std::uint32_t> reasons_down_;  // by link: how many reasons it has to be down
  std::vector<std::uint32_t> crashes_;       // by node: how many crashes it has not come back from
  std::vector<std::unique_ptr<Talker>> talkers_;
  std::multimap<std::uint32_t, Talker*> babblers_;  // by stream
  std::vector<std::unique_ptr<Process>> processes_;
  std::vector<NodeIndex> host_of_process_;
};

}  // namespace takt::models
