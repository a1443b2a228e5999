// SPDX-License-Identifier: Apache-2.0
#include "studio/plant.hpp"

#include <cstdint>
#include <optional>
#include <vector>

#include "json/node.hpp"
#include "report/network_figure.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::studio {
namespace {

const char* name_of(chart::NetworkNode::Kind kind) {
  switch (kind) {
    case chart::NetworkNode::Kind::host:
      return "host";
    case chart::NetworkNode::Kind::bridge:
      return "switch";
    case chart::NetworkNode::Kind::station:
      return "station";
  }
  return "";
}

using json::Node;

Node paths_of(const scenario::Resolved& resolved, const std::vector<std::optional<std::size_t>>& drawn) {
  Node paths = Node::object();
  for (const scenario::ResolvedStream& stream : resolved.streams) {
    Node list = Node::array();
    for (const scenario::Path& path : stream.paths) {
      Node nodes = Node::array();
      for (const std::uint32_t node : path)
        if (drawn[node]) nodes.items.push_back(Node::of_integer(static_cast<std::int64_t>(*drawn[node])));
      list.items.push_back(std::move(nodes));
    }
    paths.add(resolved.plan.streams[stream.index.value].name, std::move(list));
  }
  return paths;
}

Node requirements_of(const scenario::Resolved& resolved, const results::RunResult* result) {
  Node list = Node::array();
  if (result == nullptr) return list;
  for (const results::RequirementResult& each : result->requirements) {
    Node made = Node::object();
    made.add("entry", each.requirement
                          ? Node::of_integer(static_cast<std::int64_t>(resolved.requirements[*each.requirement].entry))
                          : Node());
    made.add("subject", Node::of_string(each.subject));
    list.items.push_back(std::move(made));
  }
  return list;
}

}  // namespace

std::string plant_json(const scenario::Resolved& resolved, const results::RunResult* result) {
  const chart::NetworkChart network = report::network_figure(resolved, result);
  Node page = Node::object();
  Node nodes = Node::array();
  Node links = Node::array();
  Node legend = Node::array();
  const auto places = chart::places(network);
  std::vector<std::optional<std::size_t>> number(places.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (!places[n]) continue;
    const chart::NetworkNode& node = network.nodes[n];
    number[n] = nodes.items.size();
    Node made = Node::object();
    made.add("name", Node::of_string(node.name));
    made.add("kind", Node::of_string(name_of(node.kind)));
    made.add("title", Node::of_string(node.title));
    made.add("failed", Node::of_bool(node.has_failed));
    made.add("x", Node::of_double(places[n]->x));
    made.add("y", Node::of_double(places[n]->y));
    nodes.items.push_back(std::move(made));
  }
  for (const chart::NetworkLink& link : network.links) {
    if (!places[link.a] || !places[link.b]) continue;
    Node made = Node::object();
    made.add("a", Node::of_integer(static_cast<std::int64_t>(*number[link.a])));
    made.add("b", Node::of_integer(static_cast<std::int64_t>(*number[link.b])));
    made.add("colour", Node::of_string(chart::colour_of_load(link.load)));
    made.add("title", Node::of_string(link.title));
    made.add("failed", Node::of_bool(link.has_failed));
    links.items.push_back(std::move(made));
  }
  for (const chart::LoadColour& each : chart::load_colours()) {
    Node made = Node::object();
    made.add("colour", Node::of_string(each.colour));
    made.add("text", Node::of_string(each.text));
    legend.items.push_back(std::move(made));
  }
  page.add("hidden", Node::of_integer(static_cast<std::int64_t>(network.nodes.size() - nodes.items.size())));
  page.add("nodes", std::move(nodes));
  page.add("links", std::move(links));
  page.add("legend", std::move(legend));
  page.add("paths", paths_of(resolved, number));
  page.add("requirements", requirements_of(resolved, result));
  return json::compact(page);
}

}  // namespace takt::studio
