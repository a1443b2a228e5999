// SPDX-License-Identifier: Apache-2.0
// TAS_Benchmark of the University of Tuebingen: times in ns, sizes with all that is on the wire, routes given. The
// length of gate lists stands at the link or at the node.
#include <map>

#include "schedule_instances/formats.hpp"

namespace takt::schedule_instances {

using namespace schedule;
using json::Node;

Instance read_tas_benchmark(const json::Document& document, json::Diagnostics& diagnostics) {
  constexpr double ns = 1'000;
  json::Reader reader(document, diagnostics);
  const Pick top(reader, document.root());
  Builder builder(diagnostics);
  builder.problem().name = top.text("name");
  builder.problem().source = "TAS_Benchmark";
  builder.problem().model.preamble = 0;
  builder.problem().model.gap = 0;
  struct AtNode {
    Ps delay = 0;
    std::optional<std::int64_t> entries;
  };
  std::map<std::string, AtNode> at_node;
  constexpr Range entries{0, 1'000'000};  // 0 stands at end stations, and means nothing
  if (const Node* const nodes = top.need_array("nodes"))
    for (const Node& each : nodes->items) {
      const Pick pick(reader, each);
      const std::string name = pick.text("name");
      const bool is_bridge = pick.truth("isBridge");
      builder.add_node(name, is_bridge, reader.source(each).place());
      at_node[name] = {is_bridge ? pick.scaled("processingDelay", ns, delay_range, 0) : 0,
                       pick.whole_if_any("gclEntries", entries)};
    }
  if (const Node* const links = top.need_array("links/ports"))
    for (const Node& each : links->items) {
      const Pick pick(reader, each);
      const json::Place where = reader.source(each).place();
      const std::string from = pick.text("source"), to = pick.text("destination");
      Link link;
      link.name = pick.text("name");
      link.octet = builder.octet_of(pick.scaled("transmissionRate", 8e9, rate_range), where);
      link.propagation = pick.scaled("propagationDelay", ns, delay_range, 0);
      link.forwarding = at_node[to].delay;
      const std::int64_t list = pick.whole("gclEntries", entries, at_node[from].entries.value_or(0));
      link.entries = list == 0 ? 1024 : static_cast<std::uint32_t>(list);
      builder.add_link(std::move(link), from, to, where);
    }
  if (diagnostics.has_errors()) return {};
  if (const Node* const streams = top.need_array("streams"))
    for (const Node& each : streams->items) {
      const Pick pick(reader, each);
      const json::Place where = reader.source(each).place();
      const std::size_t mistakes = diagnostics.errors();
      Stream stream;
      stream.name = pick.text("name");
      stream.talker = builder.node(pick.text("talker"), where);
      if (const Node* const listeners = pick.need_array("listeners")) {
        if (listeners->items.empty()) reader.error(*listeners, "a stream without listeners");
        for (const Node& one : listeners->items) stream.listeners.push_back(builder.node(text_of(reader, one), where));
      }
      stream.octets = static_cast<std::uint32_t>(pick.scaled("maxFrameSize", 1, octets_range));
      stream.frames = static_cast<std::uint32_t>(pick.whole("framesPerPeriod", frames_range, 1));
      stream.period = pick.scaled("period", ns, period_range);
      stream.release = pick.scaled("earliestOffset", ns, time_range, 0);
      stream.deadline = pick.scaled("deadline", ns, time_range);
      stream.latency = pick.scaled("maxLatency", ns, time_range);
      stream.traffic_class = static_cast<std::uint8_t>(pick.whole("priority", {0, 7}, 7));
      std::vector<LinkIndex> links;
      if (const Node* const path = pick.need_array("path"))
        for (const Node& one : path->items) {
          const std::string name = text_of(reader, one);
          if (const auto link = builder.link(name))
            links.push_back(*link);
          else
            reader.error(one, "there is no link " + json::quote(name));
        }
      if (diagnostics.errors() != mistakes) continue;
      builder.set_route(stream, std::move(links), where);
      builder.add_stream(std::move(stream), where);
    }
  return builder.take();
}

}  // namespace takt::schedule_instances
