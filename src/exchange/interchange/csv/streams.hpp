// SPDX-License-Identifier: Apache-2.0
// A table of streams: CSV with a header line. docs/interchange.md, "csv".
#pragma once

#include "interchange/import.hpp"

namespace takt::interchange {

Imported import_csv(const ImportRequest& request, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
