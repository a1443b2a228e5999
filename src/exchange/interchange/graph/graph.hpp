// SPDX-License-Identifier: Apache-2.0
// The topology as a graph: dot and svg to look at, GraphML both ways.
#pragma once

#include "interchange/export.hpp"
#include "interchange/import.hpp"

namespace takt::interchange {

Exported export_dot(const ExportRequest& request);
Exported export_graphml(const ExportRequest& request);
Exported export_svg(const ExportRequest& request);

extern const std::span<const SettingInfo> graphml_import_settings;
Imported import_graphml(const ImportRequest& request, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
