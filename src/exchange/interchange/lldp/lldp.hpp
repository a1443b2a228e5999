// SPDX-License-Identifier: Apache-2.0
// Topology from what LLDP daemons see: `lldpcli -f json` or `-f json0`, `show neighbors details` and `show chassis`, of
// each machine. docs/interchange.md, "lldp".
#pragma once

#include "interchange/import.hpp"

namespace takt::interchange {

Imported import_lldp(const ImportRequest& request, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
