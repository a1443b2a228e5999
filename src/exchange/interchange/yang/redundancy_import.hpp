// SPDX-License-Identifier: Apache-2.0
// Redundancy (802.1CB) from the tables of devices: where streams are numbered, split and recovered, put together over
// all of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "interchange/device_import.hpp"
#include "interchange/yang/data.hpp"

namespace takt::interchange::yang {

/// A device's name, and what its file says.
using DeviceData = std::vector<std::pair<std::string, const Data*>>;

/// Gives the streams of `scenario` the redundancy that the tables say. The ways of the members are in no table: those
/// of the base stay, else takt chooses them. Streams that no table speaks of stay as they are.
void read_redundancy(const DeviceData& devices, const Names& names, scenario::Scenario& scenario, Imported& imported,
                     json::Diagnostics& diagnostics);

}  // namespace takt::interchange::yang
