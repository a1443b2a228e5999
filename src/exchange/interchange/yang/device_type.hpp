// SPDX-License-Identifier: Apache-2.0
// What a bridge announces of itself (IEC/IEEE 60802, IEEE 802.1Q) as a type of device.
#pragma once

#include <string>
#include <vector>

#include "interchange/yang/data.hpp"
#include "interchange/yang/redundancy_import.hpp"
#include "scenario/description/device.hpp"

namespace takt::interchange::yang {

/// Of all files of one device. What has no place in a type of device is a remark; nothing where the data announce
/// nothing.
std::optional<scenario::Device> device_type_of(const std::vector<const Data*>& files, const std::string& name,
                                               Imported& imported, json::Diagnostics& diagnostics);

/// Delays and queues that bridges announce by IEC/IEEE 60802, put into the nodes of a scenario; the rest is a remark.
void set_announced(const DeviceData& files, scenario::Scenario& scenario, Imported& imported,
                   json::Diagnostics& diagnostics);

/// The file of a device, as people would write it.
std::string device_text(const scenario::Device& device);

}  // namespace takt::interchange::yang
