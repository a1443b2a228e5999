// SPDX-License-Identifier: Apache-2.0
// From what a Linux machine is set to, to what takt's nodes are.
#pragma once

#include "interchange/device_import.hpp"
#include "interchange/linux/device.hpp"

namespace takt::interchange::linux_tc {

/// The machine is sound (check()). What takt does otherwise, or does not have, is a remark.
ImportedDevice device_of(const std::string& name, const json::Place& place, const Machine& machine, const Names& names,
                         Imported& imported, json::Diagnostics& diagnostics);

/// Reads a ptp4l.conf into the device's gPTP and clock.
void read_ptp4l(const InputFile& file, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics);

}  // namespace takt::interchange::linux_tc
