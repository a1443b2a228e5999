// SPDX-License-Identifier: Apache-2.0
// Latencies of scenarios as distributions: what a file says, and what the named operating systems stand for.
#pragma once

#include "application/latency_law.hpp"
#include "models/host/os_latency.hpp"
#include "scenario/description/description.hpp"

namespace takt::scenario {

using application::distribution_of;

/// The three delays of a host. Figures of the profiles: published cyclictest and network stack measurements; see
/// docs/host-latency.md. They are examples of their kind, not promises about a certain machine.
models::OsLatency os_latency_of(const OperatingSystem& os, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
