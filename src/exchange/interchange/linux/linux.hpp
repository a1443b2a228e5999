// SPDX-License-Identifier: Apache-2.0
// Linux: shell scripts with tc, ethtool, bridge and ip, configuration files of ptp4l; and what `tc -j`, `ip -j` and
// `bridge -j` print of a machine. Formats and meanings: docs/interchange.md, "linux".
#pragma once

#include "interchange/export.hpp"
#include "interchange/import.hpp"

namespace takt::interchange {

extern const std::span<const SettingInfo> linux_export_settings;
extern const std::span<const SettingInfo> linux_import_settings;

/// A script for each node and a ptp4l.conf for each with gPTP.
Exported export_linux(const ExportRequest& request);

/// Scripts (`.sh`), output of `tc -j qdisc show`, `ip -j -d link show` and `bridge -j vlan show` (`.json`),
/// `ptp4l.conf` (`.conf`).
Imported import_linux(const ImportRequest& request, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
