// SPDX-License-Identifier: Apache-2.0
// The delays of a device between the ports that a node has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/description/device.hpp"

namespace takt::scenario {

/// What is at a port of a node.
struct DevicePort {
  DataRate rate;
  std::optional<Medium> medium = {};
  bool operator==(const DevicePort&) const = default;
};

struct DelayInterval {
  Duration least;
  Duration greatest;
};

/// Ports between which a device has no delay.
struct MissingDelay {
  DevicePort from;
  DevicePort to;
};

/// The octets of a frame around those that an MTU counts: addresses, tag, EtherType, FCS.
inline constexpr std::uint32_t octets_around_msdu = 22;

/// Its medium, or its rate.
std::string to_text(const DevicePort& port);

/// The least and the greatest delay between any two of the ports, in any class, of frames of 64 octets up to
/// `longest_frame`. Nothing, and the ports in `missing`, if the device does not say one of them.
std::optional<DelayInterval> delays_between(const Device& device, const std::vector<DevicePort>& ports,
                                            Octets longest_frame, std::optional<MissingDelay>& missing);

/// The interval as a node has it: what is fixed, and a jitter, all of whose values are equally likely.
void set_delays(const DelayInterval& interval, const json::Source& where, Duration& forwarding_delay,
                std::optional<Latency>& forwarding_jitter);

}  // namespace takt::scenario
