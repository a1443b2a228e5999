// SPDX-License-Identifier: Apache-2.0
// Formats that carry a part each, put together: the topology as LLDP daemons tell it, the streams as a table, what
// bridges are set to as YANG instance data. Of a shipped scenario, cut down to what the three can say, the same run
// comes of it.
#include <fmt/format.h>

#include "round_trip.hpp"

namespace takt::interchange::test {
namespace {

std::string ps(sim::Duration duration) { return fmt::format("{}ps", duration.ps()); }
std::string interface_of(const scenario::Topology& topology, std::uint32_t node, std::uint16_t port) {
  return (topology.nodes[node].forwards() ? "swp" : "eth") + std::to_string(port);
}

/// As `lldpcli -f json` names a rate; empty if it has no name for it.
std::string mau_type(sim::DataRate rate) {
  for (const auto& [mbps, name] : {std::pair<std::uint64_t, const char*>{10, "10BaseTFD"},
                                   {100, "100BaseTXFD"},
                                   {1'000, "1000BaseTFD"},
                                   {2'500, "2p5GigT"},
                                   {5'000, "5GigT"},
                                   {10'000, "10GigBaseT"},
                                   {25'000, "25GbaseT"},
                                   {40'000, "40GbaseKR4"},
                                   {100'000, "100GbaseCR4"}})
    if (rate.bits_per_second == mbps * 1'000'000) return name;
  return {};
}

/// What `lldpcli -f json show neighbors details` and `show chassis` print on each machine.
std::vector<InputFile> lldp_reports(const scenario::Topology& topology) {
  std::vector<InputFile> files;
  const auto chassis = [&](std::uint32_t node) {
    return fmt::format(
        R"({{"{}": {{"id": {{"type": "mac", "value": "02:00:00:00:00:{:02x}"}}, "capability": [{{"type": "Bridge", "enabled": {}}}]}}}})",
        topology.nodes[node].name, node, topology.nodes[node].forwards());
  };
  for (std::uint32_t node = 0; node < topology.nodes.size(); ++node) {
    std::string interfaces;
    for (const models::LinkPlan& link : topology.links) {
      for (const auto& [here, there] : {std::pair(link.a, link.b), std::pair(link.b, link.a)}) {
        if (here.node.value != node) continue;
        const std::string remote = interface_of(topology, there.node.value, there.port);
        interfaces += fmt::format(
            R"({}{{"{}": {{"chassis": {}, "port": {{"id": {{"type": "ifname", "value": "{}"}}, "descr": "{}", "auto-negotiation": {{"current": "{} - as it is"}}}}}}}})",
            interfaces.empty() ? "" : ", ", interface_of(topology, node, here.port), chassis(there.node.value), remote,
            remote, mau_type(link.rate));
      }
    }
    const std::string& name = topology.nodes[node].name;
    files.push_back(
        {name + ".chassis.json", name, fmt::format(R"({{"local-chassis": {{"chassis": {}}}}})", chassis(node))});
    files.push_back({name + ".neighbors.json", name, fmt::format(R"({{"lldp": {{"interface": [{}]}}}})", interfaces)});
  }
  return files;
}

InputFile table_of(const scenario::Scenario& scenario) {
  std::string text = "name,from,to,payload,every,offset,jitter,pcp,vlan,encapsulation\n";
  for (const scenario::Stream& stream : scenario.streams) {
    std::string to;
    for (const std::string& name : stream.to.names) to += (to.empty() ? "" : ";") + name;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", stream.name, stream.from, to, stream.payload.count,
                        ps(*stream.every), stream.offset ? ps(stream.offset->value) : "", ps(stream.jitter),
                        stream.pcp ? std::to_string(*stream.pcp) : "", stream.vlan,
                        stream.encapsulation == scenario::Encapsulation::udp ? "udp" : "ethernet");
  }
  return {"streams.csv", "streams", text};
}

/// What the three say of a scenario together. Nothing: it has stations, rates without a name, or gates that takt lays
/// out.
std::optional<scenario::Scenario> sayable(const scenario::Resolved& whole) {
  scenario::Scenario bare;
  bare.name = whole.scenario.name;
  bare.seed = whole.scenario.seed;
  bare.duration = whole.scenario.duration;
  bare.allow_overload = whole.scenario.allow_overload;
  if (whole.gates) return std::nullopt;
  for (const scenario::TopologyNode& node : whole.topology.nodes) {
    if (node.forwards() && node.is_end_station()) return std::nullopt;
    scenario::Node kept =
        node.forwards() ? scenario::Node(scenario::SwitchNode{}) : scenario::Node(scenario::HostNode{});
    scenario::ports_of(kept) = scenario::ports_of(node.description);
    bare.network.nodes.emplace_back(node.name, std::move(kept));
  }
  for (const models::LinkPlan& plan : whole.topology.links) {
    if (mau_type(plan.rate).empty()) return std::nullopt;
    scenario::Link link;
    for (const auto& end : {plan.a, plan.b})
      link.ends.push_back(whole.topology.nodes[end.node.value].name + ":" + std::to_string(end.port));
    link.rate = plan.rate;
    bare.network.links.push_back(std::move(link));
  }
  for (const scenario::Stream& stream : whole.scenario.streams) {
    if (!stream.every || stream.exponential || stream.normal || stream.burst || stream.trace || stream.redundancy ||
        (stream.offset && stream.offset->is_auto))
      continue;
    scenario::Stream kept = stream;
    kept.host_priority.reset();
    kept.launch.reset();
    kept.path.reset();
    bare.streams.push_back(std::move(kept));
  }
  if (bare.streams.empty()) return std::nullopt;
  return bare;
}

TEST(RoundTrip, ByLldpATableAndYangTogether) {
  std::size_t went_round = 0, with_settings = 0;
  for (const std::filesystem::path& path : shipped()) {
    SCOPED_TRACE(path);
    json::Diagnostics diagnostics;
    const auto whole = scenario::load_file(path, {}, diagnostics);
    ASSERT_TRUE(whole) << diagnostics.to_text();
    const std::optional<scenario::Scenario> bare = sayable(*whole);
    if (!bare) continue;
    json::Diagnostics unsound;  // too much for a link, without what was cut off
    const auto expected = scenario::load_text(sparse_text(*bare), path, {}, unsound);
    if (!expected) continue;
    const ExportFormat* const yang = find_export_format("yang");
    std::string mistake;
    const Exported exported = yang->write({*expected, {}, *Settings::read({}, yang->settings, mistake)});
    if (!exported.losses.empty()) continue;

    const Reading network = read("lldp", lldp_reports(expected->topology));
    ASSERT_TRUE(network.imported.scenario) << network.remarks();
    EXPECT_FALSE(network.lost()) << network.remarks();
    const Reading streams = read("csv", {table_of(*bare)}, &*network.imported.scenario);
    ASSERT_TRUE(streams.imported.scenario) << streams.remarks();
    std::vector<InputFile> devices;
    for (const OutputFile& file : exported.files)
      devices.push_back({file.name, file.name.substr(0, file.name.find('.')), file.content});
    const Reading together = read("yang", devices, &*streams.imported.scenario);
    ASSERT_TRUE(together.imported.scenario) << together.remarks();
    scenario::Scenario made = *together.imported.scenario;
    made.seed = bare->seed;
    made.duration = bare->duration;
    made.allow_overload = bare->allow_overload;
    const auto again = scenario::load_text(sparse_text(made), path, {}, diagnostics);
    ASSERT_TRUE(again) << diagnostics.to_text();
    const sim::Duration duration = std::min(bare->duration, sim::Duration::from_ps(20'000'000'000));
    EXPECT_EQ(digest_of(*again, duration), digest_of(*expected, duration));
    ++went_round;
    with_settings +=
        std::ranges::any_of(bare->network.nodes,
                            [](const auto& node) { return !scenario::ports_of(node.second).egress.empty(); })
            ? 1
            : 0;
  }
  EXPECT_GE(went_round, 20u);
  EXPECT_GE(with_settings, 8u);
}

}  // namespace
}  // namespace takt::interchange::test
