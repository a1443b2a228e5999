// SPDX-License-Identifier: Apache-2.0
// Requests for streams as a CUC gives them to a CNC: instance data of ieee802-dot1q-cnc-config (802.1Qdj).
// docs/interchange.md, "qcc".
#pragma once

#include "interchange/export.hpp"

namespace takt::interchange {

Exported export_qcc(const ExportRequest& request);

}  // namespace takt::interchange
