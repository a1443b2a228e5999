// SPDX-License-Identifier: Apache-2.0
// The topology as a picture: switches on an inner circle in the order of a walk, what hangs at them outside.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "interchange/graph/graph.hpp"
#include "xml/xml.hpp"
#include "json/quantity.hpp"

namespace takt::interchange {
namespace {

struct Point {
  double x = 0, y = 0;
};

/// Nodes that forward, neighbours after each other where that can be.
std::vector<std::uint32_t> walk_of(const scenario::Topology& topology) {
  std::vector<std::uint32_t> order;
  std::set<std::uint32_t> seen;
  for (std::uint32_t start = 0; start < topology.nodes.size(); ++start) {
    std::vector<std::uint32_t> open = {start};
    while (!open.empty()) {
      const std::uint32_t node = open.back();
      open.pop_back();
      if (!topology.nodes[node].forwards() || !seen.insert(node).second) continue;
      order.push_back(node);
      for (auto each = topology.neighbours[node].rbegin(); each != topology.neighbours[node].rend(); ++each)
        open.push_back(each->node);
    }
  }
  return order;
}

}  // namespace

Exported export_svg(const ExportRequest& request) {
  const scenario::Resolved& r = request.resolved;
  const scenario::Topology& topology = r.topology;
  const std::vector<std::uint32_t> inner = walk_of(topology);
  const double turn = 2 * std::numbers::pi;
  const double radius = inner.size() < 2 ? 0 : std::max(120.0, 26.0 * static_cast<double>(inner.size()));
  std::vector<Point> at(topology.nodes.size());
  std::vector<bool> placed(topology.nodes.size(), false);
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const double angle = turn * static_cast<double>(i) / static_cast<double>(inner.size()) - turn / 4;
    at[inner[i]] = {radius * std::cos(angle), radius * std::sin(angle)};
    placed[inner[i]] = true;
    std::vector<std::uint32_t> leaves;
    for (const scenario::Neighbour& each : topology.neighbours[inner[i]])
      if (!placed[each.node] && !topology.nodes[each.node].forwards()) leaves.push_back(each.node);
    // What hangs at one switch is spread over its part of the circle.
    const double part = inner.size() < 2 ? turn : turn / static_cast<double>(inner.size());
    const double reach = std::max(radius + 110, static_cast<double>(leaves.size()) * 62 / part);
    for (std::size_t k = 0; k < leaves.size(); ++k) {
      const double leaf = angle + part * ((static_cast<double>(k) + 0.5) / static_cast<double>(leaves.size()) - 0.5);
      at[leaves[k]] = {reach * std::cos(leaf), reach * std::sin(leaf)};
      placed[leaves[k]] = true;
    }
  }
  double free = 0;  // without a switch: side by side
  for (std::size_t n = 0; n < at.size(); ++n)
    if (!placed[n]) {
      at[n] = {free, radius + 260};
      free += 130;
    }
  Point least = at.empty() ? Point{} : at[0], most = least;
  for (const Point& point : at) {
    least = {std::min(least.x, point.x), std::min(least.y, point.y)};
    most = {std::max(most.x, point.x), std::max(most.y, point.y)};
  }
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.0f} {:.0f} {:.0f} {:.0f}\" font-family=\"sans-serif\" "
      "font-size=\"12\" text-anchor=\"middle\">\n<title>{}</title>\n",
      least.x - 70, least.y - 40, most.x - least.x + 140, most.y - least.y + 80, xml_escaped(r.scenario.name));
  for (const models::LinkPlan& link : r.plan.links) {
    const Point a = at[link.a.node.value], b = at[link.b.node.value];
    const double width = link.rate.bits_per_second >= 10'000'000'000  ? 4
                         : link.rate.bits_per_second >= 1'000'000'000 ? 2
                                                                      : 1;
    text += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#667\" "
        "stroke-width=\"{}\"><title>{}:{} to {}:{}, {}, {}</title></line>\n",
        a.x, a.y, b.x, b.y, width, xml_escaped(r.plan.nodes[link.a.node.value].name), link.a.port,
        xml_escaped(r.plan.nodes[link.b.node.value].name), link.b.port, json::to_text(link.rate),
        json::to_text(link.delay));
  }
  for (std::size_t n = 0; n < at.size(); ++n) {
    const models::NodePlan& node = r.plan.nodes[n];
    const double half = std::max(22.0, 4.0 * static_cast<double>(node.name.size()));
    const char* const fill = node.kind == models::NodeKind::host     ? "#e8f1fb"
                             : node.kind == models::NodeKind::bridge ? "#fdf3dc"
                                                                     : "#e6f5e6";
    text += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"24\" rx=\"{}\" fill=\"{}\" stroke=\"#334\"/>\n<text "
        "x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        at[n].x - half, at[n].y - 12, 2 * half, node.kind == models::NodeKind::bridge ? 2 : 12, fill, at[n].x,
        at[n].y + 4, xml_escaped(node.name));
  }
  Exported exported;
  exported.files.push_back({r.scenario.name + ".svg", text + "</svg>\n"});
  return exported;
}

}  // namespace takt::interchange
