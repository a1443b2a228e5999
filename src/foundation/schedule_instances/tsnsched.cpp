// SPDX-License-Identifier: Apache-2.0
// TSNsched: times in us, octets per us; sizes as they are sent. Latency ends with the last bit that the last switch
// sends.
#include <map>

#include "schedule_instances/formats.hpp"

namespace takt::schedule_instances {

using namespace schedule;
using json::Node;

namespace {

constexpr double us = 1'000'000;

void read_ports(json::Reader& reader, const Pick& network_switch, const std::string& name,
                const std::map<std::string, const Node*>& devices, Builder& builder) {
  const Node* const ports = network_switch.need_array("ports");
  if (ports == nullptr) return;
  for (const Node& each : ports->items) {
    const Pick pick(reader, each);
    const std::string peer = pick.text("connectsTo");
    if (peer == name) continue;  // generated inputs have ports that lead to their own switch and mean nothing
    const json::Place where = reader.source(each).place();
    const auto value = [&](std::string_view key, std::string_view general, double unit, Range range,
                           std::optional<std::int64_t> otherwise) {
      if (pick.find(key) != nullptr) return pick.scaled(key, unit, range);
      return network_switch.scaled(general, unit, range, otherwise);
    };
    const Ps travel = value("timeToTravel", "defaultTimeToTravel", us, delay_range, 0);
    const std::int64_t rate = value("portSpeed", "defaultPortSpeed", 8e6, rate_range, std::nullopt);
    Link link;
    link.octet = builder.octet_of(rate, where);
    const bool to_device = devices.contains(peer);
    Link back = link;
    back.propagation = travel;
    link.propagation = to_device ? 0 : travel;
    if (!builder.link_between(name, peer)) builder.add_link(link, name, peer, where);
    if (to_device && !builder.link_between(peer, name)) builder.add_link(back, peer, name, where);
  }
}

void read_flow(json::Reader& reader, const Pick& pick, const std::map<std::string, const Node*>& devices,
               Builder& builder) {
  const json::Place where = reader.source(pick.node()).place();
  const std::size_t mistakes = builder.diagnostics().errors();
  Stream stream;
  stream.name = pick.text("name");
  const std::string source = pick.text("sourceDevice");
  stream.talker = builder.node(source, where);
  if (const Node* const listeners = pick.need_array("endDevices")) {
    if (listeners->items.empty()) reader.error(*listeners, "a flow without end devices");
    for (const Node& one : listeners->items)
      stream.listeners.push_back(
          builder.node(one.kind == json::Kind::object ? Pick(reader, one).text("name") : text_of(reader, one), where));
  }
  if (builder.diagnostics().errors() != mistakes) return;
  const auto device_node = devices.find(source);
  if (device_node == devices.end()) return reader.error(pick.node(), json::quote(source) + " is no device");
  const Pick device(reader, *device_node->second);
  const auto of_flow_or_device = [&](std::string_view key, std::string_view general, double unit, Range range) {
    return pick.find(key) != nullptr ? pick.scaled(key, unit, range) : device.scaled(general, unit, range);
  };
  stream.octets = static_cast<std::uint32_t>(of_flow_or_device("packetSize", "defaultPacketSize", 1, octets_range));
  stream.period = of_flow_or_device("packetPeriodicity", "defaultPacketPeriodicity", us, period_range);
  stream.latency = of_flow_or_device("hardConstraintTime", "defaultHardConstraintTime", us, time_range);
  stream.jitter = pick.scaled_if_any("maximumJitter", us, time_range);
  std::vector<LinkIndex> links;
  if (pick.find("hops") != nullptr)
    if (const Node* const hops = pick.need_array("hops"))
      for (const Node& each : hops->items) {
        const Pick hop(reader, each);
        const std::string from = hop.text("currentNodeName"), to = hop.text("nextNodeName");
        if (const auto link = builder.link_between(from, to))
          links.push_back(*link);
        else
          reader.error(each, "no port leads from " + json::quote(from) + " to " + json::quote(to));
      }
  if (builder.diagnostics().errors() != mistakes) return;
  if (!links.empty()) builder.set_route(stream, std::move(links), where);
  builder.add_stream(std::move(stream), where);
}

}  // namespace

Instance read_tsnsched(const json::Document& document, json::Diagnostics& diagnostics) {
  json::Reader reader(document, diagnostics);
  const Pick top(reader, document.root());
  Builder builder(diagnostics);
  builder.problem().name = stem_of(document.file_name());
  builder.problem().source = "TSNsched";
  builder.problem().model.preamble = 0;
  builder.problem().model.gap = 0;
  std::map<std::string, const Node*> devices;
  const Node* const switches = top.need_array("switches");
  if (switches != nullptr)
    for (const Node& each : switches->items)
      builder.add_node(Pick(reader, each).text("name"), true, reader.source(each).place());
  if (const Node* const list = top.need_array("devices"))
    for (const Node& each : list->items) {
      const std::string name = Pick(reader, each).text("name");
      builder.add_node(name, false, reader.source(each).place());
      devices[name] = &each;
    }
  if (switches != nullptr)
    for (const Node& each : switches->items) {
      const Pick pick(reader, each);
      read_ports(reader, pick, pick.text("name"), devices, builder);
    }
  if (diagnostics.has_errors()) return {};
  if (const Node* const flows = top.need_array("flows"))
    for (const Node& each : flows->items) read_flow(reader, Pick(reader, each), devices, builder);
  return builder.take();
}

}  // namespace takt::schedule_instances
