// SPDX-License-Identifier: Apache-2.0
// INET 4.6: a network (NED) and its configuration (ini). docs/interchange.md, "inet".
#pragma once

#include "interchange/export.hpp"
#include "interchange/import.hpp"

namespace takt::interchange {

/// NAME.ned and omnetpp.ini, so that anybody can run the same network in INET.
Exported export_inet(const ExportRequest& request);

extern const std::span<const SettingInfo> inet_import_settings;
/// The TSN subset of NED and ini; what is not understood is refused by line.
Imported import_inet(const ImportRequest& request, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
