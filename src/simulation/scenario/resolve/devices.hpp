// SPDX-License-Identifier: Apache-2.0
// Types of devices ("device" of nodes): their files read, and what they say put where a node says it itself.
#pragma once

#include "json/diagnostics.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Reads the files that nodes and generators name, relative to that of the scenario, and gives what they say to the
/// keys that are not written there: delays, queues, classes, limits of gates. Mistakes in a file are reported as its
/// own. Media of links become their rates. Before the topology is built.
void read_devices(Scenario& scenario, json::Diagnostics& diagnostics);

/// Gives clocks that are free the time stamps of their devices, and gPTP their residence. Once the nodes are known.
void set_device_clocks(const Topology& topology, Scenario& scenario);

/// Reports what a scenario asks of a device that this has not. Once all is resolved.
void check_devices(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
