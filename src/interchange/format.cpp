#include "interchange/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interchange/graph/graph.hpp"
#include "interchange/linux/linux.hpp"
#include "interchange/yang/yang.hpp"

namespace takt::interchange {
namespace {

const std::array exports{
    ExportFormat{"linux", "a script for each node (tc, ethtool, bridge, ip) and ptp4l.conf", "queues, gates, shapers, preemption, SDU sizes, policing, launch times, filtering entries, gPTP",
                 "times of hosts and switches; streams, programs, applications, faults, requirements", linux_export_settings, export_linux},
    ExportFormat{"yang", "instance data of IEEE 802.1Q modules for each node", "queues, gates, shapers, preemption, SDU sizes; policing and ATS (published dialect)",
                 "times of hosts and switches; clocks, streams, programs, applications, faults, requirements", yang_export_settings, export_yang},
    ExportFormat{"dot", "the topology for Graphviz", "nodes, links", "all else", {}, export_dot},
};

const std::array imports{
    ImportFormat{"linux", "what Linux machines are set to", "NODE.sh (commands), NODE.*.json (of `tc -j qdisc show`, `ip -j -d link show`, `bridge -j vlan show`), NODE.*.conf (ptp4l); *.names.json of an export",
                 linux_import_settings, true, false, import_linux},
    ImportFormat{"yang", "instance data of devices: the published modules and those of 2018", "NODE.json, NODE.xml; *.names.json of an export", {}, true, false, import_yang},
};

std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

void add_settings(std::string& text, std::string_view command, std::string_view format, std::span<const SettingInfo> settings) {
  for (const SettingInfo& setting : settings)
    text += fmt::format("| `takt {} {} -o {}=` | {} | {} | {} |\n", command, format, setting.key, cell(setting.values), setting.fallback.empty() ? "" : "`" + std::string(setting.fallback) + "`", cell(setting.help));
}

}  // namespace

std::span<const ExportFormat> export_formats() { return exports; }
std::span<const ImportFormat> import_formats() { return imports; }

const ExportFormat* find_export_format(std::string_view name) {
  const auto found = std::ranges::find(exports, name, &ExportFormat::name);
  return found == exports.end() ? nullptr : &*found;
}
const ImportFormat* find_import_format(std::string_view name) {
  const auto found = std::ranges::find(imports, name, &ImportFormat::name);
  return found == imports.end() ? nullptr : &*found;
}

std::string formats_reference() {
  std::string text = "| `takt export` | writes | says | is not its business |\n|---|---|---|---|\n";
  for (const ExportFormat& format : exports) text += fmt::format("| `{}` | {} | {} | {} |\n", format.name, cell(format.help), cell(format.carries), cell(format.outside));
  text += "\n| `takt import` | reads | files | |\n|---|---|---|---|\n";
  for (const ImportFormat& format : imports) text += fmt::format("| `{}` | {} | {} | {} |\n", format.name, cell(format.help), cell(format.files), format.into_base ? "`--into`" : "");
  text += "\n| setting | values | if not set | |\n|---|---|---|---|\n";
  for (const ExportFormat& format : exports) add_settings(text, "export", format.name, format.settings);
  for (const ImportFormat& format : imports) add_settings(text, "import", format.name, format.settings);
  return text;
}

}  // namespace takt::interchange
