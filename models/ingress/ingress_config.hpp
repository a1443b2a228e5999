// SPDX-License-Identifier: Apache-2.0
// What a bridge does to frames between the medium and its filtering database, as management sets it: stream
// identification, FRER, per-stream filtering and policing, ATS. Plain data; IngressPipeline is what lives.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "models/egress/port_config.hpp"
#include "models/frer/redundancy_config.hpp"
#include "models/ingress/flow_meter.hpp"
#include "models/ingress/stream_filter.hpp"
#include "models/ingress/stream_gate_list.hpp"
#include "models/ingress/stream_identification.hpp"

namespace takt::models {

using AtsGroupIndex = Index<struct AtsGroupTag>;

/// Null identification (IEEE 802.1CB 6.4) by the network's own name of an address. Fields as in NullIdentification.
struct AddressIdentification {
  AddressIndex destination;
  Tagged tagged = Tagged::all;
  VlanId vlan = 0;
  bool operator==(const AddressIdentification&) const = default;
};

/// One entry of the stream identity table. The octets of an MSDU are not known here: a mask over them matches nothing.
struct StreamIdentityEntry {
  StreamHandle stream;
  std::variant<AddressIdentification, SourceMacAndVlanIdentification, MaskAndMatchIdentification> function;
  std::optional<std::uint16_t> member = {};  ///< its frames are those of this member of the stream's recovery
  bool operator==(const StreamIdentityEntry&) const = default;
};

/// A stream gate. Without entries it stays as admin_gate_open and admin_ipv say.
struct StreamGateConfig {
  std::string name;
  bool admin_gate_open = true;
  std::optional<Priority> admin_ipv;
  std::vector<StreamGateEntry> admin_control_list;
  sim::Duration admin_cycle_time;
  sim::Duration admin_cycle_time_extension;
  sim::LocalTime admin_base_time;
  bool is_running = false;  ///< set before the start: a list whose base time lies in the past is in force then
  bool closed_due_to_invalid_rx_enable = false;       ///< a frame that comes while it is closed closes it for good
  bool closed_due_to_octets_exceeded_enable = false;  ///< so does one beyond the octets of an interval
  bool operator==(const StreamGateConfig&) const = default;
};

struct NamedFlowMeterConfig {
  std::string name;
  FlowMeterConfig meter;
  bool operator==(const NamedFlowMeterConfig&) const = default;
};

struct AtsSchedulerConfig {
  std::string name;
  sim::DataRate committed_information_rate;  ///< 1 b/s to 1 Tb/s
  Octets committed_burst_size{0};            ///< at least the longest frame, counted as `media_overhead` says
  bool media_overhead = true;                ///< preamble and inter-packet gap count too (8.6.11.3.11)
  AtsGroupIndex group;                       ///< none: that of reception port and upstream traffic class
  bool operator==(const AtsSchedulerConfig&) const = default;
};

struct AtsGroupConfig {
  std::string name;
  sim::Duration maximum_residence_time = sim::Duration::max();
  bool operator==(const AtsGroupConfig&) const = default;
};

struct IngressSplit {
  StreamHandle stream;
  StreamSplitConfig split;
  bool operator==(const IngressSplit&) const = default;
};

struct IngressRecovery {
  StreamHandle stream;
  StreamRecoveryConfig recovery;
  bool operator==(const IngressRecovery&) const = default;
};

/// The whole ingress of one bridge. Indices count within their tables.
struct IngressConfig {
  std::vector<std::string> streams;                        ///< names, by stream handle
  std::vector<StreamIdentityEntry> stream_identity_table;  ///< the first that matches names the stream
  std::vector<StreamFilterConfig> stream_filters;          ///< the first that matches is the frame's
  std::vector<StreamGateConfig> stream_gates;
  std::vector<NamedFlowMeterConfig> flow_meters;
  std::vector<AtsSchedulerConfig> ats_schedulers;
  std::vector<AtsGroupConfig> ats_groups;
  /// Of the groups that schedulers without one have: one for each reception port and upstream traffic class.
  sim::Duration maximum_residence_time = sim::Duration::max();
  std::array<TrafficClass, 8> traffic_class_of_priority = standard_traffic_classes;
  std::vector<IngressSplit> splits;
  std::vector<IngressRecovery> recoveries;
  bool operator==(const IngressConfig&) const = default;
};

}  // namespace takt::models
