// SPDX-License-Identifier: Apache-2.0
// GraphML of the topology: nodes with their kind and forwarding delay, edges with ports, rate and delay.
#include <fmt/format.h>

#include "interchange/graph/graph.hpp"
#include "xml/xml.hpp"
#include "json/quantity.hpp"

namespace takt::interchange {

Exported export_graphml(const ExportRequest& request) {
  const scenario::Resolved& r = request.resolved;
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n"
      "  <key id=\"kind\" for=\"node\" attr.name=\"kind\" attr.type=\"string\"/>\n  <key id=\"forwarding_delay\" "
      "for=\"node\" attr.name=\"forwarding_delay\" attr.type=\"string\"/>\n"
      "  <key id=\"rate\" for=\"edge\" attr.name=\"rate\" attr.type=\"string\"/>\n  <key id=\"delay\" for=\"edge\" "
      "attr.name=\"delay\" attr.type=\"string\"/>\n"
      "  <key id=\"source_port\" for=\"edge\" attr.name=\"source_port\" attr.type=\"int\"/>\n  <key id=\"target_port\" "
      "for=\"edge\" attr.name=\"target_port\" attr.type=\"int\"/>\n";
  text += fmt::format("  <graph id=\"{}\" edgedefault=\"undirected\">\n", xml_escaped(r.scenario.name));
  constexpr const char* kinds[] = {"host", "switch", "station"};
  for (const models::NodePlan& node : r.plan.nodes) {
    text += fmt::format("    <node id=\"{}\"><data key=\"kind\">{}</data>", xml_escaped(node.name),
                        kinds[static_cast<std::size_t>(node.kind)]);
    if (node.forwards())
      text += fmt::format("<data key=\"forwarding_delay\">{}</data>", json::to_text(node.forwarding_delay));
    text += "</node>\n";
  }
  for (const models::LinkPlan& link : r.plan.links)
    text += fmt::format(
        "    <edge source=\"{}\" target=\"{}\"><data key=\"rate\">{}</data><data key=\"delay\">{}</data><data "
        "key=\"source_port\">{}</data><data key=\"target_port\">{}</data></edge>\n",
        xml_escaped(r.plan.nodes[link.a.node.value].name), xml_escaped(r.plan.nodes[link.b.node.value].name),
        json::to_text(link.rate), json::to_text(link.delay), link.a.port, link.b.port);
  Exported exported;
  exported.files.push_back({r.scenario.name + ".graphml", text + "  </graph>\n</graphml>\n"});
  return exported;
}

}  // namespace takt::interchange
