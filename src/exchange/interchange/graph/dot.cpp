// SPDX-License-Identifier: Apache-2.0
// Graphviz: nodes and links, wider where a link is faster.
#include <fmt/format.h>

#include "interchange/graph/graph.hpp"
#include "json/quantity.hpp"

namespace takt::interchange {
namespace {

std::string dot_quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

}  // namespace

Exported export_dot(const ExportRequest& request) {
  const scenario::Resolved& r = request.resolved;
  std::string text = "graph " + dot_quoted(r.scenario.name) +
                     " {\n  layout=neato; overlap=false; splines=true;\n  node [fontname=\"sans-serif\"]; edge "
                     "[fontname=\"sans-serif\", fontsize=9];\n";
  for (std::uint32_t n = 0; n < r.plan.nodes.size(); ++n) {
    const models::NodePlan& node = r.plan.nodes[n];
    const char* const shape = node.kind == models::NodeKind::host     ? "ellipse"
                              : node.kind == models::NodeKind::bridge ? "box"
                                                                      : "octagon";
    text += fmt::format("  {} [shape={}];\n", dot_quoted(node.name), shape);
  }
  for (const models::LinkPlan& link : r.plan.links) {
    const int width = link.rate.bits_per_second >= 10'000'000'000  ? 3
                      : link.rate.bits_per_second >= 1'000'000'000 ? 2
                                                                   : 1;
    text += fmt::format(
        "  {} -- {} [label={}, taillabel=\"{}\", headlabel=\"{}\", penwidth={}];\n",
        dot_quoted(r.plan.nodes[link.a.node.value].name), dot_quoted(r.plan.nodes[link.b.node.value].name),
        dot_quoted(json::to_text(link.rate) + ", " + json::to_text(link.delay)), link.a.port, link.b.port, width);
  }
  Exported exported;
  exported.files.push_back({r.scenario.name + ".dot", text + "}\n"});
  return exported;
}

}  // namespace takt::interchange
