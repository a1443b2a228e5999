// SPDX-License-Identifier: Apache-2.0
#include "scenario/topology/named_path.hpp"

#include <set>
#include <vector>

#include "json/suggest.hpp"

namespace takt::scenario {

NamedStep step_named(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? NamedStep{name, {}}
                                         : NamedStep{name.substr(0, colon), name.substr(colon + 1)};
}

namespace {

/// The link from `from` to `to` by that port; null if there is none.
const Neighbour* link_by(const Topology& topology, std::uint32_t from, std::uint32_t to,
                         const std::optional<std::string_view>& port) {
  for (const Neighbour& neighbour : topology.neighbours[from])
    if (neighbour.node == to && (!port || std::to_string(neighbour.port) == *port)) return &neighbour;
  return nullptr;
}

}  // namespace

Path path_named(const Topology& topology, std::span<const std::string> names) {
  Path path{*topology.find(step_named(names.front()).node)};
  for (std::size_t i = 1; i < names.size(); ++i)
    append(topology, path,
           *link_by(topology, path.back(), *topology.find(step_named(names[i]).node), step_named(names[i - 1]).port));
  return path;
}

std::optional<Path> named_path(const Topology& topology, std::span<const std::string> names, std::uint32_t from,
                               std::uint32_t to, const json::Place& place_of_all,
                               const std::function<json::Place(std::size_t)>& place_of,
                               json::Diagnostics& diagnostics) {
  std::vector<std::uint32_t> path;
  const std::size_t errors_before = diagnostics.errors();
  std::set<std::uint32_t> seen;
  bool follows_a_gap = false;  // the node before is none, so no link is missed
  for (std::size_t i = 0; i < names.size(); ++i) {
    const NamedStep step = step_named(names[i]);
    const std::string name(step.node);
    const json::Place place = place_of(i);
    const auto node = topology.find(name);
    if (!node) {
      report_unknown_node(topology, name, place, "the name of a node", diagnostics);
      follows_a_gap = true;
      continue;
    }
    if (!seen.insert(*node).second)
      diagnostics.error(place, "a node twice in one path", {json::quote(name), "each node once"});
    const bool inner = i > 0 && i + 1 < names.size();
    if (inner && !topology.nodes[*node].forwards())
      diagnostics.error_unless(topology.nodes[*node].is_of_unknown_kind, place, "a host inside a path",
                               {json::quote(name), "a switch or a station, since hosts do not forward"});
    if (!path.empty() && !follows_a_gap && !topology.port_towards(path.back(), *node))
      diagnostics.error_unless(
          !topology.has_all_links, place, "no link",
          {"none between " + json::quote(topology.nodes[path.back()].name) + " and " + json::quote(name),
           "neighbours along the path"});
    else if (!path.empty() && !follows_a_gap)
      if (const auto port = step_named(names[i - 1]).port;
          port && link_by(topology, path.back(), *node, port) == nullptr)
        diagnostics.error(place_of(i - 1), "not a port that leads on",
                          {json::quote(names[i - 1]),
                           "a port of " + json::quote(topology.nodes[path.back()].name) + " to " + json::quote(name)});
    if (step.port && i + 1 == names.size())
      diagnostics.error(place, "a port at the end of a path", {json::quote(names[i]), json::quote(name)});
    follows_a_gap = false;
    path.push_back(*node);
  }
  if (diagnostics.errors() != errors_before) return std::nullopt;
  if (path.empty() || path.front() != from || path.back() != to) {
    diagnostics.error(place_of_all, "a path between other nodes",
                      {path.empty() ? "no nodes" : json::quote(names.front()) + " to " + json::quote(names.back()),
                       json::quote(topology.nodes[from].name) + " to " + json::quote(topology.nodes[to].name)});
    return std::nullopt;
  }
  return path_named(topology, names);
}

}  // namespace takt::scenario
