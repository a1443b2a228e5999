// SPDX-License-Identifier: Apache-2.0
// A Wireshark profile for captures of a scenario: names of addresses, colours by priority, buttons for streams.
#pragma once

#include "interchange/export.hpp"

namespace takt::interchange {

Exported export_wireshark(const ExportRequest& request);

}  // namespace takt::interchange
