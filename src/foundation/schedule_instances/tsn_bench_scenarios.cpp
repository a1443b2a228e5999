// SPDX-License-Identifier: Apache-2.0
// TSNBenchScenarios of the University of Rostock: a topology and a set of streams. Bridges cut through; hosts are
// listened to without delay.
#include <map>

#include "schedule_instances/formats.hpp"

namespace takt::schedule_instances {

using namespace schedule;
using json::Node;

namespace {

constexpr double in_ns = 1'000;

void read_topology(json::Reader& reader, const Pick& top, Builder& builder) {
  struct AtNode {
    Ps forwarding = 0;
    std::optional<std::uint32_t> cut;
  };
  std::map<std::string, AtNode> at_node;
  if (const Node* const nodes = top.need_array("nodes"))
    for (const Node& each : nodes->items) {
      const Pick pick(reader, each);
      const std::string name = pick.text("id");
      const bool is_bridge = pick.truth("is_switch");
      builder.add_node(name, is_bridge, reader.source(each).place());
      AtNode at;
      if (is_bridge) {
        at.forwarding = pick.scaled("processing_delay_ns", in_ns, delay_range);
        if (const auto cut = pick.whole_if_any("fwd_header_b", {0, octets_range.most}))
          at.cut = static_cast<std::uint32_t>(*cut);
      }
      at_node[name] = at;
    }
  if (const Node* const links = top.need_array(top.find("links") != nullptr ? "links" : "edges"))
    for (const Node& each : links->items) {
      const Pick pick(reader, each);
      const json::Place where = reader.source(each).place();
      const std::string to = pick.text("target");
      Link link;
      link.name = pick.text("key");
      link.octet = builder.octet_of(pick.scaled("link_speed_mbps", 1e6, rate_range), where);
      link.propagation = pick.scaled("propagation_delay_ns", in_ns, delay_range, 0);
      link.forwarding = at_node[to].forwarding;
      link.cut_through = at_node[to].cut;
      builder.add_link(std::move(link), pick.text("source"), to, where);
    }
}

void read_stream(json::Reader& reader, const std::string& name, const Pick& pick, Builder& builder) {
  const json::Place where = reader.source(pick.node()).place();
  const std::size_t mistakes = builder.diagnostics().errors();
  Stream stream;
  stream.name = name;
  if (const Node* const sources = pick.need_array("sources")) {
    if (sources->items.size() == 1)
      stream.talker = builder.node(text_of(reader, sources->items.front()), where);
    else
      reader.error(*sources, "a stream with several talkers is not understood",
                   {std::to_string(sources->items.size()), "one"});
  }
  if (const Node* const listeners = pick.need_array("destinations")) {
    if (listeners->items.empty()) reader.error(*listeners, "a stream without listeners");
    for (const Node& one : listeners->items) stream.listeners.push_back(builder.node(text_of(reader, one), where));
  }
  if (pick.whole("redundancy", {1, 1000}, 1) != 1)
    reader.error(*pick.find("redundancy"), "redundant streams are not understood",
                 {json::excerpt(*pick.find("redundancy")), "1"});
  if (const Node* const deadline = pick.find("deadline_ns"))
    reader.error(*deadline, "deadlines within the cycle are not understood", {json::excerpt(*deadline), "null"});
  stream.octets = static_cast<std::uint32_t>(pick.whole("frame_size_b", octets_range));
  stream.period = pick.scaled("cycle_time_ns", in_ns, period_range);
  stream.latency = pick.scaled_if_any("max_latency_ns", in_ns, time_range);
  if (builder.diagnostics().errors() != mistakes) return;
  if (const Node* const route = pick.find("route")) {
    std::vector<LinkIndex> links;
    for (const Node& each : route->items) {
      const auto link = each.items.size() == 2
                            ? builder.link_between(text_of(reader, each.items[0]), text_of(reader, each.items[1]))
                            : std::nullopt;
      if (link)
        links.push_back(*link);
      else
        reader.error(each, "not a link", {json::excerpt(each), "two nodes that a link joins"});
    }
    if (builder.diagnostics().errors() != mistakes) return;
    builder.set_route(stream, std::move(links), where);
  }
  builder.add_stream(std::move(stream), where);
}

}  // namespace

Instance read_tsn_bench_scenario(const json::Document& topology, const json::Document& streams,
                                 json::Diagnostics& diagnostics) {
  Builder builder(diagnostics);
  builder.problem().name = stem_of(streams.file_name());
  builder.problem().source = "TSNBenchScenarios";
  builder.problem().model.is_strict = true;
  json::Reader network(topology, diagnostics);
  read_topology(network, Pick(network, topology.root()), builder);
  if (diagnostics.has_errors()) return {};
  json::Reader reader(streams, diagnostics);
  for (const json::Member& member : streams.root().members)
    read_stream(reader, member.key, Pick(reader, member.value), builder);
  return builder.take();
}

}  // namespace takt::schedule_instances
