// SPDX-License-Identifier: Apache-2.0
// A type of device as its data sheet has it: a file of its own, which nodes name by "device".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/description/description.hpp"

namespace takt::scenario {

/// What a bridge takes from the medium at the port of entry to that at the port of exit, PHYs included, beyond the
/// reception of the frame. An entry holds for ports of these rates and media and for this class; for all where absent.
struct DeviceDelay {
  json::Source where;
  std::optional<DataRate> from;
  std::optional<DataRate> to;
  std::optional<Medium> from_medium;
  std::optional<Medium> to_medium;
  std::optional<std::uint8_t> traffic_class;
  Duration least;
  Duration greatest;
  Duration least_per_octet;  ///< besides, for each octet of the frame
  Duration greatest_per_octet;
  bool operator==(const DeviceDelay&) const = default;
};

/// From the place of the time stamp to the medium and back.
struct DevicePhy {
  json::Source where;
  std::optional<DataRate> rate;
  std::optional<Medium> medium;
  Duration transmit;
  Duration receive;
  Duration variation;  ///< between the least and the greatest of either
  bool operator==(const DevicePhy&) const = default;
};

struct DeviceTimeStamps {
  json::Source where;
  std::optional<Duration> granularity;
  Duration error;
  bool operator==(const DeviceTimeStamps&) const = default;
};

/// From a gPTP message that comes to the one that follows from it.
struct DeviceResidence {
  json::Source where;
  Duration least;
  Duration greatest;
  bool operator==(const DeviceResidence&) const = default;
};

/// What it has; of what is absent nothing is known.
struct DeviceFeatures {
  json::Source where;
  std::optional<bool> gates;
  std::optional<bool> preemption;
  std::optional<bool> cut_through;
  std::optional<bool> credit_based_shaper;
  std::optional<bool> ats;
  std::optional<bool> ets;
  std::optional<bool> policing;
  std::optional<bool> frer;
  std::optional<bool> gptp;
  bool operator==(const DeviceFeatures&) const = default;
};

struct Device {
  json::Source where;
  std::optional<std::string> schema;  ///< "$schema", for editors
  std::string name;
  std::optional<std::string> vendor;
  std::string source;  ///< where the figures come from
  std::optional<std::string> description;
  std::vector<DeviceDelay> delays;
  std::vector<DevicePhy> phys;
  std::optional<std::uint32_t> ports;  ///< most links
  std::vector<DataRate> rates;         ///< of its ports; empty: not known
  std::optional<TrafficClasses> traffic_classes;
  std::optional<Queues> queues;
  std::optional<Octets> mtu;
  std::optional<GateLimits> gate_limits;
  std::optional<DeviceTimeStamps> time_stamps;
  std::optional<DeviceResidence> gptp_residence;
  DeviceFeatures features;
  bool operator==(const Device&) const = default;
};

const json::Object& describe(json::Type<DeviceDelay>);
const json::Object& describe(json::Type<DevicePhy>);
const json::Object& describe(json::Type<DeviceTimeStamps>);
const json::Object& describe(json::Type<DeviceResidence>);
const json::Object& describe(json::Type<DeviceFeatures>);
const json::Object& describe(json::Type<Device>);

}  // namespace takt::scenario
