// SPDX-License-Identifier: Apache-2.0
// Talkers as a capture has them: period, jitter and sizes of each stream of frames. docs/interchange.md, "pcap".
#pragma once

#include "interchange/import.hpp"

namespace takt::interchange {

Imported import_pcap(const ImportRequest& request, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
