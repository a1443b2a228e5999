// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "interchange/ports.hpp"
#include "interchange/wireshark/wireshark.hpp"

namespace takt::interchange {
namespace {

/// Names stand in fields with their own separators.
std::string plain(std::string_view name) {
  std::string text;
  for (const char c : name) text += c == '@' || c == '"' || c == ',' || c == '\n' || c == '#' ? '_' : c;
  return text;
}

}  // namespace

Exported export_wireshark(const ExportRequest& request) {
  const scenario::Resolved& r = request.resolved;
  std::string ethers, colours, buttons;
  for (std::uint32_t n = 0; n < r.plan.nodes.size(); ++n)
    ethers += fmt::format("{}\t{}\n", mac_text(mac_of(r, {n}), ':'), plain(r.plan.nodes[n].name));
  std::set<std::string> groups;
  for (const models::StreamPlan& stream : r.plan.streams) {
    const std::string address = mac_text(mac_of(r, stream.destination), ':');
    if (stream.destination.value >= r.plan.nodes.size() && groups.insert(address).second)
      ethers += fmt::format("{}\t{}\n", address, plain(stream.name));
    // A filter that tells this stream's frames from those of others.
    std::string filter =
        fmt::format("eth.src == {} && eth.dst == {}", mac_text(mac_of(r, {stream.talker.value}), ':'), address);
    if (stream.priority) filter += fmt::format(" && vlan.priority == {}", *stream.priority);
    if (stream.vlan != 0) filter += fmt::format(" && vlan.id == {}", stream.vlan);
    if (stream.udp_port != 0) filter += fmt::format(" && udp.dstport == {}", stream.udp_port);
    buttons += fmt::format("\"TRUE\",\"{}\",\"{}\",\"\"\n", plain(stream.name), filter);
  }
  // From grey to red by urgency: 16 bits a colour.
  constexpr std::array<const char*, 8> backgrounds = {
      "[57000,57000,57000]", "[60000,60000,60000]", "[57000,61000,65000]", "[52000,62000,62000]",
      "[55000,64000,55000]", "[64000,64000,50000]", "[65000,58000,45000]", "[65000,50000,50000]"};
  colours += "@gPTP@eth.type == 0x88f7@[55000,50000,65000][0,0,0]\n";
  for (int pcp = 7; pcp >= 0; --pcp)
    colours += fmt::format("@Priority {}@vlan.priority == {}@{}[0,0,0]\n", pcp, pcp,
                           backgrounds[static_cast<std::size_t>(pcp)]);
  const std::string preferences =
      "# takt: scenario " + plain(r.scenario.name) +
      "\nnameres.mac_name: TRUE\nframe.generate_epoch_time: TRUE\ngui.column.format: \n\t\"No.\", \"%m\",\n\t\"Time\", "
      "\"%t\",\n\t\"Source\", \"%uhs\",\n\t\"Destination\", \"%uhd\",\n\t\"PCP\", "
      "\"%Cus:vlan.priority:0:R\",\n\t\"Length\", \"%L\",\n\t\"Info\", \"%i\"\n";
  Exported exported;
  exported.files.push_back({"ethers", ethers});
  exported.files.push_back({"colorfilters", colours});
  exported.files.push_back({"dfilter_buttons", buttons});
  exported.files.push_back({"preferences", preferences});
  return exported;
}

}  // namespace takt::interchange
