// SPDX-License-Identifier: Apache-2.0
// Stream identification, stream filters, gates, meters and ATS schedulers of instance data.
#pragma once

#include "interchange/device_import.hpp"
#include "interchange/yang/data.hpp"

namespace takt::interchange::yang {

void read_policing(const Data& root, const Names& names, bool has_base, ImportedDevice& device, Imported& imported,
                   json::Diagnostics& diagnostics);

}  // namespace takt::interchange::yang
