// SPDX-License-Identifier: Apache-2.0
// A network as plain data: what Network is built from. It is checked before (scenario/); here it is taken as sound.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/clock/node_clock.hpp"
#include "models/egress/port_config.hpp"
#include "models/ethernet/frame.hpp"
#include "models/fault/link_fault.hpp"
#include "models/frer/redundancy_config.hpp"
#include "models/gptp/station_plan.hpp"
#include "models/host/cpu_plan.hpp"
#include "models/host/os_latency.hpp"
#include "models/host/talker_schedule.hpp"
#include "models/ingress/ingress_config.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// A host sends and receives, a bridge forwards, a station does both.
enum class NodeKind : std::uint8_t { host, bridge, station };

struct NodePlan {
  std::string name;
  NodeKind kind = NodeKind::host;
  bool forwards() const { return kind != NodeKind::host; }
  bool is_end_station() const { return kind != NodeKind::bridge; }
  sim::Duration forwarding_delay;  ///< if it forwards: last bit in to the egress queue, or to the host in the station
  std::uint32_t port_config = 0;   ///< index into NetworkPlan::port_configs
  std::uint32_t os_latency = 0;    ///< end stations: index into NetworkPlan::os_latencies
  std::optional<NodeClockPlan> clock = {};    ///< its own clock; true time if absent
  std::optional<std::uint32_t> ingress = {};  ///< if it forwards: index into NetworkPlan::ingress_configs
  Octets cut_through_header{22};  ///< if it forwards: octets, preamble included, of an untagged frame that must be in
                                  ///< before it is cut through
  std::shared_ptr<const sim::Distribution> forwarding_jitter =
      {};  ///< if it forwards: a random time besides forwarding_delay, see ForwardingJitter; null if there is none
  std::shared_ptr<const CpuPlan> cpu =
      {};  ///< end stations: whose threads take time; null: what programs and the protocol stack do takes none

  sim::Duration least_forwarding_delay() const {
    return forwarding_delay + (forwarding_jitter ? forwarding_jitter->least() : sim::Duration());
  }
  sim::Duration greatest_forwarding_delay() const {
    return forwarding_delay + (forwarding_jitter ? forwarding_jitter->greatest() : sim::Duration());
  }
};

struct LinkPlan {
  struct End {
    NodeIndex node;
    std::uint16_t port = 0;                         ///< port number within the node, from 0
    bool gates_may_stick = false;                   ///< a fault of its gates is planned
    bool gates_may_change = false;                  ///< Network::request_gates may be called for it
    std::optional<std::uint32_t> port_config = {};  ///< index into NetworkPlan::port_configs, if not that of the node
  };
  End a;
  End b;
  sim::DataRate rate;
  sim::Duration delay;    ///< propagation, the same both ways
  bool may_fail = false;  ///< something may go wrong on it, or at a node at its ends
};

/// Chance on one direction of a link.
struct ImpairmentPlan {
  std::uint32_t link = 0;  ///< index into NetworkPlan::links, with may_fail
  bool from_a_to_b = true;
  Impairment impairment;
};

struct StreamPlan {
  std::string name;
  NodeIndex talker;
  AddressIndex destination;
  VlanId vlan = 0;
  std::optional<Priority> priority;  ///< with a priority the frames carry a VLAN tag; without one they are untagged
  Octets headers{0};
  std::vector<NodeIndex> listeners;
  std::uint16_t ether_type = 0;       ///< of frames without headers; 0: takt's choice
  std::uint16_t udp_port = 0;         ///< of the receivers; 0: takt's choice
  std::uint16_t udp_source_port = 0;  ///< of the sender; 0: takt's choice
  std::uint32_t ip_group = 0;         ///< IPv4 multicast address to which it goes; 0: takt's choice
  std::optional<Priority> host_priority =
      {};  ///< untagged: by which the talker's own interfaces queue it; it is not on the wire
  /// What decides about the queue at the talker.
  Priority priority_at_talker() const { return host_priority.value_or(priority.value_or(0)); }
};

/// Static filtering entries: at `node`, frames of (vlan, address) leave through `port`. Those of a node with several
/// ports hold for what it sends itself, too. At a station `internal_port` leads to its own host.
struct FilteringPlan {
  NodeIndex node;
  VlanId vlan = 0;
  AddressIndex address;
  std::uint16_t port = 0;
};

struct TalkerPlan {
  StreamIndex stream;
  Octets payload;
  TalkerSchedule schedule;
  std::optional<sim::Duration> launch = {};        ///< see Talker::set_launch
  sim::LocalTime until = sim::LocalTime::never();  ///< see Talker::set_until
  bool babbles = false;                            ///< see Talker::set_babbling; at most one of a stream at a time
  std::string name = {};                           ///< in the random streams, if not that of the stream
};

/// An ATS scheduler at the talker of a stream; see TalkerAts.
struct TalkerAtsPlan {
  StreamIndex stream;
  sim::DataRate committed_information_rate;  ///< as in AtsSchedulerConfig, as are the others
  Octets committed_burst_size{0};
  bool media_overhead = true;
};

/// Addresses 0 .. nodes-1 are the unicast addresses of the nodes; further ones are groups.
struct NetworkPlan {
  std::vector<NodePlan> nodes;
  std::vector<LinkPlan> links;
  std::vector<StreamPlan> streams;
  std::vector<FilteringPlan> filtering;
  std::vector<TalkerPlan> talkers;
  std::vector<PortConfig> port_configs = {PortConfig{}};
  std::vector<OsLatency> os_latencies = {OsLatency{}};
  std::vector<IngressConfig> ingress_configs;
  std::vector<TalkerAtsPlan> talker_ats;  ///< at most one of a stream
  std::vector<HostSplitPlan> host_splits;
  std::vector<HostRecoveryPlan> host_recoveries;
  std::vector<ImpairmentPlan> impairments;
  /// gPTP, by node: index into gptp_stations; empty: none. Nodes with gPTP have a clock of their own.
  std::vector<std::optional<std::uint32_t>> gptp;
  std::vector<gptp::StationPlan> gptp_stations;
};

}  // namespace takt::models
