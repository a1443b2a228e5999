// SPDX-License-Identifier: Apache-2.0
// Publishers and subscribers of Programs as a configuration of OPC UA PubSub.
#pragma once

#include "interchange/export.hpp"

namespace takt::interchange {

Exported export_uadp(const ExportRequest& request);

}  // namespace takt::interchange
