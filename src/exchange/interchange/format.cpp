// SPDX-License-Identifier: Apache-2.0
#include "interchange/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interchange/csv/streams.hpp"
#include "interchange/graph/graph.hpp"
#include "interchange/inet/inet.hpp"
#include "interchange/linux/linux.hpp"
#include "interchange/lldp/lldp.hpp"
#include "interchange/pcap/import.hpp"
#include "interchange/planning/planning.hpp"
#include "interchange/qcc/qcc.hpp"
#include "interchange/uadp/uadp.hpp"
#include "interchange/wireshark/wireshark.hpp"
#include "interchange/yang/yang.hpp"

namespace takt::interchange {
namespace {

const std::array exports{
    ExportFormat{"linux", "a script for each node (tc, ethtool, bridge, ip) and ptp4l.conf",
                 "queues, gates, shapers, preemption, SDU sizes, policing, launch times, filtering entries, gPTP",
                 "times of hosts and switches; streams, programs, applications, faults, requirements",
                 linux_export_settings, export_linux},
    ExportFormat{
        "yang", "instance data of IEEE 802.1Q modules for each node",
        "queues, gates, shapers, preemption, SDU sizes; policing, ATS, redundancy and gPTP (published dialect)",
        "times of hosts and switches; oscillators and servos, streams, programs, applications, faults, requirements",
        yang_export_settings, export_yang},
    ExportFormat{"inet",
                 "a network (NED) and its configuration (ini) for INET 4.6",
                 "network, streams with UDP, queues, gates, shapers, redundancy",
                 "requirements, verification, bounds",
                 {},
                 export_inet},
    ExportFormat{"qcc",
                 "requests for streams as a CUC gives them, and the configurations of talkers that a CNC answers "
                 "(ieee802-dot1q-cnc-config)",
                 "streams with intervals, sizes, offsets, priorities, listeners; required latencies",
                 "network, nodes, ports, clocks, faults",
                 {},
                 export_qcc},
    ExportFormat{"uadp",
                 "publishers and subscribers of each node as a PubSub configuration of OPC UA (a binary file with a "
                 "PubSubConfigurationDataType, as open62541 loads it)",
                 "messages of programs: data sets, ids, content masks, intervals, offsets, time-outs, addresses",
                 "network, streams, faults, requirements; the handshake itself",
                 {},
                 export_uadp},
    ExportFormat{
        "wireshark",
        "a profile of Wireshark for captures of the scenario: ethers, colorfilters, dfilter_buttons, preferences",
        "names of addresses, priorities, streams",
        "all else",
        {},
        export_wireshark},
    ExportFormat{
        "neutral",
        "the neutral scheduling problem (schedule-problem-1) that takt schedule reads",
        "network, streams with periods, sizes, classes, offsets and paths, latency and jitter that are required",
        "gates that takt lays out, offsets that it chooses; other requirements",
        {},
        export_neutral},
    ExportFormat{"tsnkit",
                 "tasks and a topology as CSV for tsnkit, and a table of names",
                 "network, streams with periods and sizes, latency and jitter that are required",
                 "gates that takt lays out, offsets that it chooses; other requirements",
                 {},
                 export_tsnkit},
    ExportFormat{
        "graphml", "the topology as GraphML", "nodes, links, ports, rates, delays", "all else", {}, export_graphml},
    ExportFormat{"dot", "the topology for Graphviz", "nodes, links", "all else", {}, export_dot},
    ExportFormat{"svg", "the topology as a picture", "nodes, links", "all else", {}, export_svg},
};

const std::array imports{
    ImportFormat{"linux", "what Linux machines are set to",
                 "NODE.sh, .batch, .trace (commands), .json (of `tc -j`, `ip -j -d`, `bridge -j`), .conf (ptp4l); "
                 "*.names.json of an export",
                 linux_import_settings, true, false, import_linux},
    ImportFormat{"yang",
                 "instance data of devices: the published modules and those of 2018",
                 "NODE.json, NODE.xml; *.names.json of an export",
                 {},
                 true,
                 false,
                 import_yang},
    ImportFormat{"device",
                 "a type of device, by what a bridge announces (iecieee60802-bridge, -ethernet-interface, "
                 "-sched-bridge, state of IEEE 802.1Q)",
                 "TYPE.json, TYPE.xml: instance data of one bridge",
                 {},
                 false,
                 false,
                 import_device},
    ImportFormat{
        "lldp",
        "the topology that LLDP daemons see",
        "NODE.*.json, NODE.*.json0 (of `lldpcli -f json show neighbors details` and `show chassis` on each machine)",
        {},
        false,
        false,
        import_lldp},
    ImportFormat{"inet", "a network of INET: the TSN subset of NED and ini", "*.ned, one .ini", inet_import_settings,
                 false, false, import_inet},
    ImportFormat{"graphml", "a topology as GraphML", "one .graphml", graphml_import_settings, false, false,
                 import_graphml},
    ImportFormat{"neutral", "a neutral scheduling problem, and perhaps its schedule",
                 "PROBLEM.json, SOLUTION.json (of takt schedule --out)", planning_import_settings, false, false,
                 import_neutral},
    ImportFormat{"tsnkit", "an instance of tsnkit", "TASK.csv and TOPOLOGY.csv; *.names.json of an export",
                 planning_import_settings, false, false, import_tsnkit},
    ImportFormat{"tas-benchmark", "an instance of TAS_Benchmark (Tuebingen)", "one .json", planning_import_settings,
                 false, false, import_tas_benchmark},
    ImportFormat{"tsnbench", "an instance of TSNBenchScenarios (Rostock)", "TOPOLOGY.top and STREAMS.pat",
                 planning_import_settings, false, false, import_tsnbench},
    ImportFormat{"tsnsched", "an input of TSNsched", "one .json", planning_import_settings, false, false,
                 import_tsnsched},
    ImportFormat{"ecrts", "the industrial challenge of ECRTS'25", "one .txt", planning_import_settings, false, false,
                 import_ecrts},
    ImportFormat{"applications", "a network as GraphML with applications (TT and AVB) as XML",
                 "NETWORK.graphml and APPLICATIONS.xml", applications_import_settings, false, false,
                 import_applications},
    ImportFormat{"csv",
                 "tables of cables, devices, streams and Programs",
                 "*.csv, each with a header: of cables, devices, streams or Programs",
                 {},
                 true,
                 false,
                 import_csv},
    ImportFormat{"pcap",
                 "the talkers of a running plant, by what a capture holds: period, jitter, sizes",
                 "captures of Ethernet (pcap, pcapng); *.names.json of an export",
                 {},
                 true,
                 true,
                 import_pcap},
};

std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

void add_settings(std::string& text, std::string_view command, std::string_view format,
                  std::span<const SettingInfo> settings) {
  for (const SettingInfo& setting : settings)
    text += fmt::format("| `takt {} {} -o {}=` | {} | {} | {} |\n", command, format, setting.key, cell(setting.values),
                        setting.fallback.empty() ? "" : "`" + std::string(setting.fallback) + "`", cell(setting.help));
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
  for (const ExportFormat& format : exports)
    text += fmt::format("| `{}` | {} | {} | {} |\n", format.name, cell(format.help), cell(format.carries),
                        cell(format.outside));
  text += "\n| `takt import` | reads | files | |\n|---|---|---|---|\n";
  for (const ImportFormat& format : imports)
    text += fmt::format("| `{}` | {} | {} | {} |\n", format.name, cell(format.help), cell(format.files),
                        format.into_base ? "`--into`" : "");
  text += "\n| setting | values | if not set | |\n|---|---|---|---|\n";
  for (const ExportFormat& format : exports) add_settings(text, "export", format.name, format.settings);
  for (const ImportFormat& format : imports) add_settings(text, "import", format.name, format.settings);
  return text;
}

}  // namespace takt::interchange
