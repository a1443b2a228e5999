// SPDX-License-Identifier: Apache-2.0
// Launch times (SO_TXTIME): the kernel holds a message back until its instant, so that waking up late does not show on
// the wire.
#pragma once

#include <cstdint>
#include <string>

#include "node/config.hpp"
#include "uadp/octets.hpp"

struct sockaddr;

namespace takt::node {

/// Switches launch times on for a socket that sends by `interface`. Returns what is in the way, or "": only the
/// queueing disciplines etf (with CLOCK_TAI) and fq (with CLOCK_MONOTONIC) heed launch times, so one of these must be
/// on the interface.
std::string enable_launch_times(int socket, ClockName clock, int interface);

/// Sends to `to`, or where the socket is bound to if it is null. `launch_ns` is on the socket's clock; 0: at once.
/// False if the kernel did not take it.
bool send_at(int socket, uadp::Octets octets, const sockaddr* to, std::size_t to_octets, std::int64_t launch_ns);

}  // namespace takt::node
