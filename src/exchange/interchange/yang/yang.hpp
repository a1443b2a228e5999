// SPDX-License-Identifier: Apache-2.0
// YANG instance data of IEEE 802.1Q and its relatives, in JSON and XML: the published modules and those of 2018.
// docs/interchange.md, "yang".
#pragma once

#include "interchange/export.hpp"
#include "interchange/import.hpp"

namespace takt::interchange {

extern const std::span<const SettingInfo> yang_export_settings;

/// A file for each node.
Exported export_yang(const ExportRequest& request);

/// Files of devices: config, edits and state; limits that devices announce are told.
Imported import_yang(const ImportRequest& request, json::Diagnostics& diagnostics);

/// The same files, as a type of device: what one bridge announces of itself.
Imported import_device(const ImportRequest& request, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
